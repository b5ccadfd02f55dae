"""Merge tables of presets: a preset over its base, overrides over both."""

from collections.abc import Mapping

from lab.base.errors import LabError
from lab.preset.units import quoted

# Alternative keys of a section: giving one side drops inherited values of the others.
ALTERNATIVES = {
    "tank": ({"width", "height"}, {"outline"}),
    "grains": ({"count"}, {"depth"}),
    "material": ({"restitution"}, {"dissipative_time"}),
    "wall": ({"restitution"}, {"dissipative_time"}),
    "water": ({"depth"}, {"region"}, {"radius"}),
    "ship": ({"gyradius"}, {"roll_period"}),
}


def nested(overrides: Mapping) -> dict:
    """Overrides with dotted keys as nested tables; later ones go over earlier ones."""
    result: dict = {}
    for key, value in overrides.items():
        parts = str(key).split(".")
        if not all(parts):
            raise LabError(f"{quoted(key)} is not a key; write it like grains.diameter.")
        if parts[0] in ("based_on", "quick"):
            raise LabError(f"{parts[0]}: cannot be overridden; write a preset file that says it.")
        value = value.tolist() if hasattr(value, "tolist") else value  # numpy's numbers, as sweeps in Python have them
        for part in reversed(parts):
            value = {part: value}
        result = merged(result, value, alternatives={})
    return result


def merged(base: Mapping, over: Mapping, path: str = "", alternatives: Mapping = ALTERNATIVES) -> dict:
    """Merge `over` into `base`, table by table; where keys are alternatives, those of `over` win."""
    result = dict(base)
    sides = alternatives.get(path, ())
    for side in sides:
        other = set().union(*sides) - side
        if side & over.keys() and not other & over.keys():
            result = {key: value for key, value in result.items() if key not in other}
    for key, value in over.items():
        below = result.get(key)
        if isinstance(value, Mapping) and isinstance(below, Mapping):
            value = merged(below, value, f"{path}.{key}" if path else key, alternatives)
        result[key] = value
    return result
