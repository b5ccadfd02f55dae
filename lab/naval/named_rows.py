"""Small tables of a ship as CSV: rows with a name and a few numbers, each error one sentence with row and remedy."""

import csv
from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from lab.base.errors import LabError

MOST = 10_000  # rows


def read_rows(path: Path, needed: Sequence[str], perhaps: Sequence[str], what: str) -> list[dict[str, str]]:
    """The rows of a CSV file as texts by column. Raises LabError unless it has the columns needed.

    `what` names the table in the error; columns that may be left out are "" there.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError, csv.Error):
        raise LabError(f"{path} cannot be read as a CSV file; look at its name.") from None
    missing = [name for name in needed if not rows or name not in rows[0]]
    if missing or len(rows) > MOST:
        more = f" and perhaps {', '.join(perhaps)}" if perhaps else ""
        raise LabError(f"{path.name}: {what} has the columns {', '.join(needed)}{more}.")
    return [{key: (row.get(key) or "").strip() for key in (*needed, *perhaps)} for row in rows]


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
