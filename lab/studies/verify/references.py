"""Closed forms, and the contact laws integrated on their own, apart from the solver: nothing here is from `solvers`."""

from dataclasses import dataclass
from functools import cache
from math import gamma, pi, sqrt

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

RIGID = 1e15  # Pa, the most that a preset may say of a wall
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


@cache
def viscoelastic_rebound(x: float) -> tuple[float, float]:
    """Restitution of F = k ξ^(3/2) + γ √ξ ξ̇ where the contact ends with its force, and where with its overlap.

    In units of the elastic collision ξ̈ = −ξ^(3/2) − x √ξ ξ̇ from ξ = 0, ξ̇ = 1, with x = β v^(1/5) and
    β = (γ/m)(m/k)^(3/5) (Schwager and Pöschel 1998). By DOP853 at 1e-12.
    """

    def motion(_, s):
        root = sqrt(max(s[0], 0.0))
        return [s[1], -root * (s[0] + x * s[1])]

    def force_ends(_, s):
        return s[0] + x * s[1]

    def overlap_ends(t, s):
        return s[0] if t > 0.0 else 1.0

    force_ends.direction = overlap_ends.direction = -1
    overlap_ends.terminal = True
    ends = force_ends, overlap_ends
    path = solve_ivp(motion, (0.0, 100.0), [0.0, 1.0], "DOP853", events=ends, rtol=1e-12, atol=1e-14, max_step=0.5)
    return -float(path.y_events[0][0][1]), -float(path.y_events[1][0][1])


def first_order_loss() -> float:
    """C in 1 − e = C x − (3/5) C² x² + … of small x: 1.15344 (Schwager and Pöschel 1998, eq. 19).

    The work of the damping along the elastic collision, (4/5) (5/4)^(3/5) B(3/5, 3/2).
    """
    return 0.8 * 1.25**0.6 * gamma(0.6) * gamma(1.5) / gamma(2.1)


@cache
def damping_of(e: float) -> float:
    """The x of `viscoelastic_rebound` that gives restitution e where the contact ends with its force."""
    return brentq(lambda x: viscoelastic_rebound(x)[0] - e, 1e-9, 10.0, xtol=1e-12) if e < 1.0 else 0.0


def dissipative_time(x: float, mass: float, stiffness: float, speed: float) -> float:
    """A (s) that makes a collision's damping x, γ = (3/2) A k; effective mass (kg), k (N/m^1.5), speed (m/s)."""
    return x / (1.5 * (stiffness / mass) ** 0.4 * speed**0.2)


def mindlin_stiffness(young: float, poisson: float, radius: float, other: float | None = None) -> float:
    """8 G* √R_eff (N/m^1.5) of the tangential stiffness 8 G* √(R_eff ξ), 1/G* = (2 − ν)/G₁ + (2 − ν)/G₂ (Mindlin 1949).

    Of two solids with one Poisson ratio; `other` is the second one's Young's modulus (Pa), None: the same.
    """
    return 8.0 / (2.0 * (1.0 + poisson)) / (2.0 - poisson) / (1.0 / young + 1.0 / (other or young)) * sqrt(radius)


def resting_overlap(force: float, stiffness: float) -> float:
    """The overlap (m) at which a Hertz contact carries a force (N)."""
    return (force / stiffness) ** (2.0 / 3.0)
