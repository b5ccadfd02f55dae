"""Which blocks of water and of walls each unit works on."""

import taichi as ti

from solvers.fluid.state import WALLS, Particles


@ti.data_oriented
class WorkRanges:
    """Which blocks of a world each unit works on: of the used ones of water, and of the walls' ones, equal shares."""

    def __init__(self, particles: Particles, units):
        self.particles, self.units = particles, units

    @ti.func
    def _cut(self, u, blocks):
        """First and end of a unit's share of a number of blocks."""
        first, end = 0, blocks
        if ti.static(not self.units.whole):
            size = (blocks + self.units.a_world - 1) // self.units.a_world
            first = ti.min(blocks, (u % self.units.a_world) * size)
            end = ti.min(blocks, first + size)
        return first, end

    @ti.func
    def fluid(self, u):
        """First and end of a unit's blocks of water."""
        w = self.units.world(u)
        first, end = self._cut(u, self.particles.used[w])
        return w * self.particles.stride + first, w * self.particles.stride + end

    @ti.func
    def walls(self, u):
        """First and end of a unit's blocks of walls."""
        w = self.units.world(u)
        first, end = self._cut(u, self.particles.sizes[WALLS])
        start = w * self.particles.stride + self.particles.fluid_blocks
        return start + first, start + end
