"""The load on a tank that one harmonic motion drives, beside that motion: for measures of grains and of water."""

import numpy as np

from lab.measures.motion import HARMONIC, driving
from lab.measures.steady import harmonics
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import ROLL

ALONG = {"sway": 0, "heave": 1}  # the column of wall_force that a motion works against


def transfer(recording: Recording, part: slice) -> np.ndarray:
    """Complex amplitudes (2, W) of the force along the motion, N or N m, and of it over the motion's."""
    name, settings = driving(recording)
    time, frequency = recording.series["time"], settings.frequency
    middles = between(time[:, None])[part, 0]
    force = harmonics(middles, along_motion(recording)[part], frequency, (1, 2))[0]
    moved = harmonics(time[part], recording.series["pose"][part, :, HARMONIC[name]], frequency, (1, 2))[0]
    return np.stack([force, force / moved])


def along_motion(recording: Recording) -> np.ndarray:
    """The force (T, W), N, along the motion; for roll the moment about its centre, N m."""
    name, settings = driving(recording)
    force = recording.series["wall_force"]
    if name != "roll":
        return force[..., ALONG[name]]
    across, up = settings.centre
    return force[..., ROLL] + up * force[..., 0] - across * force[..., 1]


def between(values: np.ndarray) -> np.ndarray:
    """Values (T, W) in the middle of each sampling interval, where the mean over that interval belongs."""
    return np.concatenate([values[:1], 0.5 * (values[1:] + values[:-1])])


def with_halves(numbers: np.ndarray, unit: str, missing: str, note: str = "") -> Value:
    """Numbers (3, W) of the whole part and its halves."""
    errors = np.abs(numbers[1] - numbers[2]) / 2
    return over_worlds(numbers[0], unit, uncertainties=errors, kind="halves", note=note, missing=missing)
