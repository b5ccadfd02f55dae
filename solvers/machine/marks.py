"""Annotations for fields of dataclasses: what a field says, its SI unit, its range, and how it is treated.

They annotate the fields of the solvers' parameter classes, `Annotated[float, Unit("Pa"), Interval(gt=0), Doc("…")]`, so
that code that reads user input (the presets of `lab`) can check and describe it without a second list of keys.
"""

from collections.abc import Callable, Hashable
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from typing import Any, get_type_hints


@dataclass(frozen=True)
class Doc:
    """What a field says, in one sentence for a person who writes presets."""

    text: str


@dataclass(frozen=True)
class Unit:
    """The SI unit a field is kept in; "1" marks a pure number."""

    symbol: str


@dataclass(frozen=True)
class Interval:
    """The values a field may take: greater than `gt`, at least `ge`, less than `lt`, at most `le`."""

    gt: float | None = None
    ge: float | None = None
    lt: float | None = None
    le: float | None = None


@dataclass(frozen=True)
class Usual:
    """The values (SI) between which a person who tries things out moves a number, and the unit to show them in."""

    low: float
    high: float
    unit: str


@dataclass(frozen=True)
class Cheap:
    """Marks what a cheaper variant of an experiment may change: cost and accuracy, not the experiment itself."""


@dataclass(frozen=True)
class EachWorld:
    """Marks a field with an entry a world, in which the worlds of one launch may differ.

    `alike`: what they must agree in all the same, a function of the whole.
    """

    alike: Callable[[Any], Hashable] = lambda _: None


@dataclass(frozen=True)
class LargestOfWorlds:
    """Marks a number in which the worlds of one launch may differ: the largest counts for all."""


@dataclass(frozen=True)
class NotOfBed:
    """Marks a field from which a settled bed does not follow."""


@cache
def marked(kind: type, mark: type) -> dict[str, Any]:
    """The fields of a dataclass that have a mark of that type, each with its mark."""
    hints = get_type_hints(kind, include_extras=True)
    found = {
        name: [one for one in getattr(hint, "__metadata__", ()) if isinstance(one, mark)]
        for name, hint in hints.items()
    }
    return {name: marks[0] for name, marks in found.items() if marks}


def shared(value: object) -> Hashable:
    """A value in a form that can be compared and hashed, without what may differ between the worlds of a launch.

    Of a dataclass that is all of each field without a mark, and what those of `EachWorld` agree in.
    """
    import numpy as np  # not for marks alone, which are read before anything is computed

    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    if isinstance(value, tuple | list):
        return tuple(map(shared, value))
    if not is_dataclass(value):
        return value
    each, largest = marked(type(value), EachWorld), marked(type(value), LargestOfWorlds)
    names = [field.name for field in fields(value) if field.init and field.name not in largest]
    return tuple(each[name].alike(value) if name in each else shared(getattr(value, name)) for name in names)


def in_one_launch(values: list) -> object:
    """One dataclass with the worlds of all `values`, whose `shared` are equal."""
    first = values[0]
    each, largest = marked(type(first), EachWorld), marked(type(first), LargestOfWorlds)
    found = {name: joined([getattr(value, name) for value in values]) for name in each}
    found |= {name: max(getattr(value, name) for value in values) for name in largest}
    for name in (field.name for field in fields(first) if field.init and field.name not in found):
        parts = [getattr(value, name) for value in values]
        if _differs(parts[0]):
            found[name] = in_one_launch(parts)
        elif isinstance(parts[0], tuple) and any(map(_differs, parts[0])):
            found[name] = tuple(in_one_launch(list(each)) for each in zip(*parts, strict=True))
    return replace(first, **found)


def _differs(part: object) -> bool:
    """Whether it has fields in which the worlds of one launch may differ."""
    return is_dataclass(part) and bool(marked(type(part), EachWorld))


def joined(values: list) -> object:
    """The entries of all worlds, from those of each scene; None where there are none.

    Arrays and lists have an entry a world; of a dataclass, its arrays have.
    """
    import numpy as np

    first = values[0]
    if first is None:
        return None
    if isinstance(first, np.ndarray):
        return np.concatenate(values)
    if is_dataclass(first):
        names = [field.name for field in fields(first) if isinstance(getattr(first, field.name), np.ndarray)]
        return replace(first, **{name: joined([getattr(one, name) for one in values]) for name in names})
    return [one for value in values for one in value]
