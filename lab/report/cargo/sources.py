"""What `explain` and a run's summary say of the cargo that a preset names: numbers, sources, what replaces them."""

from collections.abc import Iterator
from math import isclose

from lab.base.errors import LabError
from lab.preset.cargo.cargoes import cargo_named
from lab.preset.cargo.filling import SECTIONS, numbers_for
from lab.preset.cargo.numbers import Cargo, Number
from lab.preset.fields import taken_by
from lab.preset.python.keys import value_of
from lab.preset.schema import Preset
from lab.preset.units import show

SAME = 1e-5  # relative: as exact as a number is written into a preset
Rows = list[tuple[str, str]]
FRICTION = {"grains": ("material.friction", "material.rolling_friction"), "bulk": ("bulk.repose",)}


def described(preset: Preset) -> Rows:
    """Rows of a key and where its number is from; none without a cargo of the library or of a file."""
    return [row for section in SECTIONS for row in _rows(preset, section)]


def in_words(preset: Preset) -> Iterator[str]:
    """The same as lines of a summary."""
    for key, text in described(preset):
        yield f"{key}: {text}"


def _rows(preset: Preset, section: str) -> Iterator[tuple[str, str]]:
    name = getattr(getattr(preset, section), "cargo", None)
    if name is None:
        return
    try:
        cargo = cargo_named(name, key=f"{section}.cargo")
    except LabError as error:  # of a recording, whose file has gone, or whose cargo this version lacks
        yield f"{section}.cargo", f"{name}, whose numbers cannot be looked up: {error}"
        return
    yield f"{section}.cargo", _head(cargo)
    numbers = numbers_for(cargo, section, "space" if preset.axes > 2 else "plane")
    for key, number in numbers.items():
        yield key, _from(preset, key, number)
    for key in FRICTION[section]:
        if key not in numbers:
            yield key, f"{_shown(preset, key)}, the preset's own; none is known of this cargo"
    if section == "grains" and "material.rolling_friction" in numbers and preset.contact.rolling == "none":
        yield "contact.rolling", "none: rolling friction does nothing"


def _head(cargo: Cargo) -> str:
    return f"{cargo.title}, {cargo.code} ({cargo.code_source})" if cargo.code_source else cargo.title


def _from(preset: Preset, key: str, number: Number) -> str:
    """Whether a number is the cargo's or the preset's own, with the source of the cargo's."""
    value, source = value_of(preset, key), f"{f', {number.note}' if number.note else ''}: {number.source}"
    if value is None:
        return f"replaced by the preset's own, not {number.text}{source}"
    if not isclose(value, number.value, rel_tol=SAME):
        return f"{_shown(preset, key)}, the preset's own, not {number.text}{source}"
    span = f", {'the middle of' if number.middle else 'of'} {number.text}" if number.low < number.high else ""
    return f"{_shown(preset, key)}{span}{source}"


def _shown(preset: Preset, key: str) -> str:
    value, taken = value_of(preset, key), taken_by(Preset, key)
    return "none" if value is None else show(value, taken.symbol)
