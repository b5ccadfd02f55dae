"""Read TOML tables into the dataclasses of a preset: a field's annotation says what it takes; an error is one sentence.

A value of `false` removes an inherited optional value, or a table with all its keys.
"""

from collections.abc import Mapping
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any, TypeVar
from unicodedata import category

from lab.base.errors import LabError
from lab.base.toml import BARE_KEY
from lab.preset import formats
from lab.preset.fields import NAME, Table, Taken, defaults_of, join, taken_of, walk
from lab.preset.units import needed, parse, quoted, show

T = TypeVar("T")

LIKELY = 0.7  # similarity above which a key here is suggested before a key of the same name in another section
MOST_HINTS = 3  # keys of the same name that a hint lists
LONGEST_NAME = 40  # characters of a table's name that a user chooses
BOUND = 1e15  # SI numbers must be within 1/BOUND and BOUND; their squares and cubes stay finite

RENAMED = {"ship.sheet": "tank.thickness"}  # keys of earlier versions


def check_keys(kind: type, table: object) -> None:
    """Raise LabError on the first key that the dataclass `kind` lacks, suggesting a similar one."""
    _check_keys(kind, table, "", [key for key, _ in walk(kind)])


def read(kind: type[T], table: object, path: str = "") -> T:
    """Build the dataclass `kind` from a table whose keys `check_keys` has accepted.

    Raises LabError on a value that is missing or wrong, with its dotted key below `path`.
    """
    if not isinstance(table, Mapping):
        raise LabError(f"{path or 'the preset'}: a table of keys is needed (got {quoted(table)}).")
    values, defaults = {}, defaults_of(kind)
    for name, taken in taken_of(kind).items():
        key = join(path, name)
        if name in table and not (table[name] is False and taken.below and name in defaults):
            values[name] = _value(taken, table[name], key)
        elif name not in defaults:
            if not taken.table:
                raise LabError(f"{key}: missing; {_needed(taken)}.")
            values[name] = read(taken.table, {}, key)
    return kind(**values)


def _check_keys(kind: type, table: object, path: str, everywhere: list[str]) -> None:
    if not isinstance(table, Mapping):
        return
    known = taken_of(kind)
    for key, value in table.items():
        if key not in known:
            _refuse(key, join(path, quoted(str(key))[1:-1]), list(known), everywhere)
        if known[key].table:
            _check_keys(known[key].table, value, join(path, key), everywhere)
        elif known[key].named:
            for name, inner in value.items() if isinstance(value, Mapping) else ():
                below = join(join(path, key), quoted(str(name))[1:-1])
                _check_keys(known[key].named, inner, below, everywhere)


def _refuse(key: object, wrong: str, known: list[str], everywhere: list[str]) -> None:
    """Raise LabError for a key that is unknown here; `wrong` is the whole of it."""
    if wrong in RENAMED:
        raise LabError(f"{wrong}: this key is {RENAMED[wrong]} now.")
    if any(wrong == f"{section}.{gone}" for section, keys in formats.GONE.items() for gone in keys):
        raise LabError(f"{wrong}: this version has no such model any more; leave the key out.")
    raise LabError(f"{wrong}: unknown key; {_hint(key, known, everywhere)}")


def _hint(key: object, known: list[str], everywhere: list[str]) -> str:
    here, text = set(known) <= set(everywhere), str(key)[:100]  # at the top, where keys of all sections get lost
    same = [dotted for dotted in everywhere if dotted.endswith(f".{key}")]
    same = [dotted for dotted in same if NAME not in dotted.split(".")] or same
    same = same[: MOST_HINTS if here else 1]
    likely = get_close_matches(text, known, n=1, cutoff=LIKELY)
    found = same or likely if here else likely or same
    found = found or (_below(text, everywhere) if here else []) or get_close_matches(text, known, n=1)
    if not found:
        return f"known here: {', '.join(known)}."
    *others, last = [f"'{one}'" for one in found]
    return f"did you mean {', '.join(others)}{' or ' * bool(others)}{last}?"


def _below(text: str, everywhere: list[str]) -> list[str]:
    """The dotted key whose last part is most like a text."""
    ends = {dotted.rpartition(".")[2]: dotted for dotted in reversed(everywhere)}
    return [ends[near] for near in get_close_matches(text, ends, n=1, cutoff=LIKELY)]


def _value(taken: Taken, raw: object, key: str) -> Any:
    if isinstance(raw, str) and raw in taken.words:
        return raw
    if raw is False and taken.optional:  # removes the value inherited from the base
        return None
    if taken.kind is None:
        raise LabError(f"{key}: {quoted(raw)} is unknown; {_word_hint(taken, raw)}")
    if taken.table:
        return read(taken.table, raw, key)
    if taken.items:
        return _tuple(taken, raw, key)
    if taken.named:
        return _named(taken.named, raw, key)
    if taken.kind is Table:
        return _file(taken, raw, key)
    value = _scalar(taken, raw, key)
    check_interval(taken, value, raw, key)
    return value


def _file(taken: Taken, raw: object, key: str) -> Table:
    """The columns of a file."""
    from lab.preset.tables import read_table  # with numpy, which few presets need to be read

    path = _scalar(replace(taken, kind=str), raw, key)
    asked = taken.columns
    if asked.surface:
        from lab.preset.sections.solids.mesh import read_mesh

        columns = read_mesh(path, key)
    else:
        columns = read_table(path, asked.needed, asked.optional, key, asked.most, asked.looked_at)
    return Table(Path(path).name, {name: tuple(values.tolist()) for name, values in columns.items()})


def _scalar(taken: Taken, raw: object, key: str) -> Any:
    words = "".join(f' (or "{word}")' for word in taken.words)
    if taken.kind is float:
        try:
            value = parse(raw, taken.symbol)
        except LabError as error:
            raise LabError(f"{key}: {str(error).removesuffix('.')}{words}.") from None
        if value and not 1.0 / BOUND <= abs(value) <= BOUND:
            raise LabError(f"{key}: {quoted(raw)} is beyond all measure; look at the number and its unit.")
        return value
    if not isinstance(raw, taken.kind) or (taken.kind is int and isinstance(raw, bool)):
        raise LabError(f"{key}: {_needed(taken)}{words} (got {quoted(raw)}).")
    if isinstance(raw, str) and any(category(c) in ("Cc", "Cs") for c in raw if c not in "\n\t"):
        raise LabError(f"{key}: the text has characters that cannot be shown (got {quoted(raw)}).")
    return raw


def _named(kind: type, raw: object, key: str) -> dict[str, Any]:
    """The tables that users name, in their order; one that is false is left out."""
    if not isinstance(raw, Mapping):
        raise LabError(f"{key}: tables with names of your own are needed (got {quoted(raw)}).")
    for name in raw:
        if not (isinstance(name, str) and len(name) <= LONGEST_NAME and BARE_KEY.fullmatch(name)):
            raise LabError(
                f"{key}: {quoted(str(name))} is no name; up to {LONGEST_NAME} letters A-Z, digits, - and _ make one."
            )
    return {name: read(kind, table, join(key, name)) for name, table in raw.items() if table is not False}


def _tuple(taken: Taken, raw: object, key: str) -> tuple:
    items = taken.items
    if not isinstance(raw, list | tuple) or not (taken.many or len(raw) == len(items)):
        raise LabError(f"{key}: {_needed(taken)} (got {quoted(raw)}).")
    items = items * len(raw) if taken.many else items
    return tuple(_value(item, one, f"{key}[{i}]") for i, (item, one) in enumerate(zip(items, raw, strict=True)))


def _needed(taken: Taken) -> str:
    """The clause of an error message that asks for a value."""
    if taken.kind is float:
        return needed(taken.symbol)
    if taken.items:
        return "a list is needed" if taken.many else f"a list of {len(taken.items)} is needed"
    asked = {int: "a whole number", bool: "true or false", str: "a text in quotes", Table: "a text in quotes"}
    return f"{asked.get(taken.kind, 'a table of keys')} is needed"


def _word_hint(taken: Taken, raw: object) -> str:
    near = get_close_matches(str(raw)[:100], taken.words, n=1) if isinstance(raw, str) else []
    return f"did you mean '{near[0]}'?" if near else f"choose one of {', '.join(taken.words)}."


def check_interval(taken: Taken, value: Any, raw: object, key: str) -> None:
    """Raise LabError for a number outside the range that a field may take; `raw` is how it was given."""
    limits = taken.interval
    rules = (
        ("greater than", limits.gt, lambda v, bound: v > bound),
        ("at least", limits.ge, lambda v, bound: v >= bound),
        ("less than", limits.lt, lambda v, bound: v < bound),
        ("at most", limits.le, lambda v, bound: v <= bound),
    )
    for words, bound, holds in rules:
        if bound is not None and not holds(value, bound):
            limit = show(bound, taken.symbol) if bound and taken.kind is float else bound
            raise LabError(f"{key}: must be {words} {limit} (got {quoted(raw).strip(chr(34))}).")
