"""Walls: the tank's outline, a polygon of straight segments."""

import numpy as np
import taichi as ti

from solvers.runtime import Arrays


@ti.data_oriented
class Walls:
    """A simple polygon (m, 2), counter-clockwise, with the grains inside.

    Its features are m segments and, where the wall juts into the tank, the reflex corners. A grain touches a
    segment only where its centre projects onto it, and a corner only beyond both of the corner's segments, so no
    contact counts twice.
    """

    def __init__(self, arrays: Arrays, outline: np.ndarray):
        start = np.asarray(outline, dtype=np.float64)
        edge = np.roll(start, -1, axis=0) - start
        length = np.hypot(edge[:, 0], edge[:, 1])
        along = edge / length[:, None]
        before = np.roll(along, 1, axis=0)
        reflex = np.flatnonzero(before[:, 0] * along[:, 1] - before[:, 1] * along[:, 0] < -1e-12)
        self.outline = start
        self.segments, self.corners = len(start), len(reflex)
        self.features = self.segments + self.corners
        rows = np.zeros((self.features, 6))
        rows[: self.segments] = np.column_stack([start, along, length, np.zeros(len(start))])
        rows[self.segments :] = np.column_stack([start[reflex], before[reflex], along[reflex]])
        self.table = arrays.holding(rows)

    @ti.func
    def gap(self, feature, y, z):
        """Signed distance (m) of a point from a wall feature and the unit normal into the tank.

        The distance is huge where the point does not face the feature, negative behind a segment: no contact either.
        """
        py, pz = y - self.table[feature, 0], z - self.table[feature, 1]
        ty, tz = self.table[feature, 2], self.table[feature, 3]
        along = py * ty + pz * tz
        distance, normal_y, normal_z = py * -tz + pz * ty, -tz, ty
        if ti.static(self.corners == 0) or feature < self.segments:
            if along < 0.0 or along > self.table[feature, 4]:
                distance = 1e30
        else:
            beyond = py * self.table[feature, 4] + pz * self.table[feature, 5]
            distance = ti.sqrt(py * py + pz * pz)
            normal_y, normal_z = py / distance, pz / distance
            if along <= 0.0 or beyond >= 0.0:
                distance = 1e30
        return ti.Vector([distance, normal_y, normal_z])

    @ti.func
    def near(self, feature, y, z, reach):
        """Whether a point is within `reach` (m) of a wall feature, to whichever side."""
        py, pz = y - self.table[feature, 0], z - self.table[feature, 1]
        if feature < self.segments:
            ty, tz = self.table[feature, 2], self.table[feature, 3]
            along = ti.max(0.0, ti.min(self.table[feature, 4], py * ty + pz * tz))
            py -= along * ty
            pz -= along * tz
        return py * py + pz * pz < reach * reach

    @ti.func
    def holds(self, y, z):
        """Whether a point lies inside the polygon (even–odd rule)."""
        inside = False
        for k in range(self.segments):
            ay, az = self.table[k, 0], self.table[k, 1]
            by = ay + self.table[k, 4] * self.table[k, 2]
            bz = az + self.table[k, 4] * self.table[k, 3]
            if (az > z) != (bz > z) and y < ay + (z - az) / (bz - az) * (by - ay):
                inside = not inside
        return inside
