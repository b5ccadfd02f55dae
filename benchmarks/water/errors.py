"""How good a run of a pool is: pressure at rest, the frequency and loss of a small wave, the front of a collapse."""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import least_squares

from benchmarks.peers.pool import Frame
from benchmarks.water.cases import COLUMN, DENSITY, DEPTH, GRAVITY, HIGH, Case, frequency, mode

FITTED = 1.0, 3.2  # (x − L)/H between which the front's speed is fitted; the wall is at 3.37
LOW = 0.25  # of H: height of the front


def pressure_error(frame: Frame) -> float:
    """Root of the mean square of p − ρ0 g d over ρ0 g H, d the depth below the level of `cases.gentle` at rest."""
    found = frame.pressure - DENSITY * GRAVITY * (DEPTH - frame.position[:, 1])
    return float(np.sqrt(np.mean(found**2)) / (DENSITY * GRAVITY * DEPTH))


def wave_errors(frames: Sequence[Frame]) -> tuple[float, float]:
    """Relative error of the frequency of the small wave against linear theory, and its loss of height in a period.

    The wave's share in the velocities is that of its mode, by least squares; e^(−γt) cos(Ωt) is fitted to it over time.
    """
    time = np.array([frame.time for frame in frames])
    shares = [(frame.velocity * mode(frame.position)).sum() / (mode(frame.position) ** 2).sum() for frame in frames]
    start, omega = shares[0], frequency()
    rates, losses = np.linspace(0.9, 1.1, 101) * omega, np.linspace(-0.1, 0.6, 71)
    waves = np.cos(rates[:, None, None] * time) * np.exp(-losses[None, :, None] * time)
    miss = ((waves - np.array(shares) / start) ** 2).sum(axis=2)
    best, lost = np.unravel_index(miss.argmin(), miss.shape)

    def off(fit: np.ndarray) -> np.ndarray:
        return np.cos(fit[0] * time) * np.exp(-fit[1] * time) - np.array(shares) / start

    rate, loss = least_squares(off, [rates[best], losses[lost]]).x
    return float(rate / omega - 1.0), float(1.0 - np.exp(-loss * 2.0 * np.pi / omega))


def front_speed(case: Case, frames: Sequence[Frame]) -> tuple[float, float]:
    """Speed of the front over √(gH), by a straight line, and the time t √(g/H) at which it is within H/10 of the wall.

    Experiments with H of 0.2 m and more: 1.6 to 1.8; Ritter (1892): below 2.
    """
    unit = np.sqrt(HIGH / GRAVITY)
    time = np.array([frame.time for frame in frames]) / unit
    front = np.array([frame.position[frame.position[:, 1] < LOW * HIGH, 0].max() for frame in frames])
    ran = (front + 0.5 * case.width - COLUMN) / HIGH
    fitted = (ran > FITTED[0]) & (ran < FITTED[1])
    until = (case.width - COLUMN) / HIGH - 0.1
    return float(np.polyfit(time[fitted], ran[fitted], 1)[0]), float(np.interp(until, ran, time))
