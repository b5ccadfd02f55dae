"""What a scene says of its bulk: the material, its points at the start, and the grid that carries them."""

from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import Annotated, ClassVar

import numpy as np

from solvers.bulk.grid import Grid
from solvers.machine.marks import EachWorld
from solvers.tank.given import Given

STIFFNESS = 50.0  # Young's modulus over ρ g and the deepest bed; soft for the sake of long steps
POISSON = 0.3  # Poisson's ratio
EVENED = 1.0  # 1/s, the rate at which a point takes over a volume that the grid knows better
BAND = 0.03  # the share of density up to which it does not


@dataclass(frozen=True)
class Granular:
    """A granular material as a continuum, in SI units.

    `density` of the bed at rest (kg/m³), of grains packed by the share `packing`; `friction` μ_s, `fast_friction` μ_2
    and `inertial_number` I_0 of μ(I), for grains of a `diameter` (m); `wall_friction`; `young`'s modulus (Pa). A bed
    that has not been sheared yet holds `start_friction`, and forgets it over the plastic shear strain `softening`.
    """

    density: float
    friction: float
    wall_friction: float
    young: float
    law: str = "mu-of-i"
    fast_friction: float = 0.0
    inertial_number: float = 0.28
    diameter: float = 0.0
    packing: float = 0.6
    start_friction: float = 0.0
    softening: float = 0.2

    @property
    def softens(self) -> bool:
        """Whether it holds more before it is sheared."""
        return self.start_friction > self.friction

    @property
    def bulk_modulus(self) -> float:
        """K (Pa)."""
        return self.young / (3.0 * (1.0 - 2.0 * POISSON))

    @property
    def shear_modulus(self) -> float:
        """G (Pa)."""
        return self.young / (2.0 * (1.0 + POISSON))

    @property
    def sound_speed(self) -> float:
        """Speed (m/s) of waves of pressure, √((K + 4 G/3)/ρ)."""
        return sqrt((self.bulk_modulus + 4.0 / 3.0 * self.shear_modulus) / self.density)

    @property
    def alpha(self) -> float:
        """G I_0/(d √ρ_s) (Pa^(1/2)/s), of `MuOfI`; 0 where the law needs none."""
        if self.law != "mu-of-i":
            return 0.0
        return self.shear_modulus * self.inertial_number / (self.diameter * sqrt(self.density / self.packing))


@dataclass(frozen=True, eq=False)
class Bulk(Given):
    """Bulk in W worlds: material points (W, n), by tanks, of one material, over one `grid`.

    `points` have a `position` (m), a `volume` (m³ of a slab 1 m thick, so m²) that is free of stress, a `mass` over the
    thickness (kg/m), and a `pressure` (Pa) at the start.
    """

    points: Annotated[np.ndarray, EachWorld(lambda bulk: bulk.points.shape[1])]
    material: Granular
    grid: Grid
    fill: tuple[int, ...]
    simple: ClassVar[bool] = True

    @property
    def worlds(self) -> int:
        """Number of worlds, W."""
        return len(self.points)

    @property
    def count(self) -> int:
        """Number of points in a world."""
        return self.points.shape[1]

    @property
    def moved(self) -> int:
        """How many of them are moved one by one: all."""
        return self.count

    @property
    def in_bands(self) -> int:
        """What the bands of a world are cut by: the columns of its grid."""
        return self.grid.columns

    @cached_property
    def mass(self) -> float:
        """Mass over the thickness of a world's bulk (kg/m)."""
        return float(self.points["mass"][0].sum())

    def fills(self, tanks: int) -> tuple[int, ...]:
        """How many points are in each of so many tanks."""
        return self.fill
