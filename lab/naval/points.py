"""Points of a hull that must stay above water: a CSV file of name, kind, x, y, z in m.

kind is "opening" (downflooding: hatches, vents, doors that are not weathertight) or "deck" (the deck's edge); x is
forward from the aft perpendicular, y to starboard, z from the keel. Without points of the deck its edge is where the
hull's side ends.
"""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.naval.named_rows import number_of, read_rows

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
