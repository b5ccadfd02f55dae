"""Heels at which points of a hull, such as deck edges or openings, reach the calm water surface."""

from collections.abc import Sequence
from math import pi

import numpy as np

from solvers.ship.hydrostatics import SEARCH, Loading, balanced_heave, turned
from solvers.ship.section import Immersible
from solvers.ship.water import Water


def immersion_angle(
    section: Immersible, loading: Loading, water: Water, points: Sequence[tuple[float, float]]
) -> float | None:
    """Least |heel| (rad), to either side, at which one of the points (m) reaches the still waterline, or None.

    The displacement is constant. For a deck's edges this is the angle of deck immersion, for openings the angle of
    downflooding φ_f (IMO, 2008 IS Code, part A, 2.3.1.4).
    """
    found = [
        angle for side in (1.0, -1.0) if (angle := _to_one_side(section, loading, water, points, side)) is not None
    ]
    return min(found, default=None)


def _to_one_side(section: Immersible, loading: Loading, water: Water, points, side: float) -> float | None:
    from scipy.optimize import brentq  # slow to import

    corners = tuple(np.transpose(points))

    def deepest(angle: float) -> float:
        roll = side * angle
        return -float((balanced_heave(section, loading, water, roll) + turned(corners, roll)[:, 1]).min())

    before = 0.0
    while before < pi:
        if deepest(before + SEARCH) >= 0.0:
            return float(brentq(deepest, before, before + SEARCH, xtol=1e-12))
        before += SEARCH
    return None
