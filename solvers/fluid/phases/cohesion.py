"""The cohesion of air in the two-phase form of Colagrossi and Landrini."""

import numpy as np
import taichi as ti

from solvers.fluid.terms.term import Term

STRENGTH = 1.5  # of ρ g L


class Cohesion:
    """p = p_a ((ρ/ρ_a)^1.4 − 1) + X − a ρ², m_i du_i/dt += −2 a ρ_i² Σ V_i V_j ∇W (Trimulyono et al. 2019, eq. 13, 10).

    Of air i alone; a ρ_a² = 1.5 g L (ρ_w − ρ_a), κ = λ = 0. It is the form of Colagrossi & Landrini (2003) as Mokos,
    Rogers, Stansby & Domínguez (2015) have it. L is a length of the scene, here the depth of the water. The source
    prints 2 a ρ_a² in eq. 10 and a = 1.5 g (ρ_w − ρ_a) L, its fractions lost: units ask for 2 a ρ_a there, an
    acceleration, and for that a. It tells neither X nor what eq. 10 is summed over; here X = a ρ_a², so that air at
    its density has no pressure, and the sum is over all neighbours, wall particles too.

    What it does (own derivation): between particles of air both terms together are 2 X + a (ρ_i² − ρ_j²), a background
    pressure and the gradient of −a ρ² by differences. From water air feels 2 X, too, and water nothing of it in turn.
    So air is held as by a background pressure X that water and its gauges do not feel, and momentum is not kept at the
    surface, by X times its length; the load on walls has as much too much. The air's speed of sound is
    √(c² − 2 a ρ_a): c² > 3 g L (ρ_w − ρ_a)/ρ_a is needed, for L = 52.5 mm 36 m/s.

    Limits: energy and momentum are not kept; not for air as slow as water.

    Units: a m⁵/(kg s²), X and a ρ² Pa, L m.
    """

    @staticmethod
    def leans(water: float, air: float) -> tuple[float, float]:
        """κ and λ, zero."""
        return 0.0, 0.0

    @staticmethod
    def pull(water: float, air: float, gravity: float, length: float) -> float:
        """X = a ρ_a² (Pa) for densities (kg/m³) and a length (m)."""
        return STRENGTH * gravity * length * (water - air)

    @staticmethod
    def slowest(pull: float, density: float) -> float:
        """The speed of sound (m/s) below which air of a density (kg/m³) would collapse."""
        return float(np.sqrt(2.0 * pull / density))

    @staticmethod
    def pressure(pull: float, s: np.ndarray) -> np.ndarray:
        """X − a ρ² (Pa) for density deviations s = ρ/ρ_a − 1."""
        return -pull * s * (2.0 + s)

    @staticmethod
    @ti.func
    def share(s):
        """(X − a ρ²)/X for a density deviation."""
        return (0.0 - s) * (2.0 + s)

    @staticmethod
    @ti.func
    def push(s):
        """2 a ρ²/X for a density deviation."""
        return 2.0 * (1.0 + s) * (1.0 + s)

    @staticmethod
    @ti.func
    def energy(s):
        """∫ (X − a ρ²)/ρ² dρ in units of X/ρ_a, −s²/(1 + s)."""
        return (0.0 - s) * s / (1.0 + s)


@ti.data_oriented
class CohesionForce(Term):
    """2 a ρ_i² between a particle of air and all neighbours, walls too."""

    def __init__(self, constants):
        self.constants = constants

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a neighbour."""
        c = self.constants
        pair.along[0] += (block.gas * c.get("cohesion")) * c.cohesion.push(block.s) * pair.weight
