"""Holds of a hull: a CSV file of hold, aft, forward, z and half_breadth in m, one row a corner, from the floor up.

A hold has one section from `aft` to `forward`, alike on both sides. x is forward from the aft perpendicular, z from the
keel; the first and the last row of a hold are its floor's and its top's half-breadths.
"""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.naval.named_rows import number_of, read_rows
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.naval.holds import Hold
from solvers.ship.section import ROUNDING, Section

COLUMNS = "hold", "aft", "forward", "z", "half_breadth"
SLACK = 1e-9  # of a hull's size: by so much a hold may touch her skin


def read_holds(path: Path, form: Form) -> dict[str, Hold]:
    """Holds by name. Raises LabError, one sentence, for those that are none or stand out of the hull."""
    rows: dict[str, list[tuple[float, ...]]] = {}
    for number, row in enumerate(read_rows(path, COLUMNS, (), "a table of holds"), start=1):
        values = tuple(number_of(row, key, number, path) for key in COLUMNS[1:])
        rows.setdefault(row["hold"], []).append(values)
    return {name: _hold(np.array(given), form, f"{path.name}: hold {name}") for name, given in rows.items()}


def _hold(rows: np.ndarray, form: Form, where: str) -> Hold:
    aft, forward = rows[0, :2]
    if np.ptp(rows[:, :2], axis=0).any() or not aft < forward:
        raise LabError(f"{where}: aft and forward must be the same in all its rows, and aft the smaller.")
    half, z = rows[:, 3], rows[:, 2]
    if (half < 0.0).any() or (np.diff(z) < 0.0).any():
        raise LabError(f"{where}: list its rows from the floor up, with half_breadth of at least 0.")
    starboard = np.column_stack([half, z])
    outline = np.concatenate([starboard, starboard[::-1] * [-1.0, 1.0]])
    size = float(np.ptp(outline, axis=0).max())
    outline = outline[np.hypot(*(outline - np.roll(outline, 1, axis=0)).T) > ROUNDING * size]
    try:
        hold = Hold(Section(outline), float(forward - aft))
    except Unavailable as error:
        raise LabError(f"{where}: {error}") from None
    _check_inside(starboard, float(aft), float(forward), form, where)
    return hold


def _check_inside(corners: np.ndarray, aft: float, forward: float, form: Form, where: str) -> None:
    """Raise LabError if a corner (n, 2) m is outside of the hull at the hold's ends or a station between them."""
    if aft < form.x[0] or forward > form.x[-1]:
        ends = f"{form.x[0]:g} to {form.x[-1]:g} m"
        raise LabError(f"{where}: it stands out of the hull, whose stations reach from {ends}; shorten it.")
    between = form.x[(form.x > aft) & (form.x < forward)]
    for x in (aft, *between, forward):
        for half, z in corners:
            room = half_breadth(form, float(x), float(z))
            if half > room + SLACK * form.depth:
                raise LabError(
                    f"{where}: it stands out of the hull at x {x:g}, y {half:g}, z {z:g} m, where her half-breadth is "
                    f"{room:.4g} m; make it smaller."
                )


def half_breadth(form: Form, x: float, z: float) -> float:
    """Half-breadth (m) of the hull at a place, straight between stations; 0 below and above her."""
    k = int(np.clip(np.searchsorted(form.x, x) - 1, 0, len(form.x) - 2))
    share = (x - form.x[k]) / (form.x[k + 1] - form.x[k])
    ends = [_of_section(form.sections[k + n], z) for n in (0, 1)]
    return float(ends[0] + share * (ends[1] - ends[0]))


def _of_section(section: Section | None, z: float) -> float:
    """The largest y (m) of a section at a height (m)."""
    if section is None:
        return 0.0
    begin, end = section.outline, np.roll(section.outline, -1, axis=0)
    low, high = np.minimum(begin[:, 1], end[:, 1]), np.maximum(begin[:, 1], end[:, 1])
    slack = SLACK * section.size
    found = [0.0]
    for k in np.flatnonzero((low <= z + slack) & (high >= z - slack)):
        rise = end[k, 1] - begin[k, 1]
        share = np.clip((z - begin[k, 1]) / rise, 0.0, 1.0) if abs(rise) > slack else np.array([0.0, 1.0])
        found += np.atleast_1d(begin[k, 0] + share * (end[k, 0] - begin[k, 0])).tolist()
    return max(found)
