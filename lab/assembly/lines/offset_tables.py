"""Tables of offsets as people have them: columns of station, z, half_breadth, or a matrix of stations and waterlines.

A matrix has places along the ship on one side and heights on the other; the longer of the two are the stations, unless
its labels say so. An empty cell is a height that the station does not have. Its breadths are half-breadths, as tables
of offsets list them; "full breadth" in its first cell says otherwise. All is in metres.
"""

import re
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.sheets import NONE, Sheet, read_sheet

MOST = 100_000  # rows
NAMES = {
    "station": ("station", "stations", "stn", "st", "x", "station_x", "x_station", "position"),
    "z": ("z", "height", "waterline", "waterlines", "wl", "level", "water_line"),
    "half_breadth": ("half_breadth", "half_breadths", "halfbreadth", "half_beam", "half_width", "y", "offset"),
    "full_breadth": ("full_breadth", "full_breadths", "full_beam", "full_width"),
}
EITHER = ("breadth", "breadths", "beam", "width", "b")  # half of it, or the whole?
WHICH = "may be a half-breadth or a full one; call it half_breadth or full_breadth"
UNITS = ("m", "mm", "cm", "dm", "km", "ft", "in", "inch", "metre", "metres", "meter", "meters", "feet")
METRES = ("", "m", "metre", "metres", "meter", "meters")
WITH_UNIT = re.compile(rf"^(.*?)[\s_,]*[\[(]\s*([^\])]*?)\s*[\])]$|^(.*?)[\s_,]+({'|'.join(UNITS)})$", re.IGNORECASE)
LABEL = re.compile(
    r"^(?P<word>[A-Za-z][A-Za-z .:_=-]*?)?[\s.:_=-]*(?P<number>[+-]?[\d.,]+(?:[eE][+-]?\d+)?)(?P<rest>.*)$"
)


def offsets_of(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Station, z and half-breadth (n,) m of a file. Raises LabError, one sentence with line and remedy."""
    sheet = read_sheet(path, MOST, numbers=True)
    first = sheet.rows[0][1]
    if len(first) > 1 and all(_label(sheet, cell) for cell in first[1:]):
        return _matrix(sheet)
    return _columns(sheet)


def _columns(sheet: Sheet) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of a table with a row a point."""
    line, first = sheet.rows[0]
    names = [_named(sheet, line, cell) for cell in first]
    breadth = "full_breadth" if "full_breadth" in names else "half_breadth"
    for name in ("station", "z", breadth):
        if names.count(name) != 1:
            told = "is there twice" if name in names else "is missing"
            raise LabError(
                f"{sheet.name}: line {line}: the column {name} {told}; a table of offsets has station, z and "
                "half_breadth in m, or is a matrix of stations and waterlines."
            )
    rows = []
    for number, cells in sheet.rows[1:]:
        if len(cells) != len(names):
            raise LabError(f"{sheet.name}: line {number}: has {len(cells)} cells for {len(names)} columns.")
        rows.append([_value(sheet, number, name, cell) for name, cell in zip(names, cells, strict=True)])
    if not rows:
        raise LabError(f"{sheet.name}: has no numbers below its column names.")
    found = dict(zip(names, np.array(rows).T, strict=True))
    return found["station"], found["z"], found[breadth] * (0.5 if breadth == "full_breadth" else 1.0)


def _matrix(sheet: Sheet) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of a table with a row a station, or a row a waterline."""
    line, first = sheet.rows[0]
    across = [_place(sheet, line, cell) for cell in first[1:]]
    down, values = [], []
    for number, cells in sheet.rows[1:]:
        if len(cells) > len(first):
            raise LabError(f"{sheet.name}: line {number}: has {len(cells)} cells below {len(first)}.")
        down.append(_place(sheet, number, cells[0]))
        cells = [*cells[1:], *[""] * (len(first) - len(cells))]
        values.append([np.nan if one in NONE else _value(sheet, number, "half-breadth", one) for one in cells])
    for places in (across, down):
        if len(set(places)) < len(places):
            twice = next(one for one in places if places.count(one) > 1)
            raise LabError(
                f"{sheet.name}: {twice:g} m is there twice as a place of the matrix; a table with a row a point begins "
                "with the line station,z,half_breadth."
            )
    half = np.array(values).reshape(len(down), len(across)) * _share(sheet, line, first[0])
    if not _stations_go_down(sheet, down, across):
        down, across, half = across, down, half.T
    order = np.argsort(across)
    z, half = np.array(across)[order], half[:, order]
    station, z = np.broadcast_arrays(np.array(down)[:, None], z)
    there = np.isfinite(half)
    return station[there], z[there], half[there]


def _stations_go_down(sheet: Sheet, down: list[float], across: list[float]) -> bool:
    """Whether the rows of a matrix are stations: by its labels, else by the longer side."""
    corner, cells = sheet.rows[0][1][0], [sheet.rows[0][1][1], *(row[0] for _, row in sheet.rows[1:2])]
    words = [word for word in re.split(r"[^a-z]+", corner.lower()) if _kind(word)]
    if words:
        return _kind(words[0]) == "station"
    above, beside = (_kind((LABEL.match(cell)["word"] or "").strip(" .:_=-").lower()) for cell in cells)
    if beside or above:
        return (beside == "station") if beside else (above == "z")
    return np.ptp(down) >= np.ptp(across)


def _kind(word: str) -> str | None:
    return next((name for name in ("station", "z") if word in NAMES[name]), None)


def _share(sheet: Sheet, line: int, corner: str) -> float:
    """What of a matrix's breadths is a half-breadth, by the words in its first cell."""
    words, unit = corner.lower(), re.search(r"[\[(]\s*(\w+)\s*[\])]", corner)
    if unit and unit[1].lower() in UNITS:
        _check_unit(sheet, line, corner, unit[1])
    if "full" in words:
        return 0.5
    if re.search("breadth|beam|width", words) and "half" not in words:
        raise LabError(f"{sheet.name}: line {line}: {corner} {WHICH}.")
    return 1.0


def _named(sheet: Sheet, line: int, cell: str) -> str:
    """A column's name as the lab has it. Raises LabError for another one, or one that is not in metres."""
    found = WITH_UNIT.match(cell)
    name, unit = (found[1] or found[3] or "", found[2] or found[4] or "") if found else (cell, "")
    _check_unit(sheet, line, cell, unit)
    plain = re.sub(r"[\s_-]+", "_", name.strip().lower())
    if plain in EITHER:
        raise LabError(f"{sheet.name}: line {line}: the column {cell} {WHICH}.")
    for known, others in NAMES.items():
        if plain in others:
            return known
    if sheet.number(cell) is not None:
        raise LabError(f"{sheet.name}: line {line}: names of columns are missing: station, z and half_breadth, in m.")
    raise LabError(
        f'{sheet.name}: line {line}: unknown column "{cell}"; a table of offsets has station, z and half_breadth in m, '
        "or is a matrix of stations and waterlines."
    )


def _label(sheet: Sheet, cell: str) -> bool:
    """Whether a cell may be a place of a matrix: a number, perhaps with a word before and a unit behind it."""
    found = LABEL.match(cell)
    return bool(found) and sheet.number(found["number"]) is not None


def _place(sheet: Sheet, line: int, cell: str) -> float:
    """The place (m) that a row or column of a matrix is at."""
    if not _label(sheet, cell):
        got = f'"{cell}"' if cell else "nothing"
        raise LabError(f"{sheet.name}: line {line}: the place of a station or waterline is needed in m (got {got}).")
    found = LABEL.match(cell)
    _check_unit(sheet, line, cell, found["rest"].strip(" []()"))
    return sheet.number(found["number"])


def _check_unit(sheet: Sheet, line: int, cell: str, unit: str) -> None:
    if unit.lower() not in METRES:
        raise LabError(f"{sheet.name}: line {line}: {cell} is not in metres; give all lengths in m.")


def _value(sheet: Sheet, line: int, name: str, cell: str) -> float:
    value = sheet.number(cell)
    if value is None or not np.isfinite(value):
        got = f'"{cell}"' if cell else "nothing"
        raise LabError(f"{sheet.name}: line {line}: a number is needed for {name} (got {got}).")
    return value
