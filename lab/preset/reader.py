"""Read TOML tables into dataclasses: a field's annotation says what it takes; an error is one sentence.

A field is `bool`, `int`, `str`, a `Literal` of words, a number or a tuple of numbers with the markers of
`solvers.machine.marks`, another dataclass (a table), or a `dict[str, dataclass]` (tables that users name). `X | None`
may be left out. A value of `false` removes an inherited optional value or a named table.
"""

import types
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from difflib import get_close_matches
from functools import cache
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints
from unicodedata import category

from lab.base.errors import LabError
from lab.preset.toml import BARE_KEY
from lab.preset.units import needed, parse, quoted, show
from solvers.machine.marks import Interval, Unit

T = TypeVar("T")

LIKELY = 0.7  # similarity above which a key here is suggested before a key of the same name in another section
LONGEST_NAME = 40  # characters of a table's name that a user chooses
BOUND = 1e15  # SI numbers must be within 1/BOUND and BOUND; their squares and cubes stay finite


@dataclass
class Taken:
    """What a field takes: a type, words, or both; the unit and range of its numbers."""

    kind: Any = None
    words: tuple[str, ...] = ()
    symbol: str = "1"
    interval: Interval = Interval()  # noqa: RUF009 (frozen)
    optional: bool = False


def check_keys(kind: type, table: object) -> None:
    """Raise LabError on the first key that the dataclass `kind` lacks, suggesting a similar one."""
    _check_keys(kind, table, "", list(_dotted(kind)))


def dotted_key(kind: type, given: str) -> str:
    """The full dotted key for one given by its last part alone. Raises LabError if none or several match."""
    known = list(_dotted(kind))
    if given in known or "." in given:
        return given
    found = [key for key in known if key.split(".")[-1] == given and ".NAME" not in key]
    if len(found) != 1 and f"material.{given}" not in found:
        said = f"it could be {' or '.join(found)}" if found else "no preset has such a key"
        raise LabError(f"{given}: {said}; give the whole key, e.g. material.friction.")
    return found[0] if len(found) == 1 else f"material.{given}"


def taken_by(kind: type, dotted: str) -> Taken | None:
    """What a dotted key below the dataclass `kind` takes, with any names that users choose; None: no such key."""
    taken, parts = Taken(kind), dotted.split(".")
    while parts:
        if inner := _named_kind(taken.kind):
            taken = Taken(inner)
        elif is_dataclass(taken.kind) and parts[0] in {field.name for field in fields(taken.kind)}:
            taken = _taken_by(taken.kind, parts[0])
        else:
            return None
        parts = parts[1:]
    return taken


def read(kind: type[T], table: object, path: str = "") -> T:
    """Build the dataclass `kind` from a table whose keys `check_keys` has accepted.

    Raises LabError on a value that is missing or wrong, with its dotted key below `path`.
    """
    if not isinstance(table, Mapping):
        raise LabError(f"{path or 'the preset'}: a table of keys is needed (got {quoted(table)}).")
    values = {}
    for field in fields(kind):
        key, taken = _join(path, field.name), _taken_by(kind, field.name)
        if field.name in table:
            values[field.name] = _value(taken, table[field.name], key)
        elif field.default is MISSING and field.default_factory is MISSING:
            if not is_dataclass(taken.kind):
                raise LabError(f"{key}: missing; {_needed(taken)}.")
            values[field.name] = read(taken.kind, {}, key)
    return kind(**values)


RENAMED = {"ship.sheet": "tank.thickness"}  # keys of earlier versions


def _check_keys(kind: type, table: object, path: str, everywhere: list[str]) -> None:
    if not isinstance(table, Mapping):
        return
    known = {field.name: _taken_by(kind, field.name).kind for field in fields(kind)}
    for key, value in table.items():
        if key not in known:
            wrong = _join(path, quoted(str(key))[1:-1])
            if wrong in RENAMED:
                raise LabError(f"{wrong}: this key is {RENAMED[wrong]} now.")
            raise LabError(f"{wrong}: unknown key; {_hint(key, known, everywhere)}")
        if is_dataclass(known[key]):
            _check_keys(known[key], value, _join(path, key), everywhere)
        elif inner := _named_kind(known[key]):
            for name, table in value.items() if isinstance(value, Mapping) else ():
                _check_keys(inner, table, _join(_join(path, key), quoted(str(name))[1:-1]), everywhere)


def _hint(key: object, known: Mapping, everywhere: list[str]) -> str:
    near = get_close_matches(str(key)[:100], known, n=1, cutoff=LIKELY)
    near = near or [dotted for dotted in everywhere if dotted.endswith(f".{key}")][:1]
    near = near or get_close_matches(str(key)[:100], known, n=1)
    return f"did you mean '{near[0]}'?" if near else f"known here: {', '.join(known)}."


def _dotted(kind: type, path: str = "") -> Iterator[str]:
    for field in fields(kind):
        inner = _taken_by(kind, field.name).kind
        yield _join(path, field.name)
        if is_dataclass(inner):
            yield from _dotted(inner, _join(path, field.name))
        elif named := _named_kind(inner):
            yield from _dotted(named, _join(path, f"{field.name}.NAME"))


def _named_kind(kind: Any) -> type | None:
    """The dataclass of the tables that users name, if the kind is a `dict` of such."""
    return get_args(kind)[1] if get_origin(kind) is dict else None


@cache
def _taken_by(kind: type, name: str) -> Taken:
    return _taken(get_type_hints(kind, include_extras=True)[name])


def _taken(hint: Any) -> Taken:
    """Flatten an annotation: Annotated, unions and Literals may be nested in any order."""
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is Annotated:
        taken = _taken(arguments[0])
        for mark in hint.__metadata__:
            if isinstance(mark, Unit):
                taken.symbol = mark.symbol
            elif isinstance(mark, Interval):
                taken.interval = mark
        return taken
    if origin in (Union, types.UnionType):
        parts = [_taken(part) for part in arguments if part is not types.NoneType]
        taken = next((part for part in parts if part.kind is not None), parts[0])
        taken.words = tuple(word for part in parts for word in part.words)
        taken.optional = types.NoneType in arguments
        return taken
    if origin is Literal:
        return Taken(words=arguments)
    return Taken(kind=hint)


def _value(taken: Taken, raw: object, key: str) -> Any:
    if isinstance(raw, str) and raw in taken.words:
        return raw
    if raw is False and taken.optional:  # removes the value inherited from the base
        return None
    if taken.kind is None:
        raise LabError(f"{key}: {quoted(raw)} is unknown; {_word_hint(taken, raw)}")
    if is_dataclass(taken.kind):
        return read(taken.kind, raw, key)
    if get_origin(taken.kind) is tuple:
        return _tuple(taken, raw, key)
    if inner := _named_kind(taken.kind):
        return _named(inner, raw, key)
    value = _scalar(taken, raw, key)
    _check_interval(taken, value, raw, key)
    return value


def _scalar(taken: Taken, raw: object, key: str) -> Any:
    if taken.kind is float:
        try:
            value = parse(raw, taken.symbol)
        except LabError as error:
            words = "".join(f' (or "{word}")' for word in taken.words)
            raise LabError(f"{key}: {str(error).removesuffix('.')}{words}.") from None
        if value and not 1.0 / BOUND <= abs(value) <= BOUND:
            raise LabError(f"{key}: {quoted(raw)} is beyond all measure; look at the number and its unit.")
        return value
    if not isinstance(raw, taken.kind) or (taken.kind is int and isinstance(raw, bool)):
        raise LabError(f"{key}: {_needed(taken)} (got {quoted(raw)}).")
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
    return {name: read(kind, table, _join(key, name)) for name, table in raw.items() if table is not False}


def _tuple(taken: Taken, raw: object, key: str) -> tuple:
    parts = get_args(taken.kind)
    length = None if parts[-1] is Ellipsis else len(parts)
    if not isinstance(raw, list | tuple) or length not in (None, len(raw)):
        raise LabError(f"{key}: {_needed(taken)} (got {quoted(raw)}).")
    kinds = parts[:1] * len(raw) if length is None else parts
    return tuple(_value(_item(taken, kind), raw[i], f"{key}[{i}]") for i, kind in enumerate(kinds))


def _item(taken: Taken, kind: Any) -> Taken:
    """What an item of a list takes: by its own annotation, else the unit and range of the whole list."""
    if get_origin(kind) is Annotated:
        return _taken(kind)
    return Taken(kind, symbol=taken.symbol, interval=taken.interval)


def _needed(taken: Taken) -> str:
    """The clause of an error message that asks for a value."""
    if taken.kind is float:
        return needed(taken.symbol)
    if get_origin(taken.kind) is tuple:
        parts = get_args(taken.kind)
        size = "a list" if parts[-1] is Ellipsis else f"a list of {len(parts)}"
        return f"{size} is needed"
    asked = {int: "a whole number", bool: "true or false", str: "a text in quotes"}
    return f"{asked.get(taken.kind, 'a table of keys')} is needed"


def _word_hint(taken: Taken, raw: object) -> str:
    near = get_close_matches(str(raw)[:100], taken.words, n=1) if isinstance(raw, str) else []
    return f"did you mean '{near[0]}'?" if near else f"choose one of {', '.join(taken.words)}."


def check_interval(kind: type, name: str, value: Any, key: str) -> None:
    """Raise LabError for a number outside the range that a field of a dataclass may take."""
    taken = _taken_by(kind, name)
    _check_interval(taken, value, value, key)


def _check_interval(taken: Taken, value: Any, raw: object, key: str) -> None:
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


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key
