"""Sums of harmonics Σ_{n≥1} A_n cos(nθ + δ_n), given by amplitudes A and phases δ (N,)."""

from math import pi

import numpy as np

STEPS = 8  # per wave of the highest harmonic; and the parts into which a step is then cut
CLIMBS = 20  # Newton steps; at a maximum with zero curvature each reduces the distance by a third only
TINY = 1e-300


def harmonics(angle: np.ndarray, amplitudes: np.ndarray, phases: np.ndarray, derivative: int = 0) -> np.ndarray:
    """The sum at angles (rad, any shape), or its derivative of a given order."""
    return (_waves(angle, len(amplitudes)) @ _factors(amplitudes, phases, derivative)).real


def _waves(angle: np.ndarray, count: int) -> np.ndarray:
    """e^{inθ} (…, count), by products, which are faster than cosines."""
    turn = np.exp(1j * np.asarray(angle))[..., None]
    return np.cumprod(np.broadcast_to(turn, (*turn.shape[:-1], count)), axis=-1)


def _factors(amplitudes: np.ndarray, phases: np.ndarray, derivative: int) -> np.ndarray:
    """What the waves are multiplied by in a derivative of the sum."""
    n = np.arange(1, len(amplitudes) + 1)
    return amplitudes * np.exp(1j * phases) * (1j * n) ** derivative


def coefficients(values: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Mean, and amplitudes and phases up to n = (k − 1)//2, of a function with values (k,) at equally spaced angles."""
    spectrum = np.fft.rfft(values)[: (len(values) + 1) // 2] / len(values)
    return float(spectrum[0].real), 2.0 * np.abs(spectrum[1:]), np.angle(spectrum[1:])


def largest(amplitudes: np.ndarray, phases: np.ndarray) -> float:
    """The largest value of the sum, to rounding.

    Between two angles a step w apart the sum is at most the larger of its values there plus max|f''| w²/8. Only steps
    that could exceed the largest value found are cut into finer ones, from which Newton's method climbs to the maxima.
    """
    curvature = np.abs(amplitudes) @ np.arange(1, len(amplitudes) + 1) ** 2.0
    width = 2.0 * pi / (STEPS * max(1, len(amplitudes)))
    angle = np.arange(0.0, 2.0 * pi, width)
    ends = np.maximum(harmonics(angle, amplitudes, phases), harmonics(angle + width, amplitudes, phases))
    angle = angle[ends + curvature * width**2 / 8.0 >= ends.max()]
    width /= STEPS
    angle = (angle[:, None] + width * np.arange(STEPS)).ravel()
    first, second = (_factors(amplitudes, phases, order) for order in (1, 2))
    for _ in range(CLIMBS):
        waves = _waves(angle, len(amplitudes))
        slope, bend = (waves @ first).real, (waves @ second).real
        before = angle
        angle = angle + slope / np.maximum(np.maximum(-bend, np.abs(slope) / width), TINY)  # uphill, by a step at most
        if np.array_equal(angle, before):
            break
    return float(harmonics(angle, amplitudes, phases).max())
