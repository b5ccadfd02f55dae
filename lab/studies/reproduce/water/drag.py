"""The drag on a square that is set in motion in a full box beside SPHERIC's benchmark 6, a computation on a grid.

Colicchio, Greco & Faltinsen (2006), Int. J. Numer. Meth. Fluids 51, 25; and beside finite differences of our own, which
are finer at the corners (`theory.moving_square`). Coefficients are forces per length over ρ U² L/2.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.measured import drawn
from lab.studies.reproduce.water.theory import moving_square

AVERAGE = 0.1  # s, of the curves
SPEED = 1.0  # m/s, in the end
COMPARED = 6.0  # s, in which numbers are compared
COLOURS = BLUE, VERMILION, GREEN
MEASURED = "spheric06_moving_square/force_re100.csv"


def coefficient(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times (s), in the middle of the samples' intervals, and the drag coefficient there."""
    series, preset = one.recording.series, one.recording.preset
    side = float(np.ptp(_corners(one)[:, 0]))
    force = -series["part_force"][1:, 0, 0, 0] / preset.thickness
    time = 0.5 * (series["time"][1:] + series["time"][:-1])
    return time, force / (0.5 * preset.water.density * SPEED**2 * side)


def mean_drag(one: Outcome, during: Sequence[float]) -> float:
    """Mean of the coefficient between two times (s)."""
    time, drag = coefficient(one)
    within = (time >= during[0]) & (time <= during[1])
    return float(drag[within].mean()) if time[-1] >= during[1] - 0.01 else np.nan


def added_mass(one: Outcome, during: Sequence[float]) -> float:
    """Mean force over mean acceleration between two times (s), ρ L²: before there is a wake it is mostly added mass."""
    pull = _curve(one)(np.linspace(*during, 50), 2)
    return 0.5 * SPEED**2 * mean_drag(one, during) / float(np.mean(pull))


def finite_differences(one: Outcome, until: float) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and the drag coefficient by finite differences, of the square as it moves in the run."""
    preset, corners = one.recording.preset, _corners(one)
    side, box = float(np.ptp(corners[:, 0])), np.ptp(np.array(preset.tank.outline), axis=0)
    given = side, (float(box[0]), float(box[1])), float(corners[:, 0].mean()), preset.water.kinematic_viscosity
    time, force = moving_square.drag(_curve(one), *given, until)
    return time, force / (0.5 * SPEED**2 * side)


def _corners(one: Outcome) -> np.ndarray:
    return np.array(one.recording.preset.parts["square"].points)


def _curve(one: Outcome) -> moving_square.Curve:
    """The way (m) of the square and its derivatives."""
    return one.recording.preset.parts["square"].history.history.motions["sway"].curve


NUMBERS = {"mean_drag": ("1", mean_drag), "added_mass_early": ("1", added_mass)}


def figure(found: Found) -> Figure:
    """The drag in time, means over AVERAGE, that of the grid and that of finite differences."""
    drawing, axes = canvas(SIZE)
    for (label, outcomes), colour in zip(found.items(), COLOURS, strict=False):
        time, drag = coefficient(outcomes[0])
        samples = max(1, round(AVERAGE / (time[1] - time[0])))
        means = np.convolve(drag, np.full(samples, 1.0 / samples), "valid")
        axes.plot(time[samples // 2 :][: len(means)], means, color=colour, lw=1.0, label=label)
    if (grid := drawn(axes, MEASURED)) is not None:
        axes.plot(grid[0], grid[1] + grid[2], color="black", lw=1.0, label="grid")
        axes.fill_between(grid[0], 0.95 * (grid[1] + grid[2]), 1.05 * (grid[1] + grid[2]), color="0.5", alpha=0.3, lw=0)
    longest = max((outcomes[0] for outcomes in found.values()), key=lambda one: one.recording.preset.run.duration)
    until = min(longest.recording.preset.run.duration, COMPARED)
    axes.plot(*finite_differences(longest, until), color="black", lw=1.0, ls="--", label="finite differences")
    axes.set(xlabel="time (s)", ylabel="drag coefficient", ylim=(0.0, 11.0))
    drawing.legend(loc=BELOW, ncols=4)
    return drawing
