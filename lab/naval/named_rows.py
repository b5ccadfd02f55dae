"""Small tables of a ship as CSV: rows with a name and a few numbers, each error one sentence with row and remedy."""

import csv
from collections.abc import Sequence
from io import StringIO
from itertools import islice
from math import isfinite
from pathlib import Path

from lab.base.errors import LabError
from lab.base.files import read_bytes

LARGEST_FILE = 8_000_000  # bytes
MOST = 10_000  # rows
LONGEST = 200  # letters of a name or a number; errors quote them whole


def read_rows(path: Path, needed: Sequence[str], perhaps: Sequence[str], what: str) -> list[dict[str, str]]:
    """The rows of a CSV file as texts by column. Raises LabError unless it has the columns needed.

    `what` names the table in the error; columns that may be left out are "" there.
    """
    try:
        content = read_bytes(path, LARGEST_FILE + 1)
        if content is None or len(content) > LARGEST_FILE:
            raise LabError(f"{path} is no table, or one of over {LARGEST_FILE // 1_000_000} MB; look at its name.")
        if b"\0" in content:
            raise LabError(f"{path} is no text but binary data; look at its name.")
        table = csv.DictReader(StringIO(content.decode("utf-8-sig"), newline=""))
        rows = list(islice(table, MOST + 1))
    except (OSError, ValueError, csv.Error):
        raise LabError(f"{path} cannot be read as a CSV file; look at its name.") from None
    if len(rows) > MOST:
        raise LabError(f"{path.name}: {what} has at most {MOST} rows; is it one?")
    texts = [text for row in rows for text in row.values() if isinstance(text, str)]
    if max(map(len, texts), default=0) > LONGEST:
        raise LabError(f"{path.name}: {what} has a text of more than {LONGEST} letters; is it one?")
    missing = [name for name in needed if not rows or name not in rows[0]]
    if missing:
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
