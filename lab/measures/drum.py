"""How far a drum that rotates about its own level axis carries its bed, in the earth's frame.

bed_angle: the angle by which the bed's centre of mass, seen from the axis, is deflected from straight below, positive
in the direction of turning; the mean from the first half turn on, after which a bed has found its slope. Error:
standard error of the means of blocks.
bed_radius: the mean distance of the centre of mass from the axis in that time, with the same error.
bed_angle_range: the difference between the largest and the smallest angle in that time.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, Sheet, band, level
from lab.measures.steady import BLOCKS, Steady, averaged
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import ROLL

OF = "grains"
SETTLED = np.pi  # rad, that a drum has turned before the mean begins


def applies(recording: Recording) -> bool:
    """A tank that lies has turned for a while after its first half turn."""
    tank, tilt = recording.preset.tank, recording.preset.motion.tilt
    return tank.lies and tilt is not None and _rows(recording).stop - _rows(recording).start > 2 * BLOCKS


def measure(recording: Recording) -> dict[str, Value]:
    """bed_angle and bed_angle_range (deg), bed_radius (mm)."""
    angle, away = course(recording)
    rows = Steady(_rows(recording), BLOCKS)
    note = f"from {recording.series['time'][rows.rows.start]:.3g} s on"
    return {
        "bed_angle": averaged(angle, rows, "deg", note=note),
        "bed_angle_range": over_worlds(np.ptp(angle[rows.rows], axis=0), "deg", note=note),
        "bed_radius": averaged(away, rows, "mm", note=note),
    }


def course(recording: Recording) -> tuple[np.ndarray, np.ndarray]:
    """The angle (T, W) in deg from straight below, in the direction of turning, and the distance (T, W) in mm."""
    centre, roll = recording.series["centre_of_mass"], recording.series["pose"][..., ROLL]
    y, z = centre[..., 0], centre[..., 1]
    across, up = np.cos(roll) * y - np.sin(roll) * z, np.sin(roll) * y + np.cos(roll) * z
    direction = np.sign(recording.preset.motion.tilt.angle)
    return np.degrees(direction * np.arctan2(across, -up)), 1e3 * np.hypot(y, z)


def _rows(recording: Recording) -> slice:
    """The samples after the first half turn."""
    turned = np.abs(recording.series["pose"][..., ROLL]).min(axis=1)
    return slice(int(np.count_nonzero(turned < SETTLED)), len(turned))


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Angle and distance of the bed's centre of mass against time."""
    (upper,), (lower,) = sheet.panels((1, 1))
    time, (angle, away) = recording.series["time"], course(recording)
    span = float(time[_rows(recording)][0]), float(time[-1])
    band(upper, time, angle, BLUE, "bed")
    level(sheet, upper, values.get("bed_angle"), "mean", BLUE, span)
    upper.set_ylabel("angle of the centre\nof mass (deg)")
    band(lower, time, away, BLUE)
    level(sheet, lower, values.get("bed_radius"), "mean", BLUE, span)
    lower.set_ylabel("its distance\nfrom the axis (mm)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(time[0], time[-1])


FIGURES = {"drum": draw}
