"""The raster: walls and grains into a picture, a numpy array (height, width, 3) of u8.

A picture is cut into horizontal bands. Each band is one task that paints its own grains in the order of their numbers,
so no two tasks touch the same pixel and the picture does not depend on the number of threads. Edges are smooth because
a pixel takes the share of the paint that its distance from the edge says it is covered by.

Pixel coordinates: x to the right, y downwards; the pixel in row i and column j is the square [j, j+1] x [i, i+1].
Taichi must be running (`solvers.runtime.initialise`).
"""

from dataclasses import dataclass

import numpy as np
import taichi as ti

BAND = 16  # rows of a band
PER_TASK = 512  # Taichi gives each thread at least so many turns of a parallel loop

SHADE = 0.10  # how much lighter the top and darker the bottom of a grain is
RIM = 0.32  # how much darker the rim is
RIM_WIDTH = 0.14  # of the radius
MARK_PLACE = 0.56  # of the radius from the centre
MARK_SIZE = 0.17  # of the radius
MARK_STRENGTH = 0.80

Picture = ti.types.ndarray(dtype=ti.u8, ndim=3)
Table = ti.types.ndarray(dtype=ti.f64, ndim=2)
Index = ti.types.ndarray(dtype=ti.i32, ndim=1)
Colour = ti.types.vector(3, ti.f64)


@dataclass(frozen=True)
class Camera:
    """From metres to pixels: p = offset + scale F R(turn) r, where F = diag(1, -1) because pixel rows run downwards.

    scale: pixels a metre; offset: pixel of the origin; turn: radians, counter-clockwise in the picture.
    """

    scale: float
    offset: tuple[float, float]
    turn: float = 0.0

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Pixels (k, 2) of points (k, 2) in metres."""
        cosine, sine = np.cos(self.turn), np.sin(self.turn)
        y, z = np.asarray(points, dtype=float).T
        right, up = cosine * y - sine * z, sine * y + cosine * z
        return np.column_stack(
            [self.offset[0] + self.scale * right, self.offset[1] - self.scale * up]
        )

    def carried(self, pose: np.ndarray) -> "Camera":
        """This earth camera for points of a tank with the pose (Y, Z, phi) in m, m, rad."""
        origin = self.pixels(np.asarray(pose[None, :2]))[0]
        return Camera(self.scale, (origin[0], origin[1]), self.turn + float(pose[2]))

    @classmethod
    def showing(cls, low: np.ndarray, high: np.ndarray, region: tuple) -> "Camera":
        """The camera that fits the box from low to high (m) centred into the region (left, top, right, bottom) of pixels."""
        left, top, right, bottom = region
        width, height = np.maximum(np.subtract(high, low), 1e-12)
        scale = min((right - left) / width, (bottom - top) / height)
        middle = np.add(low, high) / 2
        offset = (left + right) / 2 - scale * middle[0], (top + bottom) / 2 + scale * middle[1]
        return cls(float(scale), (float(offset[0]), float(offset[1])))


def paint_grains(
    picture: np.ndarray,
    camera: Camera,
    position: np.ndarray,
    radius: np.ndarray,
    angle: np.ndarray,
    colour: np.ndarray,
    mark: np.ndarray,
) -> None:
    """Paint grains over a picture (height, width, 3), u8, in place; a grain without a finite place is left out.

    position (n, 2) m, radius (n,) m, angle (n,) rad (where the spin mark points), colour and mark (n, 3) in 0..255.
    """
    turned = np.asarray(angle, dtype=float) + camera.turn
    discs = np.column_stack(
        [
            camera.pixels(position),
            camera.scale * np.asarray(radius, dtype=float),
            np.cos(turned),
            -np.sin(turned),
        ]
    )
    seen = np.isfinite(discs).all(axis=1)
    paints = np.column_stack([colour, mark]).astype(float)
    discs, paints = discs[seen], paints[seen]
    starts, members = _sort_into_bands(discs[:, 1], discs[:, 2] + 1.0, picture.shape[0])
    if len(members):
        _paint_bands(picture, starts, members, discs, paints)


def paint_tank(
    picture: np.ndarray,
    camera: Camera,
    outline: np.ndarray,
    wall: float,
    wall_colour: tuple,
    inner_colour: tuple,
) -> None:
    """Paint the inside of the polygon outline (m, 2) in metres, and around it a wall so many pixels thick, in place."""
    corners = camera.pixels(outline)
    height, width, _ = picture.shape
    left, top = np.clip(np.floor(corners.min(0) - wall - 1), 0, [width, height]).astype(int)
    right, bottom = np.clip(np.ceil(corners.max(0) + wall + 1), 0, [width, height]).astype(int)
    if left < right and top < bottom:
        box = ti.Vector([left, top, right, bottom])
        _paint_walls(picture, corners, box, wall, Colour(wall_colour), Colour(inner_colour))


def _sort_into_bands(y: np.ndarray, reach: np.ndarray, height: int) -> tuple:
    """Numbers of the grains in each band: band b holds members[starts[b]:starts[b + 1]], in ascending order."""
    bands = -(-height // BAND)
    first = np.clip(np.floor((y - reach) / BAND), 0, bands).astype(int)
    last = np.clip(np.floor((y + reach) / BAND), -1, bands - 1).astype(int)
    spans = np.maximum(last - first + 1, 0)
    members = np.repeat(np.arange(len(y), dtype=np.int32), spans)
    band = np.arange(len(members)) - np.repeat(np.cumsum(spans) - spans - first, spans)
    order = np.argsort(band, kind="stable")
    starts = np.searchsorted(band[order], np.arange(bands + 1)).astype(np.int32)
    return starts, members[order]


@ti.func
def _coverage(distance, radius):
    """Share of a pixel that a disc covers, from the distance (pixels) between the pixel's middle and the disc's.

    A linear ramp one pixel wide whose reach makes the volume below it pi r^2 (2 pi int rho f(rho) d rho, own
    derivation): reach = sqrt(r^2 - 1/12) + 1/2. A disc too small for its ramp is a faint cone of radius 1.
    """
    area = radius * radius
    reach = ti.sqrt(ti.max(area, 1.0 / 3.0) - 1.0 / 12.0) + 0.5
    return ti.min(3.0 * area, 1.0) * ti.math.clamp(reach - distance, 0.0, 1.0)


@ti.func
def _blend(picture: ti.template(), row, column, colour, opacity):
    for c in ti.static(range(3)):
        under = ti.cast(picture[row, column, c], ti.f64)
        mixed = under + opacity * (colour[c] - under)
        picture[row, column, c] = ti.cast(ti.math.clamp(mixed, 0.0, 255.0) + 0.5, ti.u8)


@ti.func
def _paint_disc(picture: ti.template(), x, y, radius, towards, colour, mark, top, bottom):
    """Paint the part of one grain that lies in the rows top to bottom."""
    spot = MARK_PLACE * radius * towards
    rim = RIM * ti.math.clamp((radius - 1.0) / 3.0, 0.0, 1.0)
    left = ti.max(ti.floor(x - radius - 1.0), 0.0)
    right = ti.min(ti.ceil(x + radius + 1.0), picture.shape[1])
    upper = ti.max(ti.floor(y - radius - 1.0), top)
    lower = ti.min(ti.ceil(y + radius + 1.0), bottom)
    for row in range(ti.cast(upper, ti.i32), ti.cast(lower, ti.i32)):
        for column in range(ti.cast(left, ti.i32), ti.cast(right, ti.i32)):
            offset = ti.Vector([column + 0.5 - x, row + 0.5 - y])
            distance = offset.norm()
            opacity = _coverage(distance, radius)
            if opacity > 0.0:
                inner = _coverage(distance, (1.0 - RIM_WIDTH) * radius)
                light = 1.0 - SHADE * offset.y / ti.max(radius, 1.0) - rim * (1.0 - inner)
                marked = MARK_STRENGTH * _coverage((offset - spot).norm(), MARK_SIZE * radius)
                paint = colour * light + marked * (mark - colour * light)
                _blend(picture, row, column, paint, opacity)


@ti.kernel
def _paint_bands(picture: Picture, starts: Index, members: Index, discs: Table, paints: Table):
    for k in range((starts.shape[0] - 1) * PER_TASK):
        if k % PER_TASK == 0:
            band = k // PER_TASK
            top, bottom = band * BAND, ti.min((band + 1) * BAND, picture.shape[0])
            for entry in range(starts[band], starts[band + 1]):
                i = members[entry]
                towards = ti.Vector([discs[i, 3], discs[i, 4]])
                colour = ti.Vector([paints[i, 0], paints[i, 1], paints[i, 2]])
                mark = ti.Vector([paints[i, 3], paints[i, 4], paints[i, 5]])
                x, y, radius = discs[i, 0], discs[i, 1], discs[i, 2]
                _paint_disc(picture, x, y, radius, towards, colour, mark, top, bottom)


@ti.func
def _outside(x, y, corners: ti.template()):
    """Distance to the polygon's edge, negative inside (even-odd crossing rule)."""
    nearest, sign = 1e30, 1.0
    for k in range(corners.shape[0]):
        after = (k + 1) % corners.shape[0]
        ex, ey = corners[after, 0] - corners[k, 0], corners[after, 1] - corners[k, 1]
        px, py = x - corners[k, 0], y - corners[k, 1]
        along = ti.math.clamp((px * ex + py * ey) / ti.max(ex * ex + ey * ey, 1e-30), 0.0, 1.0)
        nearest = ti.min(nearest, (px - along * ex) ** 2 + (py - along * ey) ** 2)
        if (py >= 0.0) != (y >= corners[after, 1]) and (px < ex * py / ey):
            sign = -sign
    return sign * ti.sqrt(nearest)


@ti.kernel
def _paint_walls(
    picture: Picture,
    corners: Table,
    box: ti.types.vector(4, ti.i32),
    wall: ti.f64,
    wall_colour: Colour,
    inner_colour: Colour,
):
    # The distance changes by at most one from pixel to pixel: far from the edge a whole run of pixels is alike.
    for row in range(box[1], box[3]):
        column = box[0]
        while column < box[2]:
            outside = _outside(column + 0.5, row + 0.5, corners)
            alike = ti.max(-outside, outside - wall) - 0.5
            stop = ti.min(column + ti.max(ti.cast(alike, ti.i32), 1), box[2])
            if alike < 0.0 or outside < 0.0:
                walled = ti.math.clamp(wall - outside + 0.5, 0.0, 1.0)
                inside = ti.math.clamp(0.5 - outside, 0.0, 1.0)
                for pixel in range(column, stop):
                    _blend(picture, row, pixel, wall_colour, walled)
                    _blend(picture, row, pixel, inner_colour, inside)
            column = stop
