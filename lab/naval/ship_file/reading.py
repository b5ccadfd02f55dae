"""Reading a ship file: every mistake is one sentence with file, line, key and remedy."""

import re
import tomllib
from collections.abc import Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from lab.base.data import PRESETS
from lab.base.errors import LabError
from lab.base.files import read_bytes
from lab.naval.ship_file.keys import ShipKeys
from lab.naval.ship_file.lines import line_of, of_error, places
from lab.preset.fields import Taken, taken_of
from lab.preset.reader import check_keys, read
from solvers.machine.errors import Unavailable

FILE = "ship.toml"  # in a folder
LARGEST = 1_000_000  # bytes
MOST_DOTS = 10_000  # in a line: the standard library takes long over keys of many parts
KEY = re.compile(r"^([A-Za-z0-9_-]+(?:\.[A-Za-z0-9_-]+|\[\d+\])*): ")


@dataclass(frozen=True)
class Source:
    """The text of a ship file and where it lies: what an error needs to name its line."""

    path: Path
    text: str

    @cached_property
    def _places(self) -> dict[tuple[str, ...], int]:
        return places(self.text)

    def has(self, key: str) -> bool:
        """Whether a dotted key is written in the file."""
        parts = tuple(key.split("."))
        return any(one[: len(parts)] == parts for one in self._places)

    def error(self, key: str, sentence: str) -> LabError:
        """An error on a dotted key, with its line."""
        line = line_of(self._places, key)
        return LabError(f"{self.path.name}: {f'line {line}: ' if line else ''}{key}: {sentence}")

    @contextmanager
    def told(self, key: str = ""):
        """Errors raised inside become errors on a key with its line; by itself the key that the sentence names."""
        try:
            yield
        except (LabError, Unavailable) as error:
            sentence = re.sub(r"--([a-z]+)", r"hull.\1", str(error))
            named = KEY.match(sentence)
            if named and (not key or named[1].startswith("hull.")):
                raise self.error(named[1], sentence[named.end() :]) from None
            raise self.error(key, sentence) if key else LabError(f"{self.path.name}: {sentence}") from None


def is_ship_file(path: Path) -> bool:
    """Whether a path is one of a ship file, or a folder with one, or names one of the lab's own."""
    return path.suffix.lower() == ".toml" or path.is_dir() or _own(path).is_file()


def _own(path: Path) -> Path:
    """Where the ship file of a name such as ship/handysize is, if it is the lab's own."""
    return PRESETS / path / FILE


def load_keys(path: Path) -> tuple[ShipKeys, Source]:
    """The keys of a ship file, of the ship.toml in a folder, or of a ship of the lab's own. Raises LabError."""
    file = path / FILE if path.is_dir() else path
    if not path.exists() and _own(path).is_file():
        file = _own(path)
    try:
        content = read_bytes(file, LARGEST + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "no file has such a name"
        raise LabError(f"{file} cannot be read ({reason}); look at its name.") from None
    if content is None or len(content) > LARGEST:
        raise LabError(f"{file.name}: is no ship file; give a TOML file of at most {LARGEST // 1000} kB.")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise LabError(f"{file.name}: is no text in UTF-8; save it so.") from None
    if any(line.count(".") > MOST_DOTS for line in text.splitlines()):
        raise LabError(f"{file.name}: has a line with too many points; it is no ship file.")
    return _keys(Source(file, text)), Source(file, text)


def _keys(source: Source) -> ShipKeys:
    try:
        table = tomllib.loads(source.text)
    except tomllib.TOMLDecodeError as error:
        line, said = of_error(error)
        raise LabError(f"{source.path.name}: {f'line {line}: ' if line else ''}not valid TOML: {said}.") from None
    except (ValueError, RecursionError) as error:
        raise LabError(f"{source.path.name}: not valid TOML: {error}.") from None
    with source.told():
        check_keys(ShipKeys, table)
        return read(ShipKeys, _with_units(Taken(ShipKeys), table, ""))


def _with_units(taken: Taken, value: Any, path: str) -> Any:
    """A value as the reader of presets takes it: its plain numbers with the unit that the field is in.

    Raises LabError for unknown keys in tables of a list.
    """
    if taken.table and isinstance(value, Mapping):
        known = taken_of(taken.table)
        return {key: _with_units(known[key], one, _join(path, key)) for key, one in value.items()}
    if taken.named and isinstance(value, Mapping):
        return {name: _with_units(Taken(taken.named), one, _join(path, name)) for name, one in value.items()}
    if taken.items and isinstance(value, list):
        items = taken.items * len(value) if taken.many else taken.items
        if len(items) != len(value):
            return value
        for k, (item, one) in enumerate(zip(items, value, strict=True)):
            if item.table and isinstance(one, Mapping):
                _check_item(item.table, one, f"{path}[{k}]")
        return [_with_units(item, one, f"{path}[{k}]") for k, (item, one) in enumerate(zip(items, value, strict=True))]
    if isinstance(value, int | float) and not isinstance(value, bool) and taken.symbol != "1":
        return f"{value!r} {taken.symbol}"
    return value


def _check_item(kind: type, table: Mapping, path: str) -> None:
    """Raise LabError for an unknown key of a table in a list."""
    try:
        check_keys(kind, table)
    except LabError as error:
        raise LabError(f"{path}.{error}") from None


def _join(path: str, key: object) -> str:
    return f"{path}.{key}" if path else str(key)
