"""Openings between rooms, and to the sea: what flows through them, exactly, at any heel and trim.

    Q = C_d ∫ √(2 g Δh(z)) dA,   Δh(z) = a_1 + max(h_1, z) − a_2 − max(h_2, z)

Source: Torricelli (1643), Dillingham (1981). At each height of the opening the water goes where the head is lower, both
ways at once where levels and air pressures cross.
h_i are the levels on the two sides and a_i = (p_i − p_0) / ρ g the heads of their air's overpressure, z heights above
the sea. Of an upright rectangle of width b and height D with its sill at z = 0, between an outer level H > D and an
empty room, that is (2/3) C_d b √(2 g) [H^(3/2) − (H − D)^(3/2)]; of a drowned one C_d b D √(2 g Δh).

An opening is a flat polygon. Between its corners and the heights where Δh has a bend, width and head are linear in
height, and ∫ w √Δh is a rational function of √Δh at the two ends; no strips are summed. Heads below LEAST of the hull's
depth count in proportion, not by the root, so that rooms at rest stay so.

Where the side with the higher pressure is dry, air flows, by the same law with its own density.

Limits: no inertia of the water in the opening, none of the waves in the rooms; C_d is 0.6 for sharp edges (0.58 to 0.8,
by edge and scale).
Units: m, m³/s.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

SEA = "sea"
LEAST, LEAST_OF_AIR = 1e-4, 1e-3  # of the hull's depth: heads below count in proportion, of water and of air
ROUND = 48  # corners of a circle, of its area
FACES = {"side": 1, "bulkhead": 0, "deck": 2}  # the axis that an opening's plane is square to


@dataclass(frozen=True, eq=False)
class Opening:
    """A hole between two rooms, or a room and the sea: `between` has their names, `corners` (k, 3) m are in the plane.

    `opens` (s): closed before, but for a share `leak` of its area that lets water by from a head of `leak_head` (m).
    `collapse` (m): the head at which a closed door gives way. None: never.
    """

    name: str
    between: tuple[str, str]
    corners: np.ndarray
    discharge: float = 0.6
    opens: float | None = 0.0
    leak: float = 0.0
    leak_head: float = 0.0
    collapse: float | None = None

    @cached_property
    def centre(self) -> np.ndarray:
        """The mean of the corners (3,) m."""
        return self.corners.mean(axis=0)

    @cached_property
    def plane(self) -> tuple[np.ndarray, np.ndarray]:
        """Two unit vectors (2, 3) in its plane, and the corners (k + 1, 2) m along them, closed."""
        away = self.corners - self.centre
        _, _, axes = np.linalg.svd(away)
        flat = away @ axes[:2].T
        return axes[:2], np.concatenate([flat, flat[:1]])

    @cached_property
    def area(self) -> float:
        """Area (m²)."""
        y, z = self.plane[1].T
        return 0.5 * abs(float((y[:-1] * z[1:] - y[1:] * z[:-1]).sum()))

    def share(self, time: float, head: float, collapsed: bool) -> float:
        """The share of its area that is open at a time (s) under a head (m)."""
        if collapsed or (self.opens is not None and time >= self.opens):
            return 1.0
        return self.leak if abs(head) >= self.leak_head else 0.0


@dataclass(frozen=True)
class Side:
    """What is on one side of an opening: level of the water, and head of the air's overpressure, in m of water."""

    level: float
    air: float = 0.0

    def head(self, height):
        """Pressure over ρ g (m), above that of the air outside, at heights (m) plus these heights."""
        return self.air + np.maximum(self.level, height)


@dataclass(frozen=True)
class Flow:
    """What passes from the first side to the second: water and air (m³/s); the largest head (m) across the opening."""

    water: float
    air: float
    head: float


def rectangle(centre, width: float, height: float, face: str) -> np.ndarray:
    """Corners (4, 3) m: in a side or bulkhead `width` is level and `height` up; in a deck along and across her."""
    half = 0.5 * np.array([[-width, -height], [width, -height], [width, height], [-width, height]])
    return _placed(centre, half, face)


def circle(centre, diameter: float, face: str) -> np.ndarray:
    """Corners (ROUND, 3) m of a polygon with a circle's area."""
    angle = 2.0 * np.pi * (np.arange(ROUND) + 0.5) / ROUND
    radius = 0.5 * diameter * np.sqrt(2.0 * np.pi / ROUND / np.sin(2.0 * np.pi / ROUND))
    return _placed(centre, radius * np.column_stack([np.cos(angle), np.sin(angle)]), face)


def _placed(centre, flat: np.ndarray, face: str) -> np.ndarray:
    kept = [axis for axis in range(3) if axis != FACES[face]]
    corners = np.tile(np.asarray(centre, dtype=float), (len(flat), 1))
    corners[:, kept] += flat
    return corners


def through(
    opening: Opening, up: np.ndarray, at: float, sides: tuple[Side, Side], gravity: float, depth: float
) -> Flow:
    """The flow of a wholly open opening, whose centre is `at` (m) above the sea; `up` (3,): the vertical in her axes.

    depth (m): the hull's. Air is told as if it were water under that head: see `solvers.ship.flooding.air`.
    """
    axes, flat = opening.plane
    rise = axes @ up
    steep = float(np.hypot(*rise))
    one, two = sides
    height = at + flat[:-1] @ rise
    head = float(np.abs(one.head(height) - two.head(height)).max())
    speed = opening.discharge * np.sqrt(2.0 * gravity)
    along, across = flat @ rise, flat @ np.array([-rise[1], rise[0]])
    if along.max() < LEAST_OF_AIR * depth:
        return _through_level(opening.area * speed, at, sides, depth)
    bends = [one.level, two.level, one.level + one.air - two.air, two.level + two.air - one.air]
    marks = np.concatenate([along[:-1], np.array(bends) - at])
    marks = np.unique(np.clip(marks, along.min(), along.max()))
    area, widths = np.diff(marks) / steep**2, _widths(along, across, marks)
    ends = at + np.column_stack([marks[:-1], marks[1:]])
    wet = ends.mean(axis=1)
    heads = one.head(ends) - two.head(ends)
    sign = np.sign(one.head(wet) - two.head(wet))
    water = wet < np.where(sign > 0.0, one.level, two.level)
    least = depth * np.where(water, LEAST, LEAST_OF_AIR)[:, None]
    parts = sign * area * _integral(widths, _root(np.abs(heads), least)) * speed
    return Flow(float(parts[water].sum()), float(parts[~water].sum()), head)


def _through_level(swift: float, at: float, sides: tuple[Side, Side], depth: float) -> Flow:
    """The flow of an opening that lies level at a height (m); `swift`: its area times C_d √(2 g).

    It changes from air to water while the level passes a thin layer, since a jump could not be integrated.
    """
    one, two = sides
    head = float(one.head(at) - two.head(at))
    source = one if head > 0.0 else two
    water = float(np.clip(0.5 + 0.5 * (source.level - at) / (LEAST_OF_AIR * depth), 0.0, 1.0))
    parts = [float(np.copysign(_root(abs(head), least * depth), head)) for least in (LEAST, LEAST_OF_AIR)]
    return Flow(swift * water * parts[0], swift * (1.0 - water) * parts[1], abs(head))


def _widths(along: np.ndarray, across: np.ndarray, marks: np.ndarray) -> np.ndarray:
    """Widths (n, 2) m at both ends of each interval of heights between marks; they are linear inside."""
    low, high = marks[:-1], marks[1:]
    seen = []
    for share in (0.25, 0.75):
        at = (low + share * (high - low))[:, None]
        under = along[None] < at
        cuts = under[:, :-1] != under[:, 1:]
        rise = np.where(cuts, along[1:] - along[:-1], 1.0)
        place = across[:-1] + (at - along[:-1]) / rise * (across[1:] - across[:-1])
        seen.append(np.abs((np.where(under[:, :-1], 1.0, -1.0) * cuts * place).sum(axis=1)))
    near, far = seen
    return np.maximum(np.column_stack([1.5 * near - 0.5 * far, 1.5 * far - 0.5 * near]), 0.0)


def _root(head, least):
    return np.where(head >= least, np.sqrt(head), head / np.sqrt(least))


def _integral(widths: np.ndarray, roots: np.ndarray) -> np.ndarray:
    """∫ w √Δ over an interval of length 1, where w and Δ are linear; widths and roots √Δ (n, 2) at the ends.

    With a, b the roots: ∫ √Δ = ⅔ (a² + a b + b²) / (a + b), ∫ t √Δ = 2/15 (3b³ + 6ab² + 4a²b + 2a³) / (a + b)².
    """
    a, b = roots.T
    total = np.where(a + b > 0.0, a + b, 1.0)
    whole = 2.0 / 3.0 * (a * a + a * b + b * b) / total
    first = 2.0 / 15.0 * (3.0 * b**3 + 6.0 * a * b * b + 4.0 * a * a * b + 2.0 * a**3) / total**2
    return widths[:, 0] * whole + (widths[:, 1] - widths[:, 0]) * first
