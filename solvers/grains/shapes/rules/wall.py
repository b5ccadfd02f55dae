"""Walls for grains with outlines: a segment as a normal and a distance, a corner as a point."""

import numpy as np
import taichi as ti

from solvers.grains.shapes.pose import turned, turned_back
from solvers.machine.state import State
from solvers.tank.walls import AFTER_Y, AFTER_Z, ALONG_Y, ALONG_Z, LENGTH, PART, TWO_SIDED, Walls, Y, Z

ENDLESS = 1e3  # m
FAR = 1e3  # of an outline's size


@ti.data_oriented
class SeenWalls:
    """A tank's walls for grains with outlines.

    An outline touches a segment if its contact point projects onto it, and a corner if the contact's normal lies
    between those of the corner's segments. So each contact counts once, without a jump from one feature to the other. A
    segment does not end where the next one turns towards the grains, since that one stops them.
    """

    def __init__(self, arrays: State, walls: Walls):
        self.walls = walls
        self.ends = arrays.holding("walls.limits", _ends(walls), "feature number", arrays.place)

    @ti.func
    def facing(self, feature, shift: ti.template(), y, z):
        """A segment's unit normal (y, z) towards the side of a point, and the point's distance (m) from it."""
        point = self.walls.from_start(feature, shift, y, z)
        ty, tz = self.walls.table[feature, ALONG_Y], self.walls.table[feature, ALONG_Z]
        distance, side = point[1] * ty - point[0] * tz, 1.0
        if ti.static(self.walls.open or self.walls.parts > 0):  # noqa: SIM102 (compiled only where there are plates)
            if self.walls.table[feature, TWO_SIDED] > 0.0 and distance < 0.0:
                side = -1.0
        normal = self.walls.turned(feature, shift, -tz * side, ty * side)
        return ti.Vector([normal[0], normal[1], distance * side])

    @ti.func
    def target(self, g: ti.template(), w, i, feature, shift: ti.template()):
        """A wall in a grain's frame: a segment's normal and distance (m) from the centre, or a corner's position."""
        seen = ti.Vector([ti.cast(0.0, g.real), ti.cast(0.0, g.real), ti.cast(0.0, g.real)])
        if feature < self.walls.segments:
            face = self.facing(feature, shift, g.y[w, i], g.z[w, i])
            normal = turned_back(g.turn(w, i), ti.Vector([ti.cast(face[0], g.real), ti.cast(face[1], g.real)]))
            seen = ti.Vector([normal[0], normal[1], ti.cast(face[2], g.real)])
        else:
            drawn = self.walls.from_start(feature, shift, g.y[w, i], g.z[w, i])
            point = self.walls.turned(feature, shift, drawn[0], drawn[1])
            corner = turned_back(g.turn(w, i), ti.Vector([-ti.cast(point[0], g.real), -ti.cast(point[1], g.real)]))
            seen = ti.Vector([corner[0], corner[1], ti.cast(0.0, g.real)])
        return seen

    @ti.func
    def counts_on_segment(self, feature, shift: ti.template(), y, z):
        """Whether a point projects onto a segment."""
        point = self.walls.from_start(feature, shift, y, z)
        along = point[0] * self.walls.table[feature, ALONG_Y] + point[1] * self.walls.table[feature, ALONG_Z]
        return self.ends[feature, 0] <= along <= self.ends[feature, 1]

    @ti.func
    def counts_on_corner(self, feature, shift: ti.template(), ny, nz):
        """Whether a normal (y, z) lies between those of a corner's two segments."""
        along = self.walls.turned(
            feature, shift, self.walls.table[feature, ALONG_Y], self.walls.table[feature, ALONG_Z]
        )
        past = self.walls.turned(feature, shift, self.walls.table[feature, AFTER_Y], self.walls.table[feature, AFTER_Z])
        before = ny * along[0] + nz * along[1]
        after = ny * past[0] + nz * past[1]
        return before > 0.0 and after < 0.0

    @ti.func
    def corner_contact(self, g: ti.template(), tables: ti.template(), w, i, feature, shift: ti.template()):
        """Contact of grain i with a corner, by polar radius: overlap (m), normal, point from the centre (m), 1."""
        drawn = self.walls.from_start(feature, shift, g.y[w, i], g.z[w, i])
        away = self.walls.turned(feature, shift, drawn[0], drawn[1])
        corner = ti.Vector([-ti.cast(away[0], g.real), -ti.cast(away[1], g.real)])
        own = turned_back(g.turn(w, i), corner)
        distance = own.norm()
        radius = g.radius[w, i] * tables.radius_and_slope(g.shape[w, i], own[0], own[1])
        tilt = radius[0] / ti.sqrt(radius[0] ** 2 + radius[1] ** 2)
        outward = ti.Vector([radius[0] * own[0] + radius[1] * own[1], radius[0] * own[1] - radius[1] * own[0]])
        normal = 0.0 - turned(g.turn(w, i), outward * tilt / (radius[0] * distance))
        overlap = (radius[0] - distance) * tilt
        if not self.counts_on_corner(feature, shift, normal[0], normal[1]):
            overlap = -FAR
        point = corner - overlap * normal
        return ti.Vector([overlap, normal[0], normal[1], point[0], point[1], 1.0])


@ti.func
def slopes(own, target, corner):
    """First and second derivative by the place of the gap (half its square for a corner), and |p'|²."""
    x, y = target[0], target[1]
    size = own[2] * own[2] + own[3] * own[3]
    more = 0.0 * x
    if corner:
        x, y, more = own[0] - target[0], own[1] - target[1], size
    return ti.Vector([own[2] * x + own[3] * y, own[4] * x + own[5] * y + more, size])


def _ends(walls: Walls) -> np.ndarray:
    """Bounds (features, 2) m, along each segment, between which it counts."""
    segments = walls.rows[: walls.segments]
    ends = np.zeros((walls.features, 2))
    for k, row in enumerate(segments):
        ends[k] = 0.0, row[LENGTH]
        if row[TWO_SIDED] > 0.0:
            continue
        start, along = row[[Y, Z]], row[[ALONG_Y, ALONG_Z]]
        for other in segments[segments[:, PART] == row[PART]]:
            begin, way = other[[Y, Z]], other[[ALONG_Y, ALONG_Z]]
            if np.allclose(begin, start + row[LENGTH] * along) and along[0] * way[1] - along[1] * way[0] > 0.0:
                ends[k, 1] = ENDLESS
            if np.allclose(begin + other[LENGTH] * way, start) and way[0] * along[1] - way[1] * along[0] > 0.0:
                ends[k, 0] = -ENDLESS
    return ends
