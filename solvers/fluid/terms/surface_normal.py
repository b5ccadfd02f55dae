"""Which way a free surface is, and whether it is near."""

import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.state import INSIDE, SPRAY, Particles
from solvers.fluid.terms.term import Sums, Term
from solvers.space.axes import dot


@ti.data_oriented
class SurfaceNormal(Term):
    """n ~ Σ V_j (λ_j − λ_i) ∇W, from the smallest eigenvalues λ of the step before (Marrone et al. 2010).

    A surface is near where any neighbour has λ < INSIDE; spray has λ < SPRAY itself.
    """

    def __init__(self, sums: Sums, particles: Particles, constants: Constants):
        self.particles, self.constants = particles, constants
        self.inwards, self.least, self.eigenvalue = sums.room(particles.axes), sums.room(), sums.room()

    @ti.func
    def begin(self, block: ti.template(), sums: ti.template()):
        """Begin with the block's own eigenvalues."""
        sums[self.eigenvalue] = self.particles.load(self.particles.eigenvalue_before, block.b)
        sums[self.least] = self.particles.ones()

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a neighbour's difference."""
        p = self.particles
        there = p.eigenvalue_before[pair.jb, pair.lane]
        deeper = there - sums[self.eigenvalue]
        sums[self.least] = ti.min(sums[self.least], ti.select(pair.weight > 0.0, p.ones() * there, p.ones()))
        for a in ti.static(range(p.axes)):
            sums[self.inwards + a] = sums[self.inwards + a] - (deeper * pair.weight) * pair.apart[a]

    @ti.func
    def across(self, block: ti.template(), shift: ti.template(), sums: ti.template()):
        """The part of a vector that is across a surface that is near, else zero."""
        p = self.particles
        inwards = [sums[self.inwards + a] for a in ti.static(range(p.axes))]
        steep = ti.max(dot(inwards, inwards), 1e-30)
        along = ti.select(sums[self.least] < INSIDE, dot(shift, inwards) / steep, p.zeros())
        return [along * inwards[a] for a in ti.static(range(p.axes))]

    @ti.func
    def lasting(self, block: ti.template(), sums: ti.template()):
        """1 for the particles of a block that are shifted, 0 for spray."""
        p = self.particles
        lasting = ti.select(sums[self.eigenvalue] < SPRAY, p.zeros(), p.filled(block.b))
        if ti.static(self.constants.shifting.carries):
            lasting = ti.select(sums[self.least] < INSIDE, p.zeros(), lasting)
        return lasting
