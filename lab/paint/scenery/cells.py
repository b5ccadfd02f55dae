"""Where beds stand side by side: cells of one size, in the grid that shows them largest."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lab.paint.page.layout import Box
from lab.paint.painter import Camera

GAP = 1.5  # u, between cells
BESIDE = 0.5  # u, between a name and what is below it


@dataclass(frozen=True)
class Room:
    """What a cell has around its bed, in pixels: `around` on all sides, `above` it a name, `below` it a band.

    filled: cells share the whole stage, as those of ships do, whose sea goes on to their edges.
    """

    around: float
    above: float = 0.0
    below: float = 0.0
    filled: bool = False


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
    stage, gap, count = np.array([right - left, bottom - top]), GAP * unit, len(grounds)
    around = np.array([2 * room.around, 2 * room.around + room.above + room.below])
    extent = np.max([high - low for low, high in grounds], axis=0)

    def grid(columns: int) -> np.ndarray:
        return np.array([columns, -(-count // columns)])

    def scale(columns: int) -> float:
        cell = (stage - gap * (grid(columns) - 1)) / grid(columns)
        return float(((cell - around) / extent).min())

    columns = max(range(1, count + 1), key=scale)
    largest = scale(columns)
    least = largest * extent + around + gap
    pitch = (stage + gap) / grid(columns) if room.filled else least
    start = np.array([left, top]) + (stage - pitch * grid(columns) + gap) / 2
    corners = [start + pitch * (k % columns, k // columns) for k in range(count)]
    spread = 0.5 * (pitch - least)
    cameras = []
    for corner, (low, high) in zip(corners, grounds, strict=True):
        spare = largest * (extent - (high - low)) * (0.5, 1.0)  # a smaller tank is centred, at the bottom
        inner = np.array([room.around, room.around + room.above]) + spare + largest * np.array([-low[0], high[1]])
        cameras.append(Camera(largest, tuple(corner + inner + spread)))
    names = [(float(x), float(y + room.above - BESIDE * unit)) for x, y in corners]
    sizes = pitch - gap
    boxes = [(round(x), round(y + room.above), round(x + sizes[0]), round(y + sizes[1])) for x, y in corners]
    return Cells(cameras, names, boxes, float(pitch[0] - 0.5 * gap))
