"""Level gauges: the depth of the water at places along the floor."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.given import Level
from solvers.fluid.lists.order import Order
from solvers.fluid.state import UNUSED, Particles
from solvers.machine.state import Axis, State, padded, roomy

USUAL = 8  # gauges for which there is room at least


@ti.data_oriented
class LevelGauges:
    """Depths (W, gauges) m of the first tank with water, whose number and corners (m) along y are the `pool`."""

    def __init__(
        self,
        arrays: State,
        particles: Particles,
        constants: Constants,
        order: Order,
        levels: Sequence[Level],
        pool: tuple[int, np.ndarray],
    ):
        self.particles, self.constants, self.order, (self.first, sides) = particles, constants, order, pool
        self.exact, self.count, room = arrays.exact, len(levels), roomy(len(levels), USUAL)
        own, places = arrays.under("water.diagnostics"), padded(np.array([level.y for level in levels]), room)
        self.number = own.holding("level_number", np.array([self.count]), "one", ti.i32)
        self.place = own.holding("level_y", places, "level", arrays.exact)
        self.sides = own.holding("level_sides", np.array((sides.min(), sides.max())), "side", arrays.exact)
        each = Axis("world", particles.worlds), Axis("level", room)
        (self.depth,) = own.reals(each, "level_depth", kept=False)

    def read(self) -> np.ndarray:
        """The depths (W, gauges) m as last measured."""
        return self.depth.to_numpy()[:, : self.count]

    @ti.func
    def measure(self, w, level):
        """Depth at a level gauge: the water's volume around it, weighted by a one-dimensional kernel."""
        if level < self.number[0]:
            self.depth[w, level] = self.found(w, level)

    @ti.func
    def found(self, w, level):
        """As `measure` has it."""
        p = self.particles
        reach, y = ti.cast(self.constants.get("reach"), self.exact), self.place[level]
        total = ti.cast(0.0, self.exact)
        for b in range(w * p.stride, w * p.stride + p.used[w]):
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED and self.order.layer(b) == self.first:
                    t = 1.0 - ti.abs(ti.cast(p.place[0][b, lane], self.exact) - y) / reach
                    if t > 0.0 and p.gas_at(b, lane) < 0.5:
                        total += ti.cast(p.volume[b, lane], self.exact) * t * t * (3.0 - 2.0 * t)
        left, right = (y - self.sides[0]) / reach, (self.sides[1] - y) / reach
        return ti.cast(total / (reach * (self.covered(left) + self.covered(right))), p.real)

    @ti.func
    def covered(self, x):
        """∫ from 0 to x of the kernel t² (3 − 2 t), t = 1 − x, which is 1/2 from x = 1 on."""
        t = 1.0 - ti.max(0.0, ti.min(1.0, x))
        return 0.5 - t * t * t * (1.0 - 0.5 * t)
