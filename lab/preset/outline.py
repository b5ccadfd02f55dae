"""Outlines of tanks and hulls: simple polygons, counter-clockwise in the picture."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from lab.base.errors import LabError

Point = tuple[float, float]

MOST_CORNERS = 200
TOUCHING = 1e-9  # of the outer polygon's size: how far an inner one may stand out of it by rounding


def rectangle(width: float, height: float) -> tuple[Point, ...]:
    """A rectangle (m) with the origin in the middle of its floor."""
    half = width / 2
    return ((-half, 0.0), (half, 0.0), (half, height), (-half, height))


def box_hull(breadth: float, height: float, coaming: Sequence[Sequence[float]]) -> np.ndarray:
    """The outline (m, 2) m of a box with its origin in the middle of the keel; `coaming`: its hatch's to starboard."""
    half, port = 0.5 * breadth, [[-y, z] for y, z in reversed(coaming)]
    sides = [[-half, 0.0], [half, 0.0], [half, height]], [[-half, height]]
    return np.array([*sides[0], *coaming, *port, *sides[1]])


def at_height(corners: np.ndarray, level: float) -> tuple[tuple[float, float], ...]:
    """The outermost points of an outline (m, 2) at a height, starboard and port (m)."""
    begin, end = corners, np.roll(corners, -1, axis=0)
    low, high = np.minimum(begin[:, 1], end[:, 1]), np.maximum(begin[:, 1], end[:, 1])
    meets = (low <= level) & (level <= high)
    share = np.divide(level - begin[:, 1], end[:, 1] - begin[:, 1], where=high > low, out=np.zeros(len(begin)))
    across = (begin[:, 0] + share * (end[:, 0] - begin[:, 0]))[meets]
    across = np.concatenate([across, end[meets & (high == low), 0]])
    return (float(across.max()), level), (float(across.min()), level)


def area(outline: Sequence[Point]) -> float:
    """Area (m²), positive where the corners run counter-clockwise (the shoelace formula)."""
    return sum(_cross(a, b) for a, b in _edges(outline)) / 2


def simple_polygon(corners: Sequence[Point]) -> tuple[Point, ...]:
    """The corners (m) in counter-clockwise order; a last corner equal to the first is dropped.

    Raises LabError if they do not bound an area or if the outline touches itself.
    """
    outline = tuple(corners[:-1] if len(corners) > 1 and corners[0] == corners[-1] else corners)
    if not 3 <= len(outline) <= MOST_CORNERS:
        raise LabError(f"from 3 to {MOST_CORNERS} corners are needed (got {len(outline)}).")
    if len(set(outline)) < len(outline):
        raise LabError("two corners are the same point.")
    if _touches_itself(outline):
        raise LabError("the outline crosses or touches itself.")
    size = area(outline)
    if not 0.0 < abs(size) < float("inf"):
        raise LabError("the outline has no area.")
    return outline if size > 0 else outline[::-1]


def stands_out(inner: np.ndarray, outer: np.ndarray) -> np.ndarray | None:
    """Where a polygon (m, 2) stands out of another: a corner of it outside, or one of the other inside; or None."""
    slack = TOUCHING * float(np.ptp(outer, axis=0).max())
    out = [corner for corner in inner if depth_inside(corner, outer) < -slack]
    out += [corner for corner in outer if depth_inside(corner, inner) > slack]
    return out[0] if out else None


def depth_inside(point: np.ndarray, outline: np.ndarray) -> float:
    """Distance (m) of a point from the edge of a polygon (m, 2); negative outside."""
    begin, along = outline, np.roll(outline, -1, axis=0) - outline
    share = np.clip(((point - begin) * along).sum(1) / (along**2).sum(1), 0.0, 1.0)
    away = float(np.hypot(*(point - begin - share[:, None] * along).T).min())
    (y, z), end = point, begin + along
    crosses = (begin[:, 1] > z) != (end[:, 1] > z)
    rise = np.where(crosses, along[:, 1], 1.0)
    right = crosses & (begin[:, 0] + (z - begin[:, 1]) / rise * along[:, 0] > y)
    return away if right.sum() % 2 else -away


def _edges(outline: Sequence[Point]) -> list[tuple[Point, Point]]:
    return list(zip(outline, (*outline[1:], outline[0]), strict=True))


def _touches_itself(outline: Sequence[Point]) -> bool:
    for (a, b), (c, d) in combinations(_edges(outline), 2):
        if b == c or d == a:
            start, corner, end = (a, b, d) if b == c else (c, d, b)
            if _side(start, corner, end) == 0 and _ahead(start, corner, end) < 0:
                return True
        elif _meet(a, b, c, d):
            return True
    return False


def _meet(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Whether the closed segments ab and cd have a point in common."""
    if _side(a, b, c) * _side(a, b, d) < 0 and _side(c, d, a) * _side(c, d, b) < 0:
        return True
    touching = ((a, b, c), (a, b, d), (c, d, a), (c, d, b))
    return any(_side(p, q, r) == 0 and _within(p, q, r) for p, q, r in touching)


def _within(p: Point, q: Point, r: Point) -> bool:
    return all(min(p[k], q[k]) <= r[k] <= max(p[k], q[k]) for k in (0, 1))


def _side(a: Point, b: Point, c: Point) -> int:
    """On which side of the line ab the point c lies: 1 left, -1 right, 0 on it."""
    turn = _cross(_minus(b, a), _minus(c, a))
    return (turn > 0) - (turn < 0)


def _ahead(a: Point, b: Point, c: Point) -> float:
    (ux, uy), (vx, vy) = _minus(b, a), _minus(c, b)
    return ux * vx + uy * vy


def _minus(a: Point, b: Point) -> Point:
    return (a[0] - b[0], a[1] - b[1])


def _cross(a: Point, b: Point) -> float:
    return a[0] * b[1] - a[1] * b[0]
