"""The cargo library, and cargoes of users' own files: reading them, checking each number, and finding one by name.

A file of a user's own is TOML with one cargo: `title`, `code`, and for each quantity a table or a list of tables with
`value`, `range` or both, with units, `source` in words, and maybe `note` and `axes`.
"""

import os
import tomllib
from collections.abc import Mapping
from difflib import get_close_matches
from functools import cache
from pathlib import Path

from lab.base.errors import LabError
from lab.preset.cargo.numbers import AXES, OF_MODELS, QUANTITIES, Cargo, Number
from lab.preset.units import parse, quoted, show, shown_path

FOLDER = Path(__file__).parent
LARGEST_FILE = 1_000_000  # bytes
TEXTS = "title", "code", "code_source"
KEYS = {*TEXTS, "also", "notes", *QUANTITIES}
OF_A_NUMBER = {"value", "range", "source", "note", "axes"}
SUFFIX = ".toml"  # ends the name of a user's own file
MOST_HINTS = 3


@cache
def library() -> dict[str, Cargo]:
    """The cargoes of the library by their names."""
    sources = tomllib.loads((FOLDER / "sources.toml").read_text(encoding="utf-8"))["sources"]
    tables = tomllib.loads((FOLDER / "cargoes.toml").read_text(encoding="utf-8"))
    return {name: cargo_of(name, table, "cargoes.toml", sources) for name, table in tables.items()}


def asked(name: str | Path = "") -> dict[str, Cargo]:
    """The cargoes of the library by name; of a `name`, or a cargo file's path, that one alone. Raises LabError."""
    if not str(name):
        return dict(library())
    cargo = cargo_named(str(name), key="cargoes")
    return {cargo.name: cargo}


def cargo_named(name: str, folder: Path | None = None, key: str = "grains.cargo") -> Cargo:
    """The cargo of a name in the library, or of a file of that path, relative to `folder`.

    Raises LabError, one sentence: `key` is where the name was given.
    """
    if name.endswith(SUFFIX):
        return own_cargo((folder or Path()) / name, key)
    known = library()
    wanted = name.strip().lower().replace(" ", "-").replace("_", "-")
    for cargo in known.values():
        if wanted in (cargo.name, *cargo.also):
            return cargo
    others = {other: cargo.name for cargo in known.values() for other in (cargo.name, *cargo.also)}
    near = list(dict.fromkeys(others[one] for one in get_close_matches(wanted[:100], others, n=MOST_HINTS, cutoff=0.5)))
    hint = f"did you mean {' or '.join(near)}?" if near else "`cargolab cargoes` lists them; a file ends in .toml."
    raise LabError(f"{key}: there is no cargo {quoted(name)}; {hint}")


def own_cargo(path: Path | str, key: str = "--cargo") -> Cargo:
    """The cargo of a user's own file. Raises LabError, one sentence that names the file."""
    shown = shown_path(path)
    try:
        if os.path.getsize(path) > LARGEST_FILE:
            raise LabError(f"{key}: {shown} is too large for a cargo.")
        table = tomllib.loads(Path(path).read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise LabError(f"{key}: {shown} cannot be read: {error.strerror or error}.") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, ValueError, RecursionError) as error:
        raise LabError(f"{key}: {shown} is not valid TOML: {str(error).splitlines()[0]}.") from None
    return cargo_of(Path(path).stem, table, shown)


def cargo_of(name: str, table: object, file: str, sources: Mapping[str, str] | None = None) -> Cargo:
    """The cargo of a table; `sources` has the texts that its short names stand for. Raises LabError."""
    where = f"{file}: {name}" if sources else file
    if not isinstance(table, Mapping):
        raise LabError(f"{where}: a table of quantities is needed.")
    for key in table.keys() - KEYS:
        near = get_close_matches(str(key)[:100], KEYS, n=1)
        hint = f"did you mean {near[0]}?" if near else f"a cargo has {', '.join(sorted(KEYS))}."
        raise LabError(f"{where}: unknown key {quoted(str(key))}; {hint}")
    texts = {key: _text(table, key, where) for key in TEXTS if key in table}
    if "title" not in texts:
        raise LabError(f'{where}: title: missing; a text in quotes is needed, e.g. "Linseed".')
    if sources and "code" in texts:
        texts["code_source"] = _source(sources, texts.get("code_source", ""), where)
    numbers = {key: _numbers(key, table[key], where, sources) for key in QUANTITIES if key in table}
    _check_density(numbers, where)
    notes, also = table.get("notes", []), table.get("also", [])
    if not isinstance(notes, list) or not all(isinstance(note, list) and len(note) == 2 for note in notes):
        raise LabError(f"{where}: notes: a list of [text, source] is needed.")
    if not isinstance(also, list):
        raise LabError(f"{where}: also: a list of names is needed.")
    told = tuple((str(text), _source(sources, str(source), where)) for text, source in notes)
    return Cargo(name=name, **texts, also=tuple(map(str, also)), notes=told, numbers=numbers)


def _numbers(name: str, given: object, where: str, sources: Mapping[str, str] | None) -> tuple[Number, ...]:
    """The numbers of a quantity, the one that fills presets first."""
    rows = given if isinstance(given, list) else [given]
    place = f"{where}: {name}"
    if not rows or not all(isinstance(row, Mapping) for row in rows):
        raise LabError(f"{place}: a table with value or range, and source, is needed.")
    return tuple(_number(name, row, place, sources) for row in rows)


def _number(name: str, row: Mapping, where: str, sources: Mapping[str, str] | None) -> Number:
    for key in row.keys() - OF_A_NUMBER:
        raise LabError(f"{where}: unknown key {quoted(str(key))}; a number has {', '.join(sorted(OF_A_NUMBER))}.")
    source = _source(sources, _text(row, "source", where) if "source" in row else "", where)
    axes = row.get("axes", "")
    if axes not in ("", *AXES) or (name in OF_MODELS) != bool(axes):
        wanted = f'axes = "{AXES[0]}" or "{AXES[1]}"' if name in OF_MODELS else "no axes"
        raise LabError(f"{where}: {wanted} is needed, since friction belongs to a model of the cargo.")
    value = _si(name, row["value"], f"{where}.value") if "value" in row else None
    low, high = _range(name, row["range"], where) if "range" in row else (value, value)
    if low is None:
        raise LabError(f"{where}: give a value, a range, or both.")
    middle = value is None
    value = 0.5 * (low + high) if middle else value
    if not low <= value <= high:
        raise LabError(f"{where}: the value lies outside the range.")
    return Number(name, low, high, value, source, middle, str(row.get("note", "")), axes)


def _range(name: str, given: object, where: str) -> tuple[float, float]:
    if not isinstance(given, list) or len(given) != 2:
        raise LabError(f"{where}.range: a list of two is needed, the smaller first.")
    low, high = (_si(name, one, f"{where}.range") for one in given)
    if low > high:
        raise LabError(f"{where}.range: the smaller number goes first.")
    return low, high


def _si(name: str, given: object, where: str) -> float:
    """A number in SI, within the bounds of its quantity."""
    quantity = QUANTITIES[name]
    try:
        value = parse(given, quantity.symbol)
    except LabError as error:
        raise LabError(f"{where}: {error}") from None
    if not quantity.least <= value <= quantity.most:
        low, high = (show(bound, quantity.symbol) for bound in (quantity.least, quantity.most))
        raise LabError(f"{where}: {quantity.doc} must be from {low} to {high} (got {quoted(given)}).")
    return value


def _source(sources: Mapping[str, str] | None, given: str, where: str) -> str:
    """The words of a source; in the library a short name stands for them."""
    if not given.strip():
        raise LabError(f"{where}: source: missing; say in words where the number is from.")
    if sources is None:
        return given
    if given not in sources:
        raise LabError(f"{where}: source: {quoted(given)} is not in sources.toml.")
    return sources[given]


def _text(table: Mapping, key: str, where: str) -> str:
    if not isinstance(table[key], str):
        raise LabError(f"{where}: {key}: a text in quotes is needed (got {quoted(table[key])}).")
    return table[key]


def _check_density(numbers: Mapping[str, tuple[Number, ...]], where: str) -> None:
    """Raise LabError where stowage factor times bulk density, of the first numbers, cannot be one within the ranges.

    And where the bed would be denser than its grains.
    """
    stowage, bulk, solid = (numbers.get(name, (None,))[0] for name in ("stowage", "bulk_density", "density"))
    if stowage and bulk and not stowage.low * bulk.low <= 1.0 <= stowage.high * bulk.high:
        raise LabError(f"{where}: stowage and bulk_density: no stowage factor in its range is one over the density.")
    if bulk and solid and bulk.low >= solid.high:
        raise LabError(f"{where}: bulk_density: the bed is denser than its grains.")
