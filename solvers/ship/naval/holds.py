"""A hold with grain: levels, volumes, centres and volumetric heeling moments, as loading manuals have them."""

from dataclasses import dataclass

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.cargo import ONE, filling_centre
from solvers.ship.hydrostatics import Loading, balanced_heave
from solvers.ship.section import Section


@dataclass(frozen=True)
class Filling:
    """A level filling: height of its surface (m), volume (m³) and height of its centre (m), heights as the hold's."""

    level: float
    volume: float
    centre: float


@dataclass(frozen=True, eq=False)
class Hold:
    """A hold of one section (y, z in m) along a length (m)."""

    section: Section
    length: float

    @property
    def volume(self) -> float:
        """Volume (m³) of the whole hold."""
        return self.section.area * self.length

    def filled_to(self, level: float) -> Filling:
        """The filling up to a level (m). Raises `Unavailable` for one at or below the floor, or above the top."""
        low, high = self.section.outline[:, 1].min(), self.section.outline[:, 1].max()
        if not low < level <= high:
            raise Unavailable(f"a level of {level:.4g} m must be above {low:.4g} and at most {high:.4g} m.")
        wet = self.section.immersion(-level, 0.0)
        return Filling(level, float(wet.area) * self.length, level - float(wet.depth_moment / wet.area))

    def filled_with(self, volume: float) -> Filling:
        """The level filling of a volume (m³). Raises `Unavailable` if the hold has no room for it."""
        heave = balanced_heave(self.section, Loading(volume / self.length, (0.0, 0.0)), ONE, 0.0)
        return self.filled_to(-heave)

    def volumetric_moment(self, volume: float, surface: float) -> float:
        """Moment (m⁴) of a filling (m³) whose surface is turned from level to an angle (rad), its volume kept.

        The volume times the transverse way of its centre (Grain Code, part B): to the side that goes down.
        """
        area = volume / self.length
        moved = filling_centre(self.section, area, surface) - filling_centre(self.section, area, 0.0)
        return float(abs(moved[0])) * volume

    def table(self, levels: np.ndarray, surfaces: tuple[float, ...]) -> list[tuple[float, ...]]:
        """Rows of level (m), volume (m³), centre (m) and moments (m⁴) at each of the `surfaces` (rad)."""
        rows = []
        for level in levels:
            filling = self.filled_to(float(level))
            within = min(filling.volume, self.volume * (1.0 - 1e-9))
            moments = (self.volumetric_moment(within, surface) for surface in surfaces)
            rows.append((filling.level, filling.volume, filling.centre, *moments))
        return rows
