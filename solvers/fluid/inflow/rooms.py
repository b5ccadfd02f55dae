"""Rooms of a ship at any heel: the level at which their water stands, and where its centre then is."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.state import Scope
from solvers.motion.frame import turned

DRY = -1e6  # m, the level of a room without water
HALVINGS = 48  # of the room's height, for its level


@ti.data_oriented
class Rooms:
    """Outlines of tanks: `corners` (rooms, sides + 1, 2) m in the axes of the tanks, closed, and padded with the first.

    Heights are those over the earth's origin, of tanks at a pose (Y, Z, φ) of their origin.
    """

    def __init__(self, own: Scope, outlines: Sequence[np.ndarray]):
        self.exact, self.sides = own.exact, max(map(len, outlines))
        closed = [np.concatenate([one, np.repeat(one[:1], self.sides + 1 - len(one), axis=0)]) for one in outlines]
        self.corners = own.holding("corners", np.array(closed), "room corner direction", own.exact)

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
            y0, y1, before, after = self.immersed(room, side, pose, level)
            area += 0.5 * (y1 - y0) * (before + after)
        return area

    @ti.func
    def centre_below(self, room, pose, level):
        """Centroid (m), in the axes of the tanks, of what is below a level (m): exactly, by Green's theorem."""
        area, across, deep = ti.cast(1e-30, self.exact), ti.cast(0.0, self.exact), ti.cast(0.0, self.exact)
        for side in range(self.sides):
            y0, y1, d0, d1 = self.immersed(room, side, pose, level)
            area += 0.5 * (y1 - y0) * (d0 + d1)
            across += (y1 - y0) / 6.0 * (y0 * (2.0 * d0 + d1) + y1 * (d0 + 2.0 * d1))
            deep += (y1 - y0) / 6.0 * (d0 * d0 + d0 * d1 + d1 * d1)
        return turned(across / area, level - pose[1] - deep / area, 0.0 - pose[2])

    @ti.func
    def immersed(self, room, side, pose, level):
        """The part of an edge below a level (m): where it begins and ends across, from the origin, and how deep (m)."""
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
        return y0, y1, ti.max(before, 0.0), ti.max(after, 0.0)
