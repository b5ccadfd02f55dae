"""A compartment of one or more lengths, each a prism: volumes, centres, free surfaces, and how its contents lie heeled.

The contents have one plane surface, level along the ship, in all lengths of the compartment: the lengths communicate,
and trim is left out. Of the moulded volume the share `permeability` can be filled. y is to starboard, z up, x forward;
heel is positive starboard down.

A liquid that fills the volume v and is level upright has its centre at (y_0, z_0); at the heel φ it lies level again
and its centre has moved to (y, z) in the ship's axes. It then heels her by the moment

    M(φ) = ρ v ((y − y_0) cos φ + (z − z_0) sin φ)

the actual transfer of the liquid (2008 IS Code, MSC.267(85), part B 3.1). For small angles it is ρ i φ, i the second
moment of the free surface about its own middle line; the other method of the code keeps ρ i sin φ at all heels, which
raises KG by ρ i/Δ. For a rectangle i = b³ l/12.

While the surface of a rectangle b broad meets both its sides the transfer is exact as for a wall-sided ship (Attwood
1796): y − y_0 = b² tan φ/(12 h), z − z_0 = b² tan² φ/(24 h), h the depth of the liquid.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.section import Section, Stations

HALVINGS, STEPS = 20, 3  # of the search for a level: first the bracket is halved, then follows Newton's method
TOUCH = 1e-9  # of the compartment's size: so far below its level the surface is cut, so that corners do not lie in it
FULL = 1e-9  # of the volume: a compartment that lacks no more than this is full
NOMINALLY_FULL = 0.98  # of the volume: from there on no free surface is counted (2008 IS Code, part B 3.1.2)
ALIKE = 1e-3  # second moments that differ by this share count as alike
SEARCHED = 99  # levels at which the largest free surface is looked for


@dataclass(frozen=True)
class Length:
    """A part of a compartment: one section (y, z in m) from x = `aft` to `forward` (m)."""

    section: Section
    aft: float
    forward: float

    @property
    def long(self) -> float:
        """How long it is (m)."""
        return self.forward - self.aft

    @property
    def middle(self) -> float:
        """Place x (m) of its middle."""
        return 0.5 * (self.aft + self.forward)


@dataclass(frozen=True, eq=False)
class Compartment:
    """Lengths that communicate, and the share of their volume that can be filled."""

    lengths: Sequence[Length]
    permeability: float = 1.0

    @cached_property
    def stations(self) -> Stations:
        """The sections with their lengths (m) as shares: areas of `Stations` are then volumes (m³)."""
        return Stations([one.section for one in self.lengths], np.array([one.long for one in self.lengths]))

    @cached_property
    def volume(self) -> float:
        """Volume (m³) that can be filled."""
        return self.permeability * self.stations.area

    @property
    def floor(self) -> float:
        """Height z (m) of its lowest point."""
        return float(self.stations.corners[:, 1].min())

    @property
    def top(self) -> float:
        """Height z (m) of its highest point."""
        return float(self.stations.corners[:, 1].max())

    @property
    def ends(self) -> tuple[float, float]:
        """Places x (m) of its aft and forward end."""
        return min(one.aft for one in self.lengths), max(one.forward for one in self.lengths)

    def volume_to(self, level: float) -> float:
        """Volume (m³) up to a level (m), upright. Raises `Unavailable` for one below the floor or above the top."""
        if not self.floor <= level <= self.top:
            raise Unavailable(
                f"a level of {level:.4g} m must be at least {self.floor:.4g} and at most {self.top:.4g} m."
            )
        return self.permeability * float(self.stations.immersion(-level, 0.0).area)

    def level_of(self, volume: float, heel: np.ndarray | float = 0.0) -> np.ndarray:
        """How high (m) the surface of a volume (m³) stands above K, in the earth's axes, at heels (rad).

        Raises `Unavailable` for a volume that it has no room for.
        """
        self._check(volume)
        heel = np.asarray(heel, dtype=float)
        y, z = self.stations.corners.T
        heights = np.cos(heel)[..., None] * z - np.sin(heel)[..., None] * y
        low, high, needed = heights.min(-1), heights.max(-1), volume / self.permeability
        if volume >= self.volume * (1.0 - FULL):
            return high
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            less = self.stations.immersion(-middle, -heel).area < needed
            low, high = np.where(less, middle, low), np.where(less, high, middle)
        level = 0.5 * (low + high)
        for _ in range(STEPS):
            breadth = self.stations.waterplane(-level, -heel).breadth
            off = self.stations.immersion(-level, -heel).area - needed
            level = np.clip(level - off / np.where(breadth > 0.0, breadth, np.inf), low, high)
        return level

    def centre(self, volume: float, heel: np.ndarray | float = 0.0) -> np.ndarray:
        """Centre x, y, z (…, 3) m, in the ship's axes, of a volume (m³) at heels (rad)."""
        if volume <= 0.0:
            return np.broadcast_to([np.mean(self.ends), 0.0, self.floor], (*np.shape(heel), 3)).copy()
        return self.centre_to(self.level_of(volume, heel), heel)

    def centre_to(self, level: np.ndarray, heel: np.ndarray | float = 0.0) -> np.ndarray:
        """Centre x, y, z (…, 3) m, in the ship's axes, of what lies up to levels (m) above K at heels (rad)."""
        level, heel = np.broadcast_arrays(np.asarray(level, dtype=float), heel)
        wet = self.stations.immersion(-level, -heel)
        areas = [one.section.immersion(-level, -heel).area for one in self.lengths]
        along = sum(one.long * one.middle * area for one, area in zip(self.lengths, areas, strict=True)) / wet.area
        aside, up = wet.moment / wet.area, level - wet.depth_moment / wet.area
        cos, sin = np.cos(heel), np.sin(heel)
        return np.stack([along, cos * aside - sin * up, sin * aside + cos * up], axis=-1)

    def parts(self, volume: float) -> list[tuple[float, float, float]]:
        """Aft and forward end (m) of each length, and the share of a volume (m³) that lies in it upright."""
        level = self.level_of(volume)
        held = [one.long * float(one.section.immersion(-level, 0.0).area) for one in self.lengths]
        whole = sum(held)
        shares = [one / whole if whole > 0.0 else 0.0 for one in held]
        return [(one.aft, one.forward, share) for one, share in zip(self.lengths, shares, strict=True)]

    def second_moment(self, volume: float) -> float:
        """Second moment i (m⁴) of the upright free surface of a volume (m³) about its own middle line; 0 if full."""
        if not 0.0 < volume < self.volume * (1.0 - FULL):
            return 0.0
        return float(self.second_moment_at(self.level_of(volume)))

    def second_moment_at(self, level: np.ndarray) -> np.ndarray:
        """i (m⁴) of surfaces at levels (m): ∫y² dA − (∫y dA)²/∫dA over the whole surface, times the permeability."""
        plane = self.stations.waterplane(TOUCH * self.stations.size - np.asarray(level), 0.0)
        wide = plane.breadth > 0.0
        own = plane.second_moment - plane.moment**2 / np.where(wide, plane.breadth, 1.0)
        return self.permeability * np.where(wide, own, 0.0)

    @cached_property
    def freest_volume(self) -> float:
        """The volume (m³) with the largest free surface, up to the filling that counts as full.

        Of volumes with surfaces as large it is that nearest to half full, of which most is transferred.
        """
        levels = np.union1d(np.linspace(self.floor, self.top, SEARCHED)[1:], self.stations.corners[:, 1])
        volumes = self.permeability * self.stations.immersion(-levels, 0.0).area
        counts = (volumes > 0.0) & (volumes < NOMINALLY_FULL * self.volume)
        second = np.where(counts, self.second_moment_at(levels), -1.0)
        largest = second >= second.max() * (1.0 - ALIKE)
        return float(volumes[largest][np.argmin(np.abs(volumes[largest] - 0.5 * self.volume))])

    def transfer(self, volume: float, heel: np.ndarray) -> np.ndarray:
        """M/ρ (m⁴) of a volume (m³) at heels (rad): the volume times the way of its centre to the side that goes down.

        v ((y − y_0) cos φ + (z − z_0) sin φ); positive for a heel to starboard where the liquid goes there.
        """
        heel = np.asarray(heel, dtype=float)
        way = self.centre(volume, heel) - self.centre(volume)
        return volume * (way[..., 1] * np.cos(heel) + way[..., 2] * np.sin(heel))

    def volumetric_moment(self, volume: float, surface: float) -> float:
        """Moment (m⁴) of grain of a volume (m³) whose surface turns from level to an angle (rad), the volume kept.

        The volume times the transverse way of its centre (Grain Code, MSC.23(59), part B), to the side where that is
        more, if the sides differ.
        """
        ways = self.centre(volume, np.array([surface, -surface]))[:, 1] - self.centre(volume)[1]
        return volume * float(np.abs(ways).max())

    def _check(self, volume: float) -> None:
        if not 0.0 <= volume <= self.volume * (1.0 + FULL):
            raise Unavailable(f"{volume:.5g} m3 must be at least 0 and at most the {self.volume:.5g} m3 that it holds.")
