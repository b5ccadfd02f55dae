"""Rasterise straight lines into a picture, in place."""

import numpy as np
import taichi as ti

from lab.paint.raster.base import (
    BAND,
    PER_TASK,
    Index,
    Picture,
    Shares,
    Table,
    box_around,
    colour_of,
    mix,
    row_of,
    rows_of,
    sort_into_bands,
    whole,
    whole_numbers,
)


def paint_strokes(picture: np.ndarray, strokes: np.ndarray, colour: tuple) -> None:
    """Paint straight lines (n, 6) in pixels in one colour, in place: x, y and half the thickness at either end.

    Pixels where lines meet or cross are painted once. Lines without finite ends are left out.
    """
    strokes = strokes[np.isfinite(strokes).all(axis=1)].astype(float)
    if not len(strokes):
        return
    left, top, right, bottom = box_around(picture, strokes.reshape(-1, 3)[:, :2], float(strokes[:, [2, 5]].max()))
    if left >= right or top >= bottom:
        return
    strokes -= [left, top, 0.0, left, top, 0.0]
    low, high = strokes[:, [1, 4]].min(axis=1), strokes[:, [1, 4]].max(axis=1)
    reach = 0.5 * (high - low) + strokes[:, [2, 5]].max(axis=1) + 1.0
    starts, members = sort_into_bands(0.5 * (low + high), reach, bottom - top)
    if len(members):
        covered = np.zeros((bottom - top, right - left), dtype=np.float32)
        _paint_strokes(picture, covered, starts, members, strokes, rows_of(colour), whole_numbers(left, top))


@ti.func
def _cover(covered: ti.template(), first, along, half, growth, top, bottom):
    """Add the coverage of a line from `first` in rows top to bottom; a line thinner than a pixel is faint."""
    squared, reach = along.dot(along), ti.max(half, half + growth, 0.5) + 0.5
    inverse, slant, wide = 1.0 / ti.max(squared, 1e-30), 0.0, 1e30
    if ti.abs(along.y) > 1e-6:  # in a row, only so far from where the line crosses it
        slant, wide = along.x / along.y, reach * ti.sqrt(squared) / ti.abs(along.y) + 1.0
    low, high = first.x + ti.min(along.x, 0.0) - reach + 0.5, first.x + ti.max(along.x, 0.0) + reach + 0.5
    upper = whole(first.y + ti.min(along.y, 0.0) - reach + 0.5, top, bottom)
    lower = whole(first.y + ti.max(along.y, 0.0) + reach + 0.5, top, bottom)
    for row in range(upper, lower):
        middle = first.x + (row + 0.5 - first.y) * slant
        left = whole(ti.max(low, middle - wide), 0, covered.shape[1])
        right = whole(ti.min(high, middle + wide + 1.0), 0, covered.shape[1])
        for column in range(left, right):
            away = ti.Vector([column + 0.5, row + 0.5]) - first
            on = ti.math.clamp(away.dot(along) * inverse, 0.0, 1.0)
            thick, distance = half + on * growth, (away - on * along).norm()
            share = ti.min(2.0 * thick, 1.0) * ti.math.clamp(ti.max(thick, 0.5) - distance + 0.5, 0.0, 1.0)
            covered[row, column] = ti.max(covered[row, column], ti.cast(share, ti.f32))


@ti.kernel
def _paint_strokes(
    picture: Picture, covered: Shares, starts: Index, members: Index, strokes: Table, colours: Table, corner: Index
):
    for k in range((starts.shape[0] - 1) * PER_TASK):
        if k % PER_TASK == 0:
            band = k // PER_TASK
            top, bottom = band * BAND, ti.min((band + 1) * BAND, covered.shape[0])
            for entry in range(starts[band], starts[band + 1]):
                i = members[entry]
                first = ti.Vector([strokes[i, 0], strokes[i, 1]])
                along = ti.Vector([strokes[i, 3], strokes[i, 4]]) - first
                _cover(covered, first, along, strokes[i, 2], strokes[i, 5] - strokes[i, 2], top, bottom)
            colour = row_of(colours, 0)
            for row in range(top, bottom):
                for column in range(covered.shape[1]):
                    share = covered[row, column]
                    if share > 0.0:
                        x, y = corner[0] + column, corner[1] + row
                        mix(picture, y, x, share * (colour - colour_of(picture, y, x)))
