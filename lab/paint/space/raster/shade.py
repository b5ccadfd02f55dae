"""The light on what is seen: open sky, a key light that goes with the camera, a glint; marks that turn with spheres.

Colours stay close to those of the legend: a face turned to the camera in the open has a brightness of about 1.
"""

from dataclasses import dataclass

import numpy as np
import taichi as ti

from lab.paint.raster.base import PER_TASK, Picture, Shares, Table, put, row_of
from lab.paint.space.raster.layers import NOTHING, WALL, Layers, Numbers, Whole, ray_at, read_lens
from lab.paint.space.raster.occlusion import evened, normal_at

KEY = (-0.46, 0.70, -0.55)  # direction to the light: right, up, depth
SKY, GROUND, SUN = 0.68, 0.48, 0.56  # brightness from above, from below, and of the key light
RIM = 0.22  # how much darker the rim of a sphere is
GLINT = 5  # its exponent is 2⁵ (Blinn 1977)
CAP = 0.92  # cosine of the angle that a mark reaches from its axis
SOFT = 0.04  # of that cosine over which its edge is soft
WALL_SUN = 0.30  # share of the key light's contrast on walls, which are to stay quiet


@dataclass(frozen=True)
class Paints:
    """How spheres look: colour (n, 3) in 0..255; gloss (n,) 0 to 1; marks: axes (n, 3) unit and colour (n, 3), or None.

    A mark is a spot at either end of an axis that turns with its sphere; axes as places, (y, z, x).
    """

    colour: np.ndarray
    gloss: np.ndarray | float = 0.0
    axes: np.ndarray | None = None
    mark: np.ndarray | None = None

    def table(self, which: np.ndarray, axes: np.ndarray) -> np.ndarray:
        """Rows (n, 10) for a kernel of these spheres: colour, gloss, mark's colour, and axis in camera axes (3, 3)."""
        found = np.zeros((len(which), 10))
        found[:, :3] = self.colour[which]
        found[:, 3] = self.gloss if np.isscalar(self.gloss) else self.gloss[which]
        if self.axes is not None:
            found[:, 4:7], found[:, 7:] = self.mark[which], self.axes[which] @ axes.T
        return found


def shade(layers: Layers, balls: np.ndarray, planes: np.ndarray, paints: np.ndarray, tints: np.ndarray) -> None:
    """Write into the layers the colours of what is seen.

    paints (n, 10): of the spheres, by `Paints.table`; tints (m, 3): colours of the walls, 0..255.
    """
    key = np.array(KEY) / np.linalg.norm(KEY)
    _shade(layers.shaded, layers.depth, layers.who, layers.sky, balls, planes, paints, tints, key, layers.lens)


@ti.func
def _bounced(seen, paint):
    """Light (3,) from an open sky of this share, with what is reflected between surfaces of this colour, 0..255.

    max(A, ((A a + b) A + c) A), a = 2.0404 ρ − 0.3324, b = −4.7951 ρ + 0.6417, c = 2.7552 ρ + 0.6903 (Jimenez et al.
    2016). So gaps between pale or coloured grains keep their colour.
    """
    rho = 0.8 * paint / 255.0
    a, b, c = 2.0404 * rho - 0.3324, 0.6417 - 4.7951 * rho, 2.7552 * rho + 0.6903
    return ti.max(((seen * a + b) * seen + c) * seen, seen)


@ti.func
def _of_sphere(i, point, normal, bright, lit, seen, paints: ti.template(), key):
    """Colour of a point on sphere i: bright, lit: from an open sky and from the key light; seen: the open share."""
    paint = ti.Vector([paints[i, 0], paints[i, 1], paints[i, 2]])
    axis = ti.Vector([paints[i, 7], paints[i, 8], paints[i, 9]])
    marked = ti.math.clamp((ti.abs(axis.dot(normal)) - CAP) / SOFT + 0.5, 0.0, 1.0)
    paint += marked * (ti.Vector([paints[i, 4], paints[i, 5], paints[i, 6]]) - paint)
    view = -point.normalized()
    facing = ti.max(view.dot(normal), 0.0)
    paint *= (bright * _bounced(seen, paint) + lit * (0.35 + 0.65 * seen)) * (1.0 - RIM * (1.0 - facing) ** 2)
    if paints[i, 3] > 0.0:
        glint = ti.max((view + key).normalized().dot(normal), 0.0)
        for _ in ti.static(range(GLINT)):
            glint *= glint
        paint += paints[i, 3] * seen * glint * (255.0 - paint)
    return paint


@ti.kernel
def _shade(
    found: Picture,
    depth: Shares,
    who: Whole,
    open_sky: Shares,
    balls: Table,
    planes: Table,
    paints: Table,
    tints: Table,
    light: Numbers,
    numbers: Numbers,
):
    for k in range(depth.shape[0] * PER_TASK):
        if k % PER_TASK == 0:
            row, lens = k // PER_TASK, read_lens(numbers)
            key = ti.Vector([light[0], light[1], light[2]])
            for column in range(depth.shape[1]):
                number = who[row, column]
                if number != NOTHING:
                    point = depth[row, column] * ray_at(lens, row, column)
                    normal = normal_at(point, number, balls, planes)
                    seen = evened(open_sky, who, row, column)
                    bright = GROUND + (SKY - GROUND) * (0.5 + 0.5 * normal[1])
                    lit = SUN * ti.max(normal.dot(key), 0.0)
                    paint = ti.Vector([0.0, 0.0, 0.0])
                    if number >= 0:
                        paint = _of_sphere(number, point, normal, bright, lit, seen, paints, key)
                    elif number <= WALL:
                        paint = row_of(tints, WALL - number) * seen
                        paint *= 1.0 - WALL_SUN + WALL_SUN * (0.5 + 0.5 * normal.dot(key))
                    put(found, row, column, paint)
