"""Rasterise grains: discs, and irregular ones by a table of their polar radius, with relief, rim and texture."""

from collections.abc import Sequence
from dataclasses import astuple, dataclass

import numpy as np
import taichi as ti

from lab.paint.raster.base import (
    BAND,
    PER_TASK,
    Camera,
    Index,
    Picture,
    Shares,
    Table,
    box_around,
    colour_of,
    mix,
    put,
    sort_into_bands,
    whole,
)
from solvers.grains.shapes.contour import Contour

SHADE = 0.10  # how much lighter the top and darker the bottom of a grain is
LIT = -0.5, -0.866  # direction (right, down) towards the light that shows relief
BULGE, FALL = 0.26, 0.30  # of a grain with full relief: across the light, and from its middle to its edge
GLINT = 0.42, 0.5  # place of the glint towards the light and its size, relative to the radius
FACETS = 0.45, 0.30  # size of the upper facet relative to the radius, and how much the others differ
RIM = 0.32  # how much darker the rim is
RIM_SHARE, RIM_MOST = 0.14, 3.0  # width of the rim relative to the radius; its maximum in pixels
COARSE = 2.5  # pixels; grains of a smaller radius have no facets
DIRECTIONS = 512  # entries of a table of polar radii; linear interpolation errs by up to 6e-4 of a radius for rice


@dataclass(frozen=True)
class Finish:
    """How the surface of a grain is painted; lengths relative to its radius.

    relief: 0 flat to 1 round; gloss: strength of the glint; facets: 1 as broken stone, 0 smooth; along, across: place
    of the mark in the grain's axes; length, width: its half axes; strength: its opacity.
    """

    relief: float = 0.0
    gloss: float = 0.0
    facets: float = 0.0
    along: float = 0.52
    across: float = 0.0
    length: float = 0.21
    width: float = 0.21
    strength: float = 0.55

    def rows(self, count: int) -> np.ndarray:
        """The finish (count, 8) of as many grains."""
        return np.tile(np.array(astuple(self)), (count, 1))


FLAT = Finish()


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
    picture: np.ndarray,
    discs: np.ndarray,
    colour: np.ndarray,
    mark: np.ndarray,
    edges: Edges | None = None,
    finish: np.ndarray | None = None,
) -> None:
    """Paint discs (n, 5), or irregular grains with their areas, over a picture (height, width, 3), u8, in place.

    colour and mark (of spin): (n, 3) in 0..255. edges: of irregular grains, turned by the angle of their marks.
    finish (n, 8): rows of `Finish`; None: flat. Grains without a finite position are left out.
    """
    seen = np.isfinite(discs).all(axis=1)
    rows = FLAT.rows(len(discs)) if finish is None else finish
    paints = np.column_stack([colour, mark, rows]).astype(float)[seen]
    discs = discs[seen]
    if edges is None:
        reach, which, radii = discs[:, 2], np.zeros(1, dtype=np.int32), np.zeros((1, 1))
    else:
        which, radii = edges.which[seen].astype(np.int32), edges.radii
        reach = discs[:, 2] * radii.max(axis=1)[which]
    if not len(discs):
        return
    _, top, _, bottom = box_around(picture, discs[:, :2], float(reach.max()) + 1.0)
    part, boxed = picture[top:bottom], np.column_stack([discs, reach])  # the rows that hold grains
    boxed[:, 1] -= top
    starts, members = sort_into_bands(boxed[:, 1], reach + 1.0, bottom - top)
    if len(members):
        covered = np.zeros(part.shape[:2], dtype=np.float32)
        _paint_bands(part, part.copy(), covered, starts, members, boxed, paints, which, radii, edges is not None)


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
def _depth(offset, radius, towards, radii: ti.template(), row):
    """Depth (pixels) of a point inside an outline, negative outside: (R - rho)/sqrt(1 + (R'/R)^2), and rho/R.

    Near the edge the first is the distance from it. As for a disc, the edge is moved inwards by 1/(24 r), so that the
    ramp around it covers the right area (along any closed curve the ramp adds pi/12: own derivation).
    """
    along, across = offset.dot(towards), offset.x * towards.y - offset.y * towards.x
    turn = ti.atan2(across, along) / (2.0 * ti.math.pi)
    place = (turn - ti.floor(turn)) * DIRECTIONS
    k = ti.min(ti.cast(place, ti.i32), DIRECTIONS - 1)
    rise = radii[row, (k + 1) % DIRECTIONS] - radii[row, k]
    polar = radii[row, k] + (place - k) * rise
    steepness = rise * (DIRECTIONS / (2.0 * ti.math.pi)) / polar
    edge = ti.sqrt(ti.max(radius * radius, 1.0 / 3.0) - 1.0 / 12.0) * polar
    away = offset.norm()
    return ti.Vector([(edge - away) / ti.sqrt(1.0 + steepness * steepness), away / ti.max(edge, 1e-9)])


@ti.func
def _shares(offset, radius, rim, towards, radii: ti.template(), row, irregular: ti.template()):
    """Share of a pixel that a grain covers, the same with its edge moved inwards by `rim`, and rho/R."""
    found = ti.Vector([0.0, 0.0, 0.0])
    if ti.static(irregular):
        deep, faint = _depth(offset, radius, towards, radii, row), ti.min(3.0 * radius * radius, 1.0)
        found[0] = faint * ti.math.clamp(deep[0] + 0.5, 0.0, 1.0)
        found[1] = faint * ti.math.clamp(deep[0] - rim + 0.5, 0.0, 1.0)
        found[2] = deep[1]
    else:
        away = offset.norm()
        found = ti.Vector([_coverage(away, radius), _coverage(away, radius - rim), away / radius])
    return found


@ti.func
def _facet(along, across, towards, radius):
    """How much lighter a facet of broken stone is, from its direction to the light; the facets turn with the grain."""
    best, light = -1.0, 0.0
    for x, y in ti.static(((1.0, 0.0), (0.17, 0.98), (-0.87, 0.5), (-0.82, -0.57), (0.34, -0.94))):
        reach = x * along + y * across
        if reach > best:
            best = reach
            right, down = x * towards.x + y * towards.y, x * towards.y - y * towards.x
            light = right * LIT[0] + down * LIT[1]
    return ti.select(best > FACETS[0] * radius, FACETS[1] * light, 0.06)


@ti.func
def _light(offset, radius, edge, inner, along, across, towards, paints: ti.template(), i):
    """Brightness of a grain at an offset from its middle, 1 in the middle; `edge`: 0 in the middle, 1 at the edge."""
    relief, size = paints[i, 6], ti.max(radius, 1.0)
    lit = (offset.x * LIT[0] + offset.y * LIT[1]) / size
    light = 1.0 - SHADE * offset.y / size + relief * (BULGE * lit - FALL * edge * edge)
    if paints[i, 8] > 0.0 and radius > COARSE:
        light = 1.0 + _facet(along, across, towards, size)
    rim = RIM * ti.math.clamp((radius - 1.0) / 3.0, 0.0, 1.0)
    return light - rim * (1.0 - inner)


@ti.func
def _grain_paint(offset, radius, edge, inner, towards, paints: ti.template(), i):
    """Colour of a grain at an offset (right, down) from its middle: shading, rim outside `inner`, mark and glint."""
    along, across = offset.dot(towards), offset.x * towards.y - offset.y * towards.x
    light = _light(offset, radius, edge, inner, along, across, towards, paints, i)
    paint = light * ti.Vector([paints[i, 0], paints[i, 1], paints[i, 2]])
    length, width = paints[i, 11] * radius, paints[i, 12] * radius
    x, y = along - paints[i, 9] * radius, across - paints[i, 10] * radius
    if ti.abs(x) < length + 1.0 and ti.abs(y) < width + 1.0:
        off = ti.sqrt((x / length) ** 2 + (y / width) ** 2)
        marked = paints[i, 13] * ti.math.clamp((1.0 - off) * width + 0.5, 0.0, 1.0) * ti.min(1.0, 2.0 * width)
        paint += marked * (
            ti.math.clamp(light, 0.6, 1.0) * ti.Vector([paints[i, 3], paints[i, 4], paints[i, 5]]) - paint
        )
    if paints[i, 7] > 0.0:
        glint = (offset / radius - GLINT[0] * ti.Vector([LIT[0], LIT[1]])).norm_sqr() / GLINT[1] ** 2
        paint += paints[i, 7] * ti.max(1.0 - glint, 0.0) ** 2 * (255.0 - paint)
    return paint


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
                reach, row_of, rim = discs[i, 5], 0, ti.min(RIM_SHARE * radius, RIM_MOST)
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
                        shares = _shares(offset, radius, rim, towards, radii, row_of, irregular)
                        share = ti.min(shares[0], free)
                        if share > 0.0:
                            covered[row, column] += ti.cast(share, ti.f32)
                            paint = _grain_paint(offset, radius, shares[2], shares[1], towards, paints, i)
                            if share == 1.0:
                                put(picture, row, column, paint)
                            else:
                                mix(picture, row, column, share * (paint - colour_of(under, row, column)))
