"""The grain in a hull's holds: a CSV file of name, filling, stowage (m³/t) and moment (m⁴) or level (m), a row a hold.

`filling` says what the Grain Code assumes of it: partly-filled, filled or filled-as-loaded. `moment` is the volumetric
heeling moment of that, without its factor, as grain loading manuals list it. Without it `level` is the height of the
level grain above the keel in the hold of that name.
"""

from dataclasses import dataclass
from pathlib import Path

from lab.base.errors import LabError
from lab.naval.named_rows import number_of, read_rows
from solvers.machine.errors import Unavailable
from solvers.ship.naval.grain_code import ASSUMED
from solvers.ship.naval.holds import Hold

NEEDED = "name", "filling", "stowage"
PERHAPS = "moment", "level"


@dataclass(frozen=True)
class Stowed:
    """Grain in one hold: what is assumed of it, stowage factor (m³/t) and volumetric moment (m⁴)."""

    name: str
    filling: str
    stowage: float
    moment: float

    @property
    def factor(self) -> float:
        """The Grain Code's factor for the vertical part of the shift."""
        return ASSUMED[self.filling].factor

    @property
    def heeling(self) -> float:
        """Heeling moment (t m), factor included."""
        return self.moment * self.factor / self.stowage


def read_stowed(path: Path, holds: dict[str, Hold]) -> list[Stowed]:
    """The rows of a file. Raises LabError, one sentence with row and remedy."""
    found = []
    for number, row in enumerate(read_rows(path, NEEDED, PERHAPS, "a table of grain"), start=1):
        where = f"{path.name}: row {number} ({row['name']})"
        if row["filling"] not in ASSUMED:
            raise LabError(f"{where} has the filling {row['filling'] or 'nothing'}; give {', '.join(ASSUMED)}.")
        stowage = number_of(row, "stowage", number, path, 1e-3)
        if row["moment"]:
            moment = number_of(row, "moment", number, path, 0.0)
        else:
            moment = _of_level(holds.get(row["name"]), number_of(row, "level", number, path), row["filling"], where)
        found.append(Stowed(row["name"], row["filling"], stowage, moment))
    return found


def _of_level(hold: Hold | None, level: float, filling: str, where: str) -> float:
    """The moment (m⁴) of a hold's level filling."""
    if hold is None:
        raise LabError(f"{where} has a level, but --holds has no hold of that name; give its moment, or the hold.")
    try:
        volume = min(hold.filled_to(level).volume, hold.volume * (1.0 - 1e-9))
        return hold.volumetric_moment(volume, ASSUMED[filling].surface)
    except Unavailable as error:
        raise LabError(f"{where}: {error}") from None
