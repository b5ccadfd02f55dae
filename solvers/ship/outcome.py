"""The outcome of a run in waves: whether the ship stayed upright, took a bias, or was lost; roll limits."""

from dataclasses import dataclass
from math import pi

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.hydrostatics import SEARCH, Loading, equilibrium, righting_lever
from solvers.ship.section import Immersible
from solvers.ship.water import Water

CYCLES = 10  # of the waves at the end of a run, which count as the steady motion
HARMONICS = 5  # of the wave frequency that belong to the response to it
BIAS = np.radians(0.5)  # mean roll beyond which a ship is not upright
STRAY = 0.1  # of the motion's rms: with more at other frequencies the motion has several


def roll_limits(section: Immersible, loading: Loading, water: Water, largest: float = pi) -> tuple[float, float]:
    """Angles of vanishing stability (rad) to starboard and to port, or ∓`largest` if that is nearer.

    On each side the search starts where the hull comes to rest if released slightly off upright to that side.
    """
    return tuple(float(np.clip(_vanishing(section, loading, water, s, largest), -largest, largest)) for s in (-1, 1))


def _vanishing(section: Immersible, loading: Loading, water: Water, side: int, largest: float) -> float:
    from scipy.optimize import brentq  # slow to import

    rest = equilibrium(section, loading, water, side * SEARCH)[1]
    lever = lambda angle: righting_lever(section, loading, water, angle)  # noqa: E731
    before, after = rest + side * SEARCH, rest + 2 * side * SEARCH
    while side * lever(after) > 0.0:
        if abs(after) > largest:
            return after
        before, after = after, after + side * SEARCH
    return brentq(lever, before, after, xtol=1e-10)


@dataclass(frozen=True)
class Outcome:
    """How a roll ended: `kind` upright, biased, capsized, flooded or sunk, and whether it has `several` frequencies.

    Over the last cycles: `mean` (rad), `amplitude` (rad), the mean of half the range of roll in each period, and the
    `largest` |roll| (rad).
    """

    kind: str
    several: bool
    mean: float
    amplitude: float
    largest: float


def outcome(time: np.ndarray, roll: np.ndarray, frequency: float, lost: str = "") -> Outcome:
    """Classify a roll (n,) rad at equally spaced times (n,) s in waves of a frequency (rad/s), by its last cycles.

    `lost`: "capsized", "flooded" or "sunk" if the run ended so. Else raises `Unavailable` if the run is too short.
    """
    period = 2.0 * pi / frequency
    if time[-1] - time[0] < CYCLES * period and not lost:
        raise Unavailable(f"the run must last {CYCLES} periods of the waves, {CYCLES * period:.4g} s, or more.")
    last = time > time[-1] - CYCLES * period
    t, phi = time[last], roll[last]
    phase = np.arange(1, HARMONICS + 1) * frequency * t[:, None]
    waves = np.column_stack([np.ones_like(t), np.cos(phase), np.sin(phase)])
    fitted, *_ = np.linalg.lstsq(waves, phi)
    motion, stray = phi - fitted[0], phi - waves @ fitted
    several = bool(np.sqrt((stray**2).mean()) > STRAY * np.sqrt((motion**2).mean()))
    mean = float(fitted[0])
    kind = lost or ("biased" if abs(mean) > BIAS else "upright")
    return Outcome(kind, several, mean, _amplitude(t, phi, period), float(np.abs(phi).max()))


def _amplitude(time: np.ndarray, roll: np.ndarray, period: float) -> float:
    """Mean, over whole periods back from the end, of half the range of roll in each."""
    number = np.floor((time[-1] - time) / period).astype(int)
    spans = [0.5 * np.ptp(roll[number == k]) for k in range(number.max() + 1) if (number == k).sum() > 1]
    return float(np.mean(spans))
