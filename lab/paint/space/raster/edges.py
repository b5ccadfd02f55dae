"""Smooth edges: a pixel on an outline gets the colours of all that it covers, each as much as it covers.

The covered share follows from the distance of the pixel's middle from the exact outline (as in Persson's geometric
antialiasing, 2011); what stands in front comes first (Porter & Duff 1984).
"""

import numpy as np
import taichi as ti

from lab.paint.raster.base import PER_TASK, Picture, Shares, Table, colour_of, put
from lab.paint.space.raster.layers import NOTHING, Layers, Numbers, Whole, ray_at, read_lens

AROUND = ((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1))  # the pixel itself and those beside it: row, column


def compose(picture: np.ndarray, layers: Layers, balls: np.ndarray) -> None:
    """Put what is seen over a picture (h, w, 3), in place; balls: of the spheres in the layers."""
    _compose(picture, layers.shaded, layers.depth, layers.who, balls, layers.lens)


@ti.func
def _covered(balls: ti.template(), i, row, column, lens):
    """Share of a pixel that sphere i covers, from the distance of its ray from the outline, in pixels."""
    ray = ray_at(lens, row, column)
    centre = ti.Vector([balls[i, 0], balls[i, 1], balls[i, 2]])
    along = ray.dot(centre) / ray.dot(ray)
    off = (centre - along * ray).norm()
    return ti.math.clamp(0.5 + (balls[i, 3] - off) / (lens[0] * along), 0.0, 1.0)


@ti.kernel
def _compose(picture: Picture, shaded: Picture, depth: Shares, who: Whole, balls: Table, numbers: Numbers):
    height, width = depth.shape[0], depth.shape[1]
    for k in range(height * PER_TASK):
        if k % PER_TASK == 0:
            row, lens = k // PER_TASK, read_lens(numbers)
            over, under = ti.max(row - 1, 0), ti.min(row + 1, height - 1)
            left, number = who[row, 0], who[row, 0]
            for column in range(width):
                right = who[row, ti.min(column + 1, width - 1)]
                plain = left == number and right == number
                plain = plain and who[over, column] == number and who[under, column] == number
                if plain:
                    if number != NOTHING:
                        for c in ti.static(range(3)):
                            picture[row, column, c] = shaded[row, column, c]
                else:
                    put(picture, row, column, _mixed(picture, shaded, depth, who, balls, lens, row, column))
                left, number = number, right


@ti.func
def _mixed(
    picture: ti.template(),
    shaded: ti.template(),
    depth: ti.template(),
    who: ti.template(),
    balls: ti.template(),
    lens,
    row,
    column,
):
    """The colour of a pixel at the border of several things.

    Of those beside it, one whose outline holds the pixel's middle is behind what is seen there; else depths decide.
    """
    number = ti.Vector([NOTHING] * 5)
    order, share = ti.Vector([0.0] * 5), ti.Vector([0.0] * 5)
    for j in ti.static(range(5)):
        there = ti.math.clamp(row + AROUND[j][0], 0, depth.shape[0] - 1)
        beside = ti.math.clamp(column + AROUND[j][1], 0, depth.shape[1] - 1)
        number[j], order[j], share[j] = who[there, beside], ti.cast(depth[there, beside], ti.f64), 1.0
        if number[j] >= 0:
            share[j] = _covered(balls, number[j], row, column, lens)
        if ti.static(j > 0):
            if share[j] >= 0.5:
                order[j] = ti.max(order[j], order[0] * (1.0 + 1e-9))
            for before in ti.static(range(j)):
                if number[before] == number[j]:
                    share[j] = 0.0
    total, colour = 0.0, ti.Vector([0.0, 0.0, 0.0])
    for j in ti.static(range(5)):
        weight = share[j]
        for other in ti.static(range(5)):
            if ti.static(other != j):
                before = order[other] < order[j] or (order[other] == order[j] and other < j)
                weight *= ti.select(before, 1.0 - share[other], 1.0)
        there = ti.math.clamp(row + AROUND[j][0], 0, depth.shape[0] - 1)
        beside = ti.math.clamp(column + AROUND[j][1], 0, depth.shape[1] - 1)
        paint = colour_of(shaded, there, beside)
        if number[j] == NOTHING:
            paint = colour_of(picture, row, column)
        colour, total = colour + weight * paint, total + weight
    return colour / ti.max(total, 1e-6)
