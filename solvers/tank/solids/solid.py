"""The solid that a tank's outline stands for in space: a prism. Without one a scene is plane."""

from dataclasses import dataclass

import numpy as np

from solvers.machine.quantity import SPACE


@dataclass(frozen=True)
class Prism:
    """The outline in the y–z plane, drawn out along x from −`along`/2 to `along`/2 (m), between two end walls.

    Edges of the outline without a wall are open over the whole length. The end walls are as high as the outline.
    """

    along: float

    @property
    def axes(self) -> int:
        """Number of axes of a scene in it."""
        return SPACE

    def bounds(self, lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Corners (3,) m of the box round it, from those (2,) m of the box round the outline."""
        half = 0.5 * self.along
        return np.array([*lower, -half]), np.array([*upper, half])
