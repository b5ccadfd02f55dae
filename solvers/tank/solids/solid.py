"""The solids that a tank's outline stands for in space: a prism, or a body turned about the vertical axis.

Without one a scene is plane. Points (n, 3) m have the order y, z, x. Section coordinates (n, 2) m are those in
which the outline is drawn.
"""

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
    def period(self) -> float | None:
        """The length (m) after which space repeats itself along x; None where it does not."""
        return self.along if self.periodic else None

    def half(self, outline: np.ndarray) -> float:
        """How far (m) it reaches along x on either side of the origin."""
        return 0.5 * self.along

    def section(self, points: np.ndarray) -> np.ndarray:
        """The section coordinates of points."""
        return points[:, :2]

    def volume(self, outline: np.ndarray, depth: float) -> float:
        """Volume (m³) up to `depth` (m) above the lowest point."""
        return self.along * area_below(outline, depth)


@dataclass(frozen=True)
class Turned:
    """A section through the axis z, which must be the same on both sides of y = 0, turned about that axis.

    So are the plates in it, and edges without a wall are round openings.
    """

    axes = SPACE
    period = None

    def half(self, outline: np.ndarray) -> float:
        """How far (m) it reaches along x on either side of the origin."""
        return float(outline[:, 0].max())

    def section(self, points: np.ndarray) -> np.ndarray:
        """The section coordinates of points: the distance from the axis, and z."""
        return np.column_stack([np.hypot(points[:, 0], points[:, 2]), points[:, 1]])

    def volume(self, outline: np.ndarray, depth: float) -> float:
        """Volume (m³) up to `depth` (m) above the lowest point, by slices of the section's width."""
        ends = np.linspace(0.0, depth, SLICES + 1)
        area = np.array([area_below(outline, end) if end > 0.0 else 0.0 for end in ends])
        width = np.diff(area) / np.diff(ends)
        return float(0.25 * np.pi * (width**2 * np.diff(ends)).sum())


Solid = Prism | Turned
