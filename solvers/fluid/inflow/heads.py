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
from solvers.machine.state import Axis, Scope
from solvers.motion.frame import turned

HEIGHTS, SEAS, ROOM = (0, 1), (2, 3), 4  # columns of `seen`: of both ends, and the room's level


@ti.data_oriented
class Heads:
    """The levels on both sides of each opening, in W worlds: `seen` (W, K, 5) m, as they were last looked at."""

    def __init__(self, own: Scope, inlets: Sequence[Inlet], carrier, worlds: int):
        self.exact, self.carrier, self.count = own.exact, carrier, len(inlets)
        self.ends = own.holding("ends", np.array([np.ravel(one.ends) for one in inlets]), "inlet number", own.exact)
        self.room = own.holding("room", np.array([one.room for one in inlets]), "inlet", ti.i32)
        factor = [one.discharge * one.share * one.width for one in inlets]
        self.factor = own.holding("factor", np.array(factor), "inlet", own.exact)  # of ∫ √(2 g Δh) ds, to m² a second
        each = Axis("world", worlds), Axis("inlet", self.count), Axis("number", 5)
        (self.seen,) = own.reals(each, "seen", kind=own.exact)

    @ti.func
    def look(self, w, k, pose, t, level):
        """Note the heights of an opening's ends and the levels there: the sea's at t (s), the room's `level` (m)."""
        for end in ti.static(range(2)):
            place = turned(self.ends[k, 2 * end], self.ends[k, 2 * end + 1], pose[2])
            self.seen[w, k, end] = pose[1] + place[1]
            self.seen[w, k, 2 + end] = self.carrier.hulls.sea(w, pose[0] + place[0], t)[0]
        self.seen[w, k, ROOM] = level

    @ti.func
    def head(self, w, k, s):
        """Δh (m) at the share s of an opening's length; above 0 water enters."""
        z = self.seen[w, k, 0] + s * (self.seen[w, k, 1] - self.seen[w, k, 0])
        sea = self.seen[w, k, 2] + s * (self.seen[w, k, 3] - self.seen[w, k, 2])
        return ti.max(sea, z) - ti.max(self.seen[w, k, ROOM], z)

    @ti.func
    def flow(self, w, k):
        """What flows in by an opening less what flows out by it, m²/s: per metre of the room's length."""
        found = ti.cast(0.0, self.exact)
        for way in range(2):  # in, and out
            found += (1 - 2 * way) * self.through(w, k, ti.cast(1.0, self.exact), 1 - 2 * way)
        return self.factor[k] * ti.sqrt(2.0 * self.carrier.gravity[0]) * found

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
