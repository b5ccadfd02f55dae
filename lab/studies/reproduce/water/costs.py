"""Runs of water beside what was measured: the last one is held against it, all are told with what they cost."""

from collections.abc import Callable, Iterable, Mapping, Sequence

from matplotlib.figure import Figure

from lab.studies.reproduce.experiment import Found, Row, Told
from lab.studies.reproduce.runs import Outcome

COSTS = ("run", "particles", "steps", "time step", "time")


def beside(
    found: Found,
    heads: Sequence[str],
    cells: Callable[[Outcome], Iterable[str]],
    rows: Callable[[str, Outcome], list[Row]],
    figure: Callable[[Mapping[str, Outcome]], Figure],
) -> Told:
    """The rows of the last run, a figure of all, and a table of all: their cost and the `cells` under `heads`."""
    runs = {label: outcomes[0] for label, outcomes in found.items()}
    table = [[*COSTS, *heads], *([*cost(label, one), *cells(one)] for label, one in runs.items())]
    return Told(rows(*list(runs.items())[-1]), figure(runs), table)


def cost(label: str, one: Outcome) -> list[str]:
    """The cells of a run: its name, particles, steps, mean step and time with compiling and output."""
    recording = one.recording
    particles = recording.volume.shape[1]
    steps = one.cost["grain_steps"] / particles
    mean = 1e6 * float(recording.series["time"][-1]) / steps
    return [label, f"{particles}", f"{steps:.0f}", f"{mean:.0f} µs", f"{one.cost['wall_s']:.0f} s"]
