"""What the tank did, as measures need to know it."""

from dataclasses import dataclass

import numpy as np

from lab.recording import Recording

# Harmonic motions and the coordinate of the pose (Y, Z, phi) that each moves.
HARMONIC = {"sway": 0, "roll": 2, "heave": 1}
LEAST_TILT = np.radians(2.0)  # a smaller turn is no tilting test


@dataclass(frozen=True)
class Leg:
    """The way out of a tilt: rows `[:end]` of the series, and +1 (to port) or -1 as its direction."""

    end: int
    direction: float


def is_tilt(recording: Recording) -> bool:
    """Whether the preset tilts the tank and the tank has turned far enough to tell."""
    turned = np.abs(recording.series["pose"][:, :, 2]).max(initial=0.0) > LEAST_TILT
    return bool(_motions(recording).get("tilt")) and bool(turned)


def outward_leg(tilt: np.ndarray) -> Leg:
    """The leg of a tilt (T,), rad, up to where it is first largest; the way back is left out."""
    turned = tilt - tilt[0]
    size = np.abs(turned)
    end = int(np.argmax(size >= size.max() * (1 - 1e-9))) + 1
    return Leg(end, float(np.sign(turned[end - 1])))


def driving(recording: Recording) -> tuple[str, dict] | None:
    """Name and settings of the harmonic motion that drives the tank, None without one.

    With several, the first of sway, roll and heave. A motion from a file has no single frequency: None.
    """
    motions = _motions(recording)
    if motions.get("history"):
        return None
    return next(((name, motions[name]) for name in HARMONIC if motions.get(name)), None)


def is_shaken(recording: Recording) -> bool:
    """Whether the tank goes to and fro: a harmonic motion, or one from a file that moves it."""
    moved = np.ptp(recording.series["pose"], axis=0).any()
    return driving(recording) is not None or bool(_motions(recording).get("history") and moved)


def soft_start(recording: Recording) -> float:
    """Time in which the motion comes up, s."""
    return float(_motions(recording).get("soft_start") or 0.0)


def _motions(recording: Recording) -> dict:
    return recording.preset.get("motion") or {}
