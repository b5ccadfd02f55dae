"""Water as one surface in a picture: depths of its particles are evened, and light goes into it and comes back.

As screen-space fluids are drawn (van der Laan, Green & Sainz 2009): the particles' spheres say how far away the water
is in each pixel; these depths are evened by a narrow filter, so that the surface is smooth and its edges stay (as
Truong & Yuksel 2018 keep theirs); the normals follow from them. Where water stands against a wall that one looks
through, it ends there. How thick the water is along each ray is the volume of the particles over the area of what a
pixel sees. Light is taken by it as Beer and Lambert have it, and mirrored as Schlick (1994) has Fresnel's law.
"""

import numpy as np
import taichi as ti
from scipy.ndimage import gaussian_filter

from lab.paint.raster.base import PER_TASK, Picture, Shares, colour_of, put
from lab.paint.space.camera import SpaceCamera
from lab.paint.space.raster.faces import find_walls
from lab.paint.space.raster.layers import FAR, Layers, Numbers, ray_at, read_lens
from lab.paint.space.raster.shade import KEY
from lab.paint.space.raster.spheres import Spheres, find_spheres
from lab.paint.space.walls import Walls

SWELL = 0.9  # of the spacing: radius of the spheres that stand for particles
EVEN, MOST_EVEN, PASSES = 2.5, 48, 2  # half the width of the filter in spacings, at most in pixels, and how often
NARROW = 2.0  # spacings: depths that are farther apart are of different surfaces
COARSE = 4  # pixels: side of the cells on which thickness is summed up
BENT = 0.25  # of the surface's slope: by how much what is behind is displaced, over the thickness
MOST_BENT = 0.012  # of the picture's height: that at most
TAKEN = (2.6, 0.95, 0.55)  # of red, green, blue: what is taken along a thickness of one `deep`
DEEP = (22.0, 84.0, 140.0)  # colour of water that lets nothing through
SKY_ABOVE, SKY_ASIDE = (236.0, 243.0, 250.0), (170.0, 196.0, 218.0)  # that it mirrors
MIRROR = 0.02  # share that is mirrored by a face turned to the eye
GLINT = 5  # its exponent is 2⁵


def paint_liquid(
    picture: np.ndarray,
    layers: Layers,
    camera: SpaceCamera,
    place: np.ndarray,
    spacing: float,
    tank: tuple[Walls, bool],
    deep: float,
) -> None:
    """Paint water (place (n, 3) m, of one spacing, m) over a picture, in place; the layers then have its depths.

    tank: its walls, and whether they close it all round; deep (m): a thickness that is dark. What stands before it in
    the layers hides it.
    """
    found = Layers(*layers.depth.shape)
    found.clear(camera)
    find_spheres(found, Spheres.seen(camera, place, np.full(len(place), SWELL * spacing)))
    if not (found.depth < FAR).any():
        return
    across = camera.focal * spacing / camera.gaze.distance  # pixels
    half = int(np.clip(np.ceil(EVEN * across), 2, MOST_EVEN))
    even, other = found.depth, np.empty_like(found.depth)
    for _ in range(PASSES):
        _even(even, other, half, NARROW * spacing, 0)
        _even(other, even, half, NARROW * spacing, 1)
    (walls, closed), glass = tank, Layers(*layers.depth.shape)
    glass.clear(camera)
    find_walls(glass, camera, walls, front=True)
    if closed:  # what the spheres of particles beside its walls make of it beyond them
        even[glass.depth >= FAR] = FAR
    np.copyto(even, glass.depth, where=(glass.depth < FAR) & (even < glass.depth))
    thick = _thickness(layers, camera, place, spacing, across)
    key = np.array(KEY) / np.linalg.norm(KEY)
    light = np.array([*key, *TAKEN, deep, spacing])
    _shade(picture, picture.copy(), even, layers.depth, thick, light, camera.gaze.axes @ [0.0, 1.0, 0.0], found.lens)
    np.minimum(layers.depth, even + 1.5 * spacing, out=layers.depth)  # edges that touch it are before it


def _thickness(layers: Layers, camera: SpaceCamera, place: np.ndarray, spacing: float, across: float) -> np.ndarray:
    """How thick (h, w) m the water is along the ray of each pixel, f32."""
    height, width = layers.depth.shape
    seen = camera.gaze.seen(place[np.isfinite(place).all(axis=1)])
    seen = seen[seen[:, 2] > spacing]
    pixels = camera.focal * seen[:, :2] / seen[:, 2:] * [1.0, -1.0] + np.array(camera.screen.offset)
    shape = -(-height // COARSE), -(-width // COARSE)
    rows, columns = ((pixels[:, axis] / COARSE).astype(int) for axis in (1, 0))
    inside = (pixels >= 0.0).all(axis=1) & (rows < shape[0]) & (columns < shape[1])
    volume = spacing**3 * (camera.focal / (COARSE * seen[inside, 2])) ** 2  # m, over a cell
    sums = np.bincount(rows[inside] * shape[1] + columns[inside], volume, shape[0] * shape[1]).reshape(shape)
    smooth = gaussian_filter(sums, max(0.7, 0.8 * across / COARSE))
    fine = gaussian_filter(np.kron(smooth, np.ones((COARSE, COARSE))), 0.6 * COARSE)  # no cells are seen
    return np.ascontiguousarray(fine[:height, :width], dtype=np.float32)


@ti.kernel
def _even(depth: Shares, found: Shares, half: ti.i32, narrow: ti.f64, down: ti.i32):
    """The mean of depths along a row or a column, those near in place and depth the most."""
    for k in range(depth.shape[0] * PER_TASK):
        if k % PER_TASK == 0:
            row, per = k // PER_TASK, ti.cast(1.0 / (narrow * narrow), ti.f32)
            reach = ti.cast(1.0 / ((half + 1.0) * (half + 1.0)), ti.f32)
            for column in range(depth.shape[1]):
                own = depth[row, column]
                if own < 0.5 * FAR:
                    total, weight = ti.f32(0.0), ti.f32(0.0)
                    for step in range(-half, half + 1):
                        there = ti.max(0, ti.min(row + step * down, depth.shape[0] - 1))
                        beside = ti.max(0, ti.min(column + step * (1 - down), depth.shape[1] - 1))
                        off = depth[there, beside] - own
                        near = ti.max(ti.f32(1.0) - off * off * per, ti.f32(0.0))
                        share = near * (1 - step * step * reach)
                        if near > 0.0:
                            total, weight = total + share * off, weight + share
                    found[row, column] = own + total / weight
                else:
                    found[row, column] = own


@ti.func
def _point(depth: ti.template(), row, column, lens):
    """The point of the surface in a pixel, in camera coordinates; its depth is FAR where there is none."""
    there = ti.max(0, ti.min(row, depth.shape[0] - 1))
    beside = ti.max(0, ti.min(column, depth.shape[1] - 1))
    return depth[there, beside] * ray_at(lens, there, beside)


@ti.func
def _slope(before, own, after, most):
    """The way along the surface from one pixel to the next, on the side where depth changes less."""
    back, forth = own - before, after - own
    way = ti.select(ti.abs(back[2]) < ti.abs(forth[2]), back, forth)
    return ti.select(ti.abs(way[2]) > most, ti.Vector([way[0], way[1], 0.0]), way)


@ti.kernel
def _shade(
    found: Picture,
    behind: Picture,
    depth: Shares,
    wall: Shares,
    thick: Shares,
    light: Numbers,
    up: Numbers,
    numbers: Numbers,
):
    for k in range(depth.shape[0] * PER_TASK):
        if k % PER_TASK == 0:
            row, lens = k // PER_TASK, read_lens(numbers)
            key = ti.Vector([light[0], light[1], light[2]])
            above = ti.Vector([up[0], up[1], up[2]])
            for column in range(depth.shape[1]):
                if depth[row, column] < 0.5 * FAR and depth[row, column] < wall[row, column] + light[7]:
                    own, most = _point(depth, row, column, lens), 4.0 * light[7]
                    left, after = _point(depth, row, column - 1, lens), _point(depth, row, column + 1, lens)
                    over, under = _point(depth, row - 1, column, lens), _point(depth, row + 1, column, lens)
                    right, down = _slope(left, own, after, most), _slope(over, own, under, most)
                    normal = right.cross(down).normalized()
                    if normal[2] > 0.0:
                        normal = -normal
                    view = -own.normalized()
                    length = ti.cast(thick[row, column], ti.f64)
                    shift = ti.min(BENT * length / (own[2] * lens[0]), MOST_BENT * depth.shape[0])
                    seen_row = ti.cast(ti.math.clamp(row - shift * normal[1], 0, depth.shape[0] - 1), ti.i32)
                    seen_column = ti.cast(ti.math.clamp(column + shift * normal[0], 0, depth.shape[1] - 1), ti.i32)
                    ground, paint = colour_of(behind, seen_row, seen_column), ti.Vector([0.0, 0.0, 0.0])
                    lit = 0.72 + 0.28 * ti.max(normal.dot(key), 0.0)
                    for c in ti.static(range(3)):
                        through = ti.exp(-light[3 + c] * length / light[6])
                        paint[c] = through * ground[c] + (1.0 - through) * DEEP[c] * lit
                    facing = ti.max(view.dot(normal), 0.0)
                    mirrored = MIRROR + (1.0 - MIRROR) * (1.0 - facing) ** 5
                    upwards = 0.5 + 0.5 * (2.0 * facing * normal - view).dot(above)
                    glint = ti.max((view + key).normalized().dot(normal), 0.0)
                    for _ in ti.static(range(GLINT)):
                        glint *= glint
                    for c in ti.static(range(3)):
                        sky = SKY_ASIDE[c] + upwards * (SKY_ABOVE[c] - SKY_ASIDE[c])
                        paint[c] += mirrored * (sky - paint[c])
                        paint[c] += 0.5 * glint * (255.0 - paint[c])
                    put(found, row, column, paint)
