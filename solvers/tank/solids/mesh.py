"""A tank that is a surface of triangles: its geometry, for filling it and for what its volume is."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.tank.outline import NONE_FIXED, area_below
from solvers.tank.solids.solid import FREE, MESH, InSpace

UP = 1  # the axis z in the order y, z, x
ACROSS = [0, 2]  # the axes y and x
STEEP = 1e-9  # upward part of a unit normal below which a triangle has no area as seen from above


@dataclass(frozen=True, eq=False, repr=False)
class Mesh(InSpace):
    """A surface of triangles with normals inward: `corners` (n, 3) m, and `triangles` (m, 3) by their numbers.

    The surface is closed, or open at the top: its edges of one triangle are then a single loop, the mouth, which is
    level and as high as the surface is anywhere. Walls of an open one act on both sides, and round the mouth's rim.
    """

    corners: np.ndarray
    triangles: np.ndarray

    def __repr__(self) -> str:
        """What tells it from others: a digest of its numbers."""
        digest = hashlib.blake2b(self.corners.tobytes() + self.triangles.tobytes(), digest_size=16)
        return f"Mesh({len(self.corners)}, {len(self.triangles)}, {digest.hexdigest()})"

    @cached_property
    def points(self) -> np.ndarray:
        """Corners (m, 3, 3) m of each triangle."""
        return self.corners[self.triangles]

    @cached_property
    def areas(self) -> np.ndarray:
        """Area vectors (m, 3) m² of the triangles, inward."""
        return 0.5 * np.cross(self.points[:, 1] - self.points[:, 0], self.points[:, 2] - self.points[:, 0])

    @cached_property
    def normals(self) -> np.ndarray:
        """Unit normals (m, 3), inward."""
        return self.areas / np.linalg.norm(self.areas, axis=1, keepdims=True)

    @cached_property
    def rim(self) -> np.ndarray:
        """The corners, by their numbers, at which edges (k, 2) of the mouth begin and end; none of a closed one."""
        sides = np.concatenate([self.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
        _, which, times = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True)
        return sides[times[which.ravel()] == 1]

    @property
    def open(self) -> bool:
        """Whether it has a mouth."""
        return bool(len(self.rim))

    @property
    def heightens(self) -> bool:
        """Whether walls can be raised on its rim."""
        return self.open

    @property
    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (3,) m."""
        return self.corners.min(axis=0), self.corners.max(axis=0)

    @property
    def front(self) -> np.ndarray:
        """The rectangle (4, 2) m round it as seen along x."""
        (left, low, _), (right, high, _) = self.box
        return np.array([(left, low), (right, low), (right, high), (left, high)])

    def over(self, outline: np.ndarray) -> "Mesh":
        """It with upright walls on its rim up to the top (m) of an outline."""
        top, by = outline[:, 1].max(), np.zeros(3)
        by[UP] = top - self.box[1][UP]
        if not self.open or by[UP] <= 0.0:
            return self
        low, where = np.unique(self.rim, return_inverse=True)
        one, two = where.reshape(-1, 2).T + len(self.corners)
        corners = np.concatenate([self.corners, self.corners[low] + by])
        a, b = self.rim.T  # as a side runs in its triangle, and so against it in the wall above
        walls = np.concatenate([np.column_stack([b, a, one]), np.column_stack([b, one, two])])
        return Mesh(corners, np.concatenate([self.triangles, walls]))

    def half(self, outline: np.ndarray) -> float:
        """How far (m) it reaches along x on either side of the origin."""
        return float(np.abs(self.corners[:, 2]).max())

    def volume(self, outline: np.ndarray, depth: float) -> float:
        """Volume (m³) up to `depth` (m) above the lowest point: ∮ min(z, h) n_z dA outward, h the level; the mouth is
        what closes the surface as seen from above."""
        level = self.box[0][UP] + depth
        up = -self.areas[:, UP]
        lid = -up.sum()
        return float(up @ _mean_below(self.points[..., UP], level) + lid * min(level, self.box[1][UP]))

    def within(self, region: np.ndarray) -> float:
        """Volume (m³) of a region (m, 2) m of the tank, at most."""
        (_, low, aft), (_, high, fore) = self.box
        return min(self.volume(region, high - low), (fore - aft) * area_below(region, float(np.ptp(region[:, 1]))))

    def inside(self, points: np.ndarray) -> np.ndarray:
        """Which points (n, 3) m lie in it or above its mouth: straight down from there is an odd number of walls."""
        order = np.argsort(points[:, 2], kind="stable")
        y, z, x = points[order].T
        odd = np.zeros(len(points), dtype=bool)
        for numbers, normal in zip(np.sort(self.triangles, axis=1), self.normals, strict=True):
            if abs(normal[UP]) < STEEP:
                continue
            corners = self.corners[numbers]
            first, last = np.searchsorted(x, (corners[:, 2].min(), corners[:, 2].max()), side="right")
            some = slice(first, last)
            under = _over(corners[:, ACROSS], y[some], x[some])
            off = normal[0] * (y[some] - corners[0, 0]) + normal[2] * (x[some] - corners[0, 2])
            odd[some] ^= under & (corners[0, UP] - off / normal[UP] < z[some])
        found = np.empty_like(odd)
        found[order] = odd
        return found

    def faces(self, outline: np.ndarray) -> tuple[str, ...]:
        """One face: what triangles bear is not told apart."""
        return MESH

    def overlaps(self, points, radius, edges) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """For each triangle the directions (n, 3) away from it of spheres at points, and their overlaps (n,) m."""
        for triangle in self.points:
            way = away_from(points, triangle)
            apart = np.maximum(np.linalg.norm(way, axis=1), 1e-12)
            yield way / apart[:, None], radius - apart

    def clear(self, points, outline, reach, fixed=NONE_FIXED, plates=()) -> np.ndarray:
        """Which points lie inside, at least `reach` (m) from all triangles."""
        from scipy.spatial import cKDTree  # slow to import

        found, away = self.inside(points), np.broadcast_to(reach, len(points)) * (1.0 - FREE)
        some = np.flatnonzero(found)
        if not len(some):
            return found
        tree, middles = cKDTree(points[some]), self.points.mean(axis=1)
        around = np.linalg.norm(self.points - middles[:, None], axis=2).max(axis=1) + float(away.max())
        for triangle, near in zip(self.points, tree.query_ball_point(middles, around), strict=True):
            mine = some[near]
            found[mine] &= distance(points[mine], triangle) >= away[mine]
        return found


def distance(points: np.ndarray, triangle: np.ndarray) -> np.ndarray:
    """Distances (n,) m of points (n, 3) m from a triangle (3, 3) m."""
    return np.linalg.norm(away_from(points, triangle), axis=1)


def away_from(points: np.ndarray, triangle: np.ndarray) -> np.ndarray:
    """The ways (n, 3) m to points (n, 3) m from the nearest ones of a triangle (3, 3) m."""
    normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
    over, nearest, best = np.ones(len(points), dtype=bool), np.zeros_like(points), np.full(len(points), np.inf)
    for one, two in zip(triangle, np.roll(triangle, -1, axis=0), strict=True):
        off, edge = points - one, two - one
        share = np.clip(off @ edge / (edge @ edge), 0.0, 1.0)
        way = off - share[:, None] * edge
        size = np.linalg.norm(way, axis=1)
        nearest, best = np.where((size < best)[:, None], way, nearest), np.minimum(size, best)
        over &= off @ np.cross(normal, edge) >= 0.0
    normal = normal / np.linalg.norm(normal)
    return np.where(over[:, None], ((points - triangle[0]) @ normal)[:, None] * normal, nearest)


def _over(corners: np.ndarray, y: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Which points (y, x) lie over a triangle (3, 2) as seen from above; its corners in the order of their numbers, so
    that two triangles see the edge between them alike."""
    odd = np.zeros(len(y), dtype=bool)
    for a, b in ((0, 1), (1, 2), (0, 2)):
        (ay, ax), (by, bx) = corners[a], corners[b]
        if ax != bx:
            odd ^= ((ax > x) != (bx > x)) & (y < ay + (x - ax) / (bx - ax) * (by - ay))
    return odd


def _mean_below(heights: np.ndarray, level: float) -> np.ndarray:
    """Means (m,) of min(z, h) over triangles with corners at heights (m, 3), h the level."""
    low, mid, high = np.sort(heights, axis=1).T - level
    above = (low + mid + high) / 3.0  # of max(z − h, 0), where all of it is above
    wet = np.minimum(low, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        tip = high**3 / (3.0 * (high - low) * (high - mid))  # where one corner is
        base = above - wet**3 / (3.0 * (mid - low) * (high - low))  # where two are
    over = np.select([high <= 0.0, mid <= 0.0, low < 0.0], [np.zeros_like(high), tip, base], above)
    return heights.mean(axis=1) - over
