"""The gradient of the phase: where the surface between two fluids is, and which way."""

import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.state import Particles
from solvers.fluid.terms.term import Sums, Term
from solvers.space.axes import dot

NEAR = 1e-3  # of (2 h)² times the squared gradient of the phase: from there on the other phase is near


@ti.data_oriented
class PhaseGradient(Term):
    """∇C_i = Σ V_j (C_j − C_i) ∇W, C 0 in water and 1 in air (Hu & Adams 2006, eq. 19, of colours)."""

    def __init__(self, sums: Sums, particles: Particles, constants: Constants):
        self.particles, self.constants = particles, constants
        self.gradient = sums.room(particles.axes)

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a neighbour of the other phase."""
        for a in ti.static(range(self.particles.axes)):
            sums[self.gradient + a] += (pair.other * pair.weight) * pair.apart[a]

    @ti.func
    def across(self, block: ti.template(), shift: ti.template(), sums: ti.template()):
        """The part of a vector that is across the surface where the other phase is near, else zero."""
        p, c = self.particles, self.constants
        gradient = [sums[self.gradient + a] for a in ti.static(range(p.axes))]
        steep, near = ti.max(dot(gradient, gradient), 1e-30), c.get("slope") * c.get("reach")
        along = ti.select(steep * (near * near) > NEAR, dot(shift, gradient) / steep, p.zeros())
        return [along * gradient[a] for a in ti.static(range(p.axes))]

    @ti.func
    def lasting(self, block: ti.template(), sums: ti.template()):
        """1 for the particles of a block that are shifted: all."""
        return self.particles.filled(block.b)
