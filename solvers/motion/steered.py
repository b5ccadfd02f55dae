"""A motion steered interactively: polynomial pieces, each given when it begins."""

from dataclasses import dataclass

import numpy as np
import taichi as ti

DEGREE = 5  # value, rate and acceleration at both ends of a piece


@ti.func
def piece(table: ti.template(), w, first, t):
    """Value, rate and acceleration at time t of the present piece, a polynomial in the time since its beginning."""
    s = t - table[w, first]
    value, rate, acceleration = 0.0 * s, 0.0 * s, 0.0 * s
    for n in ti.static(range(DEGREE, -1, -1)):  # Horner's scheme, with its first and second derivatives
        acceleration = acceleration * s + 2.0 * rate
        rate = rate * s + value
        value = value * s + table[w, first + 1 + n]
    return ti.Vector([value, rate, acceleration])


@dataclass(frozen=True)
class Steered:
    """An interactively steered coordinate of the tank, at rest until `Prescribed.steer` gives the first piece.

    `limit` (m/s or rad/s) is the highest speed allowed, from which the step is derived.
    """

    coordinate: str
    limit: float

    centre = (0.0, 0.0)
    state = staticmethod(piece)

    def duration(self) -> float:
        """Zero: it has no end of its own."""
        return 0.0

    def parameters(self, soft_start: float) -> list[float]:
        """The kernel's table: the time (s) at which the piece begins, and its coefficients; all zero at first."""
        return [0.0] * (2 + DEGREE)

    def fastest(self, soft_start: float) -> float:
        """Upper bound on the speed (m/s or rad/s)."""
        return self.limit


def hermite(length: float, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Coefficients (6,) of the quintic with value, rate and acceleration (3,) at 0 and at `length` (s).

    Quintic Hermite interpolation: the acceleration is continuous where two pieces meet.
    """
    h = length
    known = np.array([begin[0], begin[1], 0.5 * begin[2]])
    left = np.array(
        [
            end[0] - known @ [1.0, h, h * h],
            (end[1] - known @ [0.0, 1.0, 2.0 * h]) * h,
            (end[2] - 2.0 * known[2]) * h * h,
        ]
    )
    bent = np.array([[10.0, -4.0, 0.5], [-15.0, 7.0, -1.0], [6.0, -3.0, 0.5]]) @ left
    return np.concatenate([known, bent / h ** np.array([3.0, 4.0, 5.0])])
