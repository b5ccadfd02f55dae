"""The solids that a tank's outline stands for in space: a prism, or a body turned about an axis.

Without one a scene is plane. Points (n, 3) m have the order y, z, x; an outline (m, 2) m is in y and z.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.machine.quantity import SPACE
from solvers.tank.outline import NONE_FIXED, area_below, clear_of_walls

SLICES = 2000  # of a turned body's depth or length, for its volume
FACETS = 96  # of the outline of a round tank as seen along its axis; a multiple of four, so that it is as wide and high
FREE = 1e-9  # of a reach: by how much a point that is clear of a wall may be nearer


ENDS, MESH = ("end 1", "end 2"), ("mesh",)  # names of faces


def edges_named(count: int) -> tuple[str, ...]:
    """Names of so many edges of an outline or a profile: edge k runs from corner k to the next."""
    return tuple(f"edge {k + 1}" for k in range(count))


class InSpace:
    """What solids have in common."""

    axes = SPACE
    period: float | None = None  # m, after which space repeats itself along x; None where it does not
    thickness: float | None = None  # m, of the slab of a ship's hold that it is; None where it is none
    heightens = True  # whether walls can be raised on its top edges, above which grains start that have no room

    def section(self, points: np.ndarray) -> np.ndarray:
        """The coordinates (n, 2) m of points in which the outline is drawn, and regions of the tank are."""
        return points[:, :2]

    def clear(
        self,
        points: np.ndarray,
        outline: np.ndarray,
        reach: float | np.ndarray,
        fixed: np.ndarray = NONE_FIXED,
        plates: Sequence[np.ndarray] = (),
    ) -> np.ndarray:
        """Which points lie inside, at least `reach` (m) from all walls, from plates and from fixed grains."""
        return clear_of_walls(self.section(points), outline, reach, fixed, plates)

    def faces(self, outline: np.ndarray) -> tuple[str, ...]:
        """Names of the faces of the tank, whose loads are told apart: the edges of the outline, from 1."""
        return edges_named(len(outline))

    def overlaps(
        self, points: np.ndarray, radius: np.ndarray, edges: np.ndarray
    ) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """For each wall the directions (n, 3) away from it of spheres at points, and their overlaps (n,) m with it.

        `edges` (k, 2, 2) m: those of the outline that have walls.
        """
        for ways, depth in overlaps(self.section(points), radius, edges):
            yield self.from_section(ways, points), depth

    def from_section(self, ways: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Vectors (n, 3) at points of vectors (n, 2) in the section."""
        return np.column_stack([ways, np.zeros(len(points))])

    def within(self, region: np.ndarray) -> float:
        """Volume (m³) of a region (m, 2) m of the tank, at most."""
        return self.volume(region, float(np.ptp(region[:, 1])))

    def over(self, outline: np.ndarray) -> "InSpace":
        """It with walls as high as an outline is; of most an outline says so by itself."""
        return self


@dataclass(frozen=True)
class Prism(InSpace):
    """The outline in the y–z plane, drawn out along x from −`along`/2 to `along`/2 (m), between two end walls.

    Edges of the outline without a wall are open over the whole length. The end walls are as high as the outline. A
    `periodic` one has none: it is a slice of a tank without an end, and what leaves it on one side enters on the other.
    """

    along: float
    periodic: bool = False

    @property
    def thickness(self) -> float:
        """Thickness (m) of the slab of a ship's hold that it is."""
        return self.along

    @property
    def period(self) -> float | None:
        """The length (m) after which space repeats itself along x; None where it does not."""
        return self.along if self.periodic else None

    def half(self, outline: np.ndarray) -> float:
        """How far (m) it reaches along x on either side of the origin."""
        return 0.5 * self.along

    def faces(self, outline: np.ndarray) -> tuple[str, ...]:
        """Names of the faces: the edges of the outline, drawn out, then the end walls, at −x and at x."""
        return edges_named(len(outline)) + (() if self.periodic else ENDS)

    def clear(self, points, outline, reach, fixed=NONE_FIXED, plates=()) -> np.ndarray:
        """Which points lie inside, at least `reach` (m) from all walls, from plates and from fixed grains."""
        found = super().clear(points, outline, reach, fixed, plates)
        return found if self.periodic else found & (0.5 * self.along - np.abs(points[:, 2]) >= reach * (1.0 - FREE))

    def overlaps(self, points, radius, edges) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """The directions (n, 3) away from each wall, those at the ends too, and the overlaps (n,) m with it."""
        yield from super().overlaps(points, radius, edges)
        for side in () if self.periodic else (-1.0, 1.0):
            yield np.tile([0.0, 0.0, -side], (len(points), 1)), radius - 0.5 * self.along + side * points[:, 2]

    def volume(self, outline: np.ndarray, depth: float) -> float:
        """Volume (m³) up to `depth` (m) above the lowest point."""
        return self.along * area_below(outline, depth)


@dataclass(frozen=True)
class Turned(InSpace):
    """A section through the axis z, which must be the same on both sides of y = 0, turned about that axis.

    So are the plates in it, and edges without a wall are round openings.
    """

    def half(self, outline: np.ndarray) -> float:
        """How far (m) it reaches along x on either side of the origin."""
        return float(outline[:, 0].max())

    def section(self, points: np.ndarray) -> np.ndarray:
        """The distance of points from the axis, and z."""
        return np.column_stack([np.hypot(points[:, 0], points[:, 2]), points[:, 1]])

    def from_section(self, ways: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Vectors (n, 3) at points of vectors (n, 2) in the section."""
        y, x = outwards(points[:, 0], points[:, 2])
        return np.column_stack([ways[:, 0] * y, ways[:, 1], ways[:, 0] * x])

    def volume(self, outline: np.ndarray, depth: float) -> float:
        """Volume (m³) up to `depth` (m) above the lowest point, by slices of the section's width."""
        thick, width = _slices(outline, depth)
        return float(0.25 * np.pi * (width**2 * thick).sum())


@dataclass(frozen=True)
class Lying(InSpace):
    """A closed body turned about the axis x, such as a drum, from its `profile`: corners across the axis and x, m.

    The profile must be the same on both sides of the axis. The outline is what is seen of it along x (`front`).
    """

    profile: tuple[tuple[float, float], ...]
    heightens = False

    @cached_property
    def corners(self) -> np.ndarray:
        """The corners (m, 2) m of the profile."""
        return np.array(self.profile)

    @property
    def front(self) -> np.ndarray:
        """What is seen of it along x: a circle (FACETS, 2) m, which its widest place fills."""
        turn = 2.0 * np.pi * np.arange(FACETS) / FACETS
        return float(self.corners[:, 0].max()) * np.column_stack([np.cos(turn), np.sin(turn)])

    def half(self, outline: np.ndarray) -> float:
        """How far (m) it reaches along x on either side of the origin."""
        return float(np.abs(self.corners[:, 1]).max())

    def faces(self, outline: np.ndarray) -> tuple[str, ...]:
        """Names of the faces: the edges of the profile, from 1."""
        return edges_named(len(self.corners))

    def clear(self, points, outline, reach, fixed=NONE_FIXED, plates=()) -> np.ndarray:
        """Which points lie inside, at least `reach` (m) from all walls."""
        return clear_of_walls(self._across(points), self.corners, reach)

    def overlaps(self, points, radius, edges) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """The directions (n, 3) away from each wall of the profile, and the overlaps (n,) m with it."""
        y, z = outwards(points[:, 0], points[:, 1])
        walls = np.stack([self.corners, np.roll(self.corners, -1, axis=0)], axis=1)
        for ways, depth in overlaps(self._across(points), radius, walls):
            yield np.column_stack([ways[:, 0] * y, ways[:, 0] * z, ways[:, 1]]), depth

    def _across(self, points: np.ndarray) -> np.ndarray:
        """The distances of points from the axis, and x."""
        return np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])

    def volume(self, outline: np.ndarray, depth: float) -> float:
        """Volume (m³) up to `depth` (m) above the lowest point, by the segments of circles that slices fill.

        A circle of radius r is filled up to the height h above its middle over r² acos(−h/r) + h √(r² − h²).
        """
        thick, width = _slices(self.corners, float(np.ptp(self.corners[:, 1])))
        radius = 0.5 * width
        level = np.clip(depth - self.corners[:, 0].max(), -radius, radius)
        share = np.divide(level, radius, out=np.zeros_like(radius), where=radius > 0.0)
        filled = radius**2 * np.arccos(-share) + level * np.sqrt(radius**2 - level**2)
        return float((filled * thick).sum())

    def within(self, region: np.ndarray) -> float:
        """Volume (m³) of a region (m, 2) m of the tank, at most."""
        whole = float(np.ptp(region[:, 1]))
        length = float(np.ptp(self.corners[:, 1]))
        return min(self.volume(region, 2.0 * self.corners[:, 0].max()), length * area_below(region, whole))


def overlaps(points: np.ndarray, radius: np.ndarray, edges: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """For each edge (k, 2, 2) m the directions (n, 2) from it to points (n, 2), and their overlaps (n,) m."""
    for a, b in edges:
        along = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        away = points - (a + along[:, None] * (b - a))
        apart = np.maximum(np.linalg.norm(away, axis=1), 1e-12)
        yield away / apart[:, None], radius - apart


def outwards(y: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors (n,), (n,) away from an axis."""
    away = np.maximum(np.hypot(y, x), 1e-300)
    return y / away, x / away


def _slices(section: np.ndarray, depth: float) -> tuple[np.ndarray, np.ndarray]:
    """Thicknesses and widths (m) of slices of a section (m, 2) m up to a depth (m) above its lowest point."""
    ends = np.linspace(0.0, depth, SLICES + 1)
    area = np.array([area_below(section, end) if end > 0.0 else 0.0 for end in ends])
    thick = np.diff(ends)
    return thick, np.diff(area) / thick


Solid = InSpace
"""A tank in space."""
