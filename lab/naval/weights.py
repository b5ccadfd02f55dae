"""A table of weights: a CSV file of name, mass (t), lcg, tcg, vcg (m) and fsm (t m), one row a weight.

lcg is forward from the aft perpendicular, tcg to starboard, vcg above the keel; fsm is the moment of a free surface and
may be left out.
"""

import csv
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from lab.base.errors import LabError

NEEDED = "name", "mass", "lcg", "tcg", "vcg"
FREE = "fsm"
MOST = 10_000  # rows


@dataclass(frozen=True)
class Weights:
    """The sum: mass (t), its centre (m) and the moment of all free surfaces (t m)."""

    mass: float
    lcg: float
    tcg: float
    vcg: float
    free_surface: float

    @property
    def fluid_vcg(self) -> float:
        """KG (m) raised by the free surfaces."""
        return self.vcg + self.free_surface / self.mass


def read_weights(path: Path) -> tuple[Weights, list[dict[str, object]]]:
    """The sum of a file's weights, and its rows. Raises LabError, one sentence with row and remedy."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError, csv.Error):
        raise LabError(f"{path} cannot be read as a CSV file; look at its name.") from None
    missing = [name for name in NEEDED if not rows or name not in rows[0]]
    if missing or len(rows) > MOST:
        raise LabError(f"{path.name}: a table of weights has the columns {', '.join(NEEDED)} and perhaps {FREE}.")
    found = []
    for number, row in enumerate(rows, start=1):
        found.append({"name": row["name"]} | {key: _number(row, key, number, path) for key in (*NEEDED[1:], FREE)})
    mass = sum(row["mass"] for row in found)
    if not mass > 0.0:
        raise LabError(f"{path.name}: the weights add up to {mass:.4g} t; a ship floats on more than nothing.")
    centre = (sum(row["mass"] * row[key] for row in found) / mass for key in ("lcg", "tcg", "vcg"))
    return Weights(mass, *centre, sum(row[FREE] for row in found)), found


def _number(row: dict, key: str, number: int, path: Path) -> float:
    text = (row.get(key) or "").strip()
    if not text and key == FREE:
        return 0.0
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not isfinite(value) or (key == "mass" and value < 0.0):
        raise LabError(f"{path.name}: row {number} ({row['name']}) needs a number for {key} (got {text or 'nothing'}).")
    return value
