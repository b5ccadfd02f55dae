"""What is known of a cargo: its quantities, and a number with its range, its source and what it holds for."""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

AXES = "plane", "space"


class Quantity(NamedTuple):
    """A quantity: its SI unit, the unit it is shown in and what one of that is in SI, what it is, and bounds (SI)."""

    symbol: str
    unit: str
    scale: float
    doc: str
    least: float
    most: float


QUANTITIES = {
    "density": Quantity("kg/m^3", "kg/m^3", 1.0, "density of the solids", 300.0, 20_000.0),
    "bulk_density": Quantity("kg/m^3", "kg/m^3", 1.0, "density of the bed, pores included", 100.0, 6000.0),
    "stowage": Quantity("m^3/kg", "m^3/t", 1e-3, "stowage factor", 1e-4, 1e-2),
    "repose": Quantity("rad", "deg", math.pi / 180.0, "angle of repose", 0.1, 1.04),
    "diameter": Quantity("m", "mm", 1e-3, "size of the grains", 1e-6, 1.0),
    "moisture_limit": Quantity("1", "%", 0.01, "moisture that it may have, by wet mass", 0.0, 1.0),
    "friction": Quantity("1", "", 1.0, "friction between grains", 0.0, 2.0),
    "rolling_friction": Quantity("1", "", 1.0, "rolling friction", 0.0, 2.0),
    "restitution": Quantity("1", "", 1.0, "restitution", 0.0, 1.0),
}
OF_MODELS = "friction", "rolling_friction"  # they belong to a model: discs in the plane, or spheres in space


@dataclass(frozen=True)
class Number:
    """A quantity (SI): a value or a range, as `source` has them; `axes` says for which model, "" for the cargo itself.

    `value` is as given, else the middle of the range, which is then `middle`.
    """

    name: str
    low: float
    high: float
    value: float
    source: str
    middle: bool = False
    note: str = ""
    axes: str = ""

    @property
    def text(self) -> str:
        """Value and range with the unit, as "26 (20 to 29) deg"."""
        low, high, value = (f"{number / self._scale:.4g}" for number in (self.low, self.high, self.value))
        span = f"{low} to {high}" if self.middle else f"{value} ({low} to {high})"
        shown = value if low == high else span
        return f"{shown} {QUANTITIES[self.name].unit}".rstrip()

    @property
    def key(self) -> str | float:
        """The value as a preset says it."""
        unit, value = QUANTITIES[self.name].unit, f"{self.value / self._scale:.6g}"
        return f"{value} {unit}" if unit else float(value)

    @property
    def _scale(self) -> float:
        return QUANTITIES[self.name].scale


@dataclass(frozen=True)
class Cargo:
    """A cargo in bulk: its title, the code it is carried under, its quantities, and notes, each with its source."""

    name: str
    title: str
    code: str = ""
    code_source: str = ""
    also: tuple[str, ...] = ()
    notes: tuple[tuple[str, str], ...] = ()
    numbers: dict[str, tuple[Number, ...]] = field(default_factory=dict)

    def number(self, name: str, axes: str = "") -> Number | None:
        """The first number of a quantity, of models that of these `axes`; None if none is known."""
        known = self.numbers.get(name, ())
        return next((one for one in known if one.axes in ("", axes)), None)
