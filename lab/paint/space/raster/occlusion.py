"""How much of the sky each point in a picture sees: ambient obscurance, sampled in the picture itself.

Obscurance is the mean over the hemisphere of cos θ times a weight that falls with the distance of what is in the way
(Zhukov et al. 1998). Only what the picture shows is known to be in the way (Mittring 2007): of points around a pixel
those above its tangent plane count (McGuire et al. 2011, whose normals came from the depths; here they are exact). The
points lie on a spiral that is turned from pixel to pixel (McGuire et al. 2012) in tiles of 4 x 4, of which every other
pixel is sampled, as on a chessboard; `evened` gives all pixels of a sphere or wall the mean of the tile around them.
Nothing is left to chance, so the light is the same from picture to picture where nothing moves.
"""

import numpy as np
import taichi as ti

from lab.paint.raster.base import PER_TASK, Shares, Table
from lab.paint.space.raster.layers import NOTHING, WALL, Layers, Numbers, Whole, ray_at, read_lens

TAPS, TILE = 12, 4  # points a pixel; side of a tile in pixels
WINDINGS = 5  # of the spiral
LEAST, MOST = 0.007, 0.055  # radius of the spiral over the height of the picture
REACH = 2.5  # its radius over the mean radius of the spheres
STRENGTH, ON_WALLS = 3.0, 1.7  # of the obscurance, on spheres and on walls
FLOOR = 0.12  # least weight of what is in the way, however near to the camera: so deep gaps are dark
LOW = 0.08  # cos θ below which a point does not count, for what is nearly in the tangent plane

Steps = ti.types.ndarray(dtype=ti.i32, ndim=3)


def find_open_sky(layers: Layers, balls: np.ndarray, planes: np.ndarray, radius: float, away: float) -> None:
    """Write into the layers the share of the sky that is open, at every other pixel.

    balls, planes: of the spheres and walls in the layers; radius, away: of a typical sphere and its distance, m.
    """
    focal, height = layers.lens[0], len(layers.depth)
    pixels = float(np.clip(REACH * radius * focal / away, LEAST * height, MOST * height))
    _see(layers.depth, layers.who, layers.sky, balls, planes, _spirals(pixels), layers.lens, pixels * away / focal)


def _spirals(radius: float) -> np.ndarray:
    """Steps (TILE²/2, TAPS, 2) in rows and columns from a pixel to the points around it, for each turn of a spiral."""
    share = (np.arange(TAPS) + 0.5) / TAPS
    order = np.array([0, 4, 2, 6, 5, 1, 7, 3])  # neighbours far apart
    turn = 2.0 * np.pi * (order[:, None] / len(order) + WINDINGS * share)
    away = np.maximum(radius * share, 1.5)
    return np.round(np.stack([away * np.sin(turn), away * np.cos(turn)], axis=-1)).astype(np.int32)


@ti.func
def evened(open_sky: ti.template(), who: ti.template(), row, column):
    """The mean of the open sky over the tile around a pixel, where the same sphere or wall is seen; else over all."""
    number, total, count, other, others = who[row, column], 0.0, 0.0, 0.0, 0.0
    right = ti.min(column + TILE // 2, who.shape[1])
    for down in range(ti.max(row - TILE // 2, 0), ti.min(row + TILE // 2, who.shape[0])):
        across = ti.max(column - TILE // 2, 0)
        across += (across + down) % 2
        while across < right:
            if who[down, across] == number:
                total += open_sky[down, across]
                count += 1.0
            else:
                other += open_sky[down, across]
                others += 1.0
            across += 2
    return ti.select(count > 0.0, total / ti.max(count, 1.0), other / ti.max(others, 1.0))


@ti.func
def normal_at(point, number, balls: ti.template(), planes: ti.template()):
    """Unit normal of the sphere or wall of this number at a point on it, towards the camera."""
    normal = ti.Vector([0.0, 0.0, -1.0])
    if number >= 0:
        centre = ti.Vector([balls[number, 0], balls[number, 1], balls[number, 2]])
        normal = (point - centre) / balls[number, 3]
    elif number <= WALL:
        wall = WALL - number
        normal = ti.Vector([planes[wall, 0], planes[wall, 1], planes[wall, 2]])
    return normal


@ti.func
def short(vector):
    return ti.cast(vector, ti.f32)


@ti.func
def _hidden(point, normal, row, column, depth: ti.template(), spirals: ti.template(), lens, per):
    """Obscurance at a point of a pixel: mean of (cos θ − LOW) max(1 − per r², FLOOR) over points around it; 32 bits."""
    turn, hidden = (row % TILE * TILE + column % TILE) // 2, ti.f32(0.0)
    plane, height, width = point.dot(normal), depth.shape[0] - 1, depth.shape[1] - 1
    for tap in range(TAPS):
        there = ti.max(0, ti.min(row + spirals[turn, tap, 0], height))
        beside = ti.max(0, ti.min(column + spirals[turn, tap, 1], width))
        x, y, away = (beside - lens[1]) * lens[0], (lens[2] - there) * lens[0], depth[there, beside]
        above = away * (x * normal[0] + y * normal[1] + normal[2]) - plane
        if above > 0.0:
            right, up, deep = away * x - point[0], away * y - point[1], away - point[2]
            squared = right * right + up * up + deep * deep
            near = ti.max(1 - squared * per, ti.f32(FLOOR))
            hidden += near * ti.max(above / ti.sqrt(squared) - ti.f32(LOW), ti.f32(0.0))
    return hidden / TAPS


@ti.kernel
def _see(
    depth: Shares,
    who: Whole,
    found: Shares,
    balls: Table,
    planes: Table,
    spirals: Steps,
    numbers: Numbers,
    reach: ti.f64,
):
    for k in range(depth.shape[0] * PER_TASK):
        if k % PER_TASK == 0:
            row, lens = k // PER_TASK, read_lens(numbers)
            half = ti.Vector([lens[0], lens[1] - 0.5, lens[2] - 0.5])
            per = ti.cast(0.25 / (reach * reach), ti.f32)
            for half_column in range((depth.shape[1] + 1 - row % 2) // 2):
                column = 2 * half_column + row % 2
                number, share = who[row, column], 1.0
                if number != NOTHING:
                    point = depth[row, column] * ray_at(lens, row, column)
                    normal = normal_at(point, number, balls, planes)
                    hidden = _hidden(short(point), short(normal), row, column, depth, spirals, short(half), per)
                    share = 1.0 - ti.select(number >= 0, STRENGTH, ON_WALLS) * hidden
                found[row, column] = ti.cast(ti.max(share, 0.0), ti.f32)
