"""Presets: find, load, inherit, override.

A preset is a TOML file: one of those shipped, called by name ("tilting/quick"), or a person's own,
called by its path. It may be `based_on` another one; its keys go over the base's, and overrides go
over both.
"""

import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import TYPE_CHECKING

from lab import toml
from lab.errors import LabError
from lab.units import quoted

if TYPE_CHECKING:
    from lab.schema import Resolved

LARGEST_FILE = 1_000_000  # bytes

# Keys of a section that stand for one another: giving one side drops the other, inherited one.
ALTERNATIVES = {
    "tank": ({"width", "height"}, {"outline"}),
    "grains": ({"count"}, {"depth"}),
    "material": ({"restitution"}, {"dissipative_time"}),
    "wall": ({"restitution"}, {"dissipative_time"}),
}


@dataclass(frozen=True)
class LoadedPreset:
    """A preset ready to run: its name, its TOML text with all merged in, what it resolves to."""

    name: str
    given_text: str
    resolved: "Resolved"


@dataclass(frozen=True)
class Source:
    """Where a preset is written; `shown` is how people call it, `own` marks a person's file."""

    shown: str
    file: Traversable | Path
    own: bool = False

    @property
    def name(self) -> str:
        """A short name: a person's own file goes by its name without the ending."""
        return self.file.stem if self.own else self.shown


def names() -> dict[str, str]:
    """The shipped presets, sorted: name and title."""
    return {name: _gather(Source(name, file))["title"] for name, file in _shipped().items()}


def load(name_or_path: str | Path, overrides: Mapping | None = None) -> LoadedPreset:
    """A preset by name or path, under `overrides`: {"grains.diameter": "4 mm"} or nested tables.

    Raises LabError: no such preset, a file that cannot be read, or a key that is unknown or wrong.
    """
    from lab.schema import resolve  # brings the solvers; the list of presets does without

    source = _find(str(name_or_path))
    try:
        table = merged(_gather(source), nested(overrides or {}))
        resolved = resolve(table)
    except RecursionError:
        raise LabError(f"{source.shown}: nested too deeply.") from None
    heading = f"# {quoted(source.shown)}, with what it is based on and all overrides merged in.\n"
    return LoadedPreset(source.name, heading + toml.dumps(table), resolved)


def nested(overrides: Mapping) -> dict:
    """Overrides with dotted keys as nested tables; later ones go over earlier ones."""
    result: dict = {}
    for key, value in overrides.items():
        parts = str(key).split(".")
        if not all(parts):
            raise LabError(f"{quoted(key)} is not a key; write it like grains.diameter.")
        if parts[0] == "based_on":
            raise LabError("based_on: cannot be overridden; write a preset file that says it.")
        for part in reversed(parts):
            value = {part: value}
        result = merged(result, value, alternatives={})
    return result


def merged(base: Mapping, over: Mapping, path: str = "", alternatives: Mapping = ALTERNATIVES) -> dict:
    """`over` laid over `base`, table by table; of keys that stand for one another `over`'s stay."""
    result = dict(base)
    for side, other in _both_ways(alternatives.get(path)):
        if side & over.keys() and not other & over.keys():
            result = {key: value for key, value in result.items() if key not in other}
    for key, value in over.items():
        below = result.get(key)
        if isinstance(value, Mapping) and isinstance(below, Mapping):
            value = merged(below, value, f"{path}.{key}" if path else key, alternatives)
        result[key] = value
    return result


def _both_ways(pair: tuple[set, set] | None) -> tuple:
    return () if pair is None else (pair, pair[::-1])


def _shipped() -> dict[str, Traversable]:
    def below(folder: Traversable, path: str):
        for entry in folder.iterdir():
            if entry.is_dir():
                yield from below(entry, f"{path}{entry.name}/")
            elif entry.name.endswith(".toml"):
                yield path + entry.name.removesuffix(".toml"), entry

    return dict(sorted(below(files("presets"), "")))


def _find(name: str, beside: Path | None = None) -> Source:
    """The shipped preset `name`, else the file at that path (relative to the folder `beside`)."""
    shipped = _shipped()
    if name in shipped:
        return Source(name, shipped[name])
    path = (beside or Path()) / name
    if name.endswith(".toml") or path.is_file():
        return Source(name, path, own=True)
    group = [known for known in shipped if known.startswith(f"{name}/")]
    near = group or get_close_matches(name[:100], shipped, n=1, cutoff=0.4)
    hint = f"did you mean {' or '.join(near)}?" if near else "`cargolab list` shows all."
    raise LabError(f"there is no preset {quoted(name)}; {hint}")


def _gather(source: Source, heirs: tuple[str, ...] = ()) -> dict:
    """A preset's table with its base's under it; `heirs` are the files that led here."""
    table = _parsed(source)
    chain = (*heirs, os.path.realpath(str(source.file)))
    if chain[-1] in heirs:
        raise LabError(f"{source.shown}: based_on: the preset ends up based on itself.")
    base = table.pop("based_on", None)
    if base is None:
        return table
    if not isinstance(base, str):
        raise LabError(f"{source.shown}: based_on: the name or path of a preset is needed.")
    try:
        parent = _find(base, Path(str(source.file)).parent if source.own else None)
    except LabError as error:
        raise LabError(f"{source.shown}: based_on: {error}") from None
    return merged(_gather(parent, chain), table)


def _parsed(source: Source) -> dict:
    try:
        return tomllib.loads(_text(source))
    except tomllib.TOMLDecodeError as error:
        raise LabError(f"{source.shown}: not valid TOML: {error}.") from None
    except (ValueError, RecursionError):  # thousands of digits; lists in lists in lists …
        why = "too long a number or too deep a list"
        raise LabError(f"{source.shown}: not valid TOML: {why}.") from None


def _text(source: Source) -> str:
    try:
        with source.file.open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise LabError(f"{source.shown}: cannot be read: {error.strerror or error}.") from None
    except ValueError:
        raise LabError(f"{quoted(source.shown)} is not a file name.") from None
    if len(content) > LARGEST_FILE:
        raise LabError(f"{source.shown}: too large for a preset.")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise LabError(f"{source.shown}: not UTF-8 text (line {line}).") from None
