"""The IMSBC Code (IMO resolution MSC.268(85)), section 5: how uneven a dry bulk cargo without cohesion may lie.

Unevenness Δh is the height between the highest and the lowest level of the cargo's surface. A cargo of up to 30° of
repose is carried as grain. One of up to 35° may lie uneven by a tenth of the ship's breadth and by 1.5 m, a steeper one
by a tenth and by 2 m; the smaller of the two counts. Loading with approved trimming equipment may stand in its place.
"""

from math import radians

from solvers.ship.naval.criteria import Criterion

AS_GRAIN, STEEP = radians(30.0), radians(35.0)
OF_BREADTH = 0.1
MOST, MOST_OF_STEEP = 1.5, 2.0  # m


def unevenness_limit(repose: float, breadth: float) -> float | None:
    """The largest Δh (m) of a cargo with an angle of repose (rad) in a ship of a breadth (m); None: as grain."""
    if repose <= AS_GRAIN:
        return None
    return min(OF_BREADTH * breadth, MOST if repose <= STEEP else MOST_OF_STEEP)


def criterion(unevenness: float, repose: float, breadth: float) -> Criterion | None:
    """The criterion for a Δh (m); None for a cargo that is carried as grain."""
    limit = unevenness_limit(repose, breadth)
    if limit is None:
        return None
    return Criterion("IMSBC Code 5", "unevenness of the cargo's surface", "at most", limit, unevenness, "m")
