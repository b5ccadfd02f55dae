"""Read users' tables of numbers: CSV files with a header line of column names."""

import csv
import math
import re
from collections.abc import Iterator, Sequence
from difflib import get_close_matches
from io import StringIO
from itertools import islice

import numpy as np

from lab.base.errors import LabError
from lab.base.files import read_bytes
from lab.preset.units import NUMBER, quoted, shown_path

LARGEST_FILE = 32_000_000  # bytes
MOST_COLUMNS = 100

Line = tuple[int, list[str]]


def read_table(
    path: str,
    needed: Sequence[str],
    optional: Sequence[str] = (),
    key: str = "",
    most: int = 1_000_000,
    looked_at: int | None = None,
) -> dict[str, np.ndarray]:
    """Columns (rows,) of a CSV file by name, in the file's order: all `needed` ones and any of the `optional` ones.
    "*" among these is for columns of any name.

    The first line names the columns; cells are separated by commas, or by semicolons if the first line has any. Blank
    lines and lines that begin with # are skipped. looked_at: read so many rows alone. Raises LabError, one sentence
    that begins with the preset's `key`, the file and the line, for anything but such a table of finite numbers, and for
    more than `most` rows.
    """
    try:
        return _columns(_text(path), needed, optional, most, looked_at)
    except LabError as error:
        raise LabError(f"{f'{key}: ' if key else ''}{shown_path(path)}{error}") from None


def _columns(
    text: str, needed: Sequence[str], optional: Sequence[str], most: int, looked_at: int | None
) -> dict[str, np.ndarray]:
    lines = _lines(text)
    number, names = next(lines, (0, []))
    if not names:
        raise LabError(f": empty; a first line with the columns {', '.join(needed)} is needed.")
    _check_names(names, needed, optional, number)
    rows = [_numbers(line, names) for line in islice(lines, most if looked_at is None else looked_at)]
    if looked_at is None and next(lines, None):
        raise LabError(f": more than {most} rows.")
    if not rows:
        raise LabError(": has no numbers below its column names.")
    return dict(zip(names, np.array(rows).T.copy(), strict=True))


def _text(path: str) -> str:
    try:
        content = read_bytes(path, LARGEST_FILE + 1)
    except OSError as error:
        raise LabError(f": cannot be read: {error.strerror or error}.") from None
    except ValueError:  # characters that a file name cannot have
        raise LabError(": is not a file name.") from None
    if content is None:
        raise LabError(": is not a file.")
    if len(content) > LARGEST_FILE:
        raise LabError(f": too large for a table (over {LARGEST_FILE // 1_000_000} MB).")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise LabError(f", line {1 + content.count(10, 0, error.start)}: not UTF-8 text.") from None
    if "\0" in text:
        raise LabError(f", line {1 + text.count(chr(10), 0, text.index(chr(0)))}: not text, but binary data.")
    return text


def _lines(text: str) -> Iterator[Line]:
    """The lines that are not skipped, with their numbers, as cells without surrounding blanks."""
    delimiter = ""
    for number, line in enumerate(StringIO(text, newline=None), start=1):
        line = line.strip()
        if not line or line.startswith("#"):
            continue
        delimiter = delimiter or (";" if ";" in line else ",")
        if line.count(delimiter) >= MOST_COLUMNS:
            raise LabError(f", line {number}: more than {MOST_COLUMNS} columns.")
        try:
            cells = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True, strict=True))
        except csv.Error as error:
            raise LabError(f", line {number}: cannot be read: {error}.") from None
        yield number, [cell.strip() for cell in cells]


def _check_names(names: list[str], needed: Sequence[str], optional: Sequence[str], number: int) -> None:
    known = [*needed, *optional]
    for k, name in enumerate(names):
        if name not in known and "*" not in known:
            near = get_close_matches(name.lower()[:100], [one for one in known if name not in one.split("_")], n=1)
            hint = f"did you mean {near[0]}?" if near else f"known here: {', '.join(known)}."
            raise LabError(f", line {number}: unknown column {quoted(name)}; {hint}")
        if name in names[:k]:
            raise LabError(f", line {number}: the column {name} is there twice.")
    for name in needed:
        if name not in names:
            raise LabError(f", line {number}: the column {name} is missing.")


def _numbers(line: Line, names: list[str]) -> list[float]:
    number, cells = line
    if len(cells) != len(names):
        raise LabError(f", line {number}: {len(names)} numbers are needed, one a column (got {len(cells)}).")
    return [_number(cell, f", line {number}: {name}") for cell, name in zip(cells, names, strict=True)]


def _number(cell: str, where: str) -> float:
    if not cell:
        raise LabError(f"{where} is left out; a number is needed.")
    if re.fullmatch(r"[+-]?(nan|inf(inity)?)", cell, re.IGNORECASE):
        raise LabError(f"{where} must be a finite number (got {cell}).")
    if not NUMBER.fullmatch(cell):
        hint = ", with a point before the decimals" if "," in cell else ""
        raise LabError(f"{where}: a plain number is needed{hint} (got {quoted(cell)}).")
    value = float(cell)
    if not math.isfinite(value):
        raise LabError(f"{where} must be a finite number (got {quoted(cell)[1:-1]}).")
    return value
