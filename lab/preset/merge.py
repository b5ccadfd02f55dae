"""Merge tables of presets: a preset over its base, overrides over both."""

import os
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import reduce
from pathlib import Path

from lab.base.data import FOLDER, PREFIX, data_file
from lab.base.errors import LabError
from lab.preset.python.plain import plain
from lab.preset.units import quoted

FILE = "file"  # the key of a table that may be said in place of the table: history = "record.csv"
# Alternative keys of a section: giving one side drops inherited values of the others.
ALTERNATIVES = {
    "tank": ({"width", "height"}, {"outline"}),
    "grains": ({"count"}, {"depth"}),
    "material": ({"restitution"}, {"dissipative_time"}),
    "wall": ({"restitution"}, {"dissipative_time"}),
    "bulk": ({"friction"}, {"repose"}),
    "water": ({"depth"}, {"region"}, {"radius"}),
    "ship": ({"gyradius"}, {"roll_period"}),
}


def nested(overrides: Mapping) -> dict:
    """Overrides with dotted keys as nested tables; later ones go over earlier ones."""
    result: dict = {}
    for key, value in overrides.items():
        parts = str(key).split(".")
        if not all(parts):
            raise LabError(f"{quoted(key)} is not a key; write it like grains.diameter.")
        if parts[0] in ("based_on", "quick"):
            raise LabError(f"{parts[0]}: cannot be overridden; write a preset file that says it.")
        value = plain(value)
        for part in reversed(parts):
            value = {part: value}
        result = merged(result, value, alternatives={})
    return result


def merged(base: Mapping, over: Mapping, path: str = "", alternatives: Mapping = ALTERNATIVES) -> dict:
    """Merge `over` into `base`, table by table; where keys are alternatives, those of `over` win."""
    result = dict(base)
    sides = alternatives.get(path, ())
    for side in sides:
        other = set().union(*sides) - side
        if side & over.keys() and not other & over.keys():
            result = {key: value for key, value in result.items() if key not in other}
    for key, value in over.items():
        below = result.get(key)
        if isinstance(value, Mapping) and isinstance(below, Mapping):
            value = merged(below, value, f"{path}.{key}" if path else key, alternatives)
        result[key] = value
    return result


@dataclass(frozen=True)
class Layer:
    """A table of keys to be merged with others, and the folder that paths in it are relative to."""

    table: dict
    folder: Path

    def without(self, keys: Collection[str]) -> "Layer":
        """The layer without some of its top-level keys."""
        return Layer({key: value for key, value in self.table.items() if key not in keys}, self.folder)

    def located(self, keys: Collection[str]) -> dict:
        """The table with the paths under the dotted `keys` made absolute; NAME stands for any name."""
        return reduce(self._with_full_path, keys, dict(self.table))

    def _with_full_path(self, table: dict, dotted: str) -> dict:
        key, _, rest = dotted.partition(".")
        named = list(table) if key == "NAME" else [key] if key in table else []
        return table | {name: self._located_value(table[name], rest) for name in named}

    def _located_value(self, value: object, rest: str) -> object:
        if rest and isinstance(value, Mapping):
            return self._with_full_path(dict(value), rest)
        if isinstance(value, list) and not rest:
            return [self._located_value(one, "") if str(one).endswith(".py") else one for one in value]
        if not isinstance(value, str) or rest not in ("", FILE):
            return value
        path = _measured(value) if value.startswith(PREFIX) else os.path.abspath(self.folder / value)
        return {rest: path} if rest else path


def _measured(value: str) -> str:
    """The path of a file of measured series. Raises LabError where it is not there."""
    path = data_file(value.removeprefix(PREFIX))
    if path is None:
        raise LabError(f"{quoted(value)} is not there: set {FOLDER} to the folder of measured series that has it.")
    return os.path.abspath(path)
