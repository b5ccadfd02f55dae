"""Level gauges: the depth of the water at places over the floor."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.given import Level
from solvers.fluid.lists.order import Order
from solvers.fluid.state import UNUSED, Particles
from solvers.machine.state import Axis, State, padded, roomy
from solvers.space.axes import UP

USUAL = 8  # gauges for which there is room at least


@ti.data_oriented
class LevelGauges:
    """Depths (W, gauges) m of the first tank with water: its volume around each place over the floor's area there.

    Both are weighted by a kernel along y, in space also along x. The `pool` are the tank's number and how far (m) it
    reaches along y, and along x.
    """

    def __init__(
        self,
        arrays: State,
        particles: Particles,
        constants: Constants,
        order: Order,
        levels: Sequence[Level],
        pool: tuple[int, Sequence[tuple[float, float]]],
    ):
        self.particles, self.constants, self.order, (self.first, sides) = particles, constants, order, pool
        self.exact, self.count, room = arrays.exact, len(levels), roomy(len(levels), USUAL)
        own, places = arrays.under("water.diagnostics"), np.array([(one.y, one.x) for one in levels]).reshape(-1, 2)
        self.number = own.holding("level_number", np.array([self.count]), "one", ti.i32)
        self.place = own.holding("level_place", padded(places, room), "level axis", arrays.exact)
        self.sides = own.holding("level_sides", np.array(sides), "axis side", arrays.exact)
        self.ways = [axis for axis in range(particles.axes) if axis != UP]
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
        reach = ti.cast(self.constants.get("reach"), self.exact)
        total, floor = ti.cast(0.0, self.exact), ti.cast(1.0, self.exact)
        for b in range(w * p.stride, w * p.stride + p.used[w]):
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED and self.order.layer(b) == self.first and p.gas_at(b, lane) < 0.5:
                    weight = ti.cast(p.volume[b, lane], self.exact)
                    for k, axis in ti.static(enumerate(self.ways)):
                        off = ti.cast(p.place[axis][b, lane], self.exact) - self.place[level, k]
                        if ti.static(axis > UP and self.order.grid.periods[axis] > 0.0):
                            period = ti.cast(self.order.numbers[self.order.period + axis], self.exact)
                            off -= period * ti.floor(off / period + 0.5)
                        t = ti.max(1.0 - ti.abs(off) / reach, 0.0)
                        weight = weight * t * t * (3.0 - 2.0 * t)
                    total += weight
        for k in ti.static(range(len(self.ways))):
            left, right = self.place[level, k] - self.sides[k, 0], self.sides[k, 1] - self.place[level, k]
            floor *= reach * (self.covered(left / reach) + self.covered(right / reach))
        return ti.cast(total / floor, p.real)

    @ti.func
    def covered(self, x):
        """∫ from 0 to x of the kernel t² (3 − 2 t), t = 1 − x, which is 1/2 from x = 1 on."""
        t = 1.0 - ti.max(0.0, ti.min(1.0, x))
        return 0.5 - t * t * t * (1.0 - 0.5 * t)
