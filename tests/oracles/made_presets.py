"""Presets made up from the schema's own fields: sound values, values that are nearly sound, and odd ones."""

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from hypothesis import strategies as st

from lab.preset.fields import NAME, Table, Taken, defaults_of, taken_of, walk
from lab.preset.schema import Preset
from lab.preset.sections.video import OF_SPACE
from lab.preset.units import KINDS, kind

FIELDS = dict(walk(Preset))
IN_SPACE = {f"video.{name}" for name in OF_SPACE}  # keys that only scenes in space take
KEY = st.sampled_from(sorted({part for key in FIELDS for part in key.split(".")}))
UNITS = sorted({one.unit for one in KINDS.values()} | {"furlong", "km", "", "GPa", "%"})
MAGNITUDES = ("0", "-1", "1e300", "1e-300", "1e14", "3", "0.5", "1e-6", "1e999", "nan", "inf", ".", "1,5", "−2", "٣")
TEXTS = st.sampled_from(["", " ", "\u202e", "🚢" * 30, "x" * 5000, "a\nb", "\ufeff", "../..", "~", "\x7f", NAME, "é"])
NAMES = st.sampled_from(["gate", "a", "b-1", "ä", "", "a.b", "x" * 60, "water"]) | st.text(max_size=5)
WORDS = st.text(st.characters(exclude_categories=["Cs"]), max_size=20)
SCALARS = st.booleans() | st.integers(-(2**70), 2**70) | st.floats() | TEXTS | WORDS
TREES = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEY, inner, max_size=3), max_leaves=8
)
TABLES = ("record.csv", "grains.csv", "missing.csv", "")  # names of files
SIZES = (1e-3, 5e-3, 0.05, 0.3, 1.0, 4.0, 50.0, 1e3, 2e9)


@st.composite
def presets(draw: st.DrawFn, bases: Sequence[Mapping]) -> dict:
    """One of the sound `bases` with some keys of the schema as their fields take them, and some faults."""
    table = json.loads(json.dumps(draw(st.sampled_from(bases))))
    known = sorted(FIELDS if "along" in table.get("tank", {}) else FIELDS.keys() - IN_SPACE)
    for _ in range(draw(st.integers(0, 3))):
        key = draw(st.sampled_from(known))
        _put(table, key.replace(NAME, "gate").split("."), draw(values(FIELDS[key])))
    for _ in range(draw(st.integers(0, 2))):
        holder, key = draw(st.sampled_from(list(_places(table)) or [(table, "title")]))
        draw(st.sampled_from([odd, renamed, with_unit, deep, added, dropped]))(draw, holder, key)
    return table


def _put(table: dict, path: list[str], value: object) -> None:
    for part in path[:-1]:
        inner = table.get(part)
        table[part] = inner if isinstance(inner, dict) else {}
        table = table[part]
    table[path[-1]] = value


def tables(model: type) -> st.SearchStrategy[dict]:
    """Tables of a dataclass's keys, those without a default always there."""
    needed, rest = {}, {}
    for name, taken in taken_of(model).items():
        (rest if name in defaults_of(model) else needed)[name] = values(taken)
    return st.fixed_dictionaries(needed, optional=rest)


def values(taken: Taken) -> st.SearchStrategy:
    """Values as a field takes them, some at the ends of its range."""
    sound = [st.sampled_from(taken.words)] if taken.words else []
    if taken.kind is not None:
        sound.append(_of_kind(taken))
    return st.one_of(*sound, *([st.just(False)] if taken.optional else []))


def _of_kind(taken: Taken) -> st.SearchStrategy:
    if taken.below:
        inner = tables(taken.below)
        return inner if taken.table else st.dictionaries(st.sampled_from(["gate", "b-1"]), inner, max_size=2)
    if taken.items:
        if taken.many:
            return st.lists(values(taken.items[0]), max_size=5)
        return st.tuples(*map(values, taken.items)).map(list)
    if taken.kind is float:
        return _number(taken)
    limits = taken.interval
    plain: dict[Any, st.SearchStrategy] = {
        int: st.sampled_from([x for x in (limits.ge, limits.le, 1, 2, 100, 640) if x is not None]),
        bool: st.booleans(),
        str: st.sampled_from(["a text", "mm", "deg", "m"]),
        Table: st.sampled_from(TABLES),
    }
    return plain[taken.kind]


def _number(taken: Taken) -> st.SearchStrategy:
    """Numbers of all sizes and at the ends of a field's range, with a unit that it takes."""
    limits = taken.interval
    sizes = st.sampled_from([*(x for x in (limits.gt, limits.ge, limits.lt, limits.le) if x is not None), *SIZES])
    if taken.symbol == "1":
        return sizes | sizes.map(lambda x: f"{100 * x:g} %")
    units = st.sampled_from([taken.symbol, kind(taken.symbol).unit])
    return st.tuples(sizes, units).map(lambda pair: f"{pair[0]:g} {pair[1]}")


def _places(table: dict | list) -> Iterator[tuple]:
    """Every place of a table and of the tables and lists in it: what holds it, and its key or index."""
    for key, value in list(table.items() if isinstance(table, dict) else enumerate(table)):
        yield table, key
        if isinstance(value, dict | list):
            yield from _places(value)


def odd(draw: st.DrawFn, holder: dict | list, key: object) -> None:
    """A value of a wrong type."""
    holder[key] = draw(TREES)


def renamed(draw: st.DrawFn, holder: dict | list, key: object) -> None:
    """A key that is nearly one."""
    if isinstance(holder, dict):
        near = [f"{key}s", str(key)[:-1], str(key).upper(), str(key)[::-1], f"{key}.x"]
        holder[draw(st.sampled_from(near) | NAMES)] = holder.pop(key)


def with_unit(draw: st.DrawFn, holder: dict | list, key: object) -> None:
    """A number with a unit of any kind."""
    holder[key] = f"{draw(st.sampled_from(MAGNITUDES))} {draw(st.sampled_from(UNITS))}"


def deep(draw: st.DrawFn, holder: dict | list, key: object) -> None:
    """Tables in tables, or lists in lists."""
    inner: object = 1
    for _ in range(draw(st.integers(1, 60))):
        inner = {"tank": inner} if draw(st.booleans()) else [inner]
    holder[key] = inner


def added(draw: st.DrawFn, holder: dict | list, key: object) -> None:
    """A key of another section, or of none."""
    if isinstance(holder, dict):
        holder[draw(KEY | NAMES)] = draw(TREES)


def dropped(draw: st.DrawFn, holder: dict | list, key: object) -> None:
    """A key less."""
    del holder[key]
