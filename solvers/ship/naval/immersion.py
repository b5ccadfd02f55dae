"""Heels at which points of a whole hull, such as deck edges or openings, reach the calm water surface."""

from itertools import pairwise
from math import pi

import numpy as np

from solvers.ship.hydrostatics import SEARCH, turned
from solvers.ship.naval.form import Form
from solvers.ship.section import Section
from solvers.ship.water import Water


def heel_at_immersion(
    form: Form, displacement: float, water: Water, points: np.ndarray, side: float, lcg: float | None = None
) -> float | None:
    """Least heel (rad) up to 90° at which one of the points (n, 3) m goes under water, or None.

    At constant displacement (t), trimming freely if `lcg` (m) is given. side: 1 for heels to port, −1 to starboard.
    """
    from scipy.optimize import brentq  # slow to import

    points = np.atleast_2d(points)

    def clearance(heel: float) -> float:
        level = form.floating(displacement, water, side * heel, lcg)
        slope = (level[-1] - level[0]) / (form.x[-1] - form.x[0])
        height = turned((points[:, 1], points[:, 2]), side * heel)[:, 1]
        return float((height - level[0] - slope * (points[:, 0] - form.x[0])).min())

    heels = np.arange(0.0, 0.5 * pi + SEARCH, SEARCH)
    if clearance(0.0) <= 0.0:
        return 0.0
    for before, after in pairwise(heels):
        if clearance(after) <= 0.0:
            return float(brentq(clearance, before, after, xtol=1e-9))
    return None


def deck_edges(form: Form) -> np.ndarray:
    """The deck's edges (n, 3) m at the stations, both sides: where the side ends.

    Side is what is steeper than 45° or opens outwards, as the flare of a bow or a counter does.
    """
    found = []
    for x, section in zip(form.x, form.sections, strict=True):
        if section is not None:
            found += [(float(x), *corner) for corner in _edges(section)]
    return np.array(found)


def _edges(section: Section) -> list[tuple[float, float]]:
    """The highest ends (m) of the sides' edges: to starboard the outline goes up, to port it comes down."""
    begin, end = section.outline, np.roll(section.outline, -1, axis=0)
    way = end - begin
    of_side = (np.abs(way[:, 1]) >= np.abs(way[:, 0])) | (way[:, 0] > 0.0)  # on either side way y > 0 opens outwards
    found = []
    for side, tops in ((of_side & (way[:, 1] > 0.0), end), (of_side & (way[:, 1] < 0.0), begin)):
        if side.any():
            y, z = tops[side][int(np.argmax(tops[side][:, 1]))]
            found.append((float(y), float(z)))
    return found
