"""What all rasters share: the camera, bands of rows, and how a pixel is read and mixed.

A picture is a numpy array (height, width, 3) of u8, cut into horizontal bands. Each band is one task that paints its
own grains in the order of their numbers, so no two tasks touch the same pixel and the picture does not depend on the
number of threads. Edges are antialiased: the covered share of a pixel follows from its distance from the edge.

Loops over pixels are nested, by row and column, since `ti.ndrange` would need a division per pixel.

Pixel coordinates: x to the right, y downwards; the pixel in row i and column j is the square [j, j+1] x [i, i+1].
Taichi must be running (`solvers.machine.runtime.initialise`).
"""

from dataclasses import dataclass

import numpy as np
import taichi as ti

BAND = 16  # rows of a band
PER_TASK = 512  # smallest number of iterations of a parallel loop that Taichi gives to a thread

Picture = ti.types.ndarray(dtype=ti.u8, ndim=3)
Table = ti.types.ndarray(dtype=ti.f64, ndim=2)
Shares = ti.types.ndarray(dtype=ti.f32, ndim=2)
Index = ti.types.ndarray(dtype=ti.i32, ndim=1)
Colour = ti.types.vector(3, ti.f64)


@dataclass(frozen=True)
class Camera:
    """From metres to pixels: p = offset + scale F R(turn) r, F = diag(1, -1) as rows run downwards.

    scale: pixels a metre; offset: pixel of the origin; turn: rad, counter-clockwise in the picture.
    """

    scale: float
    offset: tuple[float, float]
    turn: float = 0.0

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Pixels (k, 2) of points (k, 2) in metres."""
        cosine, sine = np.cos(self.turn), np.sin(self.turn)
        y, z = np.asarray(points, dtype=float).T
        right, up = cosine * y - sine * z, sine * y + cosine * z
        return np.column_stack([self.offset[0] + self.scale * right, self.offset[1] - self.scale * up])

    def shifted(self, left: float, top: float) -> "Camera":
        """This camera for a part of the picture whose first pixel is in this column and row."""
        return Camera(self.scale, (self.offset[0] - left, self.offset[1] - top), self.turn)

    def carried(self, pose: np.ndarray) -> "Camera":
        """This earth camera for points of a tank with the pose (Y, Z, phi) in m, m, rad."""
        origin = self.pixels(np.asarray(pose[None, :2]))[0]
        return Camera(self.scale, (origin[0], origin[1]), self.turn + float(pose[2]))


def box_around(picture: np.ndarray, corners: np.ndarray, reach: float) -> tuple[int, int, int, int]:
    """The pixels (left, top, right, bottom) of a picture that lie within reach of the corners."""
    height, width, _ = picture.shape
    left, top = np.clip(np.floor(corners.min(0) - reach - 1), 0, [width, height]).astype(int).tolist()
    right, bottom = np.clip(np.ceil(corners.max(0) + reach + 1), 0, [width, height]).astype(int).tolist()
    return left, top, right, bottom


def sort_into_bands(y: np.ndarray, reach: np.ndarray, height: int) -> tuple:
    """Sort grains into bands: band b holds the grains members[starts[b]:starts[b + 1]], ascending."""
    bands = -(-height // BAND)
    first = np.clip(np.floor((y - reach) / BAND), 0, bands).astype(int)
    last = np.clip(np.floor((y + reach) / BAND), -1, bands - 1).astype(int)
    spans = np.maximum(last - first + 1, 0)
    members = np.repeat(np.arange(len(y), dtype=np.int32), spans)
    band = np.arange(len(members)) - np.repeat(np.cumsum(spans) - spans - first, spans)
    order = np.argsort(band, kind="stable")
    starts = np.searchsorted(band[order], np.arange(bands + 1)).astype(np.int32)
    return starts, members[order]


def whole_numbers(*numbers: int) -> np.ndarray:
    """Whole numbers, such as a box's, as an argument of a kernel; Taichi takes arrays far more quickly than vectors."""
    return np.array(numbers, dtype=np.int32)


def rows_of(*colours: tuple) -> np.ndarray:
    """Colours (k, 3) as an argument of a kernel."""
    return np.array(colours, dtype=float)


@ti.func
def put(picture: ti.template(), row, column, colour):
    for c in ti.static(range(3)):
        picture[row, column, c] = ti.cast(ti.math.clamp(colour[c], 0.0, 255.0) + 0.5, ti.u8)


@ti.func
def mix(picture: ti.template(), row, column, change):
    """Add a change of colour to a pixel."""
    for c in ti.static(range(3)):
        mixed = ti.math.clamp(picture[row, column, c] + change[c], 0.0, 255.0)
        picture[row, column, c] = ti.cast(mixed + 0.5, ti.u8)


@ti.func
def colour_of(picture: ti.template(), row, column):
    return ti.Vector([ti.cast(picture[row, column, c], ti.f64) for c in ti.static(range(3))])


@ti.func
def row_of(colours: ti.template(), k):
    return ti.Vector([colours[k, c] for c in ti.static(range(3))])


@ti.func
def whole(place, low, high):
    """The pixel at a coordinate, clamped between low and high."""
    return ti.cast(ti.math.clamp(ti.floor(place), low, high), ti.i32)
