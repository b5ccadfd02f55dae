"""Hulls with rooms in space, cut open: their plates as flat faces, with round holes in them."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from lab.paint.space.walls import Walls
from solvers.tank.parts import Hull, Opening
from solvers.tank.shapes import PrismShape

STRIPS = 12  # across a hole, whose rim they make up

Piece = tuple[float, float, float, float]  # of a plate: from which share of its edge to which, and from which x (m)


def hull_walls(shape: PrismShape, hull: Hull, cut: float | None) -> Walls:
    """The faces of a hull, of which what is beyond a `cut` along x (m) is left out, so that its rooms are seen.

    Without a cut it is a body that is seen from outside.
    """
    low, high = (shape.middle + side * 0.5 * shape.along for side in (-1.0, 1.0))
    end = high if cut is None else min(high, max(low, cut))
    holes = hull.openings
    outer = shape.polygon
    faces = list(_plates(outer, low, end, holes, hull.wall, outwards=True))
    faces.append(_end(outer, low, -1.0))
    rooms = [room for room in hull.rooms if room.middle - 0.5 * room.along < end]
    for room in rooms:
        start = room.middle - 0.5 * room.along
        stop = min(end, room.middle + 0.5 * room.along)
        faces += _plates(room.polygon, start, stop, holes, hull.wall, outwards=False)
        faces.append(_end(room.polygon, start, 1.0))
    if end < high and len(rooms) == 1 and len(rooms[0].polygon) == len(outer):
        faces += _rim(outer, rooms[0].polygon, end, holes, hull.wall)
    else:
        faces.append(_end(outer, end, 1.0))
    return Walls.of(faces)


def _end(polygon: np.ndarray, x: float, sign: float) -> np.ndarray:
    """A face across x that is seen from where x is larger (1), or smaller (−1)."""
    points = np.column_stack([polygon, np.full(len(polygon), x)])
    return points if sign > 0.0 else points[::-1]


def _plates(
    polygon: np.ndarray, low: float, high: float, holes: Sequence[Opening], wall: float, outwards: bool
) -> Iterator[np.ndarray]:
    """The sides of a prism with what holes leave of them, seen from outside or from inside."""
    for begin, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        for first, last, start, stop in _pieces(begin, end, low, high, holes, wall):
            a, b = (begin + share * (end - begin) for share in (first, last))
            face = np.array([[*a, start], [*b, start], [*b, stop], [*a, stop]])
            yield face[::-1] if outwards else face


def _pieces(
    begin: np.ndarray, end: np.ndarray, low: float, high: float, holes: Sequence[Opening], wall: float
) -> Iterator[Piece]:
    """What holes leave of a plate from one corner to the next, and from one x to another."""
    way = end - begin
    length = float(np.hypot(*way))
    for hole in holes:
        middle, normal, radius = hole.place(3)
        share = (middle[:2] - begin) @ way / length**2
        off = np.abs((middle[:2] - begin) @ np.array([-way[1], way[0]]) / length)
        half = radius / length
        if off < wall and abs(normal[:2] @ way) < 1e-6 * length and 0.0 < share < 1.0:
            edges = np.clip(share + half * np.linspace(-1.0, 1.0, STRIPS + 1), 0.0, 1.0)
            yield 0.0, edges[0], low, high
            for first, last in pairwise(edges):
                aside = (0.5 * (first + last) - share) * length
                reach = float(np.sqrt(max(0.0, radius**2 - aside**2)))
                if low < middle[2] - reach:
                    yield first, last, low, min(high, middle[2] - reach)
                if middle[2] + reach < high:
                    yield first, last, max(low, middle[2] + reach), high
            yield edges[-1], 1.0, low, high
            return
    yield 0.0, 1.0, low, high


def _rim(outer: np.ndarray, inner: np.ndarray, x: float, holes: Sequence[Opening], wall: float) -> Iterator[np.ndarray]:
    """The cut through the wall between two polygons with as many corners, without what holes leave open there."""
    ends = np.roll(outer, -1, axis=0), np.roll(inner, -1, axis=0)
    for a, b, c, d in zip(outer, ends[0], inner, ends[1], strict=True):
        for first, last, start, stop in _pieces(a, b, x - 1e-6, x, holes, wall):
            if stop < x or start >= x:
                continue
            corners = a + first * (b - a), a + last * (b - a), c + last * (d - c), c + first * (d - c)
            yield np.array([[*corner, x] for corner in corners])
