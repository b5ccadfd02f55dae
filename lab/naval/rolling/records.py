"""Records of roll: a table of time and roll whose column says whether it is in deg or rad."""

import re
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.sheets import read_sheet

MOST = 200_000  # rows
LEAST = 20
TIMES, ROLLS = ("time", "t"), ("roll", "phi", "heel", "φ")
TO_RADIANS = {"deg": np.pi / 180.0, "degree": np.pi / 180.0, "degrees": np.pi / 180.0, "°": np.pi / 180.0, "rad": 1.0}
COLUMN = re.compile(r"^(?P<name>[^\W\d_]+)[\s_]*[\[(]?(?P<unit>[^\W\d_]*|°)[\])]?$")
STEEPEST = 0.5 * np.pi  # rad: beyond it the record is no roll of a ship, or not in the unit that is given


def read_roll(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) s and roll (n,) rad of a file. Raises LabError, one sentence with the line, for what is none."""
    sheet = read_sheet(path, MOST, numbers=True)
    (line, first), *rows = sheet.rows
    names = [COLUMN.match(cell.strip().lower()) for cell in first]
    known = [(one["name"], one["unit"]) if one else ("", "") for one in names]
    at = [k for k, (name, _) in enumerate(known) if name in TIMES]
    to = [k for k, (name, _) in enumerate(known) if name in ROLLS]
    if len(at) != 1 or len(to) != 1:
        raise LabError(f"{path.name}: line {line}: needs one column time and one of roll, as: time s, roll deg.")
    if known[at[0]][1] not in ("", "s"):
        raise LabError(f"{path.name}: line {line}: time has to be in s (got {known[at[0]][1]}).")
    unit = known[to[0]][1]
    if unit not in TO_RADIANS:
        got = unit or "no unit"
        raise LabError(f"{path.name}: line {line}: roll needs its unit, roll deg or roll rad (got {got}).")
    numbers = np.array([_numbers(sheet, path, number, cells, (at[0], to[0])) for number, cells in rows])
    if len(numbers) < LEAST:
        raise LabError(f"{path.name}: has {len(numbers)} rows; a record needs at least {LEAST}.")
    time, roll = numbers[:, 0], TO_RADIANS[unit] * numbers[:, 1]
    if not (np.diff(time) > 0.0).all():
        bad = rows[int(np.argmax(np.diff(time) <= 0.0)) + 1][0]
        raise LabError(f"{path.name}: line {bad}: time does not rise; put the rows in order.")
    if np.abs(roll).max() > STEEPEST:
        raise LabError(f"{path.name}: roll of {np.degrees(np.abs(roll).max()):.3g} deg; look at its unit, {unit}.")
    return time, roll


def _numbers(sheet, path: Path, line: int, cells: list[str], at: tuple[int, int]) -> tuple[float, float]:
    found = [sheet.number(cells[k]) if k < len(cells) else None for k in at]
    if None in found:
        raise LabError(f"{path.name}: line {line}: needs a number for time and for roll.")
    return float(found[0]), float(found[1])
