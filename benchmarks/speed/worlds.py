"""Speed of batches of equal worlds, and the gain from a second thread."""

from pathlib import Path

from matplotlib.figure import Figure

from benchmarks.speed.beds import WIDTHS, usual_bed
from benchmarks.speed.drawing import draw_with_range
from benchmarks.speed.workers import Speeds, Worker, compared, millions, ratio
from lab.report.page import Page
from lab.report.plots import BELOW, BLUE, VERMILION
from solvers.machine.runtime import available_cores

WORLDS = (1, 2, 4, 16, 64, 256)
THREADS = {1: BLUE, 2: VERMILION}


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    counts, worlds, turns, seconds = ([500], WORLDS[:4], 3, 0.1) if fast else (list(WIDTHS), WORLDS, 5, 0.4)
    page.section("Worlds")
    if available_cores() < 2:
        page.say("Only one core is there: what a second thread gives is unmeasured.")
        return
    page.say("""Batches of equal worlds, each of which runs its whole time loop on one thread (schedule per-world), on
        one thread and on two.""")
    found = {n: {number: measured(work, n, number, turns, seconds) for number in worlds} for n in counts}
    page.table(
        ["grains a world", "worlds", "M, one thread", "M, two threads", "gain of the second thread"],
        [
            [n, number, *(millions(s) for s in v.values()), ratio(v[2], v[1])]
            for n, rows in found.items()
            for number, v in rows.items()
        ],
    )
    page.figure("worlds", plotted(found), "Grain-steps a second against the number of worlds")


def measured(work: Path, count: int, number: int, turns: int, seconds: float) -> Speeds:
    """Grain-steps a second (turns,) of a batch by the number of threads."""
    print(f"worlds: {number} of {count} grains", flush=True)
    bed = usual_bed(work, count)
    made = {n: lambda n=n: Worker(bed, n, number, schedule="per-world") for n in THREADS}
    return compared(made, turns, seconds)


def plotted(found: dict[int, dict[int, Speeds]]) -> Figure:
    """Medians with their ranges against the number of worlds, one panel a size of the worlds."""
    figure = Figure(figsize=(6.4, 3.0), layout="constrained")
    for axes, (count, rows) in zip(
        figure.subplots(1, len(found), sharey=True, squeeze=False)[0], found.items(), strict=True
    ):
        for threads, colour in THREADS.items():
            label = f"{threads} thread{'s' if threads > 1 else ''}"
            draw_with_range(axes, list(rows), [v[threads] for v in rows.values()], colour, label)
        axes.set(title=f"worlds of {count} grains", xlabel="worlds", ylim=(0.0, None))
        axes.set_xscale("log", base=2)
        axes.set_xticks(list(rows), [str(number) for number in rows])
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc=BELOW, ncols=len(THREADS))
    figure.axes[0].set_ylabel("million grain-steps a second")
    return figure
