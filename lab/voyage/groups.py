"""The worst group of a long sea: when a ship rolls most in it, by linear theory."""

import numpy as np

from lab.assembly.ship import make_water, make_waves
from lab.naval.linear_water import linear_motion
from lab.preset.schema import Preset

A_PERIOD = 20  # times a peak period at which her roll is looked at
AT_ONCE = 4096  # times that are computed together
ROLL = 2


def linear_roll(preset: Preset, time: np.ndarray) -> np.ndarray:
    """Roll (n,) rad at times (n,) s of the sea: φ = Re Σ R(ω) a e^(−iωt), R the response of roll with linear damping.

    A superposition (St Denis and Pierson 1953). Quadratic damping, the cargo's motion and the soft start are left out,
    so that it tells when she rolls most, not how far.
    """
    waves = make_waves(preset.waves, make_water(preset.sea, preset.run.gravity))
    share = linear_motion(preset, waves.frequency)[:, ROLL] * waves.amplitude
    pieces = np.array_split(time, max(1, len(time) // AT_ONCE))
    return np.concatenate([(np.exp(-1j * np.outer(piece, waves.frequency)) @ share).real for piece in pieces])


def worst_group(preset: Preset, length: float, span: float) -> float:
    """When (s) to begin a run of a `span` (s) in a sea of a `length` (s), so that its worst group is in the middle.

    The worst group is that of the largest linear roll.
    """
    step = 2.0 * np.pi / preset.waves.frequency / A_PERIOD
    time = np.arange(0.0, length, step)
    worst = time[np.argmax(np.abs(linear_roll(preset, time)))]
    return float(np.clip(worst - 0.5 * span, 0.0, max(0.0, length - span)))
