"""What holds matter: a closed outline, where it stands in its carrier, and how much of a ship it stands for."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Tank:
    """A tank of a world in the plane.

    `outline` (m, 2) m in its carrier's axes, a simple polygon, counter-clockwise; `open_edges` those without a wall, by
    their first corners. The world is a slab `thickness` (m) thick there: forces are those on the slab. Along a ship the
    tank is `length` (m) long, as long as she is where that is None. What it holds follows from where particles are.
    """

    outline: np.ndarray
    thickness: float
    open_edges: tuple[int, ...] = ()
    length: float | None = None

    def share(self, whole: float) -> float:
        """Force per metre (N/m) of a ship `whole` m long for each newton on the slab, 1/m."""
        return (1.0 if self.length is None else self.length / whole) / self.thickness

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Which of the points (n, 2) m lie in it (n,), by the even–odd rule."""
        (ay, az), (by, bz) = self.outline.T, np.roll(self.outline, -1, axis=0).T
        y, z = points[:, :1], points[:, 1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            left = y < ay + (z - az) / (bz - az) * (by - ay)
        return np.count_nonzero(((az > z) != (bz > z)) & left, axis=1) % 2 == 1
