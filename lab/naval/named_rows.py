"""Small tables of a ship: rows with a name and a few numbers, each error one sentence with row and remedy."""

import re
from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from lab.base.errors import LabError
from lab.base.sheets import NONE, read_sheet
from lab.preset.units import quoted

MOST = 10_000  # rows
SPARE = "", "remark", "remarks", "note", "notes", "comment"  # columns that are left unread
UNIT = re.compile(r"\s*[\[(]\s*(?P<unit>[^\])]*?)\s*[\])]$")
UNITS = {"mass": ("t",), "fsm": ("t m", "tm", "t*m"), "stowage": ("m3/t", "m³/t"), "moment": ("m4", "m⁴")}


def read_rows(path: Path, needed: Sequence[str], perhaps: Sequence[str], what: str) -> list[dict[str, str]]:
    """The rows of a file as texts by column, decimals behind points. Raises LabError unless it has the columns needed.

    `what` names the table in the error; columns that may be left out are "" there.
    """
    sheet = read_sheet(path, MOST)
    line, first = sheet.rows[0]
    known = (*needed, *perhaps)
    names = [_named(cell, known, f"{path.name}: line {line}") for cell in first]
    if len(sheet.rows) < 2 or any(name not in names for name in needed):
        more = f" and perhaps {', '.join(perhaps)}" if perhaps else ""
        raise LabError(f"{path.name}: {what} has the columns {', '.join(needed)}{more}.")
    if odd := next((cell for cell, name in zip(first, names, strict=True) if name not in (*known, *SPARE)), None):
        raise LabError(
            f"{path.name}: line {line}: unknown column {quoted(odd)}; {what} has {', '.join(known)}. Correct it or "
            "remove it; a column remark may stay."
        )
    if twice := next((name for name in known if names.count(name) > 1), None):
        raise LabError(f"{path.name}: line {line}: the column {twice} is there twice.")
    found = []
    for number, cells in sheet.rows[1:]:
        if len(cells) > len(names):
            raise LabError(f"{path.name}: line {number}: has {len(cells)} cells for {len(names)} columns.")
        row = dict(zip(names, [*cells, *[""] * (len(names) - len(cells))], strict=True))
        found.append({key: _plain(sheet.number, row.get(key, "")) for key in known})
    return found


def _named(cell: str, known: Sequence[str], where: str) -> str:
    """A column's name without its unit. Raises LabError for one that is not in the lab's units."""
    unit = UNIT.search(cell)
    name = re.sub(r"[\s_-]+", "_", UNIT.sub("", cell).strip().lower())
    asked = UNITS.get(name, ("m",))
    if unit and name in known and unit["unit"].lower() not in ("", *asked):
        raise LabError(f"{where}: {cell} has to be in {asked[0]}; give it so.")
    return name


def _plain(number, cell: str) -> str:
    """A cell with a point before decimals; "" for an empty one."""
    value = number(cell)
    return "" if cell in NONE else cell if value is None else cell.replace(",", ".")


def number_of(row: dict[str, str], key: str, number: int, path: Path, least: float | None = None) -> float:
    """The number in a row's column. Raises LabError for a text, or for less than the `least`."""
    try:
        value = float(row[key])
    except ValueError:
        value = float("nan")
    if not isfinite(value) or (least is not None and value < least):
        asked = "a number" if least is None else f"a number of at least {least:g}"
        got = row[key] or "nothing"
        raise LabError(f"{path.name}: row {number} ({next(iter(row.values()))}) needs {asked} for {key} (got {got}).")
    return value
