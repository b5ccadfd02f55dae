"""Irregular grains beside discs: how far beds go before they slide, what descriptors do to the critical angle."""

from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.measures.critical_angle import shift_curve
from lab.measures.value import Value, over_worlds
from lab.report.numbers import BARS
from lab.report.plots import GREY, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome

SECONDS = 2.0  # length of a swayed bed's course


def early_shift(outcomes: Sequence[Outcome], tilt: float) -> Value:
    """How far the centre of mass of each bed has gone downhill at a tilt (deg), mm."""
    recording = outcomes[0].recording
    curves = [shift_curve(recording, world) for world in range(recording.worlds)]
    return over_worlds([1e3 * np.interp(tilt, *curve) for curve in curves], "mm")


def early_range(outcomes: Sequence[Outcome], until: float) -> Value:
    """How far the centre of mass of each bed goes to and fro across the tank until a time (s), mm."""
    series = outcomes[0].recording.series
    return over_worlds(1e3 * np.ptp(series["centre_of_mass"][series["time"] <= until, :, 0], axis=0), "mm")


def descriptors(found: Found) -> Figure:
    """Critical angles over that of discs against the descriptor."""
    figure, axes = canvas((6.4, 3.4))
    discs = found["discs"][0]["critical_angle"]
    for name, outcomes in found.items():
        points = [(next(iter(one.setting.values()))[-1], one["critical_angle"]) for one in outcomes if one.setting]
        known = [(x, v.value / discs.value, (v.std or 0.0) / discs.value) for x, v in points if v and v.value]
        if known:
            axes.errorbar(*zip(*known, strict=True), fmt="o-", ms=3.5, capsize=2, label=name)
    axes.axhline(1.0, color=GREY, ls=":", lw=1.0)
    axes.set(xlabel="descriptor relative to R0", ylabel=f"critical angle over that of discs\n{BARS}")
    axes.legend()
    return figure


def courses(found: Found, motion: str, early: float, cost: bool = True) -> Figure:
    """Courses of discs, smooth outlines and nodes, compared until `early`, and the cost of a grain and step.

    motion: "tilt" (deg) or "sway" (s), which the centre of mass is drawn over.
    """
    figure = Figure(figsize=(7.2, 3.4) if cost else SIZE, layout="constrained")
    axes = figure.subplots(1, 1 + cost, squeeze=False)[0]
    of, labels = COURSES[motion]
    _draw_courses(axes[0], found, of, early, labels)
    if cost:
        axes[1].plot([_nodes(one) for one in found["nodes"]], [_time(one) for one in found["nodes"]], "o-", ms=3.5)
        for name, style in (("discs", ":"), ("smooth", "--")):
            axes[1].axhline(_time(found[name][0]), color=GREY, ls=style, lw=1.0, label=name)
        axes[1].set(xlabel="nodes", ylabel="time per grain and step, compiling\nand output included (µs)")
        axes[1].set_ylim(bottom=0.0)
        axes[1].legend()
    return figure


def _draw_courses(axes: Axes, found: Found, of: Callable, early: float, labels: tuple[str, str]) -> None:
    """Courses (x, y in m) of discs, smooth outlines, and few, more and many nodes."""
    by_nodes = {_nodes(one): one for one in found["nodes"]}
    nodes = {f"{n} nodes": by_nodes[n] for n in (36, 120, 500) if n in by_nodes}
    for name, one in {"discs": found["discs"][0], "smooth outlines": found["smooth"][0], **nodes}.items():
        x, y = of(one)
        axes.plot(x, 1e3 * y, label=name, lw=1.2)
    axes.axvline(early, color=GREY, ls=":", lw=1.0)
    axes.set(xlabel=labels[0], ylabel=labels[1])
    axes.legend()


def _tilted(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Tilt (deg) and how far the centre of mass of the first bed has gone downhill (m)."""
    return shift_curve(one.recording, 0)


def _swayed(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Time (s) and how far the centre of mass of the first bed is across the tank (m), at the beginning."""
    time, y = one.recording.series["time"], one.recording.series["centre_of_mass"][:, 0, 0]
    begun = time <= SECONDS
    return time[begun], y[begun] - y[0]


COURSES = {
    "tilt": (_tilted, ("tilt (deg)", "shift downhill of one bed (mm)")),
    "sway": (_swayed, ("time (s)", "centre of mass of one bed (mm)")),
}


def _nodes(one: Outcome) -> int:
    return one.setting["contact.nodes"]


def _time(one: Outcome) -> float:
    return 1e6 * one.cost["wall_s"] / one.cost["grain_steps"]
