"""The numbers of rooms and openings of hulls that kernels read."""

import numpy as np

from solvers.tank.outline import inside
from solvers.tank.parts import Hull, Opening
from solvers.tank.shapes import PrismShape

A_Y, A_Z, WAY_Y, WAY_Z, SLANT = range(5)  # an edge of a room: where it begins (m), the way to its end, dy/dz
# Of a room: half its wall, of a ball that holds both the radius (m) and the middle; in space half its length, and where
HALF, RADIUS, CENTRE = range(3)
# Of an opening: time (s), half its width (m), half the blend of χ, one over the length (m) over which its rim fades
OPENS, WIDE, BLEND, SHARP, PLACE = range(5)  # then its middle (m), and the normal of the wall there


def edges(corners: np.ndarray) -> np.ndarray:
    """The edges (m, 5) of a room."""
    way = np.roll(corners, -1, axis=0) - corners
    level = way[:, 1] == 0.0
    slant = np.where(level, 0.0, way[:, 0] / np.where(level, 1.0, way[:, 1]))
    return np.column_stack([corners, way, slant])


def circle(room: np.ndarray | PrismShape, wall: float) -> list[float]:
    """The numbers of a room: half its wall, then of a ball that holds both the radius and the middle (m).

    In space also half its length, and where its middle is along x.
    """
    corners = room.polygon if isinstance(room, PrismShape) else room
    centre = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    radius = float(np.linalg.norm(corners - centre, axis=1).max())
    if not isinstance(room, PrismShape):
        return [0.5 * wall, radius + wall, *centre.tolist()]
    half = 0.5 * room.along
    return [0.5 * wall, float(np.hypot(radius, half)) + wall, *centre.tolist(), room.middle, half, room.middle]


def hole(opening: Opening, hull: Hull, fades: float, axes: int) -> list[float]:
    """The numbers of an opening. Its normal leads into the room behind it, the later one of two."""
    middle, normal, half = opening.place(axes)
    sides = (middle[None] + side * hull.wall * normal for side in (1.0, -1.0))
    left, right = (max((k for k, room in enumerate(hull.rooms) if holds(room, at)), default=-1) for at in sides)
    if left < right:
        normal = -normal
    return [opening.opens, half, 0.5 * hull.wall, 1.0 / fades, *middle.tolist(), *normal.tolist()]


def holds(room: tuple | PrismShape, point: np.ndarray) -> bool:
    """Whether a room holds a point (1, axes) m."""
    shape = room if isinstance(room, PrismShape) else None
    return bool(shape.distance(point)[0] < 0.0 if shape else inside(point, np.array(room))[0])
