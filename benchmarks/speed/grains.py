"""Cost of a grain-step in worlds of any size, and the gain from bands on all cores."""

from pathlib import Path

from matplotlib.figure import Figure

from benchmarks.speed.beds import usual_bed
from benchmarks.speed.drawing import draw_with_range
from benchmarks.speed.workers import Speeds, Worker, compared, millions, ratio
from lab.report.page import Page
from lab.report.plots import BELOW, BLUE, VERMILION, canvas
from solvers.machine.runtime import available_cores

COUNT = 500  # of the bed that is copied
SIZES = (500, 2000, 10_000, 100_000, 1_000_000)
ONE, BANDS = "one core", "bands on all cores"
COLOURS = {ONE: BLUE, BANDS: VERMILION}


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    sizes, turns, seconds = (SIZES[:3], 3, 0.1) if fast else (SIZES, 5, 0.4)
    page.section("Grains")
    page.say(f"""One world of {COUNT} settled, touching grains and as many copies of it side by side as it takes, in 64
        bits, with friction that has a history: on one core, and cut into bands on {available_cores()}.""")
    found = {size: measured(work, size, turns, seconds) for size in sizes}
    page.table(
        ["grains", *(f"M, {name}" for name in COLOURS), "gain of the bands"],
        [[f"{n:,}", *(millions(s) for s in v.values()), ratio(v[BANDS], v[ONE])] for n, v in found.items()],
    )
    page.figure("grains", plotted(found), "Grain-steps a second against the number of grains")


def measured(work: Path, size: int, turns: int, seconds: float) -> Speeds:
    """Grain-steps per second (turns,) of a world of `size` grains, on one core and on all."""
    print(f"grains: {size}", flush=True)
    bed = usual_bed(work, COUNT).times(size // COUNT)
    made = {
        ONE: lambda: Worker(bed, 1, schedule="per-world"),
        BANDS: lambda: Worker(bed, available_cores(), schedule="per-band"),
    }
    return compared(made, turns, seconds)


def plotted(found: dict[int, Speeds]) -> Figure:
    """Medians with their ranges against the number of grains."""
    figure, axes = canvas((6.4, 3.0))
    for name, colour in COLOURS.items():
        draw_with_range(axes, list(found), [found[size][name] for size in found], colour, name)
    axes.set(xscale="log", xlabel="grains", ylabel="million grain-steps a second", ylim=(0.0, None))
    axes.set_xticks(list(found), [f"{size:,}" for size in found])
    axes.minorticks_off()
    figure.legend(loc=BELOW, ncols=len(COLOURS))
    return figure
