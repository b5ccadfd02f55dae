"""The pressure that walls have for air, apart from that which they have for water."""

import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.terms.term import Sums, Term
from solvers.space.axes import dot


@ti.data_oriented
class AirAtWalls(Term):
    """p_w of the air alone, as of `Extrapolation`, and the water's share of what a wall particle sees."""

    def __init__(self, sums: Sums, context: FluidContext):
        self.particles = context.particles
        self.seen, self.pressed, self.lever = sums.room(), sums.room(), sums.room(context.particles.axes)

    @ti.func
    def add(self, b, seen: ti.template(), sums: ti.template()):
        """Add a particle before a block of walls, if it is of air."""
        p, gas = self.particles, self.particles.gas[seen.jb, seen.lane]
        sums[self.seen] += seen.weight * (seen.volume * gas)
        sums[self.pressed] += seen.weight * (seen.volume * gas * p.pressure[seen.jb, seen.lane])
        for a in ti.static(range(p.axes)):
            sums[self.lever + a] += (seen.massive * gas) * seen.apart[a]

    @ti.func
    def note(self, b, pull: ti.template(), of_water, sums: ti.template()):
        """Store both for a block, from the gravity (m/s²) that air has there and from Σ V_f W of the water."""
        p, seen = self.particles, sums[self.seen]
        pressed = sums[self.pressed] + dot(pull, [sums[self.lever + a] for a in ti.static(range(p.axes))])
        p.store(p.pressure_of_air, b, pressed / ti.max(seen, 1e-30))
        p.store(p.share, b, of_water / ti.max(of_water + seen, 1e-30))
