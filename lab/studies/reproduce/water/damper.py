"""The roll of a tank on an axle beside SPHERIC's benchmark 9: Bulian, Souto-Iglesias, Delorme & Botia-Vera (2010).

J. Hydraul. Res. 48, extra issue, 28. The tank and the water in it swing at nearly the same period, and the mass drives
them at it: the water's wave opposes the roll. The mass slides as its record says.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.estimates import Estimate
from lab.studies.reproduce.experiment import Found, Row, Told, alone, held
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.costs import COSTS, cost
from lab.studies.reproduce.water.measured import drawn, series

MEASURED = "spheric09_tuned_liquid_damper/motion_and_roll.csv"
TIME, EMPTY, WATER = 0, 3, 4  # columns: s, deg, deg
LARGEST = {EMPTY: 38.16, WATER: 9.468}  # deg, of the record until 31.5 s
SETTLED = 10.0  # s: from then on the curves' times are compared
APART = 0.5  # s: the farthest that one curve is shifted along the other
EXACT, SOUND = "3 %: the mechanics alone", "10 %: what a sound computation is expected to give"
LATE = "0.1 s: what a sound computation is expected to give"
ROLL = 2  # of a pose
DRY = "empty"
COLOURS = BLUE, VERMILION, GREEN


def tell(found: Found) -> Told:
    """The empty tank, then that with water in the finest run; all runs with their errors and costs."""
    runs = {label: outcomes[0] for label, outcomes in found.items()}
    record, wet = series(MEASURED), [label for label in runs if label != DRY]
    rows = _rows("empty tank", runs[DRY], record, EMPTY, 0.03, EXACT)
    rows += _rows(f"with water, {wet[-1]}", runs[wet[-1]], record, WATER, 0.1, SOUND)
    cells = [_cells(label, runs[label], record) for label in wet]
    heads = "largest roll", "beside the measured curve", "energy of the water", "of the tank"
    return Told(rows, _figure(runs, wet), [[*COSTS, *heads], *cells])


def roll(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times (T,) s and roll (T,) deg of a run."""
    return one.recording.series["time"], np.degrees(one.recording.series["pose"][:, 0, ROLL])


def late(time: np.ndarray, ours: np.ndarray, when: np.ndarray, theirs: np.ndarray) -> float:
    """By how much (s) one curve is later than another: the shift at which both are most alike, from SETTLED on."""
    shifts = np.linspace(-APART, APART, 201)
    at = when[(when >= SETTLED + APART) & (when <= time[-1] - APART)]
    wanted = np.interp(at, when, theirs)
    likeness = [float(np.interp(at + shift, time, ours) @ wanted) for shift in shifts]
    return float(shifts[int(np.argmax(likeness))])


def _rows(name: str, one: Outcome, record: np.ndarray | None, column: int, share: float, origin: str) -> Sequence[Row]:
    time, ours = roll(one)
    size = LARGEST[column]
    between = (1.0 - share) * size, (1.0 + share) * size
    largest = Estimate.exact(float(np.abs(ours).max()))
    rows = [held(f"largest roll, {name}", f"{size:g} deg", largest, between, origin, "deg")]
    shift = None if record is None else Estimate.exact(late(time, ours, record[TIME], record[column]))
    return [*rows, held(f"later than measured from {SETTLED:g} s on, {name}", "0 s", shift, (-0.1, 0.1), LATE, "s")]


def _cells(label: str, one: Outcome, record: np.ndarray | None) -> list[str]:
    time, ours = roll(one)
    apart = "no record"
    if record is not None:
        theirs = np.interp(time, record[TIME], record[WATER])
        shift = late(time, ours, record[TIME], record[WATER])
        apart = f"{np.sqrt(np.mean((ours - theirs) ** 2)):.2f} deg (rms), {shift:+.3f} s"
    residuals = [alone(one[name]) for name in ("water_residual", "axle_residual")]
    return [*cost(label, one), f"{np.abs(ours).max():.2f} deg", apart, *residuals]


def _figure(runs: dict[str, Outcome], wet: Sequence[str]) -> Figure:
    figure, (upper, lower) = canvas((SIZE[0], 5.0), 2, 1, sharex=True)
    record = drawn(upper, MEASURED)
    for axes, column, labels in ((upper, EMPTY, [DRY]), (lower, WATER, wet)):
        if record is not None:
            axes.plot(record[TIME], record[column], color="black", lw=0.8, label="measured")
        for label, colour in zip(labels, COLOURS[column == WATER :], strict=False):
            axes.plot(*roll(runs[label]), color=colour, lw=0.9, ls="--" if column == EMPTY else "-", label=label)
        axes.set_ylabel("roll (deg)")
    lower.set_xlabel("time (s)")
    (lines, names), (more, further) = (axes.get_legend_handles_labels() for axes in (upper, lower))
    named = dict(zip([*names, *further], [*lines, *more], strict=True))
    figure.legend(named.values(), named.keys(), loc=BELOW, ncols=4)
    return figure
