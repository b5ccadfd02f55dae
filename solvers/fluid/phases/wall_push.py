"""The pressure between a particle of water or air and a wall particle."""

import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.terms.term import Sums, Term
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.space.axes import dot


@ti.data_oriented
class WallPushOfTwo(Term):
    """As `WallPush`, of water; air i meets its mirror image, 2 p_i + ρ_i g·(r_w − r_i) (`phases.interfaces`).

    The spring behind a wall's face holds air as heavy as before in less volume.
    """

    def __init__(self, sums: Sums, context: FluidContext, walls: Extrapolation):
        self.particles, self.constants, self.walls = context.particles, context.constants, walls
        self.units, self.weighs, self.squeezed = context.units, sums.room(context.particles.axes), sums.room()

    @ti.func
    def begin(self, block: ti.template(), sums: ti.template()):
        """Begin with the weight of a block's air per volume, N/m³."""
        w = self.units.world(block.u)
        felt = self.walls.of_air(w, self.walls.felt(w, block.b))
        sums[self.squeezed] = 1.0 + block.gas * block.s
        for a in ti.static(range(self.particles.axes)):
            weight = block.gas * sums[self.squeezed] * self.constants.get("air_density")
            sums[self.weighs + a] = weight * felt[a]

    @ti.func
    def along(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """The force of a wall particle along the line to it."""
        p, c = self.particles, self.constants
        seen = (1.0 - block.gas) * p.pressure[pair.jb, pair.lane] + block.gas * block.pressure
        pressure = seen + c.clipped(block.pressure, block.gas)
        spring = pair.volume * c.hardness(pair.square, p.firm[pair.jb, pair.lane], block.gas)
        spring *= sums[self.squeezed]
        pressure = pressure - dot([sums[self.weighs + a] for a in ti.static(range(p.axes))], pair.apart)
        if ti.static(c.coheres):
            pressure += (block.gas * c.get("cohesion")) * c.cohesion.push(block.s)
        return pressure * pair.weight + spring

    @ti.func
    def of_wall(self, block: ti.template(), pair: ti.template(), along: ti.template()):
        """What of it is the wall particle's own."""
        return along - (block.pressure * pair.weight) * (1.0 + block.gas)
