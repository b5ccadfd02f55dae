"""Rasterise walls and grains into a picture, a numpy array (height, width, 3) of u8.

A picture is cut into horizontal bands. Each band is one task that paints its own grains in the
order of their numbers, so no two tasks touch the same pixel and the picture does not depend on the
number of threads. Edges are antialiased: the covered share of a pixel follows from its distance
from the edge. The edge of an irregular grain is interpolated from a table of its polar radius.

Loops over pixels are nested, by row and column, since `ti.ndrange` would need a division per pixel.

Pixel coordinates: x to the right, y downwards; the pixel in row i and column j is the square
[j, j+1] x [i, i+1].
Taichi must be running (`solvers.machine.runtime.initialise`).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import taichi as ti

from solvers.grains.shapes.contour import Contour

BAND = 16  # rows of a band
PER_TASK = 512  # smallest number of iterations of a parallel loop that Taichi gives to a thread

SHADE = 0.10  # how much lighter the top and darker the bottom of a grain is
RIM = 0.32  # how much darker the rim is
RIM_SHARE, RIM_MOST = 0.14, 3.0  # width of the rim relative to the radius; its maximum in pixels
MARK_PLACE = 0.52  # distance of the spin mark from the centre, relative to the radius
MARK_SIZE = 0.21  # radius of the spin mark, relative to the radius
MARK_STRENGTH = 0.55  # opacity of the spin mark
DIRECTIONS = 512  # entries of a table of polar radii; linear interpolation errs by up to 6e-4 of a radius for rice

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

    def carried(self, pose: np.ndarray) -> "Camera":
        """This earth camera for points of a tank with the pose (Y, Z, phi) in m, m, rad."""
        origin = self.pixels(np.asarray(pose[None, :2]))[0]
        return Camera(self.scale, (origin[0], origin[1]), self.turn + float(pose[2]))


@dataclass(frozen=True)
class Edges:
    """Polar radii (K, DIRECTIONS) of outlines at even angles from 0, in radii of the disc of equal area.

    `which` (n,): the row of each grain.
    """

    radii: np.ndarray
    which: np.ndarray

    @classmethod
    def of(cls, contours: Sequence[Contour], which: np.ndarray) -> "Edges":
        """The edges of outlines (K) about their centroids, with the area of a disc of radius 1."""
        angle = 2.0 * np.pi / DIRECTIONS * np.arange(DIRECTIONS)
        return cls(np.stack([contour.polar(angle) for contour in contours]), np.asarray(which))

    @classmethod
    def joined(cls, several: Sequence["Edges"]) -> "Edges":
        """The edges of the grains of all, one after the other."""
        first = np.cumsum([0, *(len(edges.radii) for edges in several)])
        which = [start + edges.which for start, edges in zip(first, several, strict=False)]
        return cls(np.concatenate([edges.radii for edges in several]), np.concatenate(which))


def to_discs(camera: Camera, position: np.ndarray, radius: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Discs (n, 5) in pixels: x, y, radius, and the direction (right, down) of the spin mark.

    position (n, 2) m, radius (n,) m, angle (n,) rad.
    """
    turned = angle + camera.turn
    return np.column_stack([camera.pixels(position), camera.scale * radius, np.cos(turned), -np.sin(turned)])


def paint_grains(
    picture: np.ndarray, discs: np.ndarray, colour: np.ndarray, mark: np.ndarray, edges: Edges | None = None
) -> None:
    """Paint discs (n, 5), or irregular grains with their areas, over a picture (height, width, 3), u8, in place.

    colour and mark (of spin): (n, 3) in 0..255. edges: of irregular grains, turned by the angle of their marks.
    Grains without a finite position are left out.
    """
    seen = np.isfinite(discs).all(axis=1)
    paints = np.column_stack([colour, mark]).astype(float)[seen]
    discs = discs[seen]
    if edges is None:
        reach, which, radii = discs[:, 2], np.zeros(1, dtype=np.int32), np.zeros((1, 1))
    else:
        which, radii = edges.which[seen].astype(np.int32), edges.radii
        reach = discs[:, 2] * radii.max(axis=1)[which]
    starts, members = sort_into_bands(discs[:, 1], reach + 1.0, picture.shape[0])
    if len(members):
        covered, boxed = np.zeros(picture.shape[:2], dtype=np.float32), np.column_stack([discs, reach])
        _paint_bands(picture, picture.copy(), covered, starts, members, boxed, paints, which, radii, edges is not None)


def paint_tank(
    picture: np.ndarray,
    camera: Camera,
    outline: np.ndarray,
    wall: float,
    wall_colour: tuple,
    inner_colour: tuple,
    open_edges: Sequence[int] = (),
) -> None:
    """Paint the inside of a polygon, outline (m, 2) in m, and a wall (pixels thick) around it.

    open_edges: edges k, from corner k to the next, without a wall.
    """
    corners = camera.pixels(outline)
    walled = np.ones(len(corners), dtype=np.int32)
    walled[list(open_edges)] = 0
    box = _box(picture, corners, wall)
    if box[0] < box[2] and box[1] < box[3]:
        _paint_walls(picture, corners, walled, box, wall, Colour(wall_colour), Colour(inner_colour))


def paint_plate(picture: np.ndarray, camera: Camera, line: np.ndarray, thickness: float, colour: tuple) -> None:
    """Paint a polyline (m, 2) in m as a plate with round ends, `thickness` in pixels."""
    corners = camera.pixels(line)
    box = _box(picture, corners, thickness)
    if box[0] < box[2] and box[1] < box[3]:
        _paint_line(picture, corners, box, 0.5 * thickness, Colour(colour))


def paint_strokes(picture: np.ndarray, strokes: np.ndarray, colour: tuple) -> None:
    """Paint straight lines (n, 6) in pixels in one colour, in place: x, y and half the thickness at either end.

    Pixels where lines meet or cross are painted once. Lines without finite ends are left out.
    """
    strokes = strokes[np.isfinite(strokes).all(axis=1)].astype(float)
    if not len(strokes):
        return
    box = _box(picture, strokes.reshape(-1, 3)[:, :2], float(strokes[:, [2, 5]].max()))
    left, top, right, bottom = (int(edge) for edge in box)
    part = np.ascontiguousarray(picture[top:bottom, left:right])
    strokes -= [left, top, 0.0, left, top, 0.0]
    low, high = strokes[:, [1, 4]].min(axis=1), strokes[:, [1, 4]].max(axis=1)
    reach = 0.5 * (high - low) + strokes[:, [2, 5]].max(axis=1) + 1.0
    starts, members = sort_into_bands(0.5 * (low + high), reach, len(part))
    if len(members) and part.size:
        covered = np.zeros(part.shape[:2], dtype=np.float32)
        _paint_strokes(part, covered, starts, members, strokes, Colour(colour))
        picture[top:bottom, left:right] = part


def _box(picture: np.ndarray, corners: np.ndarray, reach: float) -> ti.Vector:
    """The pixels (left, top, right, bottom) of a picture that lie within reach of the corners."""
    height, width, _ = picture.shape
    left, top = np.clip(np.floor(corners.min(0) - reach - 1), 0, [width, height]).astype(int)
    right, bottom = np.clip(np.ceil(corners.max(0) + reach + 1), 0, [width, height]).astype(int)
    return ti.Vector([left, top, right, bottom])


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


@ti.func
def _coverage(distance, radius):
    """Share of a pixel that a disc covers, from the distance (pixels) between their middles.

    A linear ramp one pixel wide, f = reach - rho, whose volume 2 pi int rho f(rho) d rho is pi r^2
    if reach = sqrt(r^2 - 1/12) + 1/2 (own derivation). A disc too small for its ramp,
    r^2 < 1/3, is a faint cone of radius 1 and volume 3 r^2 pi/3.
    """
    area = radius * radius
    reach = ti.sqrt(ti.max(area, 1.0 / 3.0) - 1.0 / 12.0) + 0.5
    return ti.min(3.0 * area, 1.0) * ti.math.clamp(reach - distance, 0.0, 1.0)


@ti.func
def _set(picture: ti.template(), row, column, colour):
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
def _depth(offset, radius, towards, radii: ti.template(), row):
    """Depth (pixels) of a point inside an outline, negative outside: (R - rho)/sqrt(1 + (R'/R)^2).

    Near the edge this is the distance from it. As for a disc, the edge is moved inwards by 1/(24 r), so that the ramp
    around it covers the right area (along any closed curve the ramp adds pi/12: own derivation).
    """
    along, across = offset.dot(towards), offset.x * towards.y - offset.y * towards.x
    turn = ti.atan2(across, along) / (2.0 * ti.math.pi)
    place = (turn - ti.floor(turn)) * DIRECTIONS
    k = ti.min(ti.cast(place, ti.i32), DIRECTIONS - 1)
    rise = radii[row, (k + 1) % DIRECTIONS] - radii[row, k]
    polar = radii[row, k] + (place - k) * rise
    steepness = rise * (DIRECTIONS / (2.0 * ti.math.pi)) / polar
    edge = ti.sqrt(ti.max(radius * radius, 1.0 / 3.0) - 1.0 / 12.0) * polar
    return (edge - offset.norm()) / ti.sqrt(1.0 + steepness * steepness)


@ti.func
def _outline_coverage(offset, radius, inset, towards, radii: ti.template(), row):
    """Share of a pixel that an outline covers when moved inwards by `inset` pixels; very small outlines are faint."""
    within = _depth(offset, radius, towards, radii, row) - inset
    return ti.min(3.0 * radius * radius, 1.0) * ti.math.clamp(within + 0.5, 0.0, 1.0)


@ti.func
def _grain_coverage(offset, radius, inset, towards, radii: ti.template(), row, irregular: ti.template()):
    """Share of a pixel that a grain covers, its edge moved inwards by `inset` pixels."""
    share = 0.0
    if ti.static(irregular):
        share = _outline_coverage(offset, radius, inset, towards, radii, row)
    else:
        share = _coverage(offset.norm(), radius - inset)
    return share


@ti.func
def _rim_width(radius):
    return ti.min(RIM_SHARE * radius, RIM_MOST)


@ti.func
def _grain_paint(offset, radius, inner, towards, colour, mark):
    """Colour of a grain at an offset (right, down) from its middle: shading, rim outside `inner`, and spin mark."""
    rim = RIM * ti.math.clamp((radius - 1.0) / 3.0, 0.0, 1.0)
    light = 1.0 - SHADE * offset.y / ti.max(radius, 1.0) - rim * (1.0 - inner)
    paint = light * colour
    spot = offset - MARK_PLACE * radius * towards
    if spot.norm_sqr() < (MARK_SIZE * radius + 1.0) ** 2:
        marked = MARK_STRENGTH * _coverage(spot.norm(), MARK_SIZE * radius)
        paint += marked * (mark - paint)
    return paint


@ti.func
def whole(place, low, high):
    """The pixel at a coordinate, clamped between low and high."""
    return ti.cast(ti.math.clamp(ti.floor(place), low, high), ti.i32)


@ti.kernel
def _paint_bands(
    picture: Picture,
    under: Picture,
    covered: Shares,
    starts: Index,
    members: Index,
    discs: Table,
    paints: Table,
    which: Index,
    radii: Table,
    irregular: ti.template(),
):
    """Paint all bands. The coverages of a pixel add up to one at most, so no background shows where discs touch."""
    for k in range((starts.shape[0] - 1) * PER_TASK):
        if k % PER_TASK == 0:
            band = k // PER_TASK
            top, bottom = band * BAND, ti.min((band + 1) * BAND, picture.shape[0])
            for entry in range(starts[band], starts[band + 1]):
                i = members[entry]
                x, y, radius = discs[i, 0], discs[i, 1], discs[i, 2]
                towards = ti.Vector([discs[i, 3], discs[i, 4]])
                colour = ti.Vector([paints[i, 0], paints[i, 1], paints[i, 2]])
                mark = ti.Vector([paints[i, 3], paints[i, 4], paints[i, 5]])
                reach, row_of = discs[i, 5], 0
                if ti.static(irregular):
                    row_of = which[i]
                left = whole(x - reach - 1.0, 0, picture.shape[1])
                right = whole(x + reach + 2.0, 0, picture.shape[1])
                upper = whole(y - reach - 1.0, top, bottom)
                lower = whole(y + reach + 2.0, top, bottom)
                for row in range(upper, lower):
                    for column in range(left, right):
                        offset = ti.Vector([column + 0.5 - x, row + 0.5 - y])
                        free = 1.0 - covered[row, column]
                        share = ti.min(_grain_coverage(offset, radius, 0.0, towards, radii, row_of, irregular), free)
                        if share > 0.0:
                            covered[row, column] += ti.cast(share, ti.f32)
                            width = _rim_width(radius)
                            inner = _grain_coverage(offset, radius, width, towards, radii, row_of, irregular)
                            paint = _grain_paint(offset, radius, inner, towards, colour, mark)
                            if share == 1.0:
                                _set(picture, row, column, paint)
                            else:
                                mix(picture, row, column, share * (paint - colour_of(under, row, column)))


@ti.func
def _past(x, y, corners: ti.template(), k, after):
    """Distance to the edge from corner k to corner `after`, and the position along it, in 0..1 between its ends."""
    ex, ey = corners[after, 0] - corners[k, 0], corners[after, 1] - corners[k, 1]
    px, py = x - corners[k, 0], y - corners[k, 1]
    along = (px * ex + py * ey) / ti.max(ex * ex + ey * ey, 1e-30)
    on = ti.math.clamp(along, 0.0, 1.0)
    return ti.Vector([ti.sqrt((px - on * ex) ** 2 + (py - on * ey) ** 2), along])


@ti.func
def off_outline(x, y, corners: ti.template()):
    """Distance to the polygon's edge, negative inside (even-odd crossing rule)."""
    nearest, sign = 1e30, 1.0
    for k in range(corners.shape[0]):
        after = (k + 1) % corners.shape[0]
        nearest = ti.min(nearest, _past(x, y, corners, k, after)[0])
        ex, ey = corners[after, 0] - corners[k, 0], corners[after, 1] - corners[k, 1]
        px, py = x - corners[k, 0], y - corners[k, 1]
        if (py >= 0.0) != (y >= corners[after, 1]) and (px < ex * py / ey):
            sign = -sign
    return sign * nearest


@ti.func
def _off_walls(x, y, corners: ti.template(), walled: ti.template(), wall):
    """Distance to the nearest edge with a wall, larger than `wall` beyond an end next to an open edge.

    A wall thus ends in a straight cut where the neighbouring edge is open.
    """
    nearest, count = 1e30, corners.shape[0]
    for k in range(count):
        if walled[k] == 1:
            after = (k + 1) % count
            length = ti.sqrt((corners[after, 0] - corners[k, 0]) ** 2 + (corners[after, 1] - corners[k, 1]) ** 2)
            place = _past(x, y, corners, k, after)
            distance = place[0]
            if walled[(k + count - 1) % count] == 0:
                distance = ti.max(distance, wall - place[1] * length)
            if walled[after] == 0:
                distance = ti.max(distance, wall + (place[1] - 1.0) * length)
            nearest = ti.min(nearest, distance)
    return nearest


@ti.kernel
def _paint_walls(
    picture: Picture,
    corners: Table,
    walled: Index,
    box: ti.types.vector(4, ti.i32),
    wall: ti.f64,
    wall_colour: Colour,
    inner_colour: Colour,
):
    # The distances change by at most one per pixel, so far from the edges many pixels in a row are equal.
    for row in range(box[1], box[3]):
        column = box[0]
        while column < box[2]:
            x, y = column + 0.5, row + 0.5
            outside = off_outline(x, y, corners)
            alike = ti.max(-outside, outside - wall) - 0.5
            stop = ti.min(column + ti.max(ti.cast(alike, ti.i32), 1), box[2])
            if alike < 0.0 or outside < 0.0:
                inside = ti.math.clamp(0.5 - outside, 0.0, 1.0)
                reached = (1.0 - inside) * ti.math.clamp(wall - _off_walls(x, y, corners, walled, wall) + 0.5, 0.0, 1.0)
                for pixel in range(column, stop):
                    under = colour_of(picture, row, pixel)
                    mix(picture, row, pixel, reached * (wall_colour - under) + inside * (inner_colour - under))
            column = stop


@ti.kernel
def _paint_line(picture: Picture, corners: Table, box: ti.types.vector(4, ti.i32), reach: ti.f64, colour: Colour):
    for row, column in ti.ndrange((box[1], box[3]), (box[0], box[2])):
        nearest = 1e30
        for k in range(corners.shape[0] - 1):
            nearest = ti.min(nearest, _past(column + 0.5, row + 0.5, corners, k, k + 1)[0])
        share = ti.math.clamp(reach - nearest + 0.5, 0.0, 1.0)
        if share > 0.0:
            mix(picture, row, column, share * (colour - colour_of(picture, row, column)))


@ti.func
def _paint_stroke(covered: ti.template(), first, along, half, growth, top, bottom):
    """Add the coverage of a line from `first` in rows top to bottom; a line thinner than a pixel is faint."""
    inverse, reach = 1.0 / ti.max(along.dot(along), 1e-30), ti.max(half, half + growth, 0.5) + 0.5
    left = whole(first.x + ti.min(along.x, 0.0) - reach + 0.5, 0, covered.shape[1])
    right = whole(first.x + ti.max(along.x, 0.0) + reach + 0.5, 0, covered.shape[1])
    upper = whole(first.y + ti.min(along.y, 0.0) - reach + 0.5, top, bottom)
    lower = whole(first.y + ti.max(along.y, 0.0) + reach + 0.5, top, bottom)
    for row in range(upper, lower):
        for column in range(left, right):
            away = ti.Vector([column + 0.5, row + 0.5]) - first
            on = ti.math.clamp(away.dot(along) * inverse, 0.0, 1.0)
            thick, distance = half + on * growth, (away - on * along).norm()
            share = ti.min(2.0 * thick, 1.0) * ti.math.clamp(ti.max(thick, 0.5) - distance + 0.5, 0.0, 1.0)
            covered[row, column] = ti.max(covered[row, column], ti.cast(share, ti.f32))


@ti.kernel
def _paint_strokes(picture: Picture, covered: Shares, starts: Index, members: Index, strokes: Table, colour: Colour):
    for k in range((starts.shape[0] - 1) * PER_TASK):
        if k % PER_TASK == 0:
            band = k // PER_TASK
            top, bottom = band * BAND, ti.min((band + 1) * BAND, picture.shape[0])
            for entry in range(starts[band], starts[band + 1]):
                i = members[entry]
                first = ti.Vector([strokes[i, 0], strokes[i, 1]])
                along = ti.Vector([strokes[i, 3], strokes[i, 4]]) - first
                _paint_stroke(covered, first, along, strokes[i, 2], strokes[i, 5] - strokes[i, 2], top, bottom)
            for row in range(top, bottom):
                for column in range(picture.shape[1]):
                    share = covered[row, column]
                    if share > 0.0:
                        mix(picture, row, column, share * (colour - colour_of(picture, row, column)))
