"""Heads over the openings of ships, and what flows through them: the law of `solvers.ship.flooding.openings`.

Q = C_d L ∫ √(2 g Δh) ds along the opening, Δh = max(h_sea, z) − max(h_room, z) (Torricelli 1643; Dillingham 1981), with
z the height of a point of it. Here h_sea is the sea's level at that place, linear between the opening's ends, and
h_room the level of the room's water as if it were at rest, which follows from its volume and the room's heel; so Δh has
at most three bends, between which ∫ √Δh ds = ⅔ (a² + a b + b²)/(a + b), a and b its roots at the two ends.
"""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.inflow.inlet import Inlet
from solvers.machine.state import Axis, State
from solvers.motion.frame import turned

DRY = -1e6  # m, the level of a room without water
HALVINGS = 48  # of the room's height, for its level
HEIGHTS, SEAS, ROOM = (0, 1), (2, 3), 4  # columns of `seen`: of both ends, and the room's level


@ti.data_oriented
class Heads:
    """The levels on both sides of each opening, in W worlds: `seen` (W, K, 5) m, as they were last looked at.

    `corners` (tanks, k, 2) m are those of the tanks, padded; `water` (tanks,) m² what is in each at the start without
    being counted by particles that enter.
    """

    def __init__(self, arrays: State, inlets: Sequence[Inlet], outlines: Sequence[np.ndarray], carrier, worlds: int):
        self.exact, self.carrier, self.count = arrays.exact, carrier, len(inlets)
        own, most = arrays.under("water.inflow"), max(map(len, outlines))
        closed = [np.concatenate([one, np.repeat(one[:1], most + 1 - len(one), axis=0)]) for one in outlines]
        self.sides = most
        self.corners = own.holding("corners", np.array(closed), "room corner direction", own.exact)
        self.ends = own.holding("ends", np.array([np.ravel(one.ends) for one in inlets]), "inlet number", own.exact)
        self.room = own.holding("room", np.array([one.room for one in inlets]), "inlet", ti.i32)
        each = Axis("world", worlds), Axis("inlet", self.count), Axis("number", 5)
        (self.seen,) = own.reals(each, "seen", kind=own.exact)

    @ti.func
    def look(self, w, k, pose, t, area):
        """Note the heights of an opening's ends and the levels there, of the sea at t (s) and of a room with `area`."""
        for end in ti.static(range(2)):
            place = turned(self.ends[k, 2 * end], self.ends[k, 2 * end + 1], pose[2])
            self.seen[w, k, end] = pose[1] + place[1]
            self.seen[w, k, 2 + end] = self.carrier.hulls.sea(w, pose[0] + place[0], t)[0]
        self.seen[w, k, ROOM] = self.level(self.room[k], pose, area)

    @ti.func
    def level(self, room, pose, area):
        """The height (m) of a level surface over an area (m²) of water in a room at a pose of the tanks."""
        low, high = ti.cast(1e9, self.exact), ti.cast(-1e9, self.exact)
        for corner in range(self.sides):
            z = pose[1] + turned(self.corners[room, corner, 0], self.corners[room, corner, 1], pose[2])[1]
            low, high = ti.min(low, z), ti.max(high, z)
        found = ti.cast(DRY, self.exact)
        if area > 0.0:
            for _ in range(HALVINGS):
                found = 0.5 * (low + high)
                if self.area_below(room, pose, found) < area:
                    low = found
                else:
                    high = found
        return found

    @ti.func
    def area_below(self, room, pose, level):
        """Area (m²) of a room below a level (m), along its immersed edges, as of hulls (`solvers.motion.buoyancy`)."""
        area = ti.cast(0.0, self.exact)
        for side in range(self.sides):
            one = turned(self.corners[room, side, 0], self.corners[room, side, 1], pose[2])
            two = turned(self.corners[room, side + 1, 0], self.corners[room, side + 1, 1], pose[2])
            before, after = level - pose[1] - one[1], level - pose[1] - two[1]
            y0, y1 = one[0], two[0]
            if (before > 0.0) != (after > 0.0):
                crossing = y0 + before / (before - after) * (y1 - y0)
                if before > 0.0:
                    y1 = crossing
                else:
                    y0 = crossing
            area += 0.5 * (y1 - y0) * (ti.max(before, 0.0) + ti.max(after, 0.0))
        return area

    @ti.func
    def head(self, w, k, s):
        """Δh (m) at the share s of an opening's length; above 0 water enters."""
        z = self.seen[w, k, 0] + s * (self.seen[w, k, 1] - self.seen[w, k, 0])
        sea = self.seen[w, k, 2] + s * (self.seen[w, k, 3] - self.seen[w, k, 2])
        return ti.max(sea, z) - ti.max(self.seen[w, k, ROOM], z)

    @ti.func
    def through(self, w, k, until, way):
        """∫ √Δh ds (m^½), s from 0 to `until`, of where water goes this `way`: 1 in, −1 out."""
        z0, z1 = self.seen[w, k, 0], self.seen[w, k, 1]
        sea0, sea1, room = self.seen[w, k, 2], self.seen[w, k, 3], self.seen[w, k, ROOM]
        one = ti.min(self.crossing(sea0 - z0, sea1 - z1), until)
        two = ti.min(self.crossing(room - z0, room - z1), until)
        three = ti.min(self.crossing(sea0 - room, sea1 - room), until)
        first, last = ti.min(one, ti.min(two, three)), ti.max(one, ti.max(two, three))
        middle = one + two + three - first - last
        total, begin = 0.0 * until, 0.0 * until
        for part in range(4):  # a loop, since functions are compiled wherever they are called
            end = ti.select(part == 0, first, ti.select(part == 1, middle, ti.select(part == 2, last, until)))
            total += self.between(w, k, begin, end, way)
            begin = end
        return total

    @ti.func
    def crossing(self, before, after):
        """Where from 0 to 1 a linear function is zero; 1 where it is not."""
        found = ti.cast(1.0, self.exact)
        if (before > 0.0) != (after > 0.0):
            found = before / (before - after)
        return found

    @ti.func
    def between(self, w, k, begin, end, way):
        """∫ √(way Δh) ds between two shares of an opening, in which Δh is linear."""
        a = ti.sqrt(ti.max(way * self.head(w, k, begin), 0.0))
        b = ti.sqrt(ti.max(way * self.head(w, k, end), 0.0))
        return (end - begin) * 2.0 / 3.0 * (a * a + a * b + b * b) / ti.max(a + b, 1e-30)

    @ti.func
    def place(self, w, k, part, way):
        """The share of an opening up to which this part of what goes one way flows."""
        low, high, at = ti.cast(0.0, self.exact), ti.cast(1.0, self.exact), ti.cast(1.0, self.exact)
        wanted = ti.cast(-1.0, self.exact)
        for _ in range(25):
            passed = self.through(w, k, at, way)
            if wanted < 0.0:
                wanted = part * passed  # the first is all of it
            elif passed < wanted:
                low = at
            else:
                high = at
            at = 0.5 * (low + high)
        return at
