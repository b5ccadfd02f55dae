"""From where a scene in space is seen, and what of its cargo: all of it, what is behind a plane, or a slice."""

from dataclasses import dataclass

import numpy as np

AZIMUTH, ELEVATION = np.radians(25.0), np.radians(20.0)  # where the camera stands unless it is told


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


@dataclass(frozen=True)
class Viewpoint:
    """Where the camera stands, azimuth and elevation (rad), how often it goes round in a film, and what it shows."""

    azimuth: float = AZIMUTH
    elevation: float = ELEVATION
    turns: float = 0.0
    section: Section | None = None

    @classmethod
    def of(cls, look) -> "Viewpoint":
        """The viewpoint that a look (`lab.paint.page.look.Look`) asks for."""
        section = None
        if look.cut is not None or look.slice is not None:
            section = across(look.cut or 0.0, look.slice)
        azimuth, elevation = (
            default if wish is None else wish
            for wish, default in ((look.azimuth, AZIMUTH), (look.elevation, ELEVATION))
        )
        return cls(azimuth, elevation, look.orbit or 0.0, section)
