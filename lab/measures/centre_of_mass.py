"""Where the bed's centre of mass went, in the tank's frame (y to starboard, z up, in space x astern).

final_shift_y, final_shift_z, in a tank with ends in space final_shift_x: displacement from the settled bed at t = 0 to
the last sample;
final_shift: the same length in y, counted in the world's mean grain diameter d;
largest_shift: the largest distance from the settled centre of mass at any time.
In an open tank they are those of the grains that have not spilled.
Error: none of their own, since positions are computed without noise. The last sample of a shaken bed
shows it at one phase of its motion.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lab.measures.drawing import BLUE, GREEN, VERMILION, Sheet, band
from lab.measures.motion import driving, is_tilt
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import PLANE, directions

OF = "grains"
if TYPE_CHECKING:
    from matplotlib.axes import Axes


def applies(recording: Recording) -> bool:
    """Every recording has a centre of mass."""
    return True


def measure(recording: Recording) -> dict[str, Value]:
    """final_shift_y, _z and _x (mm), final_shift (d), largest_shift (mm)."""
    moved = _moved(recording)
    final, axes = moved[-1], directions(moved.shape[2])
    largest = np.fmax.reduce(np.hypot.reduce(moved, axis=2))
    notes = {"missing": "no grain is left in the tank"}
    if len(recording.open_edges):
        notes["note"] = "of the grains still in the tank"
    return {
        **{f"final_shift_{axis}": over_worlds(1e3 * final[:, k], "mm", **notes) for k, axis in enumerate(axes)},
        "final_shift": over_worlds(final[:, 0] / recording.mean_diameter, "d", **notes),
        "largest_shift": over_worlds(1e3 * largest, "mm", **notes),
    }


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The shift against time, where no measure of tilting or shaking draws it against the motion of the tank."""
    if is_tilt(recording) or driving(recording) is not None:
        return
    ((axes,),) = sheet.panels()
    time = recording.series["time"]
    draw_shift(axes, time, shift(recording))
    axes.set_xlim(time[0], time[-1])


def shift(recording: Recording) -> np.ndarray:
    """Displacement (T, W, axes), mm, of the centre of mass from the settled bed."""
    return 1e3 * _moved(recording)


def _moved(recording: Recording) -> np.ndarray:
    """As `shift`, in m; without x where space repeats itself along it, and no place is farther than another."""
    centre = recording.series["centre_of_mass"]
    if recording.preset.tank.periodic:
        centre = centre[..., :PLANE]
    return centre - centre[0]


def draw_shift(axes: "Axes", time: np.ndarray, moved: np.ndarray) -> None:
    """Shift (T, W, axes), mm, against time (T,), s."""
    looks = (BLUE, "y, to starboard"), (VERMILION, "z, up"), (GREEN, "x, astern")
    for k in range(moved.shape[2]):
        band(axes, time, moved[:, :, k], *looks[k])
    axes.set_ylabel("shift of the centre of mass\nin the tank (mm)")
    axes.set_xlabel("time (s)")


FIGURES = {"shift": draw}
