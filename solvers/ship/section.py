"""A hull's section, a polygon, or the stations of a whole hull: what is under a calm or sloping surface at any pose.

Under a surface z = ζ + s (y − Y) (Y the sway of the hull's origin) a point's depth is d = ζ + s (y − Y) − z. The
coordinates (y, d) are a shear that preserves areas. In them, by Green's theorem, every integral over the immersed part
is one along the outline only: on the surface d = 0, which adds nothing. So immersed pieces of the outline need not be
sorted or closed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.machine.errors import Unavailable

ROUNDING = 1e-12  # of the section's size: shorter lengths count as zero
PAIRS = 1_000_000  # of edges that are compared at once


@dataclass(frozen=True)
class Immersion:
    """The immersed part: area ∫∫dA (m²), ∫∫y dA (m³) with y from the hull's origin, and ∫∫d dA (m³), d the depth.

    Arrays of the poses' shape; `elevation` (m) and `slope` are those of the surface.
    """

    area: np.ndarray
    moment: np.ndarray
    depth_moment: np.ndarray
    elevation: np.ndarray
    slope: np.ndarray

    @property
    def centroid(self) -> np.ndarray:
        """Centroid (…, 2) m in the earth's axes, y from the hull's origin, z from the calm surface; nan if dry."""
        with np.errstate(invalid="ignore", divide="ignore"):
            y, depth = self.moment / self.area, self.depth_moment / self.area
        return np.stack([y, self.elevation + self.slope * y - depth], axis=-1)


@dataclass(frozen=True)
class Waterplane:
    """The waterline's breadth ∫dy (m), ∫y dy (m²) and ∫y² dy (m³), y from the hull's origin."""

    breadth: np.ndarray
    moment: np.ndarray
    second_moment: np.ndarray


class Immersible:
    """What hydrostatics ask of a hull, per metre of her: `outlines`, each with its share of that metre."""

    outlines: Sequence[tuple[np.ndarray, float]]

    @cached_property
    def size(self) -> float:
        """The larger of the width and height (m) of the largest section."""
        return max(float(np.ptp(outline, axis=0).max()) for outline, _ in self.outlines)

    @cached_property
    def area(self) -> float:
        """Area (m²) of the whole section, or volume a metre of the whole hull."""
        return sum(share * _enclosed(outline) for outline, share in self.outlines)

    @cached_property
    def corners(self) -> np.ndarray:
        """The corners (k, 2) m of all outlines."""
        return np.concatenate([outline for outline, _ in self.outlines])

    def immersion(self, heave, roll, elevation=0.0, slope=0.0) -> Immersion:
        """The part below the surface `elevation` (m) + `slope` (∂ζ/∂y) × y, at poses that broadcast together."""
        y, depth, elevation, slope = self._below(heave, roll, elevation, slope)
        y0, d0, y1, d1 = clipped(y, depth)
        along = self._chain[1] * (y1 - y0)
        area = 0.5 * along * (d0 + d1)
        moment = along / 6.0 * (y0 * (2.0 * d0 + d1) + y1 * (d0 + 2.0 * d1))
        depth_moment = along / 6.0 * (d0 * d0 + d0 * d1 + d1 * d1)
        return Immersion(area.sum(-1), moment.sum(-1), depth_moment.sum(-1), elevation, slope)

    def waterplane(self, heave, roll, elevation=0.0, slope=0.0) -> Waterplane:
        """Breadth and moments of the waterline, at poses that broadcast together."""
        y, depth, _, _ = self._below(heave, roll, elevation, slope)
        crossing, sign = crossings(y, depth)
        powers = [(self._chain[1] * sign * crossing**n / n).sum(-1) for n in (1, 2, 3)]
        return Waterplane(*powers)

    @cached_property
    def _chain(self) -> tuple[np.ndarray, np.ndarray]:
        """All corners (k + 1, 2) m, outlines closed, and shares (k,) of the edges, 0 from one outline to the next."""
        closed = [np.concatenate([outline, outline[:1]]) for outline, _ in self.outlines]
        shares = [np.append(np.full(len(outline), share), 0.0) for outline, share in self.outlines]
        return np.concatenate(closed), np.concatenate(shares)[:-1]

    def _below(self, heave, roll, elevation, slope):
        """Corners' y from the hull's origin and depth (…, m), the first of an outline again at its end; the surface."""
        heave, roll, elevation, slope = np.broadcast_arrays(heave, roll, elevation, slope)
        corners, _ = self._chain
        cos, sin = np.cos(roll)[..., None], np.sin(roll)[..., None]
        y = cos * corners[:, 0] - sin * corners[:, 1]
        z = heave[..., None] + sin * corners[:, 0] + cos * corners[:, 1]
        return y, elevation[..., None] + slope[..., None] * y - z, elevation, slope


@dataclass(frozen=True, eq=False)
class Section(Immersible):
    """A section: a simple polygon (m, 2) of y, z in m, counter-clockwise, in the hull's own frame.

    Raises `Unavailable` for any other outline.
    """

    outline: np.ndarray

    def __post_init__(self):
        outline = np.array(self.outline, dtype=float)
        object.__setattr__(self, "outline", outline)
        _check(outline)

    @property
    def outlines(self) -> list[tuple[np.ndarray, float]]:
        """Its outline, all along."""
        return [(self.outline, 1.0)]

    @cached_property
    def top(self) -> float:
        """Breadth (m) of its uppermost twentieth: a deck's, also one with camber, or little."""
        y, z = self.outline.T
        return float(np.ptp(y[z >= z.max() - 0.05 * np.ptp(z)]))

    def waterlines(self, heave: float, roll: float, elevation: float = 0.0, slope: float = 0.0) -> np.ndarray:
        """Ends (k, 2, 2) m of the waterline's k pieces at one pose, from port to starboard, in the earth's axes.

        Each end is y from the hull's origin and z.
        """
        y, depth, _, _ = self._below(heave, roll, elevation, slope)
        crossing, sign = crossings(y, depth)
        ends = np.sort(crossing[sign != 0.0]).reshape(-1, 2)
        ends = ends[np.ptp(ends, axis=1) > ROUNDING * self.size]
        return np.stack([ends, elevation + slope * ends], axis=-1)

    def wet_edges(self, heave: float, roll: float) -> np.ndarray:
        """Start and end (k, 2, 2) m of each edge's part below calm water, the water to its right, earth's axes."""
        y, depth, _, _ = self._below(heave, roll, 0.0, 0.0)
        y0, d0, y1, d1 = clipped(y, depth)
        wet = np.hypot(y1 - y0, d1 - d0) > ROUNDING * self.size
        return np.stack([np.stack([y0, -d0], axis=-1), np.stack([y1, -d1], axis=-1)], axis=1)[wet]


@dataclass(frozen=True, eq=False)
class Stations(Immersible):
    """A whole hull that keeps her trim: sections side by side, with their shares (n,) of her length.

    All are in the hull's own frame. In beam waves the surface is the same for all of them.
    """

    sections: Sequence[Section]
    shares: np.ndarray

    @property
    def outlines(self) -> list[tuple[np.ndarray, float]]:
        """Each station's outline with its share."""
        return [(section.outline, float(share)) for section, share in zip(self.sections, self.shares, strict=True)]


def box(width: float, height: float) -> Section:
    """A rectangular section (m) whose origin is the middle of its bottom."""
    half = 0.5 * width
    return Section(np.array([[-half, 0.0], [half, 0.0], [half, height], [-half, height]]))


def clipped(y: np.ndarray, depth: np.ndarray):
    """Start y, depth and end y, depth (…, m) of the edges' immersed parts; dry edges have zero length."""
    y0, d0, y1, d1 = y[..., :-1], depth[..., :-1], y[..., 1:], depth[..., 1:]
    crossing = _crossing(y0, d0, y1, d1)
    in0, in1 = d0 > 0.0, d1 > 0.0
    # A dry end moves to the crossing; an edge that is wholly dry shrinks to a point on the surface.
    start_y, end_y = np.where(in0, y0, crossing), np.where(in1, y1, crossing)
    return start_y, np.where(in0, d0, 0.0), end_y, np.where(in1, d1, 0.0)


def _crossing(y0, d0, y1, d1) -> np.ndarray:
    """The y at which edges cross the surface; an arbitrary point for edges that do not."""
    cuts = (d0 > 0.0) != (d1 > 0.0)
    share = np.where(cuts, d0 / np.where(cuts, d0 - d1, 1.0), 0.0)
    return y0 + share * (y1 - y0)


def crossings(y: np.ndarray, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The y (…, m) at which each edge leaves (sign 1) or enters (−1) the water; sign 0 if it does neither."""
    y0, d0, y1, d1 = y[..., :-1], depth[..., :-1], y[..., 1:], depth[..., 1:]
    sign = (d0 > 0.0).astype(float) - (d1 > 0.0)
    return np.where(sign != 0.0, _crossing(y0, d0, y1, d1), 0.0), sign


def _check(outline: np.ndarray) -> None:
    """Raise `Unavailable`, one sentence, if an outline is not a simple polygon, counter-clockwise."""
    if outline.ndim != 2 or outline.shape[1] != 2 or len(outline) < 3:
        raise Unavailable("the hull's outline needs at least three corners of two coordinates (y, z).")
    if not np.isfinite(outline).all():
        raise Unavailable("the hull's outline has a coordinate that is not a finite number.")
    size = float(np.ptp(outline, axis=0).max())
    edges = np.roll(outline, -1, axis=0) - outline
    short = np.flatnonzero(np.hypot(*edges.T) <= ROUNDING * size)
    if len(short):
        raise Unavailable(f"the hull's outline has the same corner twice in a row, at number {short[0] + 1}.")
    crossed = _first_crossing(outline, edges)
    if crossed is not None:
        raise Unavailable(f"the hull's outline crosses or touches itself: edges {crossed[0] + 1} and {crossed[1] + 1}.")
    if _enclosed(outline) <= 0.0:
        raise Unavailable("the hull's outline runs clockwise; list its corners the other way round.")


def _enclosed(outline: np.ndarray) -> float:
    """Signed area (m²) by the shoelace formula."""
    y, z = outline.T
    return float(0.5 * (y @ np.roll(z, -1) - z @ np.roll(y, -1)))


def _first_crossing(outline: np.ndarray, edges: np.ndarray) -> tuple[int, int] | None:
    """The first two edges that share a point they should not, or None."""
    count = len(outline)
    number = np.arange(count)
    after = np.roll(edges, -1, axis=0)
    turn, ahead = _cross(edges, after), (edges * after).sum(axis=1)
    folds = np.flatnonzero((ahead < 0.0) & (np.abs(turn) <= ROUNDING * -ahead))  # edges on which the next folds back
    fold = int(folds[0]) if len(folds) else count
    lower, upper = np.minimum(outline, outline + edges), np.maximum(outline, outline + edges)
    rows = max(1, PAIRS // count)
    for begin in range(0, min(count, fold), rows):
        k = number[begin : begin + rows, None]
        near = (number >= k + 2) & ((number + 1) % count != k)
        for y in (0, 1):
            near &= (lower[:, y] <= upper[k, y]) & (upper[:, y] >= lower[k, y])
        one, other = np.nonzero(near)
        one += begin
        found = np.flatnonzero(_meet(outline[one], edges[one], outline[other], edges[other]))
        if len(found) and one[found[0]] < fold:
            return int(one[found[0]]), int(other[found[0]])
    return None if fold == count else (min(fold, (fold + 1) % count), max(fold, (fold + 1) % count))


def _meet(start: np.ndarray, along: np.ndarray, starts: np.ndarray, alongs: np.ndarray) -> np.ndarray:
    """Whether segments (n, 2) whose boxes overlap share a point with as many others, each with one."""
    a, b = _cross(along, starts - start), _cross(along, starts + alongs - start)
    c, d = _cross(alongs, start - starts), _cross(alongs, start + along - starts)
    return (a * b <= 0.0) & (c * d <= 0.0)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
