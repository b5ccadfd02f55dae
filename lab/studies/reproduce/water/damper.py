"""The roll of a tank on an axle beside SPHERIC's benchmark 9: Bulian, Souto-Iglesias, Delorme & Botia-Vera (2010).

J. Hydraul. Res. 48, extra issue, 28. The tank and the water in it swing at nearly the same period, and the mass drives
them at it: the water's wave opposes the roll. The mass slides as its record says.
"""

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.measured import drawn, series

MEASURED = "spheric09_tuned_liquid_damper/motion_and_roll.csv"
TIME, EMPTY, WATER = 0, 3, 4  # columns: s, deg, deg
SETTLED = 10.0  # s: from then on the curves' times are compared
APART = 0.5  # s: the farthest that one curve is shifted along the other
ROLL = 2  # of a pose
DRY = "empty"
COLOURS = BLUE, VERMILION, GREEN


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


def _column(one: Outcome) -> int:
    """The column of the record that a run is held against."""
    return EMPTY if one.recording.preset.water is None else WATER


def largest_roll(one: Outcome, _: object) -> float:
    """The largest roll (deg)."""
    return float(np.abs(roll(one)[1]).max())


def later(one: Outcome, _: object) -> float:
    """By how much (s) the run is later than the record; NaN without it."""
    record = series(MEASURED)
    return np.nan if record is None else late(*roll(one), record[TIME], record[_column(one)])


def off(one: Outcome, _: object) -> float:
    """Root mean square difference (deg) from the record; NaN without it."""
    record, (time, ours) = series(MEASURED), roll(one)
    if record is None:
        return np.nan
    return float(np.sqrt(np.mean((ours - np.interp(time, record[TIME], record[_column(one)])) ** 2)))


NUMBERS = {"axle_largest_roll": ("deg", largest_roll), "roll_later": ("s", later), "roll_off": ("deg", off)}


def figure(found: Found) -> Figure:
    """The roll of the empty tank and of those with water, or with another liquid alone, beside the record."""
    runs = {label: outcomes[0] for label, outcomes in found.items()}
    wet = [label for label in runs if label != DRY]
    panels = (
        [(EMPTY, "measured", [DRY]), (WATER, "measured", wet)] if DRY in runs else [(EMPTY, "measured, empty", wet)]
    )
    drawing, axes_of = canvas((SIZE[0], 2.5 * len(panels)), len(panels), 1, sharex=True)
    named = {}
    for axes, (column, words, labels) in zip(np.atleast_1d(axes_of), panels, strict=True):
        record = drawn(axes, MEASURED)
        if record is not None:
            axes.plot(record[TIME], record[column], color="black", lw=0.8, label=words)
        for label, colour in zip(labels, COLOURS[len(panels) - 1 if DRY not in labels else 0 :], strict=False):
            axes.plot(*roll(runs[label]), color=colour, lw=0.9, ls="--" if label == DRY else "-", label=label)
        axes.set_ylabel("roll (deg)")
        lines, words = axes.get_legend_handles_labels()
        named |= dict(zip(words, lines, strict=True))
    axes.set_xlabel("time (s)")
    drawing.legend(named.values(), named.keys(), loc=BELOW, ncols=4)
    return drawing
