"""Waves of a piston by linear potential flow: Havelock (1929), Phil. Mag. 8, 569; Dean & Dalrymple (1991), eq. 6.26.

A piston at X e^{iωt} in water of depth h raises the surface at a distance x by

η = X e^{iωt} [i C(k) e^{−ikx} + Σ_n C_n e^{−q_n x}]

with C = 4 sinh² kh/(sinh 2kh + 2kh) where ω² = g k tanh kh, and C_n = 4 sin² q_n h/(sin 2 q_n h + 2 q_n h) where
ω² = −g q_n tan q_n h.
Any motion is a sum of such ones, here by a Fourier transform over a time in which all waves have gone by.
"""

from collections.abc import Callable

import numpy as np

GRAVITY = 9.81
MODES = 12  # local ones
LONG, STEP = 60.0, 0.01  # s: period and step of the transform
FASTEST = 60.0  # rad/s: faster parts of a motion are left out
HALVINGS = 60


def rise(time: np.ndarray, moved: np.ndarray, depth: float, distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Times (T,) s and the rise (T,) m there of water that a piston, `moved` (m) at `time` (s), sets in motion."""
    instants = np.arange(0.0, LONG, STEP)
    parts = np.fft.rfft(np.interp(instants, time, moved, left=0.0, right=0.0))
    omega = 2.0 * np.pi * np.fft.rfftfreq(len(instants), STEP)
    slow = (omega > 0.0) & (omega < FASTEST)
    answer = np.zeros(len(omega), complex)
    answer[slow] = transfer(omega[slow], depth, distance)
    return instants, np.fft.irfft(parts * answer, len(instants))


def transfer(omega: np.ndarray, depth: float, distance: float) -> np.ndarray:
    """Rise over the piston's way, complex, at angular frequencies (n,) rad/s."""
    wanted, along = omega**2 * depth / GRAVITY, distance / depth
    kh = _roots(lambda a: a * np.tanh(a), wanted, 0.0, wanted + 1.0)
    small = np.exp(-2.0 * kh)
    found = 2j * (1.0 - small) ** 2 / (1.0 - small**2 + 4.0 * kh * small) * np.exp(-1j * kh * along)
    for mode in range(1, MODES + 1):
        qh = _roots(lambda a: a * np.tan(a), -wanted, (mode - 0.5) * np.pi, mode * np.pi)
        found += 4.0 * np.sin(qh) ** 2 / (np.sin(2.0 * qh) + 2.0 * qh) * np.exp(-qh * along)
    return found


def _roots(
    rising: Callable[[np.ndarray], np.ndarray], wanted: np.ndarray, low: float, high: float | np.ndarray
) -> np.ndarray:
    """Where a function that rises between low and high has the wanted values (n,), by halving."""
    low, high = np.full_like(wanted, low), np.full_like(wanted, high)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        below = rising(middle) < wanted
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return 0.5 * (low + high)
