"""The 2008 IS Code (IMO resolution MSC.267(85)), part A 2.2: criteria on the curve of righting levers."""

from math import inf, radians

import numpy as np

from solvers.ship.naval.criteria import Criterion
from solvers.ship.naval.curve import Levers

THIRTY, FORTY = radians(30.0), radians(40.0)


def criteria(levers: Levers, metacentric_height: float, flooding: float | None = None) -> tuple[Criterion, ...]:
    """The six criteria of 2.2.1 to 2.2.4, corrected for free surfaces; `flooding` (rad): an opening goes under."""
    end = min(FORTY, inf if flooding is None else flooding)
    note = "" if end == FORTY else f"up to the flooding angle, {np.degrees(end):.1f} deg"
    last = float(levers.heel[-1])
    low, high = min(THIRTY, end), end
    top = levers.highest(0.0, last)
    beyond = levers.highest(THIRTY, last)
    area = "area under the righting levers, "
    return (
        Criterion("IS Code A 2.2.1", f"{area}0 to 30 deg", "at least", 0.055, levers.area(0.0, low), "m rad", note),
        Criterion("IS Code A 2.2.1", f"{area}0 to 40 deg", "at least", 0.090, levers.area(0.0, high), "m rad", note),
        Criterion("IS Code A 2.2.1", f"{area}30 to 40 deg", "at least", 0.030, levers.area(low, high), "m rad", note),
        Criterion(
            "IS Code A 2.2.2",
            "largest righting lever at 30 deg or more",
            "at least",
            0.20,
            float(levers.at(beyond)),
            "m",
        ),
        Criterion(
            "IS Code A 2.2.3", "heel of the largest righting lever", "at least", 25.0, float(np.degrees(top)), "deg"
        ),
        Criterion("IS Code A 2.2.4", "GM, corrected for free surfaces", "at least", 0.15, metacentric_height, "m"),
    )
