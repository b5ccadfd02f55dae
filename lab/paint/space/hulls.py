"""Hulls with rooms in space, cut open: their plates as flat faces, with round holes in them."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from lab.paint.space.walls import Walls
from solvers.tank.parts import Hull, Opening
from solvers.tank.shapes import PrismShape

STRIPS = 12  # across a hole, whose rim they make up
THIN = 1e-6  # m, of a cut

Piece = tuple[np.ndarray, np.ndarray, np.ndarray]  # of a plate at two places of its edge: shares, and from and to x (m)


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
    rooms = [room for room in hull.rooms if end < high and room.middle - 0.5 * room.along < end]
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
        for shares, start, stop in _pieces(begin, end, low, high, holes, wall):
            a, b = (begin + share * (end - begin) for share in shares)
            face = np.array([[*a, start[0]], [*b, start[1]], [*b, stop[1]], [*a, stop[0]]])
            yield face if outwards else face[::-1]


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
            reach = np.sqrt(np.maximum(0.0, radius**2 - ((edges - share) * length) ** 2))
            edges, reach = np.array([0.0, *edges, 1.0]), np.array([0.0, *reach, 0.0])
            for k, pair in enumerate(pairwise(edges)):
                near = reach[k : k + 2]
                for start, stop in ((low + 0.0 * near, middle[2] - near), (middle[2] + near, high + 0.0 * near)):
                    start, stop = np.clip(start, low, high), np.clip(stop, low, high)
                    if (stop > start).any() and pair[1] > pair[0]:
                        yield np.array(pair), start, stop
            return
    yield np.array([0.0, 1.0]), np.full(2, low), np.full(2, high)


def _rim(outer: np.ndarray, inner: np.ndarray, x: float, holes: Sequence[Opening], wall: float) -> Iterator[np.ndarray]:
    """The cut through the wall between two polygons with as many corners, without what holes leave open there."""
    ends = np.roll(outer, -1, axis=0), np.roll(inner, -1, axis=0)
    for a, b, c, d in zip(outer, ends[0], inner, ends[1], strict=True):
        for first, last in _solid(a, b, x, holes, wall):
            corners = a + first * (b - a), a + last * (b - a), c + last * (d - c), c + first * (d - c)
            yield np.array([[*corner, x] for corner in corners])


def _solid(
    begin: np.ndarray, end: np.ndarray, x: float, holes: Sequence[Opening], wall: float
) -> Iterator[tuple[float, float]]:
    """Between which shares of an edge a plate is there at a place along x (m)."""
    there = [shares for shares, start, stop in _pieces(begin, end, x - THIN, x, holes, wall) if (stop == x).all()]
    while there:
        first, last = there.pop(0)
        while there and there[0][0] == last:
            last = there.pop(0)[1]
        if last > first:
            yield first, last
