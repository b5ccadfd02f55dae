"""The reference of a preset's keys, made from the schema's dataclasses for as long as the schema does not tell it."""

import types
from collections.abc import Iterator
from dataclasses import MISSING, Field, fields, is_dataclass
from inspect import cleandoc
from typing import Annotated, Literal, Union, get_args, get_origin, get_type_hints

from lab.preset.schema import Given
from lab.preset.units import show
from solvers.machine.marks import Interval, Unit

KINDS = {float: "number", int: "whole number", str: "text", bool: "true or false"}


def preset_reference() -> str:
    """Every table of a preset: its keys with what they take, their range and default."""
    return "\n\n".join(["# Keys of a preset", *_table(Given, "")])


def _table(kind: type, path: str) -> Iterator[str]:
    hints = get_type_hints(kind, include_extras=True)
    rows, inner = [], []
    for field in fields(kind):
        taken, marks, words = _flat(hints[field.name])
        named = get_args(taken)[1] if get_origin(taken) is dict else None
        if is_dataclass(taken) or named:
            inner.append((named or taken, f"{path}{field.name}{'.NAME' if named else ''}."))
        else:
            cells = field.name, _taken(taken, words), _unit(marks), _range(marks), _default(field)
            rows.append(f"| `{cells[0]}` | {' | '.join(cells[1:])} |")
    yield f"## {f'`[{path[:-1]}]`' if path else 'At the top'}"
    if path and kind.__doc__ and not kind.__doc__.startswith(kind.__name__):
        yield cleandoc(kind.__doc__).partition("\n\n")[0]
    if rows:
        yield "\n".join(["| key | takes | unit | range | default |", "|---|---|---|---|---|", *rows])
    for table, below in inner:
        yield from _table(table, below)


def _flat(hint: object) -> tuple[object, list, list]:
    """The type behind an annotation, its marks, and the words that may stand instead."""
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is Annotated:
        kind, marks, words = _flat(arguments[0])
        return kind, [*marks, *hint.__metadata__], words
    if origin is Literal:
        return None, [], list(arguments)
    if origin in (Union, types.UnionType):
        parts = [_flat(part) for part in arguments if part is not types.NoneType]
        kind = next((part[0] for part in parts if part[0] is not None), None)
        return kind, [mark for part in parts for mark in part[1]], [word for part in parts for word in part[2]]
    return hint, [], []


def _taken(kind: object, words: list) -> str:
    named = "list" if get_origin(kind) is tuple else KINDS.get(kind, "")
    return ", ".join([named] * bool(named) + [f'`"{word}"`' for word in words])


def _unit(marks: list) -> str:
    return next((mark.symbol for mark in marks if isinstance(mark, Unit) and mark.symbol != "1"), "")


def _range(marks: list) -> str:
    ends = [(sign, getattr(mark, end)) for mark in marks if isinstance(mark, Interval)
            for end, sign in (("gt", "> "), ("ge", "≥ "), ("lt", "< "), ("le", "≤ "))]  # fmt: skip
    return ", ".join(f"{sign}{end:.4g}" for sign, end in ends if end is not None)


def _default(field: Field) -> str:
    if field.default is MISSING:
        return "" if field.default_factory is not MISSING else "needed"
    unit = _unit(getattr(field.type, "__metadata__", ()))
    if field.default is None or field.default == "":
        return ""
    return show(field.default, unit) if unit and isinstance(field.default, float) else f"{field.default}"
