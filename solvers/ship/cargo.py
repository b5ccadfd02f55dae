"""Loose cargo at rest in a heeled hold: a homogeneous filling with a plane surface, limited by the angle of repose.

In a slow heel a bed keeps its shape up to the angle of repose. Beyond it grains slide until the surface slopes against
the horizon by that angle again, so it leans by heel − repose against the deck. A fluid has an angle of repose of 0.
"""

from collections.abc import Sequence

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.hydrostatics import Loading, balanced_heave, righting_lever, turned
from solvers.ship.section import Immersible, Section
from solvers.ship.water import Water

ONE = Water(density=1.0)  # a fluid in which a displaced area (m²) is the mass (kg/m)


def lean(heel, repose: float) -> np.ndarray:
    """Angle (rad) of the surface against the deck, with the sign of the heel, at heels (rad) reached slowly from 0."""
    heel = np.asarray(heel, dtype=float)
    return np.sign(heel) * np.maximum(np.abs(heel) - repose, 0.0)


def filling_centre(hold: Section, area: float, leaning: float) -> np.ndarray:
    """Centroid (2,) m, in the hold's frame, of a filling of an area (m²) whose surface leans by an angle (rad).

    The filling is the immersed part of the hold when it floats with that immersed area. A positive angle is that of a
    heel to port, where the filling is deepest. Raises `Unavailable` if the hold has no room for it.
    """
    heave = balanced_heave(hold, Loading(area, (0.0, 0.0)), ONE, leaning)
    centre = hold.immersion(heave, leaning).centroid - np.array([0.0, heave])
    return turned((centre[0], centre[1]), -leaning)


def level_area(hold: Section, height: float) -> float:
    """Area (m²) of the level filling whose centroid is at a height (m). Raises `Unavailable` if there is none."""
    from scipy.optimize import brentq  # slow to import

    low, high = hold.outline[:, 1].min(), hold.outline[:, 1].max()
    surplus = lambda level: float(hold.immersion(-level, 0.0).centroid[1]) + level - height  # noqa: E731
    least = low + 1e-6 * hold.size
    if not surplus(least) < 0.0 < surplus(high):
        raise Unavailable(f"no level filling of the hold has its centre at {height:.4g} m.")
    return float(hold.immersion(-brentq(surplus, least, high), 0.0).area)


def relaxed_levers(
    section: Immersible,
    loading: Loading,
    water: Water,
    heels: np.ndarray,
    fillings: Sequence[tuple[Section, float, float]],
    repose: float,
) -> np.ndarray:
    """Righting levers GZ (m) at heels (rad) with a cargo that has slid to its angle of `repose` (rad).

    Each of the `fillings` is a hold, an area (m²) and a mass (kg/m). `loading` is that of hull and level cargo
    together, upright; the holds' axes are the hull's.
    """
    upright = [filling_centre(hold, area, 0.0) for hold, area, _ in fillings]
    levers = []
    for heel, leaning in zip(heels, lean(heels, repose), strict=True):
        ways = [
            filling_centre(hold, area, leaning) - lay for (hold, area, _), lay in zip(fillings, upright, strict=True)
        ]
        moved = sum(mass / loading.mass * way for (_, _, mass), way in zip(fillings, ways, strict=True))
        centre = loading.centre[0] + moved[0], loading.centre[1] + moved[1]
        levers.append(righting_lever(section, Loading(loading.mass, centre), water, heel))
    return np.array(levers)
