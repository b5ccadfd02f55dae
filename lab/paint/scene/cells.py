"""Where beds stand side by side: cells of one size, in the grid that shows them largest."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lab.paint.page.layout import Box
from lab.paint.painter import Camera

GAP = 0.8  # u, between cells
BESIDE = 0.5  # u, between a name and what is below it


@dataclass(frozen=True)
class Room:
    """What a cell has around its bed, in pixels: `around` on all sides, `above` it a name, `below` it a band.

    beside: as wide as the names are, if they may also stand to the left of the beds, where that shows these larger.
    filled: cells share the whole view, as those of ships do, whose sea goes on to their edges.
    """

    around: float
    above: float = 0.0
    below: float = 0.0
    filled: bool = False
    beside: float = 0.0

    @property
    def ways(self) -> list[tuple[float, float]]:
        """What names take to the left of a bed and above it, in each of the ways in which they may stand."""
        return [(0.0, self.above), *([(self.beside, 0.0)] if self.beside else [])]


@dataclass(frozen=True)
class Cells:
    """Of each bed the camera, the place of its name, and the box below the name; the width of a name in pixels."""

    cameras: list[Camera]
    names: list[tuple[float, float]]
    boxes: list[Box]
    width: float


def lay_cells(grounds: Sequence[tuple[np.ndarray, np.ndarray]], box: Box, unit: float, room: Room) -> Cells:
    """Cells for beds within these corners (lower, upper) m, in a box of pixels, all to one scale."""
    left, top, right, bottom = box
    view, gap, count = np.array([right - left, bottom - top]), GAP * unit, len(grounds)
    extent = np.max([high - low for low, high in grounds], axis=0)

    def grid(columns: int) -> np.ndarray:
        return np.array([columns, -(-count // columns)])

    def taken(way: tuple[float, float]) -> np.ndarray:
        return 2 * room.around + np.array(way) + [0.0, room.below]

    def scale(shape: tuple[int, tuple[float, float]]) -> float:
        columns, way = shape
        cell = (view - gap * (grid(columns) - 1)) / grid(columns)
        return float(((cell - taken(way)) / extent).min())

    shapes = [(columns, way) for way in room.ways for columns in range(1, count + 1)]
    columns, way = max(shapes, key=scale)
    largest, around, (left_of, above) = scale((columns, way)), taken(way), way
    least = largest * extent + around + gap
    pitch = (view + gap) / grid(columns) if room.filled else least
    start = np.array([left, top]) + (view - pitch * grid(columns) + gap) / 2
    corners = [start + pitch * (k % columns, k // columns) for k in range(count)]
    spread = 0.5 * (pitch - least)
    cameras = []
    for corner, (low, high) in zip(corners, grounds, strict=True):
        spare = largest * (extent - (high - low)) * (0.5, 1.0)  # a smaller tank is centred, at the bottom
        inner = room.around + np.array([left_of, above]) + spare + largest * np.array([-low[0], high[1]])
        cameras.append(Camera(largest, tuple(corner + inner + spread)))
    foot = above - BESIDE * unit if above or not left_of else room.around + room.above - BESIDE * unit
    names = [(float(x), float(y + foot)) for x, y in corners]
    sizes = pitch - gap
    boxes = [(round(x), round(y + above), round(x + sizes[0]), round(y + sizes[1])) for x, y in corners]
    return Cells(cameras, names, boxes, left_of or float(pitch[0] - 0.5 * gap))
