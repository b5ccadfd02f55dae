"""Buoyancy and weight of a hull at rest: forces, moments, equilibrium, stability, energy. Per metre of length.

The water's pressure is ρ g d, d the depth below the surface z = ζ + s y, calm or sloping. The force of this field on
the immersed area A is its exact integral, ρ g A (−s, 1) at the centroid of A (Archimedes). Under a wave longer than the
hull it is the Froude–Krylov force to first order, sway force included.
"""

from dataclasses import dataclass
from math import pi

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.section import Immersible
from solvers.ship.water import Water

SEARCH = pi / 180.0  # step (rad) of the search for an angle of equilibrium
LEVEL = 1e-12  # of the hull's size: righting levers up to this count as zero


@dataclass(frozen=True)
class Loading:
    """Mass (kg/m) of the hull with all it carries, and its centre of gravity y, z (m) in the hull's frame."""

    mass: float
    centre: tuple[float, float]


def turned(point: tuple[float, float], roll) -> np.ndarray:
    """Vector (…, 2) m, in the earth's axes, from the hull's origin to a point (y, z) of its frame at a roll (rad)."""
    cos, sin = np.cos(roll), np.sin(roll)
    y = cos * point[0] - sin * point[1]
    arm = np.empty((*np.shape(y), 2))  # faster than np.stack
    arm[..., 0], arm[..., 1] = y, sin * point[0] + cos * point[1]
    return arm


def buoyancy(
    section: Immersible, water: Water, heave, roll, elevation=0.0, slope=0.0, about: tuple[float, float] = (0.0, 0.0)
) -> np.ndarray:
    """Force y, z (N/m) and moment (N) of the water about the hull's point `about`, (…, 3), at poses (m, rad).

    The surface is `elevation` (m) high at the hull's origin and rises by `slope` to starboard.
    """
    wet = section.immersion(heave, roll, elevation, slope)
    pressure = water.density * water.gravity
    force_y, force_z = -pressure * wet.slope * wet.area, pressure * wet.area
    point = turned(about, roll)
    # ∫∫ z dA from z = ζ + s y − d
    height = wet.elevation * wet.area + wet.slope * wet.moment - wet.depth_moment
    lever_y = wet.moment - point[..., 0] * wet.area
    lever_z = height - (np.asarray(heave) + point[..., 1]) * wet.area
    return np.stack([force_y, force_z, pressure * (lever_y + wet.slope * lever_z)], axis=-1)


def restoring(section: Immersible, loading: Loading, water: Water, heave, roll, elevation=0.0, slope=0.0) -> np.ndarray:
    """Restoring force y, z (N/m) of buoyancy and weight, and moment (N) about the centre of gravity, (…, 3)."""
    load = buoyancy(section, water, heave, roll, elevation, slope, about=loading.centre)
    return load - np.array([0.0, loading.mass * water.gravity, 0.0])


def stiffness(section: Immersible, loading: Loading, water: Water, heave: float, roll: float) -> np.ndarray:
    """Hydrostatic stiffness (3, 3) in sway, heave and roll about the centre of gravity.

    It is minus the derivative of the restoring force and moment, at a pose where buoyancy balances the weight; in N/m²,
    N/m and N per rad.
    """
    wet, first, second = _about(section, heave, roll, loading.centre)
    above = heave + turned(loading.centre, roll)[1] - wet.centroid[1]  # z_G − z_B
    breadth = section.waterplane(heave, roll).breadth
    table = np.array([[0.0, 0.0, 0.0], [0.0, breadth, first], [0.0, first, second - wet.area * above]])
    return water.density * water.gravity * table


def surface_force(
    section: Immersible, water: Water, heave: float, roll: float, about: tuple[float, float] = (0.0, 0.0)
) -> np.ndarray:
    """Derivatives (2, 3) of `buoyancy` with respect to the surface's elevation (per m) and slope, in calm water.

    In a long wave a e^(i(ky − ωt)) the Froude–Krylov force is a times the first row and ika times the second.
    """
    wet, first, second = _about(section, heave, roll, about)
    point = turned(about, roll)
    plane = section.waterplane(heave, roll)
    tilt = second + point[0] * first + wet.area * (wet.centroid[1] - heave - point[1])
    table = np.array([[0.0, plane.breadth, first], [-wet.area, plane.moment, tilt]])
    return water.density * water.gravity * table


def _about(section: Immersible, heave: float, roll: float, point: tuple[float, float]):
    """The immersed part, and ∫(y − y_P) dy and ∫(y − y_P)² dy of the waterline about a point P of the hull."""
    plane, y = section.waterplane(heave, roll), turned(point, roll)[0]
    first = plane.moment - y * plane.breadth
    return section.immersion(heave, roll), first, plane.second_moment - y * (plane.moment + first)


def potential_energy(section: Immersible, loading: Loading, water: Water, heave, roll) -> np.ndarray:
    """Potential energy (J/m) in calm water, M g z_G + ρ g ∫∫d dA; its negative gradient is force and moment."""
    height = np.asarray(heave) + turned(loading.centre, roll)[..., 1]
    wet = section.immersion(heave, roll)
    return water.gravity * (loading.mass * height + water.density * wet.depth_moment)


def balanced_heave(section: Immersible, loading: Loading, water: Water, roll: float) -> float:
    """The heave (m) at which buoyancy balances the weight at a roll (rad); raises `Unavailable` if the hull sinks."""
    from scipy.optimize import brentq  # slow to import

    needed = loading.mass / water.density
    if not 0.0 < needed < section.area:
        raise Unavailable(
            f"the hull's mass of {loading.mass:.6g} kg/m must be above 0 and below the "
            f"{section.area * water.density:.6g} kg/m that its whole section displaces."
        )
    heights = turned(tuple(section.corners.T), roll)[..., 1]
    surplus = lambda heave: float(section.immersion(heave, roll).area) - needed  # noqa: E731
    return brentq(surplus, -heights.max() - 1e-9, -heights.min() + 1e-9, xtol=1e-14 * section.size, rtol=1e-15)


def righting_lever(section: Immersible, loading: Loading, water: Water, roll: float) -> float:
    """Righting lever GZ (m) at a roll (rad) in vertical equilibrium; it rights if it has the sign of the roll."""
    heave = balanced_heave(section, loading, water, roll)
    return float(-restoring(section, loading, water, heave, roll)[2] / (loading.mass * water.gravity))


def righting_levers(section: Immersible, loading: Loading, water: Water, rolls: np.ndarray) -> np.ndarray:
    """The GZ curve (m) at rolls (rad)."""
    return np.array([righting_lever(section, loading, water, roll) for roll in rolls])


def metacentric_height(section: Immersible, loading: Loading, water: Water, roll: float = 0.0) -> float:
    """Metacentric height GM (m), the slope of GZ at a roll (rad): I/A − B̄G, I about the middle of the waterline."""
    heave = balanced_heave(section, loading, water, roll)
    wet, plane = section.immersion(heave, roll), section.waterplane(heave, roll)
    second = plane.second_moment - plane.moment**2 / plane.breadth
    gravity_height = heave + turned(loading.centre, roll)[1]
    return float(second / wet.area - (gravity_height - wet.centroid[1]))


def equilibrium(section: Immersible, loading: Loading, water: Water, roll: float = 0.0) -> tuple[float, float]:
    """Heave (m) and roll (rad) at which the hull comes to rest in calm water, starting from a roll (rad).

    It turns in the direction of its moment; from an unstable equilibrium to port, the positive side.
    """
    from scipy.optimize import brentq

    lever = lambda angle: righting_lever(section, loading, water, angle)  # noqa: E731
    start, before = lever(roll), roll
    if abs(start) <= LEVEL * section.size:
        if metacentric_height(section, loading, water, roll) > 0.0:
            return balanced_heave(section, loading, water, roll), roll
        start, before = -1.0, roll + 1e-6 * SEARCH
    step = -SEARCH if start > 0.0 else SEARCH
    after = roll + step
    while lever(after) * start > 0.0:
        before, after = after, after + step
        if abs(after - roll) > 2.0 * pi:
            raise Unavailable("the hull has no angle of stable equilibrium: its section is round about its centre.")
    angle = brentq(lever, before, after, xtol=1e-13)
    return balanced_heave(section, loading, water, angle), angle
