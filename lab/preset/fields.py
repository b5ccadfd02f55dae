"""What the fields of a preset's dataclasses take, read from their annotations.

A field is `bool`, `int`, `str`, a `Literal` of words, a number or a tuple of numbers with the marks of
`solvers.machine.marks`, a `Table` (the name of a file with columns of numbers), another dataclass (a table of keys), or
a `dict[str, dataclass]` (tables that users name). `X | None` may be left out. Every field has a sentence, `Doc`.
"""

import types
from collections.abc import Iterator
from dataclasses import MISSING, dataclass, fields, is_dataclass, replace
from functools import cache, cached_property
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from lab.base.errors import LabError
from solvers.machine.marks import Cheap, Doc, Interval, Unit, Usual

ANY = "*"  # among the columns of a file: those of any name
NAME = "NAME"  # stands in dotted keys for a name that users choose


@dataclass(frozen=True)
class Alike:
    """Marks a field that must be equal in all runs of one launch; what their scenes must share, the scenes say."""


@dataclass(frozen=True)
class Of:
    """Marks a field that says something of matters, which are named by their keys; refused without any of them."""

    matters: tuple[str, ...]

    def __init__(self, *matters: str) -> None:
        object.__setattr__(self, "matters", matters)


@dataclass(frozen=True)
class Columns:
    """Marks a field whose value is a CSV file: the columns it needs, those it may have (ANY: all), the most rows."""

    needed: tuple[str, ...]
    optional: tuple[str, ...] = ()
    most: int = 1_000_000
    looked_at: int | None = None  # rows that are read to refuse a wrong file early; None: all, to use them
    surface: bool = False  # whether the file is an STL file, with the corners of a triangle in a row


@dataclass(frozen=True)
class Table:
    """What the file of a preset holds: its name, and its columns of numbers by name."""

    name: str
    columns: dict[str, tuple[float, ...]]

    def __hash__(self) -> int:
        return hash((self.name, tuple(self.columns.items())))


@dataclass(frozen=True)
class Taken:
    """What a field takes: a type, words, or both; the unit and range of its numbers; its sentence and other marks."""

    kind: Any = None
    words: tuple[str, ...] = ()
    symbol: str = "1"
    interval: Interval = Interval()  # noqa: RUF009 (frozen)
    optional: bool = False
    doc: str = ""
    usual: Usual | None = None
    columns: Columns | None = None
    cheap: bool = False
    alike: bool = False
    of: tuple[str, ...] = ()

    @cached_property
    def table(self) -> type | None:
        """The dataclass of a table of keys, None for other values."""
        return self.kind if is_dataclass(self.kind) and self.kind is not Table else None

    @cached_property
    def named(self) -> type | None:
        """The dataclass of the tables that users name, if the field holds such."""
        return get_args(self.kind)[1] if get_origin(self.kind) is dict else None

    @cached_property
    def below(self) -> type | None:
        """The dataclass of the tables below this field, named by users or not."""
        return self.table or self.named

    @cached_property
    def items(self) -> "tuple[Taken, ...]":
        """What the items of a list take, all the same one where it may have `many`; empty for other values.

        An item goes by its own annotation, else by the unit and range of the whole list.
        """
        kinds = get_args(self.kind) if get_origin(self.kind) is tuple else ()
        alike = {"symbol": self.symbol, "interval": self.interval}
        own = (taken_from(kind) if get_origin(kind) is Annotated else Taken(kind, **alike) for kind in kinds)
        return tuple(one for one in own if one.kind is not Ellipsis)

    @cached_property
    def many(self) -> bool:
        """Whether a list may have any number of items."""
        return Ellipsis in get_args(self.kind)


@cache
def taken_of(kind: type) -> dict[str, Taken]:
    """What the fields of a dataclass take, by name."""
    hints = get_type_hints(kind, include_extras=True)
    return {field.name: taken_from(hints[field.name]) for field in fields(kind) if field.init}


@cache
def defaults_of(kind: type) -> dict[str, Any]:
    """The defaults of a dataclass's fields, by name; those that must be given are not among them."""
    found = {}
    for field in fields(kind):
        if field.default is not MISSING:
            found[field.name] = field.default
        elif field.default_factory is not MISSING:
            found[field.name] = field.default_factory()
    return found


def taken_from(hint: Any) -> Taken:
    """Flatten an annotation: Annotated, unions and Literals may be nested in any order."""
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return replace(taken_from(arguments[0]), **_marked(hint.__metadata__))
    if origin in (Union, types.UnionType):
        parts = [taken_from(part) for part in arguments if part is not types.NoneType]
        taken = next((part for part in parts if part.kind is not None), parts[0])
        words = tuple(word for part in parts for word in part.words)
        return replace(taken, words=words, optional=types.NoneType in arguments)
    if origin is Literal:
        return Taken(words=arguments)
    return Taken(kind=hint)


def _marked(marks: tuple) -> dict[str, object]:
    """The fields of `Taken` that marks set."""
    found: dict[str, object] = {}
    for mark in marks:
        if isinstance(mark, Doc):
            found["doc"] = mark.text
        elif isinstance(mark, Unit):
            found["symbol"] = mark.symbol
        elif isinstance(mark, Of):
            found["of"] = mark.matters
        elif isinstance(mark, Cheap | Alike):
            found[type(mark).__name__.lower()] = True
        elif isinstance(mark, Interval | Usual | Columns):
            found[type(mark).__name__.lower()] = mark
    return found


@cache
def walk(kind: type) -> tuple[tuple[str, Taken], ...]:
    """Every dotted key below a dataclass, with what it takes; a name that users choose is NAME."""
    return tuple(_walk(kind, ""))


def _walk(kind: type, path: str) -> Iterator[tuple[str, Taken]]:
    for name, taken in taken_of(kind).items():
        key = join(path, name)
        yield key, taken
        if taken.below:
            yield from _walk(taken.below, join(key, NAME) if taken.named else key)


def marked(kind: type, mark: str) -> list[str]:
    """The dotted keys below a dataclass whose fields have a mark: columns, cheap or alike."""
    return [key for key, taken in walk(kind) if getattr(taken, mark)]


def taken_by(kind: type, dotted: str) -> Taken | None:
    """What a dotted key below the dataclass `kind` takes, with any names that users choose; None: no such key."""
    taken, parts = Taken(kind), dotted.split(".")
    while parts:
        if taken.named:
            taken = Taken(taken.named)
        elif taken.table and parts[0] in taken_of(taken.table):
            taken = taken_of(taken.table)[parts[0]]
        else:
            return None
        parts = parts[1:]
    return taken


def dotted_key(kind: type, given: str) -> str:
    """The full dotted key for one given by its last part alone. Raises LabError if none or several match."""
    known = [key for key, _ in walk(kind)]
    if given in known or "." in given:
        return given
    found = [key for key in known if key.split(".")[-1] == given and f".{NAME}" not in key]
    if len(found) != 1 and f"material.{given}" not in found:
        said = f"it could be {' or '.join(found)}" if found else "no preset has such a key"
        raise LabError(f"{given}: {said}; give the whole key, e.g. material.friction.")
    return found[0] if len(found) == 1 else f"material.{given}"


def join(path: str, key: str) -> str:
    """The dotted key of a key in a table."""
    return f"{path}.{key}" if path else key
