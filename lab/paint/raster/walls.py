"""Rasterise tanks and plates into a picture, in place."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from lab.paint.raster.base import (
    Camera,
    Index,
    Picture,
    Table,
    box_around,
    colour_of,
    mix,
    put,
    row_of,
    rows_of,
    whole,
    whole_numbers,
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
    box = box_around(picture, corners, wall)
    if box[0] < box[2] and box[1] < box[3]:
        core = core if wall > LEAST_PANE else None
        colours = rows_of(wall_colour, inner_colour, core or wall_colour)
        spans = np.empty((box[3] - box[1], 3 * len(corners)))
        face = FACE * wall if core else wall
        _paint_walls(picture, _edges(corners, open_edges), spans, whole_numbers(*box), wall, face, colours)


def paint_shape(
    picture: np.ndarray, camera: Camera, shapes: Sequence[np.ndarray], wall: float, wall_colour: tuple, colour: tuple
) -> None:
    """Paint what several polygons, each (m, 2) in m, enclose by the even–odd rule, and a wall (pixels) around it."""
    corners = [camera.pixels(shape) for shape in shapes]
    box = box_around(picture, np.concatenate(corners), wall)
    if box[0] < box[2] and box[1] < box[3]:
        edges = np.concatenate([_edges(of_shape) for of_shape in corners])
        spans = np.empty((box[3] - box[1], 3 * len(edges)))
        colours = rows_of(wall_colour, colour, wall_colour)
        _paint_walls(picture, edges, spans, whole_numbers(*box), wall, wall, colours)


def paint_plate(picture: np.ndarray, camera: Camera, line: np.ndarray, thickness: float, colour: tuple) -> None:
    """Paint a polyline (m, 2) in m as a plate with round ends, `thickness` in pixels."""
    corners = camera.pixels(line)
    box = box_around(picture, corners, thickness)
    if box[0] < box[2] and box[1] < box[3]:
        _paint_line(picture, _edges(corners)[:-1], whole_numbers(*box), 0.5 * thickness, rows_of(colour))


def _edges(corners: np.ndarray, open_edges: Sequence[int] = ()) -> np.ndarray:
    """A polygon's edges (m, 9) for a kernel, each from a corner to the next.

    Start x, y; way x, y; end's y; 1 over the squared length; the length where the wall before, and after, is open,
    else 0; whether it has a wall.
    """
    ends = np.concatenate([corners[1:], corners[:1]])
    way = ends - corners
    squared = np.maximum((way**2).sum(axis=1), 1e-30)
    found = np.zeros((len(corners), 9))
    found[:, :2], found[:, 2:4], found[:, 4], found[:, 5], found[:, 8] = corners, way, ends[:, 1], 1.0 / squared, 1.0
    for k in open_edges:
        before, after = k - 1, (k + 1) % len(corners)
        found[before, 7], found[after, 6], found[k, 8] = np.sqrt(squared[before]), np.sqrt(squared[after]), 0.0
    return found


@ti.func
def _past(x, y, edges: ti.template(), k):
    """Squared distance to edge k and the position along it, in 0..1 between its ends."""
    px, py, ex, ey = x - edges[k, 0], y - edges[k, 1], edges[k, 2], edges[k, 3]
    along = (px * ex + py * ey) * edges[k, 5]
    on = ti.math.clamp(along, 0.0, 1.0)
    return ti.Vector([(px - on * ex) ** 2 + (py - on * ey) ** 2, along])


@ti.func
def off_outline(x, y, corners: ti.template()):
    """Distance to the edge of a polygon with these corners, negative inside (even-odd crossing rule)."""
    nearest, sign = 1e30, 1.0
    for k in range(corners.shape[0]):
        after = (k + 1) % corners.shape[0]
        ex, ey = corners[after, 0] - corners[k, 0], corners[after, 1] - corners[k, 1]
        px, py = x - corners[k, 0], y - corners[k, 1]
        on = ti.math.clamp((px * ex + py * ey) / ti.max(ex * ex + ey * ey, 1e-30), 0.0, 1.0)
        nearest = ti.min(nearest, (px - on * ex) ** 2 + (py - on * ey) ** 2)
        if (py >= 0.0) != (y >= corners[after, 1]) and (px < ex * py / ey):
            sign = -sign
    return sign * ti.sqrt(nearest)


@ti.func
def _span(y, edges: ti.template(), k, reach):
    """From which x to which an edge is within reach in a row, and where the row crosses it; far left if it does not."""
    x, top, ex, ey = edges[k, 0], edges[k, 1], edges[k, 2], edges[k, 3]
    low, high, crossed = 1e9, -1e9, -1e9
    if y > top + ti.min(ey, 0.0) - reach and y < top + ti.max(ey, 0.0) + reach:
        low, high = x + ti.min(ex, 0.0) - reach, x + ti.max(ex, 0.0) + reach
        if ti.abs(ey) > 1e-6:
            middle, wide = x + ex * (y - top) / ey, reach / (ti.abs(ey) * ti.sqrt(edges[k, 5]))
            low, high = ti.max(low, middle - wide), ti.min(high, middle + wide)
            if (y >= top) != (y >= edges[k, 4]):
                crossed = middle
    return ti.Vector([low, high, crossed])


@ti.func
def _from_edges(x, y, edges: ti.template(), spans: ti.template(), row, wall):
    """Distance to the nearest edge, and to the nearest one with a wall; large where none is within reach.

    The second is larger than `wall` beyond an end next to an open edge: a wall ends there in a straight cut.
    """
    nearest, off = 1e30, 1e30
    for k in range(edges.shape[0]):
        if spans[row, 3 * k] <= x and x < spans[row, 3 * k + 1]:
            place = _past(x, y, edges, k)
            nearest = ti.min(nearest, place[0])
            if edges[k, 8] > 0.0:
                distance = ti.sqrt(place[0])
                if edges[k, 6] > 0.0:
                    distance = ti.max(distance, wall - place[1] * edges[k, 6])
                if edges[k, 7] > 0.0:
                    distance = ti.max(distance, wall + (place[1] - 1.0) * edges[k, 7])
                off = ti.min(off, distance)
    return ti.Vector([ti.sqrt(nearest), off])


@ti.kernel
def _paint_walls(picture: Picture, edges: Table, spans: Table, box: Index, wall: ti.f64, face: ti.f64, colours: Table):
    # Only pixels near an edge are measured; between them, and within the outline, a row is of one colour.
    for row in range(box[1], box[3]):
        y, here = row + 0.5, row - box[1]
        for k in range(edges.shape[0]):
            found = _span(y, edges, k, wall + 1.0)
            for c in ti.static(range(3)):
                spans[here, 3 * k + c] = found[c]
        column = box[0]
        while column < box[2]:
            x, sign, near, following = column + 0.5, 1.0, False, ti.cast(box[2], ti.f64)
            for k in range(edges.shape[0]):
                sign = ti.select(x < spans[here, 3 * k + 2], -sign, sign)
                low = spans[here, 3 * k]
                near = near | ((low <= x) & (x < spans[here, 3 * k + 1]))
                following = ti.min(following, ti.select(low > x, low, 1e9))
            if near:
                away = _from_edges(x, y, edges, spans, here, wall)
                _paint_edge(picture, row, column, sign * away[0], away[1], wall, face, colours)
                column += 1
            else:
                stop = whole(following + 0.5, column + 1, box[2])
                if sign < 0.0:
                    inner = row_of(colours, 1)
                    for pixel in range(column, stop):
                        put(picture, row, pixel, inner)
                column = stop


@ti.func
def _paint_edge(picture: ti.template(), row, column, outside, off, wall, face, colours: ti.template()):
    """Mix inside, wall and its core into a pixel."""
    inside = ti.math.clamp(0.5 - outside, 0.0, 1.0)
    reached = (1.0 - inside) * ti.math.clamp(wall - off + 0.5, 0.0, 1.0)
    if inside + reached > 0.0:
        core = ti.math.clamp(ti.min(off, wall - off) - face + 0.5, 0.0, 1.0)
        colour, under = row_of(colours, 0), colour_of(picture, row, column)
        colour += core * (row_of(colours, 2) - colour)
        mix(picture, row, column, reached * (colour - under) + inside * (row_of(colours, 1) - under))


@ti.kernel
def _paint_line(picture: Picture, edges: Table, box: Index, reach: ti.f64, colours: Table):
    for row in range(box[1], box[3]):
        for column in range(box[0], box[2]):
            nearest = 1e30
            for k in range(edges.shape[0]):
                nearest = ti.min(nearest, _past(column + 0.5, row + 0.5, edges, k)[0])
            if nearest < (reach + 0.5) ** 2:
                share = ti.min(reach - ti.sqrt(nearest) + 0.5, 1.0)
                mix(picture, row, column, share * (row_of(colours, 0) - colour_of(picture, row, column)))
