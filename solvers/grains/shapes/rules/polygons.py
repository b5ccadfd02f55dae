"""Outlines as polygons, and the area of overlap of two polygons, or of one with a wall."""

from math import pi

import numpy as np
import taichi as ti

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.pose import turned, turned_back
from solvers.grains.shapes.tables import TINY
from solvers.machine.state import State
from solvers.space.extremes import greater, lesser, within

# Elements of a shared area: the area A (m²); the integral ∫ n dl (m) of the outward normals of the first outline's part
# inside the other; the moments ∫ r n dl (m²) about the first outline's centre.
AREA, PUSH_X, PUSH_Y, XX, XY, YX, YY = range(7)


@ti.data_oriented
class Polygons:
    """Corners of C outlines, equally spaced by polar angle, scaled to the outlines' areas.

    The shared area of two of them is exact, however often they cross. With the second star-shaped about its centre, A =
    −∫ ½ (R² − ρ²) dφ along the part of the first that lies in it (Green's theorem), a sum over pieces of its edges
    between the rays through the second's corners. Neither centre may lie in the other outline.
    """

    def __init__(self, arrays: State, outlines: list[Contour], count: int):
        self.count = count
        corners = np.array([_corners(outline, count) for outline in outlines])
        own = arrays.under("polygons")
        self.corner = own.holding("corner", corners, "outline corner number")
        self.bounding = own.holding("bounding", np.linalg.norm(corners, axis=-1).max(axis=-1), "outline")
        self.least = own.holding("least", np.array([_least(one) for one in corners]), "outline")

    @ti.func
    def shared(self, one: ti.template(), between, centre, other: ti.template(), start, edges, margin):
        """Shared area of `edges` edges of an outline from corner `start` on with the other, in the other's frame.

        `between` and `centre` are the first outline's rotation and centre in that frame. Also returns a lower bound of
        the distance (m) if nothing is shared, and the first corner and number of edges that may be within `margin` (m).
        """
        total, gap = nothing(one.scale), one.scale * self.bounding[one.shape]
        begin, end = edges, 0
        p = self.seen(one, between, centre, start)
        sector, beyond = self.ray(p, other)
        for k in range(edges):
            q = self.seen(one, between, centre, start + k + 1)
            piece, away, sector, beyond = self.edge(p, q, centre, other, sector, beyond)
            total += piece
            gap = lesser(away, gap)
            if away < margin:
                begin, end = ti.min(begin, k), k + 1
            p = q
        return total, gap, start + ti.min(begin, end), ti.max(end - begin, 0)

    @ti.func
    def facing(self, one: ti.template(), between, centre, reach):
        """First corner and number of edges that may lie within a circle of radius `reach` (m) about the origin."""
        distance, own = centre.norm(), one.scale * self.bounding[one.shape]
        start, edges = 0, 0
        if distance < own + reach:
            edges = self.count
            if distance > reach:
                widest = lesser(own, ti.sqrt(distance * distance - reach * reach))
                cosine = (distance * distance + widest * widest - reach * reach) / (2.0 * distance * widest)
                start, edges = self.about(turned_back(between, -centre), cosine)
        return start, edges

    @ti.func
    def about(self, direction, cosine):
        """First corner and number of edges within an angle of given cosine about a direction in the outline's frame."""
        half = ti.acos(within(cosine, 1.0)) * ti.static(0.5 * self.count / pi)
        middle = ti.atan2(direction[1], direction[0]) * ti.static(0.5 * self.count / pi)
        start = ti.cast(ti.floor(middle - half), ti.i32)
        return start, ti.min(self.count, ti.cast(ti.ceil(middle + half), ti.i32) - start)

    @ti.func
    def own(self, shape, k):
        """Corner k of an outline, modulo their number."""
        n = k % self.count
        return ti.Vector([self.corner[shape, n, 0], self.corner[shape, n, 1]])

    @ti.func
    def seen(self, one: ti.template(), between, centre, k):
        """Corner k of a scaled outline with the rotation `between` and its centre at `centre`."""
        return centre + one.scale * turned(between, self.own(one.shape, k))

    @ti.func
    def ray(self, p, other: ti.template()):
        """The sector of a point, between the rays of two successive corners, and R/ρ − 1 there."""
        s = ti.cast(ti.floor(ti.atan2(p[1], p[0]) * ti.static(0.5 * self.count / pi)), ti.i32)
        return s, beyond_side(p, other.scale * self.own(other.shape, s), other.scale * self.own(other.shape, s + 1))

    @ti.func
    def edge(self, p, q, centre, other: ti.template(), sector, beyond):
        """Contribution of an edge p q, a lower bound (m) of its distance from the other outline, and the `ray` of q.

        A point outside at ρ, on a ray that meets the outline at R, has a distance of at least (ρ − R) cos ψ, with ψ the
        largest angle between the other outline's normal and its radius. Within a sector 1 − R/ρ is least at an end.
        """
        total, s, t, left = nothing(other.scale), sector, 0.0 * other.scale, self.count
        here, least = beyond, beyond
        onward = p.cross(q) > 0.0
        while left > 0:
            a, b = other.scale * self.own(other.shape, s), other.scale * self.own(other.shape, s + 1)
            at_q, end = ti.select(onward, b.cross(q), q.cross(a)), 1.0 + 0.0 * t
            left = ti.select(at_q > 0.0, left - 1, 0)
            if at_q > 0.0:
                at_p = ti.select(onward, b.cross(p), p.cross(a))
                end = greater(lesser(at_p / lesser(at_p - at_q, -TINY), end), t)
                s += ti.select(onward, 1, -1)
            there = beyond_side(p + end * (q - p), a, b)
            if here > 0.0 or there > 0.0:
                total += inside(p, q, t, end, here, there, a, b, centre)
            here, t, least = there, end, greater(there, least)
        farther = lesser(p.norm_sqr(), q.norm_sqr()) - 0.25 * (q - p).norm_sqr()
        return total, -least * self.least[other.shape] * ti.sqrt(greater(farther, 0.0)), s, here

    @ti.func
    def below(self, shape, normal, height):
        """First corner and number of edges that may lie lower than a height (m) along a unit normal."""
        start, edges = 0, 0
        if height > -self.bounding[shape]:
            start, edges = self.about(-normal, -height / self.bounding[shape])
        return start, edges

    @ti.func
    def behind(self, one: ti.template(), normal, distance, start, edges, margin):
        """Shared area of `edges` edges with a half-plane, its normal in the outline's frame, its edge at −distance.

        Also returns the first corner and number of edges that contain all those within `margin` (m).
        """
        total, begin, end = nothing(one.scale), edges, 0
        p = one.scale * self.own(one.shape, start)
        for k in range(edges):
            q = one.scale * self.own(one.shape, start + k + 1)
            deep_p, deep_q = -p.dot(normal) - distance, -q.dot(normal) - distance
            if greater(deep_p, deep_q) > -margin:
                begin, end = ti.min(begin, k), k + 1
            if deep_p > 0.0 or deep_q > 0.0:
                crossing = deep_p / ti.select(deep_p == deep_q, 1.0, deep_p - deep_q)
                a, b = ti.select(deep_p > 0.0, 0.0, crossing), ti.select(deep_q > 0.0, 1.0, crossing)
                x, y = p + a * (q - p), p + b * (q - p)
                depth = 0.5 * (greater(deep_p, 0.0) + greater(deep_q, 0.0))
                total += part(depth * (y - x).cross(normal), x, y, 0.0 * x)
            p = q
        return total, start + ti.min(begin, end), ti.max(end - begin, 0)


@ti.func
def nothing(like):
    """The shared area where nothing is shared: zeros."""
    return ti.Vector([0.0 * like for _ in ti.static(range(YY + 1))])


@ti.func
def beyond_side(p, a, b):
    """R/ρ − 1 for a point at ρ whose ray meets the side a b at R."""
    side = b - a
    at = side.cross(p - a)
    return at / (a.cross(b) - at)


@ti.func
def inside(p, q, start, end, beyond_start, beyond_end, a, b, centre):
    """Contribution of an edge p q, between its fractions `start` and `end`, inside the triangle of 0, a and b."""
    side = b - a
    at_p, at_q = side.cross(p - a), side.cross(q - a)
    crossing = at_p / ti.select(at_p == at_q, 1.0, at_p - at_q)
    x = p + ti.select(beyond_start > 0.0, start, crossing) * (q - p)
    y = p + ti.select(beyond_end > 0.0, end, crossing) * (q - p)
    beyond_x, beyond_y = greater(beyond_start, 0.0), greater(beyond_end, 0.0)
    return part(-0.5 * x.cross(y - x) * (beyond_x + beyond_y + beyond_x * beyond_y), x, y, centre)


@ti.func
def part(area, a, b, centre):
    """Contribution of a piece a b of an outline with its `area`."""
    push, arm = ti.Vector([b[1] - a[1], a[0] - b[0]]), 0.5 * (a + b) - centre
    return ti.Vector([area, push[0], push[1], arm[0] * push[0], arm[0] * push[1], arm[1] * push[0], arm[1] * push[1]])


def _edges(corners: np.ndarray) -> np.ndarray:
    """Vectors (count, 2) m from each corner to the next."""
    return np.roll(corners, -1, axis=0) - corners


def _least(corners: np.ndarray) -> float:
    """The least cosine of the angle between an edge's normal and the radius of a point on it."""
    edges, ahead = _edges(corners), np.roll(corners, -1, axis=0)
    height = (corners[:, 0] * edges[:, 1] - corners[:, 1] * edges[:, 0]) / np.linalg.norm(edges, axis=1)
    return float((height / np.maximum(np.linalg.norm(corners, axis=1), np.linalg.norm(ahead, axis=1))).min())


def _corners(outline: Contour, count: int) -> np.ndarray:
    """Corners (count, 2) m on the outline, scaled to its area."""
    points = outline.points(2.0 * np.pi / count * np.arange(count))
    ahead = np.roll(points, -1, axis=0)
    area = 0.5 * (points[:, 0] * ahead[:, 1] - points[:, 1] * ahead[:, 0]).sum()
    return points * np.sqrt(outline.area / area)
