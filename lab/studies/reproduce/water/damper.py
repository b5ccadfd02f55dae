"""The roll of a tank on an axle beside SPHERIC's benchmark 9: Bulian, Souto-Iglesias, Delorme & Botia-Vera (2010).

J. Hydraul. Res. 48, extra issue, 28. The tank and the water in it swing at nearly the same period, and the mass drives
them at it: the water's wave opposes the roll. What it opposes is told swing by swing: of the run, of shallow water
that is rolled alike, and what the measured roll asks of it, which is what the equation of the axle leaves over.
"""

from collections.abc import Iterable, Sequence
from functools import cache
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline
from scipy.signal import savgol_filter

from lab.preset.schema import Preset
from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.measured import drawn, series
from lab.studies.reproduce.water.theory.shallow_water import ShallowTank

MEASURED = "spheric09_tuned_liquid_damper/motion_and_roll.csv"
LIQUIDS = "spheric09_tuned_liquid_damper/roll_oil_glycerine.csv"
TIME, EMPTY, WATER = 0, 3, 4  # columns: s, deg, deg
# The measured roll with a liquid: its name, the file and the column (deg), by the liquid's density (kg/m³).
RECORDS = {998.0: ("water", MEASURED, WATER), 990.0: ("oil", LIQUIDS, 1), 1261.0: ("glycerine", LIQUIDS, 2)}
SETTLED = 10.0  # s: from then on the curves' times are compared
APART = 0.5  # s: the farthest that one curve is shifted along the other
ROLL = 2  # of a pose
GROWN = 2.5  # s: before, the tank hardly swings
CELLS = 200  # of shallow water: twice as many change its moments by 0.1 %
SMOOTH = 9  # samples, 0.18 s, over which the steps of the record's encoder are smoothed by cubics
DRY = "empty"
COLOURS = BLUE, VERMILION, GREEN, "#CC79A7", "#E69F00"  # Okabe & Ito (2008)


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


def _record(one: Outcome) -> tuple[str, str, int]:
    """The measured roll that a run is held against: of what, its file and its column."""
    water = one.recording.preset.water
    return ("empty", MEASURED, EMPTY) if water is None else RECORDS[water.density]


def _measured(one: Outcome) -> tuple[np.ndarray, np.ndarray] | None:
    """Times (T,) s and the measured roll (T,) deg of what a run has in its tank; None without the file."""
    _, file, column = _record(one)
    record = series(file)
    return None if record is None else (record[TIME], record[column])


def largest_roll(one: Outcome, _: object) -> float:
    """The largest roll (deg)."""
    return float(np.abs(roll(one)[1]).max())


def later(one: Outcome, _: object) -> float:
    """By how much (s) the run is later than the record; NaN without it."""
    record = _measured(one)
    return np.nan if record is None else late(*roll(one), *record)


def off(one: Outcome, _: object) -> float:
    """Root mean square difference (deg) from the record; NaN without it."""
    record, (time, ours) = _measured(one), roll(one)
    if record is None:
        return np.nan
    return float(np.sqrt(np.mean((ours - np.interp(time, *record)) ** 2)))


def opposed(time: np.ndarray, moment: np.ndarray, roll: np.ndarray) -> np.ndarray:
    """Of each swing from GROWN on its middle (s), its largest roll (deg) and the moment (N m) against its rate, (n, 3).

    The moment is that of a harmonic with the same work: −∫ Q φ̇ dt/∫ |φ̇| dt times 4/π. A swing is from one upward
    passage to the next; `roll` (T,) deg, `moment` (T,) N m.
    """
    passed = np.flatnonzero((roll[:-1] < 0.0) & (roll[1:] >= 0.0) & (time[1:] >= GROWN))
    found = []
    for begin, end in pairwise(passed):
        swing = slice(begin, end + 1)
        way = np.diff(roll[swing])
        work = np.sum(0.5 * (moment[swing][1:] + moment[swing][:-1]) * way)
        against = -4.0 / np.pi * work / np.abs(way).sum()
        found.append((0.5 * (time[begin] + time[end]), np.abs(roll[swing]).max(), against))
    return np.array(found).reshape(-1, 3)


def shallow(preset: Preset, time: np.ndarray, roll: np.ndarray) -> np.ndarray:
    """`opposed` of shallow water in the preset's tank that is made to roll, times (T,) s and roll (T,) deg."""
    tank = preset.tank.width, preset.water.depth, preset.axle.place[1], preset.run.gravity
    when, moment = _moments_of(tank, time.tobytes(), roll.tobytes())
    length = preset.axle.length or preset.thickness
    return opposed(when, preset.water.density * length * moment, np.interp(when, time, roll))


@cache  # takes seconds
def _moments_of(tank: tuple[float, float, float, float], times: bytes, rolls: bytes) -> np.ndarray:
    time = np.frombuffer(times)
    return ShallowTank(*tank, CELLS).moments(CubicSpline(time, np.radians(np.frombuffer(rolls))), float(time[-1]))


def asked(preset: Preset, time: np.ndarray, roll: np.ndarray) -> np.ndarray:
    """`opposed` of what a measured roll (T,) deg at times (T,) s asks of the water, by the equation of the axle."""
    axle, gravity, slide = preset.axle, preset.run.gravity, preset.axle.slide
    when = np.arange(time[0], min(time[-1], slide.motion.time[-1]), 0.1 * (time[1] - time[0]))
    smooth = CubicSpline(time, np.radians(savgol_filter(roll, SMOOTH, 3)))
    mass = CubicSpline(slide.motion.time, slide.motion.values)
    angle, rate, place = smooth(when), smooth(when, 1), mass(when)
    moment = (axle.inertia + slide.mass * place**2) * smooth(when, 2) + 2.0 * slide.mass * place * mass(when, 1) * rate
    moment += gravity * (slide.mass * place * np.cos(angle) - axle.moment * np.sin(angle))
    moment += axle.friction * np.sign(rate) + axle.damping * rate
    return opposed(when, moment, np.degrees(angle))


def moment_over_shallow(one: Outcome, _: object) -> float:
    """The water's moment against the roll over that of shallow water which rolls alike, mean of the swings.

    NaN without water.
    """
    if one.recording.preset.water is None:
        return np.nan
    time, ours = roll(one)
    found = opposed(time, one.recording.series["axle_moment"][:, 0], ours)
    theory = shallow(one.recording.preset, time, ours)
    return float(np.mean(found[:, 2] / np.interp(found[:, 0], theory[:, 0], theory[:, 2])))


NUMBERS = {
    "axle_largest_roll": ("deg", largest_roll),
    "roll_later": ("s", later),
    "roll_off": ("deg", off),
    "axle_moment_over_shallow": ("1", moment_over_shallow),
}


def figure(found: Found) -> Figure:
    """The roll of the empty tank and of those with water beside the record, and the water's moments."""
    runs = {label: outcomes[0] for label, outcomes in found.items()}
    wet = [label for label in runs if label != DRY]
    drawing, panels = canvas((SIZE[0], 7.5), 3, 1)
    _rolls(panels[0], {DRY: runs[DRY]}, [BLUE])
    _rolls(panels[1], {label: runs[label] for label in wet}, COLOURS[1:])
    panels[0].sharex(panels[1])
    _moments(panels[2], {label: runs[label] for label in wet})
    _legend(drawing, panels)
    return drawing


def liquid(found: Found) -> Figure:
    """The roll with another liquid beside the measured one."""
    drawing, axes = canvas((SIZE[0], 2.5))
    _rolls(axes, {label: outcomes[0] for label, outcomes in found.items()}, COLOURS)
    _legend(drawing, [axes])
    return drawing


def _rolls(axes: Axes, runs: dict[str, Outcome], colours: Sequence[str]) -> None:
    """The rolls of runs with the same in their tank, over the measured one."""
    _, file, column = _record(next(iter(runs.values())))
    if (record := drawn(axes, file)) is not None:
        axes.plot(record[TIME], record[column], color="black", lw=0.8, label="measured")
    for (label, one), colour in zip(runs.items(), colours, strict=False):
        axes.plot(*roll(one), color=colour, lw=0.9, ls="--" if label == DRY else "-", label=label)
    axes.set(xlabel="time (s)", ylabel="roll (deg)")


def _moments(axes: Axes, runs: dict[str, Outcome]) -> None:
    """The moment against the roll, swing by swing, over the largest roll of the swing."""
    for (label, one), colour in zip(runs.items(), COLOURS[1:], strict=False):
        time, ours = roll(one)
        _, most, against = opposed(time, one.recording.series["axle_moment"][:, 0], ours).T
        axes.plot(most, against, "o-", ms=3, lw=0.9, color=colour, label=label)
    _, most, against = shallow(one.recording.preset, time, ours).T
    axes.plot(most, against, "s:", ms=3, lw=0.9, color="0.5", label="shallow water")
    if (record := drawn(axes, MEASURED)) is not None:
        _, most, against = asked(one.recording.preset, record[TIME], record[WATER]).T
        axes.plot(most, against, "x-", ms=4, lw=0.8, color="black", label="asked by the measured roll")
    axes.set(xlabel="largest roll of the swing (deg)", ylabel="water's moment (N m)", ylim=(0.0, None))


def _legend(drawing: Figure, panels: Iterable[Axes]) -> None:
    """One legend for all panels."""
    named = {}
    for axes in panels:
        lines, words = axes.get_legend_handles_labels()
        named |= dict(zip(words, lines, strict=True))
    drawing.legend(named.values(), named.keys(), loc=BELOW, ncols=3)
