"""Tables as spreadsheets and design programs write them: their text, cells and numbers.

The text may be UTF-8, UTF-16 or Latin-1; cells are separated by tabs, semicolons, commas or blanks. Where commas do not
separate cells they may stand before decimals. Blank lines and lines that begin with # are skipped.
"""

import csv
import re
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from dataclasses import dataclass
from io import StringIO
from itertools import islice
from pathlib import Path

from lab.base.errors import LabError
from lab.base.files import read_bytes

LARGEST = 8_000_000  # bytes
MOST_CELLS = 500  # in a row
LONGEST = 200  # letters in a cell: messages quote cells whole
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
WITH_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
NONE = ("", "-", "–", "—")  # how an empty cell is written
BLANKS = " "


@dataclass(frozen=True)
class Sheet:
    """Rows of cells without surrounding blanks, each with the number of its line; `separator` stands between cells."""

    name: str
    rows: list[tuple[int, list[str]]]
    separator: str

    def number(self, cell: str) -> float | None:
        """The number in a cell, None if it has none."""
        if self.separator != "," and WITH_COMMA.fullmatch(cell):
            cell = cell.replace(",", ".")
        return float(cell) if NUMBER.fullmatch(cell) else None


def read_sheet(path: Path, most: int, numbers: bool = False) -> Sheet:
    """The rows of a file, at most so many. Raises LabError, one sentence with file and line, for what is no table.

    numbers: below the first row are only numbers, so that blanks, too, may separate them.
    """
    lines = [(number, line) for number, line in enumerate(StringIO(_text(path), newline=None), start=1)]
    lines = [(n, line.rstrip("\r\n")) for n, line in lines if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise LabError(f"{path.name}: is empty; look at its name.")
    if len(lines) > most + 1:
        raise LabError(f"{path.name}: has more than {most} rows; is it the table?")
    separator = _separator([line for _, line in lines], numbers)
    sheet = Sheet(path.name, [(n, _cells(line, separator, f"{path.name}: line {n}")) for n, line in lines], separator)
    _check_decimals(sheet)
    return sheet


def _text(path: Path) -> str:
    try:
        content = read_bytes(path, LARGEST + 1)
    except (OSError, ValueError) as error:
        raise LabError(f"{path} cannot be read ({getattr(error, 'strerror', '')}); look at its name.") from None
    if content is None or len(content) > LARGEST:
        raise LabError(f"{path} is no table, or one of over {LARGEST // 1_000_000} MB; look at its name.")
    text = content.decode(_encoding(content), "replace")
    if "\0" in text:
        raise LabError(f"{path.name}: is no text but binary data; export the table as CSV.")
    return text


def _encoding(content: bytes) -> str:
    """The text's encoding: by its first bytes, by bytes that are 0 in every second place, or as it can be read."""
    if content.startswith((BOM_UTF16_LE, BOM_UTF16_BE)):
        return "utf-16"
    for start, name in ((1, "utf-16-le"), (0, "utf-16-be")):
        half = content[start::2]
        if len(content) > 3 and half.count(0) > 0.8 * len(half) and content[1 - start :: 2].count(0) == 0:
            return name
    try:
        content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8-sig"


def _separator(lines: list[str], numbers: bool) -> str:
    for separator in ("\t", ";"):
        if separator in lines[0]:
            return separator
    if not numbers:
        return ","
    of_numbers = lambda cell: cell.strip() in NONE or NUMBER.fullmatch(cell.strip())  # noqa: E731
    by_commas = [line.split(",") for line in islice(lines[1:], 100)]
    if "," in lines[0] and all(of_numbers(cell) for cells in by_commas for cell in cells[1:]):
        return ","
    return BLANKS if " " in lines[0].strip() else ","


def _cells(line: str, separator: str, where: str) -> list[str]:
    if separator == BLANKS:
        cells = re.sub(r"\s+(?=[\[(])", "", line.strip()).split()  # a unit in brackets belongs to the name before it
    else:
        try:
            cells = [cell.strip() for cell in next(csv.reader([line], delimiter=separator, skipinitialspace=True))]
        except csv.Error as error:
            raise LabError(f"{where} cannot be read: {error}.") from None
    if len(cells) > MOST_CELLS or max(map(len, cells)) > LONGEST:
        raise LabError(f"{where} has more than {MOST_CELLS} cells, or one of over {LONGEST} letters; is it the table?")
    return cells


def _check_decimals(sheet: Sheet) -> None:
    """Raise LabError for decimals behind commas and behind points in one table: one of them groups thousands."""
    if sheet.separator == ",":
        return
    cells = [(n, cell) for n, row in sheet.rows for cell in row]
    comma = next((one for one in cells if WITH_COMMA.fullmatch(one[1])), None)
    point = next((one for one in cells if NUMBER.fullmatch(one[1]) and "." in one[1]), None)
    if comma and point:
        raise LabError(
            f"{sheet.name}: decimals are behind a comma in line {comma[0]} ({comma[1]}) and behind a point in line "
            f"{point[0]} ({point[1]}); write all alike."
        )
