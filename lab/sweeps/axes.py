"""Parse the values of a sweep: ranges "0.2:1.5:14 Hz", lists "2 mm, 3 mm", single values."""

import re
import tomllib
from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path

from lab.base.errors import LabError
from lab.preset.find import screen

NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
UNIT = r"[^\W\d_%°][^:,]*|%|°"  # a unit may follow each number, the count, or the word
RANGE = re.compile(rf"({NUMBER})\s*({UNIT})?\s*:\s*({NUMBER})\s*({UNIT})?\s*:\s*([0-9]+)\s*(:\s*log\b)?\s*({UNIT})?")
QUANTITY = re.compile(rf"({NUMBER})\s*(.*)")
MOST = 10_000  # values of a range


def values(key: str, text: str) -> list[object]:
    """The values that `text` describes: a range (`:log`: evenly spaced in the logarithm), a list, or one value.

    A unit after a range or a list applies to all numbers in it without a unit. Each value is as in a preset: a number,
    a text, a TOML value. Raises LabError on an impossible range.
    """
    text = text.strip()
    found = RANGE.fullmatch(text)
    if found:
        return _range(key, *found.groups())
    return _with_last_unit(_listed(text))


def screen_first(name: str | Path, axes: Mapping[str, str | Sequence], overrides: Mapping | None) -> None:
    """Raise LabError for what is wrong with the keys of a sweep's first point, without loading the solvers."""
    first = {key: (values(key, given) if isinstance(given, str) else given)[:1] for key, given in axes.items()}
    setting = {key: found[0] for key, found in first.items() if len(found)}
    try:
        screen(name, {**(overrides or {}), **setting})
    except LabError as error:
        raise LabError(point_fails(setting, error)) from None


def point_fails(setting: Mapping[str, object], error: LabError) -> str:
    """The sentence on a point of a sweep that is no preset."""
    return f"point {', '.join(f'{key} = {value}' for key, value in setting.items())}: {error}"


def plain(text: str) -> object:
    """One value: TOML, or a text such as 4 mm, which needs no quotes here."""
    listed = _toml(text)
    return listed[0] if len(listed) == 1 else text


def _range(key: str, first: str, unit: str, last: str, other: str, count: str, log: str, common: str) -> list[object]:
    units = {name.strip() for name in (unit, other, common) if name}
    if len(units) > 1:
        raise LabError(f"{key}: a range needs one unit for both its ends (got {' and '.join(sorted(units))}).")
    start, stop, number = float(first), float(last), int(count)
    if not 2 <= number <= MOST:
        raise LabError(f"{key}: a range has 2 to {MOST} values (got {number}).")
    if not (isfinite(start) and isfinite(stop) and start != stop):
        raise LabError(f"{key}: the ends of a range must be two different numbers (got {first} and {last}).")
    if log and not start * stop > 0:
        raise LabError(f"{key}: a logarithmic range cannot reach or cross zero (got {first} to {last}).")
    import numpy as np  # not for single values, which every command may take

    numbers = (np.geomspace if log else np.linspace)(start, stop, number)
    rounded = [float(f"{x:.12g}") for x in numbers]  # 0.3, not 0.30000000000000004
    if units:
        return [f"{x:.12g} {units.copy().pop()}" for x in rounded]
    whole = all(x.is_integer() for x in rounded) and not set(first + last) & set(".eE")
    return [int(x) for x in rounded] if whole else rounded


def _listed(text: str) -> list[object]:
    listed = _toml(text)
    if listed:
        return listed
    items = [item.strip() for item in text.split(",")]
    if len(items) < 2 or not all(items):
        return [text]
    return [plain(item) for item in items]


def _with_last_unit(items: list[object]) -> list[object]:
    """Give numbers of a list the unit of its last quantity, as in 2, 3, 4 mm."""
    last = QUANTITY.fullmatch(items[-1]) if isinstance(items[-1], str) else None
    if len(items) < 2 or last is None or not last[2]:
        return items
    return [f"{x!r} {last[2]}" if isinstance(x, int | float) and not isinstance(x, bool) else x for x in items]


def _toml(text: str) -> list[object]:
    """The TOML values that `text` lists; empty if it is not TOML."""
    try:
        table = tomllib.loads(f"value = [{text}]")
    except (ValueError, RecursionError):
        return []
    kinds = bool | int | float | str | list | dict
    items = table["value"]
    return items if len(table) == 1 and all(isinstance(item, kinds) for item in items) else []
