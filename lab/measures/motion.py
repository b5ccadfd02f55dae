"""How the tank moved, for the measures that depend on it."""

from dataclasses import dataclass

import numpy as np

from lab.recording import Recording
from solvers.machine.quantity import ROLL
from solvers.motion.harmonic import Harmonic

# Harmonic motions and the coordinate of the pose (Y, Z, phi) that each moves.
HARMONIC = {"sway": 0, "roll": ROLL, "heave": 1}
# A run that turns the tank by less is not a tilting test, and one that turns it by more is that of a drum
LEAST_TILT, MOST_TILT = np.radians(2.0), np.pi


@dataclass(frozen=True)
class Leg:
    """The way out of a tilt: rows `[:end]` of the series; its direction is +1 (to port) or -1."""

    end: int
    direction: float


def is_tilt(recording: Recording) -> bool:
    """Whether the preset tilts the tank, the tank has turned far enough to tell, and does not go round."""
    turned = LEAST_TILT < np.abs(recording.series["pose"][:, :, ROLL]).max(initial=0.0) <= MOST_TILT
    return recording.preset.motion.tilt is not None and bool(turned)


def outward_leg(tilt: np.ndarray) -> Leg:
    """The leg of a tilt (T,), rad, up to where it is first largest; the way back is left out."""
    turned = tilt - tilt[0]
    size = np.abs(turned)
    end = int(np.argmax(size >= size.max() * (1 - 1e-9))) + 1
    return Leg(end, float(np.sign(turned[end - 1])))


def driving(recording: Recording) -> tuple[str, Harmonic] | None:
    """Name and settings of the harmonic motion that drives the tank, None without one.

    With several, the first of sway, roll and heave. A motion from a file has no single frequency: None.
    """
    motion = recording.preset.motion
    if motion.history:
        return None
    return next(((name, getattr(motion, name)) for name in HARMONIC if getattr(motion, name)), None)


def is_shaken(recording: Recording) -> bool:
    """Whether the tank moves to and fro: by a harmonic motion, or by one from a file."""
    moved = np.ptp(recording.series["pose"], axis=0).any()
    return driving(recording) is not None or bool(recording.preset.motion.history and moved)


def soft_start(recording: Recording) -> float:
    """Time in which the motion grows to its full size, s."""
    return recording.preset.motion.soft_start
