"""The figure of both matters: speed against size, a panel a shape."""

from collections.abc import Mapping

from matplotlib.figure import Figure

from benchmarks.gpu.turns import BESIDE, heading
from benchmarks.speed.drawing import draw_with_range
from benchmarks.speed.workers import Speeds
from lab.report.plots import BELOW, BLUE, GREEN, GREY, VERMILION

COLOURS = {"f64": BLUE, "mixed": GREEN, "f32": VERMILION, BESIDE: GREY}


def plotted(found: Mapping[tuple[str, int], Speeds], what: str) -> Figure:
    """Medians with their ranges against the number of `what`s, by shape and number, for each precision and BESIDE."""
    shapes = list(dict.fromkeys(shape for shape, _ in found))
    figure = Figure(figsize=(6.4, 3.0), layout="constrained")
    for axes, shape in zip(figure.subplots(1, len(shapes), sharey=True), shapes, strict=True):
        for name, colour in COLOURS.items():
            done = {number: v[name] for (of, number), v in found.items() if of == shape and name in v}
            if done:
                draw_with_range(axes, list(done), list(done.values()), colour, heading(name))
        axes.set(title=shape, xscale="log", yscale="log", xlabel=f"{what}s")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc=BELOW, ncols=len(COLOURS))
    figure.axes[0].set_ylabel(f"million {what}-steps a second")
    return figure
