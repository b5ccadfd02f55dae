"""Rasterise walls, plates and lines into a picture, in place."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from lab.paint.raster.base import (
    BAND,
    PER_TASK,
    Camera,
    Index,
    Picture,
    Shares,
    Table,
    box_around,
    colour_of,
    mix,
    row_of,
    sort_into_bands,
    whole,
)

FACE, LEAST_PANE = 0.3, 4.5  # of a pane's thickness: each face; pixels: a thinner wall is of one colour


def paint_tank(
    picture: np.ndarray,
    camera: Camera,
    outline: np.ndarray,
    wall: float,
    wall_colour: tuple,
    inner_colour: tuple,
    open_edges: Sequence[int] = (),
    core: tuple | None = None,
) -> None:
    """Paint the inside of a polygon, outline (m, 2) in m, and a wall (pixels thick) around it.

    open_edges: edges k, from corner k to the next, without a wall. core: colour of the wall between its two faces, as
    a pane has; None: that of the wall. Thin walls have one colour.
    """
    corners = camera.pixels(outline)
    walled = np.ones(len(corners), dtype=np.int32)
    walled[list(open_edges)] = 0
    box = box_around(picture, corners, wall)
    if box[0] < box[2] and box[1] < box[3]:
        core = core if wall > LEAST_PANE else None
        colours = _rows(wall_colour, inner_colour, core or wall_colour)
        _paint_walls(picture, corners, walled, _whole(box), wall, FACE * wall if core else wall, colours)


def paint_plate(picture: np.ndarray, camera: Camera, line: np.ndarray, thickness: float, colour: tuple) -> None:
    """Paint a polyline (m, 2) in m as a plate with round ends, `thickness` in pixels."""
    corners = camera.pixels(line)
    box = box_around(picture, corners, thickness)
    if box[0] < box[2] and box[1] < box[3]:
        _paint_line(picture, corners, _whole(box), 0.5 * thickness, _rows(colour))


def paint_strokes(picture: np.ndarray, strokes: np.ndarray, colour: tuple) -> None:
    """Paint straight lines (n, 6) in pixels in one colour, in place: x, y and half the thickness at either end.

    Pixels where lines meet or cross are painted once. Lines without finite ends are left out.
    """
    strokes = strokes[np.isfinite(strokes).all(axis=1)].astype(float)
    if not len(strokes):
        return
    box = box_around(picture, strokes.reshape(-1, 3)[:, :2], float(strokes[:, [2, 5]].max()))
    left, top, right, bottom = box
    part = np.ascontiguousarray(picture[top:bottom, left:right])
    strokes -= [left, top, 0.0, left, top, 0.0]
    low, high = strokes[:, [1, 4]].min(axis=1), strokes[:, [1, 4]].max(axis=1)
    reach = 0.5 * (high - low) + strokes[:, [2, 5]].max(axis=1) + 1.0
    starts, members = sort_into_bands(0.5 * (low + high), reach, len(part))
    if len(members) and part.size:
        covered = np.zeros(part.shape[:2], dtype=np.float32)
        _paint_strokes(part, covered, starts, members, strokes, _rows(colour))
        picture[top:bottom, left:right] = part


def _whole(box: tuple[int, int, int, int]) -> np.ndarray:
    """A box as an argument of a kernel; Taichi takes arrays far more quickly than vectors."""
    return np.array(box, dtype=np.int32)


def _rows(*colours: tuple) -> np.ndarray:
    """Colours (k, 3) as an argument of a kernel."""
    return np.array(colours, dtype=float)


@ti.func
def _past(x, y, corners: ti.template(), k, after):
    """Distance to the edge from corner k to corner `after`, and the position along it, in 0..1 between its ends."""
    ex, ey = corners[after, 0] - corners[k, 0], corners[after, 1] - corners[k, 1]
    px, py = x - corners[k, 0], y - corners[k, 1]
    along = (px * ex + py * ey) / ti.max(ex * ex + ey * ey, 1e-30)
    on = ti.math.clamp(along, 0.0, 1.0)
    return ti.Vector([ti.sqrt((px - on * ex) ** 2 + (py - on * ey) ** 2), along])


@ti.func
def off_outline(x, y, corners: ti.template()):
    """Distance to the polygon's edge, negative inside (even-odd crossing rule)."""
    nearest, sign = 1e30, 1.0
    for k in range(corners.shape[0]):
        after = (k + 1) % corners.shape[0]
        nearest = ti.min(nearest, _past(x, y, corners, k, after)[0])
        ex, ey = corners[after, 0] - corners[k, 0], corners[after, 1] - corners[k, 1]
        px, py = x - corners[k, 0], y - corners[k, 1]
        if (py >= 0.0) != (y >= corners[after, 1]) and (px < ex * py / ey):
            sign = -sign
    return sign * nearest


@ti.func
def _off_walls(x, y, corners: ti.template(), walled: ti.template(), wall):
    """Distance to the nearest edge with a wall, larger than `wall` beyond an end next to an open edge.

    A wall thus ends in a straight cut where the neighbouring edge is open.
    """
    nearest, count = 1e30, corners.shape[0]
    for k in range(count):
        if walled[k] == 1:
            after = (k + 1) % count
            length = ti.sqrt((corners[after, 0] - corners[k, 0]) ** 2 + (corners[after, 1] - corners[k, 1]) ** 2)
            place = _past(x, y, corners, k, after)
            distance = place[0]
            if walled[(k + count - 1) % count] == 0:
                distance = ti.max(distance, wall - place[1] * length)
            if walled[after] == 0:
                distance = ti.max(distance, wall + (place[1] - 1.0) * length)
            nearest = ti.min(nearest, distance)
    return nearest


@ti.kernel
def _paint_walls(
    picture: Picture, corners: Table, walled: Index, box: Index, wall: ti.f64, face: ti.f64, colours: Table
):
    # The distances change by at most one per pixel, so far from the edges many pixels in a row are equal.
    for row in range(box[1], box[3]):
        column = box[0]
        while column < box[2]:
            x, y = column + 0.5, row + 0.5
            outside = off_outline(x, y, corners)
            alike = ti.max(-outside, outside - wall) - 0.5
            stop = ti.min(column + ti.max(ti.cast(alike, ti.i32), 1), box[2])
            if alike < 0.0 or outside < 0.0:
                inside = ti.math.clamp(0.5 - outside, 0.0, 1.0)
                off = _off_walls(x, y, corners, walled, wall)
                reached = (1.0 - inside) * ti.math.clamp(wall - off + 0.5, 0.0, 1.0)
                core = ti.math.clamp(ti.min(off, wall - off) - face + 0.5, 0.0, 1.0)
                face_colour, inner_colour = row_of(colours, 0), row_of(colours, 1)
                wall_colour = face_colour + core * (row_of(colours, 2) - face_colour)
                for pixel in range(column, stop):
                    under = colour_of(picture, row, pixel)
                    mix(picture, row, pixel, reached * (wall_colour - under) + inside * (inner_colour - under))
            column = stop


@ti.kernel
def _paint_line(picture: Picture, corners: Table, box: Index, reach: ti.f64, colours: Table):
    for row, column in ti.ndrange((box[1], box[3]), (box[0], box[2])):
        nearest = 1e30
        for k in range(corners.shape[0] - 1):
            nearest = ti.min(nearest, _past(column + 0.5, row + 0.5, corners, k, k + 1)[0])
        share = ti.math.clamp(reach - nearest + 0.5, 0.0, 1.0)
        if share > 0.0:
            mix(picture, row, column, share * (row_of(colours, 0) - colour_of(picture, row, column)))


@ti.func
def _paint_stroke(covered: ti.template(), first, along, half, growth, top, bottom):
    """Add the coverage of a line from `first` in rows top to bottom; a line thinner than a pixel is faint."""
    inverse, reach = 1.0 / ti.max(along.dot(along), 1e-30), ti.max(half, half + growth, 0.5) + 0.5
    left = whole(first.x + ti.min(along.x, 0.0) - reach + 0.5, 0, covered.shape[1])
    right = whole(first.x + ti.max(along.x, 0.0) + reach + 0.5, 0, covered.shape[1])
    upper = whole(first.y + ti.min(along.y, 0.0) - reach + 0.5, top, bottom)
    lower = whole(first.y + ti.max(along.y, 0.0) + reach + 0.5, top, bottom)
    for row in range(upper, lower):
        for column in range(left, right):
            away = ti.Vector([column + 0.5, row + 0.5]) - first
            on = ti.math.clamp(away.dot(along) * inverse, 0.0, 1.0)
            thick, distance = half + on * growth, (away - on * along).norm()
            share = ti.min(2.0 * thick, 1.0) * ti.math.clamp(ti.max(thick, 0.5) - distance + 0.5, 0.0, 1.0)
            covered[row, column] = ti.max(covered[row, column], ti.cast(share, ti.f32))


@ti.kernel
def _paint_strokes(picture: Picture, covered: Shares, starts: Index, members: Index, strokes: Table, colours: Table):
    for k in range((starts.shape[0] - 1) * PER_TASK):
        if k % PER_TASK == 0:
            band = k // PER_TASK
            top, bottom = band * BAND, ti.min((band + 1) * BAND, picture.shape[0])
            for entry in range(starts[band], starts[band + 1]):
                i = members[entry]
                first = ti.Vector([strokes[i, 0], strokes[i, 1]])
                along = ti.Vector([strokes[i, 3], strokes[i, 4]]) - first
                _paint_stroke(covered, first, along, strokes[i, 2], strokes[i, 5] - strokes[i, 2], top, bottom)
            colour = row_of(colours, 0)
            for row in range(top, bottom):
                for column in range(picture.shape[1]):
                    share = covered[row, column]
                    if share > 0.0:
                        mix(picture, row, column, share * (colour - colour_of(picture, row, column)))
