"""Paint the water of a tank over a picture: all pixels where the level of a grid is above one half.

The distance of a pixel from the surface follows from the level and its slope. It gives the covered share of the pixels
along the edge, and the line that is drawn along the surface.
"""

from dataclasses import dataclass

import numpy as np
import taichi as ti

from lab.paint.painter import BAND, PER_TASK, Camera, Colour, Picture, Shares, Table, colour_of, mix, off_outline, whole
from lab.paint.water.grid import Grid

HALF = 0.5  # the level on the surface
NEAR_WALL = 2.0  # nodes; nearer to it, the distance from the outline is not interpolated but computed


@dataclass(frozen=True)
class Paints:
    """Colours of the surface: a table (k, 3) along the tone, mixed with shade colours by height where `shaded`.

    upper, lower: of the water at the highest and the lowest row of the tank; edge: of the line along the surface,
    `line` pixels thick and this `strong`; under: the colour of the empty tank below it, all in 0..255.
    """

    table: np.ndarray
    upper: tuple
    lower: tuple
    edge: tuple
    under: tuple
    line: float
    strong: float
    shaded: bool


def paint_surface(
    picture: np.ndarray, camera: Camera, grid: Grid, level: np.ndarray, tone: np.ndarray, paints: Paints
) -> None:
    """Paint water over a picture (height, width, 3), u8, in place; the camera is that of the tank's points.

    level, tone (rows, columns): at the nodes of the grid, the tone in 0..1 along the table; where the paints are
    shaded it is how far the water has the table's last colour, as foam has.
    """
    corners = camera.pixels(grid.outline)
    whole_grid = camera.pixels(_corners(grid))
    height, width, _ = picture.shape
    left, top = np.clip(np.floor(whole_grid.min(axis=0)), 0, [width, height]).astype(int)
    right, bottom = np.clip(np.ceil(whole_grid.max(axis=0)), 0, [width, height]).astype(int)
    if left >= right or top >= bottom:
        return
    _paint(
        picture,
        level.astype(np.float32),
        tone.astype(np.float32),
        grid.distances,
        corners,
        _to_nodes(camera, grid),
        np.ascontiguousarray(paints.table, dtype=np.float64),
        ti.Vector([left, top, right, bottom]),
        ti.Vector([float(corners[:, 1].min()), float(corners[:, 1].max())]),
        ti.Vector([camera.scale * grid.distance, camera.scale, paints.line, paints.strong]),
        Colour(paints.upper),
        Colour(paints.lower),
        Colour(paints.edge),
        Colour(paints.under),
        paints.shaded,
        bool(grid.open_edges),
    )


def _corners(grid: Grid) -> np.ndarray:
    """The corners (4, 2) of a grid, m."""
    right, top = grid.low[0] + grid.distance * (grid.columns - 1), grid.low[1] + grid.distance * (grid.rows - 1)
    return np.array([grid.low, (right, grid.low[1]), (right, top), (grid.low[0], top)])


def _to_nodes(camera: Camera, grid: Grid) -> np.ndarray:
    """Rows (2, 3): column and row of the nodes as 1, x and y of the pixels give them; inverts `Camera.pixels`."""
    cosine, sine = np.cos(camera.turn), np.sin(camera.turn)
    x, y = camera.offset
    turned = np.array([[cosine, -sine], [-sine, -cosine]]) / camera.scale
    start = -turned @ np.array([x, y]) - np.array(grid.low)
    return np.column_stack([start, turned]) / grid.distance


@ti.func
def _bilinear(field: ti.template(), left, low, x, y):
    below = (1.0 - x) * field[low, left] + x * field[low, left + 1]
    above = (1.0 - x) * field[low + 1, left] + x * field[low + 1, left + 1]
    return (1.0 - y) * below + y * above


@ti.func
def _slope(field: ti.template(), left, low, x, y):
    """Slope of the interpolated field, a node."""
    one, two = field[low, left], field[low, left + 1]
    three, four = field[low + 1, left], field[low + 1, left + 1]
    across, up = (1.0 - y) * (two - one) + y * (four - three), (1.0 - x) * (three - one) + x * (four - two)
    return ti.sqrt(across * across + up * up)


@ti.func
def _inside(x, y, away, node, scale, corners: ti.template(), is_open: ti.template()):
    """Share of a pixel inside the tank, from the interpolated distance `away` (m), negative inside."""
    outside = away * scale
    if ti.static(not is_open):  # noqa: SIM102 (only the outer one is known as the kernel is compiled)
        if ti.abs(outside) < NEAR_WALL * node + 1.0:
            outside = off_outline(x, y, corners)
    return ti.math.clamp(0.5 - outside, 0.0, 1.0)


@ti.func
def _table_colour(table: ti.template(), tone):
    k = ti.cast(ti.math.clamp(tone * table.shape[0], 0.0, table.shape[0] - 1.0), ti.i32)
    return ti.Vector([table[k, 0], table[k, 1], table[k, 2]])


@ti.kernel
def _paint(
    picture: Picture,
    level: Shares,
    tone: Shares,
    distances: Shares,
    corners: Table,
    to_nodes: Table,
    table: Table,
    box: ti.types.vector(4, ti.i32),
    span: ti.types.vector(2, ti.f64),
    sizes: ti.types.vector(4, ti.f64),
    upper: Colour,
    lower: Colour,
    edge: Colour,
    under: Colour,
    shaded: ti.template(),
    is_open: ti.template(),
):
    node, scale, line, strong = sizes[0], sizes[1], sizes[2], sizes[3]
    bands = (box[3] - box[1] + BAND - 1) // BAND
    for k in range(bands * PER_TASK):
        if k % PER_TASK == 0:
            top = box[1] + k // PER_TASK * BAND
            for row in range(top, ti.min(top + BAND, box[3])):
                py = row + 0.5
                height = ti.math.clamp((py - span[0]) / ti.max(span[1] - span[0], 1.0), 0.0, 1.0)
                for column in range(box[0], box[2]):
                    px = column + 0.5
                    u = to_nodes[0, 0] + to_nodes[0, 1] * px + to_nodes[0, 2] * py
                    v = to_nodes[1, 0] + to_nodes[1, 1] * px + to_nodes[1, 2] * py
                    if u >= 0.0 and v >= 0.0 and u < level.shape[1] - 1.0 and v < level.shape[0] - 1.0:
                        left, low = whole(u, 0, level.shape[1] - 2), whole(v, 0, level.shape[0] - 2)
                        x, y = u - left, v - low
                        here = _bilinear(level, left, low, x, y)
                        slope = ti.max(_slope(level, left, low, x, y) / node, 1e-6)
                        deep = (here - HALF) / slope  # pixels below the surface
                        share = ti.math.clamp(deep + 0.5, 0.0, 1.0)
                        inside = 0.0
                        if share > 0.0:
                            away = _bilinear(distances, left, low, x, y)
                            inside = _inside(px, py, away, node, scale, corners, is_open)
                        if inside > 0.0:
                            shown = ti.cast(_bilinear(tone, left, low, x, y), ti.f64)
                            paint = upper + height * (lower - upper)
                            rim = strong * ti.math.clamp(line - deep + 0.5, 0.0, 1.0)
                            if ti.static(shaded):
                                paint += shown * (_table_colour(table, 1.0) - paint)
                                rim *= 1.0 - shown  # foam has no sharp edge
                            else:
                                paint = _table_colour(table, shown)
                            paint += rim * (edge - paint)
                            below = under  # beside a wall, whose own share of the pixel stays as it is
                            if inside == 1.0:
                                below = colour_of(picture, row, column)
                            mix(picture, row, column, share * inside * (paint - below))
