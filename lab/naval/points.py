"""Points of a hull that must stay above water: a CSV file of name, kind, x, y, z in m.

kind is "opening" (downflooding: hatches, vents, doors that are not weathertight) or "deck" (the deck's edge); x is
forward from the aft perpendicular, y to starboard, z from the keel. Without points of the deck its edge is where the
hull's side ends.
"""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.naval.named_rows import number_of, read_rows
from solvers.ship.naval.form import Form

COLUMNS = "name", "kind", "x", "y", "z"
KINDS = "opening", "deck"


def read_points(path: Path) -> dict[str, np.ndarray]:
    """Points (n, 3) m by kind; no entry for a kind without any. Raises LabError, one sentence with row and remedy."""
    found: dict[str, list] = {}
    for number, row in enumerate(read_rows(path, COLUMNS, (), "a table of points"), start=1):
        if row["kind"] not in KINDS:
            kinds = " or ".join(KINDS)
            raise LabError(
                f"{path.name}: row {number} ({row['name']}) has the kind {row['kind'] or 'nothing'}; give {kinds}."
            )
        found.setdefault(row["kind"], []).append([number_of(row, key, number, path) for key in "xyz"])
    return {kind: np.array(points) for kind, points in found.items()}


def names_of_openings(path: Path) -> tuple[str, ...]:
    """The names of the openings, in the order of their points."""
    rows = read_rows(path, COLUMNS, (), "a table of points")
    return tuple(row["name"] for row in rows if row["kind"] == "opening")


def check_near(points: dict[str, np.ndarray], form: Form, path: Path) -> None:
    """Raise LabError for a point that lies ahead or astern of a hull, or farther aside or up than it is large."""
    aft, fore = float(form.x[0]), float(form.x[-1])
    half = max(float(np.abs(section.outline[:, 0]).max()) for section in form.sections if section is not None)
    for kind, places in points.items():
        for x, y, z in places:
            if not aft - half <= x <= fore + half or abs(y) > 2.0 * half or z - form.base > 5.0 * form.depth:
                raise LabError(
                    f"{path.name}: the {kind} at x {x:g}, y {y:g}, z {z:g} m is far from the hull, which lies from x "
                    f"{aft:g} to {fore:g} m and is {2.0 * half:.4g} m broad; give x, y and z in m."
                )
