"""Lines in space over a picture: hidden where a sphere or a wall is in front of them."""

import numpy as np
import taichi as ti

from lab.paint.raster.base import Picture, Shares, Table, colour_of, mix, row_of, rows_of, whole
from lab.paint.space.camera import SpaceCamera
from lab.paint.space.raster.layers import WALL, Layers, Numbers, Whole
from lab.paint.space.walls import Walls

SHARP = np.cos(np.radians(30.0))  # faces that meet at a smaller angle are parts of one round surface, without an edge
SLACK = 2.5  # thicknesses of a line that it may lie behind what is seen and still be drawn
GLASS = 0.55, 0.6  # strength and thickness of the edges of walls that are left out, over those of the others


def edge_lines(camera: SpaceCamera, walls: Walls, half: float) -> np.ndarray:
    """The edges of walls as lines (m, 10) for `paint_lines_in_space`, `half` as thick in pixels.

    Drawn are the rims, the sharp edges, and where a round surface turns away.
    """
    ends, faces = walls.edges
    if not len(ends):
        return np.zeros((0, 10))
    facing = walls.facing(camera.gaze.eye)
    rim = faces[:, 1] < 0
    one, two = faces[:, 0], np.where(rim, faces[:, 0], faces[:, 1])
    sharp = (walls.normals[one] * walls.normals[two]).sum(axis=1) < SHARP
    drawn = rim | sharp | (facing[one] != facing[two])
    glass = ~(facing[one] | facing[two])[drawn]
    thick = half * np.where(glass, GLASS[1], 1.0)
    return lines_between(camera, ends[drawn], thick, np.where(glass, GLASS[0], 1.0), faces[drawn])


def lines_between(
    camera: SpaceCamera,
    ends: np.ndarray,
    half: np.ndarray,
    strength: np.ndarray | float,
    faces: np.ndarray | None = None,
) -> np.ndarray:
    """Lines (m, 10) from ends (m, 2, 3) m: column, row and 1/depth of both, half thickness (pixels), opacity, faces.

    faces (m, 2): the walls that a line bounds, which do not hide it; −1: none.
    """
    parts, beside = [], np.full((len(ends), 2), -1) if faces is None else faces
    for k in (0, 1):
        pixels, depth = camera.pixels(ends[:, k]), camera.gaze.seen(ends[:, k])[:, 2]
        parts += [pixels, 1.0 / depth]
    return np.column_stack([*parts, np.broadcast_to(half, len(ends)), np.broadcast_to(strength, len(ends)), beside])


def paint_lines_in_space(picture: np.ndarray, layers: Layers, lines: np.ndarray, colour: tuple) -> None:
    """Paint lines (m, 10) over a picture in one colour, in place, each pixel once."""
    if len(lines):
        covered = np.zeros(picture.shape[:2], dtype=np.float32)
        _cover(covered, layers.depth, layers.who, lines, layers.lens)
        _mix(picture, covered, rows_of(colour))


@ti.kernel
def _cover(covered: Shares, depth: Shares, who: Whole, lines: Table, lens: Numbers):
    ti.loop_config(serialize=True)
    for i in range(lines.shape[0]):
        first = ti.Vector([lines[i, 0], lines[i, 1]])
        way = ti.Vector([lines[i, 3], lines[i, 4]]) - first
        one, two = WALL - ti.cast(lines[i, 8], ti.i32), WALL - ti.cast(lines[i, 9], ti.i32)
        half, per = lines[i, 6], 1.0 / ti.max(way.dot(way), 1e-12)
        reach = half + 1.0
        slant, wide = 0.0, 1e9
        if ti.abs(way.y) > 1e-6:  # in a row, only so far from where the line crosses it
            slant, wide = way.x / way.y, reach * ti.sqrt(way.dot(way)) / ti.abs(way.y) + 1.0
        low, high = first.x + ti.min(way.x, 0.0) - reach, first.x + ti.max(way.x, 0.0) + reach
        upper = whole(first.y + ti.min(way.y, 0.0) - reach, 0, covered.shape[0])
        lower = whole(first.y + ti.max(way.y, 0.0) + reach + 1.0, 0, covered.shape[0])
        for row in range(upper, lower):
            middle = first.x + (row + 0.5 - first.y) * slant
            left = whole(ti.max(low, middle - wide), 0, covered.shape[1])
            right = whole(ti.min(high, middle + wide) + 1.0, 0, covered.shape[1])
            for column in range(left, right):
                off = ti.Vector([column + 0.5, row + 0.5]) - first
                on = ti.math.clamp(off.dot(way) * per, 0.0, 1.0)
                away = 1.0 / (lines[i, 2] + on * (lines[i, 5] - lines[i, 2]))
                near = away < depth[row, column] + SLACK * 2.0 * half * away / lens[0]
                if near or who[row, column] == one or who[row, column] == two:
                    share = ti.min(2.0 * half, 1.0) * ti.math.clamp(
                        ti.max(half, 0.5) + 0.5 - (off - on * way).norm(), 0.0, 1.0
                    )
                    covered[row, column] = ti.max(covered[row, column], ti.cast(lines[i, 7] * share, ti.f32))


@ti.kernel
def _mix(picture: Picture, covered: Shares, colours: Table):
    for row in range(covered.shape[0]):
        for column in range(covered.shape[1]):
            if covered[row, column] > 0.0:
                change = row_of(colours, 0) - colour_of(picture, row, column)
                mix(picture, row, column, covered[row, column] * change)
