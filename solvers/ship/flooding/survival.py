"""Whether a damaged ship survives: the factor s of SOLAS II-1/7-2, from her righting levers with the water in her.

    s_final = K [GZ_max/0.12 m · Range/16°]^(1/4)
    s_intermediate = [GZ_max/0.05 m · Range/7°]^(1/4)

with GZ_max and Range not above these. K is 1 up to a heel of θ_min and 0 from θ_max on: 25° and 30° of a cargo ship, 7°
and 15° of a passenger ship. s_intermediate is 0 beyond a heel of 30° (cargo) or 15° (passenger).

Range is that of positive levers from the heel where she lies up to where they vanish, or to where an opening that
cannot be closed goes under; GZ_max is the largest lever within it.

Limits: between θ_min and θ_max no s is told, since K there could not be checked in a public text; s_mom, of passengers,
wind and survival craft, and the larger limits of damaged ro-ro spaces (0.20 m, 20°) are left out.
Units: m, rad.
"""

from dataclasses import dataclass

import numpy as np

from solvers.ship.naval.curve import Levers

FINAL, INTERMEDIATE = (0.12, np.radians(16.0)), (0.05, np.radians(7.0))  # GZ_max (m) and Range (rad)
HEELS = {"cargo": (np.radians(25.0), np.radians(30.0)), "passenger": (np.radians(7.0), np.radians(15.0))}


@dataclass(frozen=True)
class Survival:
    """Heel (rad) where she lies, largest lever (m) beyond it, range (rad), and s; None where it is not told."""

    heel: float
    lever: float
    range: float
    factor: float | None


def survival(levers: Levers, kind: str, final: bool, flooding: float | None = None) -> Survival:
    """What levers (m) to the side of her list say of a `kind` of ship; at `flooding` (rad) an opening goes under."""
    least, most = HEELS[kind]
    heel = levers.equilibrium()
    if heel is None or (flooding is not None and flooding <= heel):
        return Survival(float("nan") if heel is None else heel, 0.0, 0.0, 0.0)
    end = min(levers.crossing(heel + 1e-6, rising=False) or float(levers.heel[-1]), flooding or np.inf)
    lever = max(float(levers.at(levers.highest(heel, end))), 0.0)
    high, wide = FINAL if final else INTERMEDIATE
    factor = (min(lever / high, 1.0) * min((end - heel) / wide, 1.0)) ** 0.25
    if abs(heel) >= most and (final or abs(heel) > most):
        return Survival(heel, lever, end - heel, 0.0)
    told = factor if not final or abs(heel) <= least else None
    return Survival(heel, lever, end - heel, told)
