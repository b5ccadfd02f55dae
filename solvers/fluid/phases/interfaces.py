"""What acts between a particle of water and one of air, by name: weights of their pressures and velocities.

The pair's pressure is p_i + p_j + κ d (p_i − p_j), its velocity (1 + λ d) (u_j − u_i), with d = 1 for air i beside
water j, −1 for water i beside air j, 0 within a phase. Both are symmetric, so that forces are equal and opposite.
"""

import taichi as ti

from solvers.fluid.phases.cohesion import Cohesion
from solvers.fluid.terms.term import Term


class Weighted:
    """κ = λ = (ρ_w − ρ_a)/(ρ_w + ρ_a): pressure and velocity at the face between two particles (Toro 2009, eq. 9.28).

    2 p* = 2 (ρ_j p_i + ρ_i p_j)/(ρ_i + ρ_j) is the pressure of Hu & Adams (2006, eq. 15), at which both phases are
    accelerated alike; u* = (ρ_i u_i + ρ_j u_j)/(ρ_i + ρ_j) is the velocity that goes with it, so that what one gains in
    kinetic energy the other loses in elastic energy, pair by pair (own derivation). They are those of a linear Riemann
    problem with equal speeds of sound, without its dissipation (Rezavand, Zhang & Hu 2020). Water hardly sees how air
    moves, air sees water as a wall. At walls air meets its mirror image: there the pressure is 2 p_i + ρ_i g·(r_w −
    r_i), the weight 2. By symmetry of both sides, and with `solvers.fluid.phases.slip_correction`, the volume of air
    between walls and water then follows them, however coarse it is (own derivation). With a weight of 1 and an
    extrapolated pressure half a spacing of it is missed; a weight of 2 with such a pressure drives air at rest.

    Limits: a flow with strain along the surface opens and closes air there a little.
    """

    @staticmethod
    def leans(water: float, air: float) -> tuple[float, float]:
        """κ and λ for densities (kg/m³)."""
        lean = (water - air) / (water + air)
        return lean, lean


class HuAdams:
    """κ = (ρ_w − ρ_a)/(ρ_w + ρ_a), λ = 0 (Hu & Adams 2006, eq. 15): their pressure between particles, plain velocities.

    Limits: air that slides along water changes the density of the water, a thousand times stiffer; energy is not kept.
    """

    @staticmethod
    def leans(water: float, air: float) -> tuple[float, float]:
        """κ and λ for densities (kg/m³)."""
        return (water - air) / (water + air), 0.0


class Plain:
    """κ = λ = 0 (Colagrossi & Landrini 2003, eq. 15): p_i + p_j of particles by their volumes, plain velocities.

    Limits: air at the surface feels the water's pressure gradient, a thousand times its own; it needs a cohesion or a
    background pressure to stay in place.
    """

    @staticmethod
    def leans(water: float, air: float) -> tuple[float, float]:
        """κ and λ, zero."""
        return 0.0, 0.0


INTERFACES = {"weighted": Weighted, "hu-adams": HuAdams, "plain": Plain, "cohesion": Cohesion}


@ti.data_oriented
class InterfaceForce(Term):
    """κ d (p_i − p_j), by which the pressure between a particle of water and one of air leans."""

    def __init__(self, particles, constants):
        self.particles, self.constants = particles, constants

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a neighbour of the other phase."""
        apart = block.pressure - self.particles.pressure[pair.jb, pair.lane]
        pair.along[0] += (self.constants.get("lean_of_pressure") * pair.other) * apart * pair.weight
