"""Values as Python has them, numpy's numbers and pint's quantities among them, as presets write them."""

from collections.abc import Mapping

from lab.base.errors import LabError
from lab.preset.units import known_unit


def plain(value: object) -> object:
    """The value as text, number, boolean, list or table; a quantity of any pint registry becomes a text, "4.0 mm"."""
    if isinstance(value, Mapping):
        return {key: plain(inner) for key, inner in value.items()}
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return _quantity(value)
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        return value.tolist()
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    return value


def _quantity(value) -> object:
    """A quantity as text, or as a list of texts; in base units where the lab has no such unit."""
    if not known_unit(unit := _written(value.units)):
        try:
            value = value.to_base_units()
        except Exception as error:  # each version of pint has errors of its own
            raise LabError(f"{value}: this quantity has no unit that the lab knows; write it as a text.") from error
        unit = _written(value.units)
    numbers = plain(value.magnitude)
    if isinstance(numbers, list):
        return [_text(number, unit) for number in numbers]
    return _text(numbers, unit) if unit else numbers


def _text(number: object, unit: str) -> object:
    if isinstance(number, list):
        return [_text(one, unit) for one in number]
    return f"{float(number)!r} {unit}" if unit else number


def _written(unit: object) -> str:
    return "" if str(unit) == "dimensionless" else str(unit)
