"""The solids that a tank's outline stands for in space: a prism, or a body turned about the vertical axis.

Without one a scene is plane. Points (n, 3) m have the order y, z, x. Section coordinates (n, 2) m are those in
which the outline is drawn.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from solvers.machine.quantity import SPACE
from solvers.tank.outline import area_below

SLICES = 2000  # of a turned body's depth, for its volume


@dataclass(frozen=True)
class Prism:
    """The outline in the y–z plane, drawn out along x from −`along`/2 to `along`/2 (m), between two end walls.

    Edges of the outline without a wall are open over the whole length. The end walls are as high as the outline. A
    `periodic` one has none: it is a slice of a tank without an end, and what leaves it on one side enters on the other.
    """

    along: float
    periodic: bool = False
    axes = SPACE

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

    def section(self, points: np.ndarray) -> np.ndarray:
        """The section coordinates of points."""
        return points[:, :2]

    def out_of_section(self, ways: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Vectors (n, 3) at points (n, 3) of those (n, 2) in the section."""
        return np.column_stack([ways, np.zeros(len(points))])

    def ends(self, points: np.ndarray, radius: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """For each end wall the direction (n, 3) away from it and the overlaps (n,) m of spheres at points (n, 3)."""
        for side in () if self.periodic else (-1.0, 1.0):
            yield np.tile([0.0, 0.0, -side], (len(points), 1)), radius - 0.5 * self.along + side * points[:, 2]

    def between_ends(self, points: np.ndarray, reach: float | np.ndarray) -> np.ndarray:
        """Which points (n, 3) are at least `reach` (m) from both end walls; of a slice, which are in it."""
        return np.abs(points[:, 2]) <= 0.5 * self.along - (0.0 if self.periodic else np.asarray(reach) * (1.0 - 1e-9))

    def volume(self, outline: np.ndarray, depth: float) -> float:
        """Volume (m³) up to `depth` (m) above the lowest point."""
        return self.along * area_below(outline, depth)


@dataclass(frozen=True)
class Turned:
    """A section through the axis z, which must be the same on both sides of y = 0, turned about that axis.

    So are the plates in it, and edges without a wall are round openings.
    """

    axes = SPACE
    period = thickness = None

    def half(self, outline: np.ndarray) -> float:
        """How far (m) it reaches along x on either side of the origin."""
        return float(outline[:, 0].max())

    def section(self, points: np.ndarray) -> np.ndarray:
        """The section coordinates of points: the distance from the axis, and z."""
        return np.column_stack([np.hypot(points[:, 0], points[:, 2]), points[:, 1]])

    def out_of_section(self, ways: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Vectors (n, 3) at points (n, 3) of those (n, 2) in the section."""
        away = np.maximum(np.hypot(points[:, 0], points[:, 2]), 1e-300)
        return np.column_stack([ways[:, 0] * points[:, 0] / away, ways[:, 1], ways[:, 0] * points[:, 2] / away])

    def ends(self, points: np.ndarray, radius: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """What is turned has no end walls."""
        return iter(())

    def between_ends(self, points: np.ndarray, reach: float | np.ndarray) -> np.ndarray:
        """All points (n, 3): what is turned has no end walls."""
        return np.ones(len(points), dtype=bool)

    def volume(self, outline: np.ndarray, depth: float) -> float:
        """Volume (m³) up to `depth` (m) above the lowest point, by slices of the section's width."""
        ends = np.linspace(0.0, depth, SLICES + 1)
        area = np.array([area_below(outline, end) if end > 0.0 else 0.0 for end in ends])
        width = np.diff(area) / np.diff(ends)
        return float(0.25 * np.pi * (width**2 * np.diff(ends)).sum())


Solid = Prism | Turned
