"""Places at which particles of water enter a room of a ship."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.inflow.heads import ROOM, Heads
from solvers.fluid.inflow.inlet import Inlet, mouth
from solvers.fluid.inflow.rooms import Rooms
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.state import SPRAY, UNUSED
from solvers.machine.state import Axis, State
from solvers.motion.frame import turned

NEAR = 0.9  # spacings: where another particle is nearer than that, none can enter
TRIES = 6  # places that a particle tries in a step
TURN = 0.6180339887498949  # golden section: places that follow one another spread evenly (Weyl 1916)


@ti.data_oriented
class Places:
    """Finds where a particle enters: its `spot` (W, 4), place (m) and velocity over the earth (m/s), in the tank axes.

    In the mouth of its opening, with the speed of the jet, or on the water where the room's level is over the mouth
    (`solvers.fluid.inflow.inflow.Inflow`). `turns` (W, K) counts the tries.
    """

    def __init__(
        self,
        arrays: State,
        inlets: Sequence[Inlet],
        outlines: Sequence[np.ndarray],
        context: FluidContext,
        rooms: Rooms,
        heads: Heads,
    ):
        self.particles, self.order, self.constants = context.particles, context.lists.order, context.constants
        self.rooms, self.heads, self.carrier, self.exact = rooms, heads, heads.carrier, arrays.exact
        own, world = arrays.under("water.inflow"), Axis("world", context.particles.worlds)
        mouths = [mouth(one, outlines[one.room]) for one in inlets]
        self.mouth = own.holding("mouth", np.array([ends.ravel() for ends, _ in mouths]), "inlet number", own.exact)
        self.inward = own.holding("inward", np.array([inward for _, inward in mouths]), "inlet direction", own.exact)
        (self.turns,) = own.integers((world, Axis("inlet", len(inlets))), "turns")
        (self.spot,) = own.reals((world, Axis("number", 4)), "spot", kind=own.exact, kept=False)

    @ti.func
    def spacing(self):
        """Distance of particles (m)."""
        return ti.cast(self.constants.get("spacing"), self.exact)

    @ti.func
    def find(self, w, k, t, new):
        """Find where a particle may enter by an opening at t (s), after `new` others; returns whether it can."""
        motion, room, found = self.carrier.kinematics(w, t), self.heads.room[k], False
        for _ in range(TRIES):
            if not found:
                s = self.heads.place(w, k, self.next(w, k), 1.0)
                self.stand_at(w, k, s)
                height = motion[1] + turned(self.spot[w, 0], self.spot[w, 1], motion[2])[1]
                may = True
                if height < self.heads.seen[w, k, ROOM]:
                    may = self.lie_on_top(w, k, motion[2], new)
                else:
                    jet = ti.sqrt(2.0 * self.carrier.gravity[0] * ti.max(self.heads.head(w, k, s), 0.0))
                    own = turned(motion[3], motion[4], 0.0 - motion[2])
                    self.spot[w, 2] = own[0] - motion[5] * self.spot[w, 1] + jet * self.inward[k, 0]
                    self.spot[w, 3] = own[1] + motion[5] * self.spot[w, 0] + jet * self.inward[k, 1]
                found = may and self.is_free(w, room, new)
        return found

    @ti.func
    def next(self, w, k):
        """A number from 0 to 1 for the next try; those that follow one another are spread evenly."""
        self.turns[w, k] = self.turns[w, k] + 1
        part = self.turns[w, k] * ti.cast(TURN, self.exact)
        return part - ti.floor(part)

    @ti.func
    def stand_at(self, w, k, s):
        """Note the place before the mouth of an opening at a share of its length, half a spacing from all walls."""
        y, z = self.mouth[k, 2] - self.mouth[k, 0], self.mouth[k, 3] - self.mouth[k, 1]
        size, half = ti.sqrt(y * y + z * z), 0.5 * self.spacing()
        at = ti.cast(0.5, self.exact)
        if size > self.spacing():
            at = ti.max(half, ti.min(size - half, s * size)) / size
        self.spot[w, 0] = self.mouth[k, 0] + at * y + half * self.inward[k, 0]
        self.spot[w, 1] = self.mouth[k, 1] + at * z + half * self.inward[k, 1]

    @ti.func
    def lie_on_top(self, w, k, roll, new):
        """Note a place on the water, anywhere across a room, moving as the water there; returns whether it is free.

        It is over the highest particle that is no spray.
        """
        p, room, near = self.particles, self.heads.room[k], NEAR * self.spacing()
        across, up = turned(1.0, 0.0, 0.0 - roll), turned(0.0, 1.0, 0.0 - roll)
        low, high = ti.cast(1e6, self.exact), ti.cast(-1e6, self.exact)
        for corner in range(self.rooms.sides):
            x = self.rooms.corners[room, corner, 0] * across[0] + self.rooms.corners[room, corner, 1] * across[1]
            low, high = ti.min(low, x), ti.max(high, x)
        at, top, found = low + self.next(w, k) * (high - low), ti.cast(-1e6, self.exact), -1
        for slot in range(self.first_slot(w), self.end_slot(w, new)):
            b, lane = slot // p.lanes, slot % p.lanes
            if self.is_in(b, lane, room) and p.eigenvalue[b, lane] > SPRAY:
                y, z = ti.cast(p.place[0][b, lane], self.exact), ti.cast(p.place[1][b, lane], self.exact)
                beside, over = y * across[0] + z * across[1] - at, y * up[0] + z * up[1]
                if beside * beside < near * near:
                    over += ti.sqrt(near * near - beside * beside)
                    if over > top:
                        top, found = over, slot
        if found >= 0:
            self.spot[w, 0], self.spot[w, 1] = at * across[0] + top * up[0], at * across[1] + top * up[1]
            for a in ti.static(range(p.axes)):
                self.spot[w, 2 + a] = ti.cast(p.velocity[a][found // p.lanes, found % p.lanes], self.exact)
        return found >= 0 and self.is_within(room, self.spot[w, 0], self.spot[w, 1])

    @ti.func
    def is_in(self, b, lane, room):
        """Whether a lane has a particle of a room."""
        return self.particles.number[b, lane] != UNUSED and self.layer_of(self.particles.number[b, lane]) == room

    @ti.func
    def is_free(self, w, room, new):
        """Whether no particle of a room is near the noted place."""
        p, near, free = self.particles, 0.999 * NEAR * self.spacing(), True
        for slot in range(self.first_slot(w), self.end_slot(w, new)):
            b, lane = slot // p.lanes, slot % p.lanes
            if self.is_in(b, lane, room):
                y = ti.cast(p.place[0][b, lane], self.exact) - self.spot[w, 0]
                z = ti.cast(p.place[1][b, lane], self.exact) - self.spot[w, 1]
                if y * y + z * z < near * near:
                    free = False
        return free

    @ti.func
    def first_slot(self, w):
        """The first slot of a world: lane by lane, since loops over a block's lanes would be unrolled."""
        return w * self.particles.stride * self.particles.lanes

    @ti.func
    def end_slot(self, w, new):
        """The end of the slots of a world that are in use, with those of `new` particles behind them."""
        p = self.particles
        return (w * p.stride + p.used[w]) * p.lanes + new

    @ti.func
    def layer_of(self, number):
        """The tank of a particle."""
        layer = 0
        if ti.static(self.order.layers > 1):
            layer = self.order.layer_of(number)
        return layer

    @ti.func
    def is_within(self, room, y, z):
        """Whether a place (m) is in a room, half a spacing from its walls."""
        inside, least = False, 0.49 * self.spacing()
        for side in range(self.rooms.sides):
            y0, z0 = self.rooms.corners[room, side, 0], self.rooms.corners[room, side, 1]
            y1, z1 = self.rooms.corners[room, side + 1, 0], self.rooms.corners[room, side + 1, 1]
            if (z0 > z) != (z1 > z):  # noqa: SIM102 (no division by zero)
                if y < y0 + (z - z0) / (z1 - z0) * (y1 - y0):
                    inside = not inside
            size = (y1 - y0) * (y1 - y0) + (z1 - z0) * (z1 - z0)
            share = ((y - y0) * (y1 - y0) + (z - z0) * (z1 - z0)) / ti.max(size, 1e-30)
            share = ti.max(0.0, ti.min(1.0, share))
            away_y, away_z = y - y0 - share * (y1 - y0), z - z0 - share * (z1 - z0)
            if size > 0.0 and away_y * away_y + away_z * away_z < least * least:
                inside, least = False, ti.cast(1e6, self.exact)
        return inside and least < 1e5
