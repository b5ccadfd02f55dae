"""Tables in feet, long tons and inches: for paper only, all is computed in metric units."""

import re
from functools import cache
from math import ceil, log10

from lab.naval.tables import Table

# Unit of a column: Pint's names of it and of what is printed, and how that is written
UNITS = {
    "m": ("m", "ft", "ft"),
    "m2": ("m^2", "ft^2", "ft2"),
    "m3": ("m^3", "ft^3", "ft3"),
    "m4": ("m^4", "ft^4", "ft4"),
    "m rad": ("m", "ft", "ft rad"),
    "t": ("tonne", "long_ton", "LT"),
    "t m": ("tonne*m", "long_ton*ft", "LT ft"),
    "t/cm": ("tonne/cm", "long_ton/inch", "LT/in"),
    "t m/cm": ("tonne*m/cm", "long_ton*ft/inch", "LT ft/in"),
    "m3/t": ("m^3/tonne", "ft^3/long_ton", "ft3/LT"),
    "kg/m3": ("kg/m^3", "lb/ft^3", "lb/ft3"),
}
OF_ROW = "unit"  # the column that names a row's unit
SIZES = "limit", "attained", "margin"  # columns in the row's unit
NUMBER = re.compile(r"-?\d+(\.\d+)?")


def imperial(table: Table) -> Table:
    """The same table in feet and long tons; columns name their units, and a column "unit" those of its rows."""
    header, lines = table
    if OF_ROW in header:
        return header, [_row(header, line) for line in lines]
    units = [_unit(name) for name in header]
    names = [name if unit is None else _renamed(name, unit) for name, unit in zip(header, units, strict=True)]
    return names, [tuple(map(_cell, line, units)) for line in lines]


def _row(header, line):
    """A row whose numbers are in the unit that it names."""
    at = list(header).index(OF_ROW)
    unit = line[at] if line[at] in UNITS else None
    in_unit = [name in SIZES or k > at for k, name in enumerate(header)]
    cells = [_cell(cell, unit if inside else None) for cell, inside in zip(line, in_unit, strict=True)]
    cells[at] = UNITS[unit][2] if unit else line[at]
    return tuple(cells)


def _unit(name: str) -> str | None:
    """The unit that a column's name ends with."""
    words = name.split()
    return next((" ".join(words[-n:]) for n in (2, 1) if " ".join(words[-n:]) in UNITS and len(words) > n), None)


def _renamed(name: str, unit: str) -> str:
    return f"{name.removesuffix(unit)}{UNITS[unit][2]}"


def _cell(cell: object, unit: str | None) -> object:
    """A number in the other unit with as many digits as it had; texts as they are."""
    if unit is None or not isinstance(cell, str) or not NUMBER.fullmatch(cell):
        return cell
    factor = _factor(unit)
    digits = len(cell.partition(".")[2]) - max(0, ceil(log10(factor)))
    return f"{float(cell) * factor:.{max(0, digits)}f}"


@cache
def _factor(unit: str) -> float:
    """What one of a unit is in the other."""
    registry = _registry()
    one, other, _ = UNITS[unit]
    return float(registry.Quantity(1.0, one).to(other).magnitude)


@cache
def _registry():
    from pint import UnitRegistry  # takes a third of a second

    return UnitRegistry()
