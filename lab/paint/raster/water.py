"""Rasterise the sea: rows of one shade below a surface with a height in each column, and lines with a height, too."""

import numpy as np
import taichi as ti

from lab.paint.raster.base import Index, Picture, Table, colour_of, mix, put, row_of, whole, whole_numbers


def paint_below(picture: np.ndarray, box: tuple, surface: np.ndarray, shade: np.ndarray) -> None:
    """Paint all that is below a surface into a box (left, top, right, bottom) of pixels, in place.

    surface (columns,): its row, a number with a fraction; shade (rows, 3): the colours of the box's rows.
    """
    _, top, _, bottom = box
    first, last = (int(np.clip(row, top, bottom)) for row in (surface.min() - 1.0, surface.max() + 1.0))
    _fill(picture, whole_numbers(*box, first, last), np.ascontiguousarray(surface[None]), shade)


def paint_lines(
    picture: np.ndarray, box: tuple, places: np.ndarray, strokes: np.ndarray, colour: tuple[int, int, int]
) -> None:
    """Mix lines into a box of pixels, in place, one after the other.

    places (k, columns): their rows; strokes (k, 2): thickness in pixels and strength, 0..1.
    """
    colours = np.array([colour], dtype=float)
    _mix_lines(picture, whole_numbers(*box), places, np.asarray(strokes, dtype=float), colours)


@ti.kernel
def _fill(picture: Picture, box: Index, surface: Table, shade: Table):
    for row in range(box[4], box[3]):
        colour = row_of(shade, row - box[1])
        if row < box[5]:
            for column in range(box[0], box[2]):
                below = ti.math.clamp(row + 1.0 - surface[0, column - box[0]], 0.0, 1.0)
                mix(picture, row, column, below * (colour - colour_of(picture, row, column)))
        else:
            for column in range(box[0], box[2]):
                put(picture, row, column, colour)


@ti.kernel
def _mix_lines(picture: Picture, box: Index, places: Table, strokes: Table, colours: Table):
    for column in range(box[0], box[2]):
        colour = row_of(colours, 0)
        for k in range(strokes.shape[0]):
            place, half = places[k, column - box[0]], 0.5 * strokes[k, 0]
            for row in range(whole(place - half - 1.0, box[1], box[3]), whole(place + half + 2.0, box[1], box[3])):
                share = strokes[k, 1] * ti.math.clamp(half + 0.5 - ti.abs(row + 0.5 - place), 0.0, 1.0)
                mix(picture, row, column, share * (colour - colour_of(picture, row, column)))
