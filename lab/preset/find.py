"""Presets: find, load, inherit, override.

A preset is a TOML file: a shipped one, called by name ("tilting/quick"), or a user's own, called by its path. It may be
`based_on` another preset: its keys override the base's, and overrides go over both. Title, source and what the source
reports are not inherited. A path in a preset is relative to the folder of the file that contains it; a path in an
override is relative to the working directory. A preset may have a table `quick` of keys that make it cheaper; the name
with the suffix QUICK, "tilting/fill-deep-quick", applies them.
"""

import os
import tomllib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache, reduce
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import TYPE_CHECKING

from lab.base import toml
from lab.base.data import PRESETS
from lab.base.errors import LabError
from lab.base.files import read_bytes
from lab.plugins.loading import admit
from lab.preset import formats
from lab.preset.cargo.filling import filled, located
from lab.preset.fields import NAME, marked
from lab.preset.kept import read as kept
from lab.preset.merge import Layer, merged, nested
from lab.preset.reader import check_keys, read
from lab.preset.units import quoted, shown_path

if TYPE_CHECKING:
    from lab.preset.schema import Preset

LARGEST_FILE = 1_000_000  # bytes
# Limit on the sum over the lines of (number of dots)²: the standard library's memory and time for a key of many parts,
# a.b.c…, grow with the square, and a key is within one line.
MOST_DOTS = 10_000_000

PLUGINS = "plugins"  # the key that names code which a preset needs
SHIP_FILE = "ship.toml"  # beside the presets, but none: the file of a ship for `cargolab hull`
QUICK = "-quick"  # suffix of a preset's name: its quick variant
# Keys that describe one experiment and are not inherited by presets based on it.
OWN_KEYS = ("title", "source", "reports", "based_on")


@dataclass(frozen=True)
class LoadedPreset:
    """A preset ready to run: its name, its TOML text with base and overrides merged in, and the resolved values.

    In the text, paths are as written.
    """

    name: str
    given_text: str
    resolved: "Preset"


@dataclass(frozen=True)
class Source:
    """The file of a preset; `shown` is its name in messages, `own` marks a user's file."""

    shown: str
    file: Traversable | Path
    own: bool = False

    @property
    def name(self) -> str:
        """A short name; for a user's own file, the file name without its extension."""
        if not self.own:
            return self.shown
        return self.file.stem if self.file.stem.strip(".") else "preset"  # results lie in a folder of that name

    @property
    def folder(self) -> Path:
        """The folder that paths in the preset are relative to."""
        return Path(str(self.file)).parent


def names() -> dict[str, str]:
    """Titles of the shipped presets and their quick variants by name, sorted."""
    return {one["name"]: one["title"] for one in listed()}


def listed(group: str = "", word: str = "") -> list[dict[str, object]]:
    """Name, title, source and report of the shipped presets and their `quick` variants, sorted by name.

    Those alone whose name begins with `group` and which have `word` in one of these texts, in capitals or not. Raises
    LabError if there are none.
    """
    found = []
    for name, file in _shipped().items():
        layers = _layers(Source(name, file))
        quick, told = _quick_tables(layers), _written(layers)
        one = {key: told.get(key, "") for key in ("title", "source", "reports")}
        found.append({"name": name, "quick": False, **one})
        if quick:
            cheaper = {"title": f"{one['title']}, cheaper and less exact"}
            found.append({"name": name + QUICK, "quick": True, **one, **cheaper})
    found = [one for one in found if one["name"].startswith(group)]
    if not found:
        groups = sorted({name.partition("/")[0] for name in _shipped()})
        raise LabError(f"no preset's name begins with {quoted(group)}; the groups are {', '.join(groups)}.")
    found = [one for one in found if word.lower() in "\n".join(map(str, one.values())).lower()]
    if not found:
        raise LabError(f"--search: no preset has {quoted(word)} in its name, title, source or report.")
    return sorted(found, key=lambda one: one["name"])


def load(name_or_path: str | Path, overrides: Mapping | None = None) -> LoadedPreset:
    """Load a preset by name or path, with `overrides`: {"grains.diameter": "4 mm"} or nested tables.

    Raises LabError: no such preset, a file that cannot be read, or a key that is unknown or wrong.
    """
    source, layers, table = _merged(name_or_path, overrides)
    from lab.preset.schema import resolve  # imports the solvers, which what is refused so far does not need

    try:
        resolved = resolve(table)
    except RecursionError:
        raise LabError(f"{source.shown}: nested too deeply.") from None
    based = f"{quoted(resolved.based_on)}, on which it is based, and " if resolved.based_on else ""
    heading = f"# {quoted(source.shown)} with {based}all overrides merged in.\n"
    quick = QUICK if _find_variant(str(name_or_path))[1] else ""
    return LoadedPreset(source.name + quick, heading + toml.dumps(_written(layers)), resolved)


def screen(name_or_path: str | Path, overrides: Mapping | None = None) -> None:
    """Raise LabError for what is wrong with a preset by itself, key by key, without loading the solvers.

    What only several keys make wrong together `load` says, and all of it once the solvers are loaded.
    """
    _merged(name_or_path, overrides)


def _merged(name_or_path: str | Path, overrides: Mapping | None) -> tuple[Source, list[Layer], dict]:
    """The file of a preset, its layers, and its keys with those of its bases and overrides. Raises as `load`."""
    source, quick = _find_variant(str(name_or_path))
    try:
        layers = _layers(source)
        formats.upgrade([layer.table for layer in layers], source.shown, changes := nested(overrides or {}))
        asked = reduce(merged, (layer.located([PLUGINS]) for layer in (*layers, Layer(changes, Path())))).get(PLUGINS)
        admit(asked if isinstance(asked, list) else [])
        keys = kept.keys()
        variant = _quick_variant(source, layers, marked(keys, "cheap"))
        if quick and not variant:
            raise LabError(f"{source.shown}: has no quick variant; run {source.shown} itself.")
        layers = [*layers, Layer(variant if quick else {}, Path()), Layer(changes, Path())]
        layers = filled(layers)
        table = reduce(merged, (layer.located([PLUGINS, *marked(keys, "columns")]) for layer in layers))
        table = located(table, layers)
        if keys is not kept.loaded():
            check_keys(keys, table)
            read(keys, table)
    except RecursionError:
        raise LabError(f"{source.shown}: nested too deeply.") from None
    return source, layers, table


def _quick_variant(source: Source, layers: list[Layer], cheap: Collection[str]) -> dict:
    """The keys that make a preset its quick variant, all of them `cheap`; empty if it has none."""
    tables = _quick_tables(layers)
    if not all(isinstance(table, Mapping) for table in tables):
        raise LabError(f"{source.shown}: quick: a table of keys is needed.")
    variant = reduce(merged, tables, {})
    if not variant:
        return {}
    differs = variant.pop("differs", None)
    if not isinstance(differs, str) or not differs.strip():
        raise LabError(f"{source.shown}: quick.differs: missing; say in a text how the quick variant differs.")
    for dotted in _leaves(variant):
        if not any(_is_below(dotted, key) for key in cheap):
            raise LabError(
                f"{source.shown}: quick.{quoted(dotted)[1:-1]}: may not differ; only {', '.join(cheap)} may."
            )
    return {"quick": differs, **variant}


def _is_below(dotted: str, key: str) -> bool:
    """Whether a dotted key of a preset is a key of the schema, in which NAME is any name, or below it."""
    parts, asked = dotted.split("."), key.split(".")
    return len(parts) >= len(asked) and all(two in (one, NAME) for one, two in zip(parts, asked, strict=False))


def _quick_tables(layers: list[Layer]) -> list:
    """Remove the `quick` tables from the layers and return those after the last `quick = false`."""
    # A text under `quick` marks a preset that is a quick variant already.
    tables = [layer.table.pop("quick") for layer in layers if not isinstance(layer.table.get("quick", ""), str)]
    refused = [place for place, table in enumerate(tables) if table is False]
    return tables[refused[-1] + 1 :] if refused else tables


def _leaves(table: Mapping, path: str = "") -> Iterator[str]:
    """The dotted keys of a table's values."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{path}{key}.")
        else:
            yield f"{path}{key}"


@cache
def _shipped() -> dict[str, Traversable]:
    """The files of the lab's own presets by name, sorted."""

    def below(folder: Traversable, path: str):
        for entry in folder.iterdir():
            if entry.is_dir():
                yield from below(entry, f"{path}{entry.name}/")
            elif entry.name.endswith(".toml") and entry.name != SHIP_FILE:
                yield path + entry.name.removesuffix(".toml"), entry

    return dict(sorted(below(PRESETS, "")))


def _find_variant(name: str) -> tuple[Source, bool]:
    """The preset of that name, and whether its quick variant is meant."""
    plain = name.removesuffix(QUICK)
    shipped = _shipped()
    quick = plain != name and name not in shipped and plain in shipped
    return _find(plain if quick else name), quick


def _find(name: str, beside: Path | None = None) -> Source:
    """The shipped preset `name`, else the file at that path, relative to the folder `beside`."""
    shipped = _shipped()
    if name in shipped:
        return Source(name, shipped[name])
    path = (beside or Path()) / name
    if name.endswith(".toml") or os.path.isfile(path):  # Path.is_file raises on names that are too long
        return Source(shown_path(name), path, own=True)
    if any(known.startswith(f"{name}/") for known in shipped):
        raise LabError(f"{quoted(name)} is a group of presets; `cargolab list` shows those in it.")
    near = get_close_matches(name[:100], shipped, n=1, cutoff=0.4)
    hint = f"did you mean {near[0]}?" if near else "`cargolab list` shows all."
    raise LabError(f"there is no preset {quoted(name)}; {hint}")


def _layers(source: Source, heirs: tuple[str, ...] = ()) -> list[Layer]:
    """The layers of a preset: its bases, the lowest first, then its own; `heirs` are the files that led here."""
    table = _parsed(source)
    chain = (*heirs, os.path.realpath(str(source.file)))
    if chain[-1] in heirs:
        raise LabError(f"{source.shown}: based_on: the preset ends up based on itself.")
    base = table.pop("based_on", None)
    own = Layer(table, source.folder)
    if base is None:
        return [own]
    if not isinstance(base, str):
        raise LabError(f"{source.shown}: based_on: the name or path of a preset is needed.")
    try:
        parent = _find(base, source.folder if source.own else None)
    except LabError as error:
        raise LabError(f"{source.shown}: based_on: {error}") from None
    own.table.setdefault("title", f"{shown_path(source.name)}, based on {parent.shown}")
    own.table["based_on"] = parent.shown
    return [*(layer.without(OWN_KEYS) for layer in _layers(parent, chain)), own]


def _written(layers: list[Layer]) -> dict:
    """All layers merged in order, with paths as written and without `based_on`."""
    return reduce(merged, (layer.without(("based_on",)).table for layer in layers))


def _parsed(source: Source) -> dict:
    text = _text(source)
    if sum(line.count(".") ** 2 for line in text.split("\n")) > MOST_DOTS:
        raise LabError(f"{source.shown}: not valid TOML: keys of too many parts.")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise LabError(f"{source.shown}: not valid TOML: {error}.") from None
    except (ValueError, RecursionError):  # thousands of digits; lists in lists in lists …
        why = "too long a number or too deep a list"
        raise LabError(f"{source.shown}: not valid TOML: {why}.") from None


def _text(source: Source) -> str:
    try:
        content = read_bytes(source.file, LARGEST_FILE + 1) if source.own else source.file.read_bytes()
    except OSError as error:
        raise LabError(f"{source.shown}: cannot be read: {error.strerror or error}.") from None
    except ValueError:
        raise LabError(f"{source.shown}: is not a file name.") from None
    if content is None:
        raise LabError(f"{source.shown}: is not a file.")
    if len(content) > LARGEST_FILE:
        raise LabError(f"{source.shown}: too large for a preset.")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise LabError(f"{source.shown}: not UTF-8 text (line {line}).") from None
