"""The water's force on a hull in waves without radiation: buoyancy and excitation."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from solvers.ship.hydrostatics import buoyancy, surface_force, turned
from solvers.ship.potential.radiation import Hydrodynamics
from solvers.ship.section import Immersible
from solvers.ship.water import Water
from solvers.ship.waves import Waves

NO_WAVES = Waves(np.zeros(0, complex), np.zeros(0), np.zeros(0))


@dataclass(frozen=True, eq=False)
class Floating:
    """Buoyancy of a section or a whole hull under the waves' sloping surface, and the rest of the waves' linear force.

    `about` (m) is the point of the hull whose pose (y, z, roll) is given and about which moments are taken. `excess`
    (n, 3), complex, is each wave's force and moment per metre of amplitude, less the part that this buoyancy gives.
    """

    section: Immersible
    water: Water
    about: tuple[float, float] = (0.0, 0.0)
    waves: Waves = NO_WAVES
    excess: np.ndarray | None = None

    def force(self, pose: np.ndarray, time: float) -> np.ndarray:
        """Force y, z (N/m) and moment (N), (3,), at a pose (m, m, rad) and time (s)."""
        arm = turned(self.about, pose[2])
        y, heave = pose[0] - arm[0], pose[1] - arm[1]
        if not len(self.waves.amplitude):
            return buoyancy(self.section, self.water, heave, pose[2], about=self.about)
        elevation, slope, *excess = self.waves.sums(self.factors, y, time)
        return buoyancy(self.section, self.water, heave, pose[2], elevation, slope, self.about) + np.array(excess)

    def depths(self, points: Sequence[tuple[float, float]], pose: np.ndarray, time: float) -> np.ndarray:
        """Depths (k,) m of points of the hull (m) below the local wave surface."""
        place = pose[:2] + turned(tuple(np.transpose(points)), pose[2]) - turned(self.about, pose[2])
        return self.waves.elevation(place[:, 0], np.full(len(place), time)) - place[:, 1]

    @cached_property
    def factors(self) -> np.ndarray:
        """Complex factors (n, 5) of each wave's amplitude: for elevation, slope and the three `excess` forces."""
        number = self.waves.wave_number[:, None]
        excess = np.zeros((len(number), 3)) if self.excess is None else self.excess
        return np.hstack([np.ones_like(number), 1j * number, excess])

    @cached_property
    def still(self) -> "Floating":
        """The same hull in calm water."""
        return replace(self, waves=NO_WAVES, excess=None)


def floating_in_waves(
    section: Immersible,
    water: Water,
    about: tuple[float, float],
    waves: Waves,
    table: Hydrodynamics,
    rest: tuple[float, float],
    diffraction: bool = True,
) -> Floating:
    """A hull in waves whose force in small waves is the table's excitation, or only its Froude–Krylov part.

    The table's moments are about `about`, its pose the heave (m) and roll (rad) `rest`. Buoyancy under the sloping
    surface already is the Froude–Krylov force of long waves, so it is subtracted from the table's force.
    """
    here = table.at(waves.frequency)
    wanted = here.excitation if diffraction else here.froude_krylov
    level, slope = surface_force(section, water, *rest, about)
    excess = wanted - (level + 1j * waves.wave_number[:, None] * slope)
    return Floating(section, water, about, waves, excess)
