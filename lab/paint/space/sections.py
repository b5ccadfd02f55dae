"""What of the cargo is shown: all of it, what is behind a plane, or a slice."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Section:
    """A cut by the plane through a point (3,) m with a unit normal (3,), in the tank's axes (y, z, x).

    thick: m, of a slice about the plane; None: all behind the plane is shown, away from the normal. A sphere belongs to
    where its middle is.
    """

    point: np.ndarray
    normal: np.ndarray
    thick: float | None = None

    def holds(self, place: np.ndarray) -> np.ndarray:
        """Whether (n,) spheres at these places (n, 3) m are shown."""
        off = (np.asarray(place) - self.point) @ self.normal
        return off <= 0.0 if self.thick is None else np.abs(off) <= 0.5 * self.thick

    def shown(self, place: np.ndarray) -> np.ndarray:
        """The places (n, 3), NaN for spheres that are left out."""
        return np.where(self.holds(place)[:, None], place, np.nan)


def across(x: float, thick: float | None = None) -> Section:
    """A cut across the tank at this x (m), which leaves out what is nearer to the viewer, or a slice about it."""
    return Section(np.array([0.0, 0.0, x]), np.array([0.0, 0.0, 1.0]), thick)
