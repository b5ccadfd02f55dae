"""Roll in a long-crested random sea from abeam by linear theory, with nonlinear damping made linear (Kaplan 1966).

Sway, heave and roll answer the waves by potential flow. Roll damping B₁ φ̇ + B₂ φ̇|φ̇| of a Gaussian roll whose speed has
the standard deviation σ takes as much energy as the linear one B₁ + √(8/π) σ B₂. σ follows from the response, so the
two are found together. The response's spectrum is |H|² S, S that of the waves; its moments m₀ and m₂ give the rest:
significant amplitude 2 √m₀, mean period 2π √(m₀/m₂), N = duration/period. Maxima of a narrow-banded Gaussian record are
Rayleigh's, and the largest of N is √(2 m₀ ln N) most often, √m₀ (√(2 ln N) + 0.5772/√(2 ln N)) on average
(Longuet-Higgins 1952), and less than √(2 m₀ ln(N/ln(1/p))) with a probability p.

Limits: small angles, a righting lever that is a straight line, no speed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import log, pi, sqrt

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.potential.radiation import Hydrodynamics

LINEARISED = sqrt(8.0 / pi)
EULER = 0.5772156649
SURE = 0.95  # probability of the level that is told beside the mean maximum
ROLL = 2


@dataclass(frozen=True, eq=False)
class Afloat:
    """A ship for small motions about her centre of gravity: `table` of her whole hull (kg, N …) about it.

    `mass` (kg), `inertia` in roll without water (kg m²), springs of heave (N/m) and roll (N m/rad).
    """

    table: Hydrodynamics
    mass: float
    inertia: float
    heave_spring: float
    roll_spring: float

    def response(self, damping: float) -> np.ndarray:
        """Complex amplitudes (n, 3) of sway, heave (m) and roll (rad) per metre of waves, `damping` (N m s) added."""
        omega = self.table.frequency[:, None, None]
        own = np.diag([self.mass, self.mass, self.inertia])
        spring = np.diag([0.0, self.heave_spring, self.roll_spring])
        viscous = np.diag([0.0, 0.0, damping])
        whole = -(omega**2) * (own + self.table.added_mass) - 1j * omega * (self.table.damping + viscous) + spring
        return np.linalg.solve(whole, self.table.excitation[..., None])[..., 0]


@dataclass(frozen=True, eq=False)
class Answer:
    """Roll in a sea: frequencies (n,) rad/s, |H| (n,) rad/m, spectra of waves (m² s) and roll (rad² s).

    `damping` (N m s) is the linear damping, equivalent in this sea, waves left out; m₀ (rad²) and m₂ (rad²/s²).
    """

    frequency: np.ndarray
    ratio: np.ndarray
    waves: np.ndarray
    roll: np.ndarray
    damping: float
    zeroth: float
    second: float

    @property
    def significant(self) -> float:
        """Significant amplitude (rad), the mean of the highest third."""
        return 2.0 * sqrt(self.zeroth)

    @property
    def period(self) -> float:
        """Mean period (s) between upward crossings of zero."""
        return 2.0 * pi * sqrt(self.zeroth / self.second)

    def cycles(self, duration: float) -> float:
        """N in a duration (s)."""
        return duration / self.period

    def largest(self, duration: float) -> tuple[float, float, float]:
        """Of the largest amplitude (rad) in a duration (s): most probable, mean, and not exceeded with SURE."""
        return rayleigh_largest(sqrt(self.zeroth), self.cycles(duration))


def rayleigh_largest(deviation: float, count: float) -> tuple[float, float, float]:
    """Most probable and mean largest of `count` maxima of Rayleigh, and the level not exceeded with SURE.

    `deviation` is the standard deviation of the record. Raises Unavailable for fewer than three maxima.
    """
    if count < 3.0:
        raise Unavailable("the time is shorter than three rolls: of so few no largest can be told; give more hours.")
    root = sqrt(2.0 * log(count))
    return deviation * root, deviation * (root + EULER / root), deviation * sqrt(2.0 * log(count / log(1.0 / SURE)))


def random_roll(ship: Afloat, density: Callable, linear: float, quadratic: float) -> Answer:
    """Her roll in a sea of spectrum `density` (ω to m² s), with B₁ (N m s) and B₂ (N m s²). Raises Unavailable."""
    return linearised(ship.response, ship.table.frequency, density, linear, quadratic)


def linearised(
    response: Callable[[float], np.ndarray], omega: np.ndarray, density: Callable, linear: float, quadratic: float
) -> Answer:
    """`random_roll` of a ship whose `response` to a damping has her motions (n, 3) per metre of waves at ω (n,)."""
    from scipy.optimize import brentq  # slow to import

    waves = density(omega)

    def answered(speed: float) -> Answer:
        damping = linear + LINEARISED * speed * quadratic
        ratio = np.abs(response(damping)[:, ROLL])
        roll = ratio**2 * waves
        moments = (float(np.trapezoid(omega**k * roll, omega)) for k in (0, 2))
        return Answer(omega, ratio, waves, roll, damping, *moments)

    most = sqrt(answered(0.0).second)
    if not most > 0.0:
        raise Unavailable("this sea does not roll her at all: look at its period.")
    speed = most if not quadratic else brentq(lambda s: sqrt(answered(s).second) - s, 0.0, most, xtol=1e-10 * most)
    return answered(float(speed))
