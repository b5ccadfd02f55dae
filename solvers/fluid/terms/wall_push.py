"""The pressure between a particle of water and a wall particle, without air."""

import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.terms.term import Term


@ti.data_oriented
class WallPush(Term):
    """p_i + p_w, where walls do not pull, and the spring behind a wall's face (`Constants.hardness`)."""

    def __init__(self, context: FluidContext):
        self.particles, self.constants = context.particles, context.constants

    @ti.func
    def along(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """The force of a wall particle along the line to it."""
        p, c = self.particles, self.constants
        pressure = p.pressure[pair.jb, pair.lane] + c.clipped(block.pressure, block.gas)
        return pressure * pair.weight + pair.volume * c.hardness(pair.square, p.firm[pair.jb, pair.lane], block.gas)

    @ti.func
    def of_wall(self, block: ti.template(), pair: ti.template(), along: ti.template()):
        """What of it is the wall particle's own."""
        return along - block.pressure * pair.weight
