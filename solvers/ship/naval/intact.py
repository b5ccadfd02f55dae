"""The 2008 IS Code (IMO resolution MSC.267(85)), part A 2.2: criteria on the curve of righting levers.

Where an opening goes under that cannot be closed weathertight the curve ends: beyond it there is no area, no lever and
no largest lever, and a ship that lies with an opening under water meets none of the criteria.
"""

from math import radians

import numpy as np

from solvers.ship.naval.criteria import AFLOAT_NO_MORE, Criterion
from solvers.ship.naval.curve import Levers

THIRTY, FORTY = radians(30.0), radians(40.0)


def criteria(levers: Levers, metacentric_height: float, flooding: float | None = None) -> tuple[Criterion, ...]:
    """The six criteria of 2.2.1 to 2.2.4, corrected for free surfaces; `flooding` (rad): an opening goes under."""
    end = levers.reach(flooding)
    area = lambda begin, stop: levers.area(min(begin, end), min(stop, end))  # noqa: E731
    lever = float(levers.at(levers.highest(THIRTY, end))) if end > THIRTY else 0.0
    top = float(np.degrees(levers.highest(0.0, end))) if end else 0.0
    height = metacentric_height if end else 0.0
    floods = "" if end == levers.heel[-1] else f"up to the flooding angle, {np.degrees(end):.1f} deg"
    notes = [floods if end < stop else "" for stop in (THIRTY, FORTY, FORTY)] + [floods, floods, ""]
    if not end:
        notes = [AFLOAT_NO_MORE] * 6
    rows = (
        ("2.2.1", "area under the righting levers, 0 to 30 deg", 0.055, area(0.0, THIRTY), "m rad"),
        ("2.2.1", "area under the righting levers, 0 to 40 deg", 0.090, area(0.0, FORTY), "m rad"),
        ("2.2.1", "area under the righting levers, 30 to 40 deg", 0.030, area(THIRTY, FORTY), "m rad"),
        ("2.2.2", "largest righting lever at 30 deg or more", 0.20, lever, "m"),
        ("2.2.3", "heel of the largest righting lever", 25.0, top, "deg"),
        ("2.2.4", "GM, corrected for free surfaces", 0.15, height, "m"),
    )
    return tuple(
        Criterion(f"IS Code A {rule}", what, "at least", limit, attained, unit, note)
        for (rule, what, limit, attained, unit), note in zip(rows, notes, strict=True)
    )
