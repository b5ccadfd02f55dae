"""A table of weights: a CSV file of name, mass (t), lcg, tcg, vcg (m) and fsm (t m), one row a weight.

lcg is forward from the aft perpendicular, tcg to starboard, vcg above the keel; fsm is the moment of a free surface and
may be left out. For longitudinal strength `aft` and `forward` (m) are a weight's ends; without them it is at a point.
"""

from dataclasses import dataclass
from pathlib import Path

from lab.base.errors import LabError
from lab.naval.named_rows import number_of, read_rows
from solvers.machine.errors import Unavailable
from solvers.ship.naval.whole_hull.strength import Extent

NEEDED = "name", "mass", "lcg", "tcg", "vcg"
FREE = "fsm"
ENDS = "aft", "forward"


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
    found = []
    for number, row in enumerate(read_rows(path, NEEDED, (FREE, *ENDS), "a table of weights"), start=1):
        row[FREE] = row[FREE] or "0"
        values = {key: number_of(row, key, number, path, 0.0 if key == "mass" else None) for key in (*NEEDED[1:], FREE)}
        if any(row[end] for end in ENDS):
            values |= {end: number_of(row, end, number, path) for end in ENDS}
        found.append({"name": row["name"]} | values)
    mass = sum(row["mass"] for row in found)
    if not mass > 0.0:
        raise LabError(f"{path.name}: the weights add up to {mass:.4g} t; a ship floats on more than nothing.")
    centre = (sum(row["mass"] * row[key] for row in found) / mass for key in ("lcg", "tcg", "vcg"))
    return Weights(mass, *centre, sum(row[FREE] for row in found)), found


def extents(path: Path, rows: list[dict[str, object]]) -> list[Extent]:
    """The weights of a file along the ship. Raises LabError for ends that do not fit a weight's centre."""
    found = []
    for row in rows:
        ends = (row[end] for end in ENDS) if ENDS[0] in row else (None, None)
        try:
            found.append(Extent(row["name"], row["mass"], row["lcg"], *ends))
        except Unavailable as error:
            raise LabError(f"{path.name}: {error}") from None
    return found
