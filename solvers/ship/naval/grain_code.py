"""The International Grain Code (IMO resolution MSC.23(59), 1991): assumed shift of grain and the criteria of A 7.

Part B assumes a surface of 15° in a filled and of 25° in a partly filled compartment. The moment of that shift is a
volumetric moment V (m⁴), the volume times the transverse way of its centre; divided by the stowage factor it is one of
mass. The vertical part of the shift is allowed for by the factor: 1.12 in partly filled compartments; 1.00 in filled
ones with the cargo's centre taken at the centre of the hold's volume, else 1.06.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, radians

import numpy as np

from solvers.ship.naval.criteria import AFLOAT_NO_MORE, Criterion
from solvers.ship.naval.curve import Levers

FORTY = radians(40.0)
AT_FORTY = 0.8  # λ40 over λ0
STEEPEST = radians(12.0)
LEAST_AREA, LEAST_GM = 0.075, 0.30  # m rad, m


@dataclass(frozen=True)
class Assumed:
    """What the code assumes of a compartment: the surface's angle (rad) and the factor for the vertical shift."""

    surface: float
    factor: float


ASSUMED = {
    "partly-filled": Assumed(radians(25.0), 1.12),
    "filled": Assumed(radians(15.0), 1.00),
    "filled-as-loaded": Assumed(radians(15.0), 1.06),
}


def heeling_arm(volumetric_moment: float, stowage: float, displacement: float) -> float:
    """λ0 (m) = V / (SF Δ) from a volumetric moment (m⁴), a stowage factor (m³/t) and a displacement (t) (A 7.1)."""
    return volumetric_moment / (stowage * displacement)


def straight_line(arm: float) -> Callable[[np.ndarray], np.ndarray]:
    """The heeling arm (m) at heels (rad): a straight line from λ0 upright to 0.8 λ0 at 40° (figure A 7)."""
    return lambda heel: arm * (1.0 - (1.0 - AT_FORTY) * np.asarray(heel) / FORTY)


@dataclass(frozen=True)
class Residual:
    """The criteria's picture: heel of equilibrium, end of the area and what sets it, area (m rad); angles in rad."""

    heel: float
    end: float
    ends_at: str
    area: float


def residual(levers: Levers, arm: Callable[[np.ndarray], np.ndarray], flooding: float | None = None) -> Residual:
    """Residual stability beside a heeling arm, up to the largest difference, 40° or the `flooding` angle (rad)."""
    left = levers.less(arm)
    heel = left.equilibrium()
    if heel is None:
        return Residual(inf, inf, "no angle of equilibrium", 0.0)
    ends = {"40 deg": FORTY, "flooding": inf if flooding is None else flooding}
    reach = min(*ends.values(), float(levers.heel[-1]))
    if heel >= reach:
        return Residual(heel, heel, "the heel itself", 0.0)
    ends["the largest difference"] = left.highest(heel, float(levers.heel[-1]))
    name = min(ends, key=ends.get)
    return Residual(heel, ends[name], name, left.area(heel, ends[name]))


def criteria(
    levers: Levers,
    arm: Callable[[np.ndarray], np.ndarray],
    metacentric_height: float,
    deck: float | None = None,
    flooding: float | None = None,
) -> tuple[Criterion, ...]:
    """The three criteria of A 7.1 beside a heeling arm (m); `deck` and `flooding` are angles (rad) of immersion.

    The metacentric height (m) is after correction for free surfaces. The deck's edge counts for ships built from 1994.
    """
    found, stands = residual(levers, arm, flooding), levers.reach(flooding)
    steepest = STEEPEST if deck is None else min(STEEPEST, deck)
    heel, why = found.heel, "deck edge" if steepest < STEEPEST else ""
    if flooding is not None and flooding <= heel < inf:
        heel, why = inf, f"she floods at {np.degrees(flooding):.1f} deg, before {np.degrees(heel):.1f} deg"
    named = found.end == inf or found.ends_at == "40 deg"
    reach = f"up to {found.ends_at}" + ("" if named else f", {np.degrees(found.end):.1f} deg")
    if not stands:
        metacentric_height, heel, why = 0.0, inf, AFLOAT_NO_MORE
    return (
        Criterion(
            "Grain Code A 7.1.1", "heel from the shift of grain", "at most", *np.degrees([steepest, heel]), "deg", why
        ),
        Criterion("Grain Code A 7.1.2", "residual area", "at least", LEAST_AREA, found.area, "m rad", reach),
        Criterion(
            "Grain Code A 7.1.3",
            "GM, corrected for free surfaces",
            "at least",
            LEAST_GM,
            metacentric_height,
            "m",
            "" if stands else AFLOAT_NO_MORE,
        ),
    )
