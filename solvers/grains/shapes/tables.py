"""Tables of outlines for kernels: points by place along the outline, polar radii by direction, no trigonometry."""

from math import ceil, log2, pi

import numpy as np
import taichi as ti

from solvers.grains.shapes.contour import Contour
from solvers.machine.errors import BadOutline
from solvers.machine.state import State
from solvers.space.extremes import greater, lesser

ERROR = 1e-6  # of R0, the largest error of a table
LEAST, MOST = 64, 4096  # cells
LOOKS = 128  # points of an outline, at least, from which contacts are sought
MISSED = 1e-3  # of R0: overlap by which two contacts may differ that fit in between two of these points
BETWEEN = np.array([0.25, 0.5, 0.75])  # of a cell, where the error is sampled; it is largest near the middle
TINY = 1e-30
FLAT = 1e3  # of a grain's radius: upper bound of a radius of curvature


@ti.data_oriented
class Tables:
    """Cubic Hermite interpolants of the outlines of C classes, each cut into `cells`, a power of two.

    Points are equally spaced by polar angle: a place a on an outline is θ = 2π a/cells, up to whole turns. Polar radii
    are equally spaced by slope in each quadrant about an axis, since they are looked up by a point's coordinates. Both
    have continuous first derivatives, and second ones within a cell. Lengths are those of the contours; a grain is
    similar to its class, `scale` times as large. Raises BadOutline if an outline needs more than MOST cells.
    """

    def __init__(self, arrays: State, outlines: list[Contour]):
        self.cells = cells_for(outlines)
        self.looks = looks_for(outlines, self.cells)
        own = arrays.under("outlines")
        self.curve = own.holding(
            "curve", np.array([curve_cells(outline, self.cells) for outline in outlines]), "outline cell number"
        )
        self.radii = own.holding(
            "radii", np.array([polar_cells(outline, self.cells) for outline in outlines]), "outline cell number"
        )
        self.bounding = own.holding("bounding", np.array([outline.bounding_radius for outline in outlines]), "outline")
        self.convex = own.holding("convex", np.array([float(outline.convex) for outline in outlines]), "outline")
        self.smallest = own.holding("smallest", np.array([outline.smallest_radius for outline in outlines]), "outline")

    @ti.func
    def wrapped(self, place):
        """A place reduced to 0 ≤ a < `cells`, without whole turns."""
        return place - self.cells * ti.floor(place / self.cells)

    @ti.func
    def cell(self, place):
        """The cell of a place, and the fraction within it."""
        whole = ti.floor(place)
        return ti.cast(whole, ti.i32) & (self.cells - 1), place - whole

    @ti.func
    def trace(self, shape, place):
        """Point of an outline and its first two derivatives by place: x, y (m), x', y' (m/cell), x'', y'' (m/cell²)."""
        k, f = self.cell(place)
        x = ti.Vector([self.curve[shape, k, n] for n in ti.static(range(4))])
        y = ti.Vector([self.curve[shape, k, 4 + n] for n in ti.static(range(4))])
        return ti.Vector([value(x, f), value(y, f), slope(x, f), slope(y, f), bend(x, f), bend(y, f)])

    @ti.func
    def radius(self, shape, x, y):
        """Polar radius R (m) of an outline in the direction of a point (x, y)."""
        k, f = self.cell(self.direction(x, y)[0])
        return value(ti.Vector([self.radii[shape, k, n] for n in ti.static(range(4))]), f)

    @ti.func
    def radius_and_slope(self, shape, x, y):
        """R (m) and dR/dθ (m) in the direction of a point (x, y)."""
        place, tilt = self.direction(x, y)
        k, f = self.cell(place)
        r = ti.Vector([self.radii[shape, k, n] for n in ti.static(range(4))])
        return ti.Vector([value(r, f), slope(r, f) * (1.0 + tilt * tilt) * (self.cells / 8.0)])

    @ti.func
    def curved(self, shape, x, y):
        """Radius of curvature (m) of an outline in the direction of a point, at most FLAT times the polar radius.

        (R² + R'²)^(3/2)/(R² + 2 R'² − R R'').
        """
        place, tilt = self.direction(x, y)
        k, f = self.cell(place)
        c, more = ti.Vector([self.radii[shape, k, n] for n in ti.static(range(4))]), 1.0 + tilt * tilt
        # Derivatives by angle; the cells are equally spaced by its tangent.
        r, by_tilt = value(c, f), slope(c, f) * (self.cells / 8.0)
        dr, ddr = by_tilt * more, more * (bend(c, f) * (self.cells / 8.0) ** 2 * more + 2.0 * tilt * by_tilt)
        size = r * r + dr * dr
        return radius_of_curvature(ti.sqrt(size) ** 3, size + dr * dr - r * ddr, r)

    @ti.func
    def direction(self, x, y):
        """Place of the direction of (x, y) among the cells, 0 to `cells`, and its slope about the nearest axis."""
        steep = ti.abs(y) > ti.abs(x)
        along, across = ti.select(steep, y, x), ti.select(steep, -x, y)
        quadrant = ti.select(steep, 1.0, 0.0) + ti.select(along < 0.0, 2.0, 0.0)
        tilt = across / ti.select(along == 0.0, TINY, along)
        return (quadrant + 0.5 * (tilt + 1.0)) * (self.cells / 4.0), tilt


@ti.func
def advanced(own, step):
    """Point of an outline and its derivatives (`Tables.trace`) after a short step, to second order."""
    return ti.Vector(
        [
            own[0] + step * (own[2] + 0.5 * step * own[4]),
            own[1] + step * (own[3] + 0.5 * step * own[5]),
            own[2] + step * own[4],
            own[3] + step * own[5],
            own[4],
            own[5],
        ]
    )


@ti.func
def radius_of_curvature(cube, turns, size):
    """The ratio cube/turns, with an absolute value of at most FLAT times `size`."""
    least = cube / (FLAT * size)
    return cube / ti.select(turns < 0.0, lesser(turns, -least), greater(turns, least))


@ti.func
def value(c, f):
    """Value at f of the cubic with coefficients c, from the constant up."""
    return c[0] + f * (c[1] + f * (c[2] + f * c[3]))


@ti.func
def slope(c, f):
    """First derivative of the cubic with coefficients c."""
    return c[1] + f * (2.0 * c[2] + f * (3.0 * c[3]))


@ti.func
def bend(c, f):
    """Second derivative of the cubic with coefficients c."""
    return 2.0 * c[2] + f * (6.0 * c[3])


def cells_for(outlines: list[Contour]) -> int:
    """Number of cells, a power of two, with which all tables of these outlines are within ERROR."""
    count = LEAST
    while max(table_error(outline, count) for outline in outlines) > ERROR:
        count *= 2
        if count > MOST:
            raise BadOutline(f"the outline bends too sharply for a table of {MOST} points.")
    return count


def looks_for(outlines: list[Contour], cells: int) -> int:
    """Points of an outline from which contacts are sought, a power of two.

    Two minima and their saddle may hide between points a distance h apart; where the curvature changes by κ' along the
    outlines, their gaps then differ by at most κ' h³/12.
    """
    wanted = 2.0 * pi * (max(one.sharpest_change * one.radius**2 for one in outlines) / (12.0 * MISSED)) ** (1 / 3)
    return min(max(LOOKS, 2 ** ceil(log2(max(wanted, 1.0)))), cells)


def table_error(outline: Contour, count: int) -> float:
    """Largest error, relative to R0, of a point or a polar radius in tables with `count` cells."""
    place = np.arange(count)[:, None] + BETWEEN
    powers = BETWEEN ** np.arange(4)[:, None]
    cells = curve_cells(outline, count)
    points = np.stack([cells[:, :4] @ powers, cells[:, 4:] @ powers], axis=-1) - outline.points(
        2 * np.pi * place / count
    )
    radii = polar_cells(outline, count) @ powers - outline.polar(angle_of(place, count))
    return max(np.linalg.norm(points, axis=-1).max(), np.abs(radii).max()) / outline.radius


def curve_cells(outline: Contour, count: int) -> np.ndarray:
    """Coefficients (count, 8) of x and y in each cell, with cells equally spaced by polar angle."""
    angle = 2.0 * np.pi / count * np.arange(count + 1)
    turn = np.exp(1j * angle)
    points = outline.polar(angle) * turn
    along = (outline.polar(angle, 1) * turn + 1j * points) * (2.0 * np.pi / count)
    return np.concatenate([_hermite(points.real, along.real), _hermite(points.imag, along.imag)], axis=-1)


def polar_cells(outline: Contour, count: int) -> np.ndarray:
    """Coefficients (count, 4) of R in each cell of directions."""
    place = np.arange(count + 1.0)
    angle = angle_of(place, count)
    tilt = np.mod(place, count / 4) * (8 / count) - 1.0
    return _hermite(outline.polar(angle), outline.polar(angle, 1) * (8 / count) / (1.0 + tilt**2))


def angle_of(place: np.ndarray, count: int) -> np.ndarray:
    """Polar angle (rad) of a place among `count` cells of directions."""
    quadrant = np.floor(4.0 * place / count)
    return 0.5 * np.pi * quadrant + np.arctan(2.0 * (4.0 * place / count - quadrant) - 1.0)


def _hermite(values: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Coefficients (n, 4) of the cubics with values and slopes (n + 1,) at their ends, for cells of width 1."""
    a, b, p, q = values[:-1], values[1:], slopes[:-1], slopes[1:]
    return np.stack([a, p, 3.0 * (b - a) - 2.0 * p - q, 2.0 * (a - b) + p + q], axis=-1)
