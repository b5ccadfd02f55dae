"""Find which sphere is seen in each pixel, and how far away it is.

Each is met by the pixel's ray itself, so outlines are the ellipses of perspective, and depths and normals are exact.
Bands of rows are one task each, with their own spheres from the nearest on, so that most of what is hidden is passed
over by one comparison a pixel, and the picture does not depend on the number of threads.
"""

from dataclasses import dataclass

import numpy as np
import taichi as ti

from lab.paint.raster.base import BAND, PER_TASK, Index, Shares, Table, sort_into_bands, whole
from lab.paint.space.camera import SpaceCamera
from lab.paint.space.raster.layers import Layers, Numbers, Whole

SMALLEST = 0.7  # pixels: smaller spheres are drawn with this radius, else they would be missed between pixels


@dataclass(frozen=True)
class Spheres:
    """Spheres of one picture from the nearest on, in camera coordinates.

    balls (n, 4): right, up, depth, radius, m; which (n,): their numbers among those that were given.
    """

    balls: np.ndarray
    which: np.ndarray

    @classmethod
    def seen(cls, camera: SpaceCamera, place: np.ndarray, radius: np.ndarray) -> "Spheres":
        """The spheres (place (n, 3), radius (n,), m) that are before the camera; those that are not finite are gone."""
        seen = camera.gaze.seen(place)
        drawn = np.maximum(radius, SMALLEST * seen[:, 2] / camera.focal)
        with np.errstate(invalid="ignore"):
            before = np.flatnonzero(np.isfinite(seen).all(axis=1) & (seen[:, 2] > 2.0 * drawn))
        order = before[np.argsort(seen[before, 2] - drawn[before], kind="stable")]
        return cls(np.column_stack([seen[order], drawn[order]]), order.astype(np.int32))


def find_spheres(layers: Layers, spheres: Spheres) -> None:
    """Write into the layers where these spheres are the nearest; `who` counts them in their own order."""
    height = len(layers.depth)
    if not len(spheres.balls):
        return
    top, bottom = _rows(layers.lens, spheres.balls)
    starts, members = sort_into_bands(0.5 * (top + bottom), 0.5 * (bottom - top), height)
    if len(members):
        rows = np.column_stack([top, bottom])
        _find(layers.depth, layers.who, starts, members, spheres.balls, rows, layers.lens)


def _rows(lens: np.ndarray, balls: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rows (n,) between which spheres are seen, by the two tangents from the camera (Mara & McGuire 2013, section 2).

    In the plane of up and depth: tan = (u d ± r √(u² + d² − r²))/(d² − r²).
    """
    _, up, depth, radius = balls.T
    half = radius * np.sqrt(up**2 + depth**2 - radius**2)
    squared = depth**2 - radius**2
    return lens[2] - lens[0] * (up * depth + half) / squared, lens[2] - lens[0] * (up * depth - half) / squared


@ti.func
def _span(ball, y, lens: ti.template(), width):
    """First and last column (excluded) in which a row meets a sphere: (x, y, 1) · c ≥ √(c² − r²) |(x, y, 1)|."""
    outside = ball[0] ** 2 + ball[1] ** 2 + ball[2] ** 2 - ball[3] ** 2
    along = y * ball[1] + ball[2]
    a, b = outside - ball[0] ** 2, ball[0] * along
    c = (y * y + 1.0) * outside - along * along
    found, first, last = b * b - a * c, 0, 0
    if found > 0.0:
        root = ti.sqrt(found)
        first = whole(lens[1] + lens[0] * (b - root) / a + 0.5, 0, width)
        last = whole(lens[1] + lens[0] * (b + root) / a + 0.5, 0, width)
    return ti.Vector([first, last])


@ti.kernel
def _find(depth: Shares, who: Whole, starts: Index, members: Index, balls: Table, rows: Table, lens: Numbers):
    for k in range((starts.shape[0] - 1) * PER_TASK):
        if k % PER_TASK == 0:
            band = k // PER_TASK
            top, bottom = band * BAND, ti.min((band + 1) * BAND, depth.shape[0])
            for entry in range(starts[band], starts[band + 1]):
                i = members[entry]
                ball = ti.Vector([balls[i, 0], balls[i, 1], balls[i, 2], balls[i, 3]])
                outside = ball[0] ** 2 + ball[1] ** 2 + ball[2] ** 2 - ball[3] ** 2
                nearest = ti.cast(ball[2] - ball[3], ti.f32)
                for row in range(whole(rows[i, 0], top, bottom), whole(rows[i, 1] + 1.0, top, bottom)):
                    y = (lens[2] - row - 0.5) / lens[0]
                    span = _span(ball, y, lens, depth.shape[1])
                    along, squared = y * ball[1] + ball[2], y * y + 1.0
                    for column in range(span[0], span[1]):
                        if depth[row, column] > nearest:
                            x = (column + 0.5 - lens[1]) / lens[0]
                            b, a = x * ball[0] + along, x * x + squared
                            met = ti.cast((b - ti.sqrt(ti.max(b * b - a * outside, 0.0))) / a, ti.f32)
                            if met < depth[row, column]:
                                depth[row, column] = met
                                who[row, column] = i
