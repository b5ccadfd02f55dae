"""Closed forms, and the contact laws integrated on their own, apart from the solver: nothing here is from `solvers`."""

from dataclasses import dataclass
from math import gamma, pi, sqrt

import numpy as np
from scipy.integrate import solve_ivp

# 2 ∫ dx/√(1 − x^(5/2)) from 0 to 1: the duration of a Hertz collision in units of its depth over its speed.
HERTZ_DURATION = 0.8 * sqrt(pi) * gamma(0.4) / gamma(0.9)


def sphere_mass(radius: float, density: float) -> float:
    """Mass (kg) of a sphere."""
    return 4.0 / 3.0 * pi * radius**3 * density


def hertz_stiffness(young: float, poisson: float, radius: float, other: float | None = None) -> float:
    """k (N/m^1.5) of F = k ξ^(3/2), (4/3) E* √R_eff (Johnson 1985, eq. 4.22), of two solids with one Poisson ratio.

    `other` is the second one's Young's modulus (Pa), None: the same.
    """
    return 4.0 / 3.0 * sqrt(radius) / ((1.0 - poisson**2) * (1.0 / young + 1.0 / (other or young)))


@dataclass(frozen=True)
class HertzCollision:
    """A head-on elastic collision at a speed (m/s), of effective mass (kg) and stiffness k (N/m^1.5)."""

    mass: float
    stiffness: float
    speed: float

    @property
    def deepest(self) -> float:
        """Largest overlap (m), (5 m v²/(4 k))^(2/5)."""
        return (1.25 * self.mass * self.speed**2 / self.stiffness) ** 0.4

    @property
    def force(self) -> float:
        """Largest force (N)."""
        return self.stiffness * self.deepest**1.5

    @property
    def duration(self) -> float:
        """Time of contact (s)."""
        return HERTZ_DURATION * self.deepest / self.speed
