"""A preset is filled from the cargo that it names: `grains.cargo` or `bulk.cargo`.

What belongs to the cargo goes over the layers below the one that names it, and under that layer's own keys and all
above: so a cargo set over a preset replaces that preset's material, and a key given with it or later wins. What is a
choice of the model (size of grains, laws) is filled only where no layer says it.
"""

from collections.abc import Mapping
from functools import reduce
from pathlib import Path

from lab.preset.cargo.cargoes import SUFFIX, cargo_named
from lab.preset.cargo.numbers import Cargo, Number
from lab.preset.merge import Layer, merged

SECTIONS = "grains", "bulk"
# Keys of the cargo itself, by section and key, and the quantity that fills each
OF_GRAINS = {
    ("material", "density"): "density",
    ("material", "friction"): "friction",
    ("material", "rolling_friction"): "rolling_friction",
    ("material", "restitution"): "restitution",
}
OF_BULK = {("bulk", "density"): "bulk_density", ("bulk", "repose"): "repose", ("bulk", "diameter"): "diameter"}
LAWS = {"tangential": "cundall-strack", "rolling": "constant-torque"}  # those that friction was found with
OTHERS = "start_friction", "fast_friction"  # of another cargo, where a layer below has them
SPACE = "along", "turned", "mesh"  # keys of a tank in space
COARSE = 1.5  # times the real grain: from here on a grain stands for real ones


def filled(layers: list[Layer]) -> list[Layer]:
    """The layers of a preset with those that its cargoes add; the same where none names a cargo. Raises LabError."""
    for section in SECTIONS:
        place = _place(layers, section)
        if place is not None:
            layers = _with_cargo(layers, section, place)
    return layers


def located(table: dict, layers: list[Layer]) -> dict:
    """The merged table with the path of a cargo's own file made absolute, as paths in resolved presets are."""
    for section in SECTIONS:
        place = _place(layers, section)
        if place is not None and (name := layers[place].table[section]["cargo"]).endswith(SUFFIX):
            path = str((layers[place].folder / name).absolute())
            table = table | {section: table[section] | {"cargo": path}}
    return table


def numbers_for(cargo: Cargo, section: str, axes: str) -> dict[str, Number]:
    """The numbers that a cargo fills into a preset with grains or bulk, by dotted key; `axes`: plane or space."""
    keys = OF_GRAINS if section == "grains" else OF_BULK
    found = {".".join(key): cargo.number(name, axes) for key, name in keys.items()}
    if section == "bulk" and found["bulk.density"] is None:
        found["bulk.density"] = _by_stowage(cargo)
    return {key: number for key, number in found.items() if number is not None}


def _by_stowage(cargo: Cargo) -> Number | None:
    """The density of the bed as one over the stowage factor, where no other is known."""
    known = cargo.number("stowage")
    if known is None:
        return None
    note = f"one over the stowage factor, {known.text}"
    return Number("bulk_density", 1 / known.high, 1 / known.low, 1 / known.value, known.source, known.middle, note)


def _place(layers: list[Layer], section: str) -> int | None:
    """The number of the highest layer that says a section's cargo; None if that takes it away, or none does."""
    said = [k for k, layer in enumerate(layers) if "cargo" in _table(layer.table, section)]
    if not said or not isinstance(layers[said[-1]].table[section]["cargo"], str):
        return None  # also where it is no text, which the reader refuses
    return said[-1]


def _with_cargo(layers: list[Layer], section: str, place: int) -> list[Layer]:
    whole = reduce(merged, (layer.table for layer in layers), {})
    below = reduce(merged, (layer.table for layer in layers[:place]), {})
    layer = layers[place]
    cargo = cargo_named(layer.table[section]["cargo"], layer.folder, f"{section}.cargo")
    axes = "space" if any(_table(whole, "tank").get(key) for key in SPACE) else "plane"
    own: dict = {}
    for dotted, number in numbers_for(cargo, section, axes).items():
        table, _, key = dotted.partition(".")
        own.setdefault(table, {})[key] = number.key
    if section == "bulk":
        gone = {key: False for key in OTHERS if key in _table(below, "bulk")}
        own["bulk"] = own.get("bulk", {}) | gone
        return _inserted(layers, place, _without_other(own, layer.table, "bulk"), {})
    own = _without_other(own, layer.table, "material")
    return _inserted(layers, place, own | _stands_for(cargo, whole), _choices(cargo, whole, own))


def _choices(cargo: Cargo, whole: Mapping, own: Mapping) -> dict:
    """What is filled only where no layer says it: the size of the grains, and the laws that friction was found with."""
    found: dict = {}
    size, grains = cargo.number("diameter"), _table(whole, "grains")
    if size and not any(key in grains for key in ("diameter", "table", "bed")) and not whole.get("shapes"):
        found["grains"] = {"diameter": size.key}
    if "rolling_friction" in _table(own, "material"):
        found["contact"] = dict(LAWS)
    return found


def _stands_for(cargo: Cargo, whole: Mapping) -> dict:
    """The real size of the grains, where the preset's are coarse."""
    from lab.base.errors import LabError
    from lab.preset.units import parse

    size, given = cargo.number("diameter"), _table(whole, "grains").get("diameter")
    try:
        coarse = size is not None and parse(given, "m") > COARSE * size.value
    except LabError:  # no size, or one that the reader refuses
        return {}
    return {"grains": {"stands_for": size.key}} if coarse else {}


def _without_other(own: dict, given: Mapping, section: str) -> dict:
    """What a cargo fills, less what keys given beside it stand in place of."""
    table = merged({section: own.get(section, {})}, {section: _table(given, section)})[section]
    kept = {key: value for key, value in own.get(section, {}).items() if key in table}
    return own | {section: kept} if section in own else own


def _inserted(layers: list[Layer], place: int, own: dict, choices: dict) -> list[Layer]:
    added = [*layers[:place], Layer(own, Path()), *layers[place:]]
    return [Layer(choices, Path()), *added] if choices else added


def _table(table: Mapping, section: str) -> Mapping:
    """A section of a table; empty if there is none, or if it is no table."""
    found = table.get(section)
    return found if isinstance(found, Mapping) else {}
