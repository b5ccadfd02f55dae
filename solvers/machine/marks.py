"""Markers that say what a number means: its SI unit, the range it may take, the words it may be.

They annotate the fields of the solvers' parameter classes, `Annotated[float, Unit("Pa"), Interval(gt=0)]`, so that
whoever reads parameters from people (the presets of `lab`) can check them without a second list of keys.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Unit:
    """The SI unit a field is kept in; "1" marks a pure number."""

    symbol: str


@dataclass(frozen=True)
class Interval:
    """The values a field may take: greater than, at least, less than, at most."""

    gt: float | None = None
    ge: float | None = None
    lt: float | None = None
    le: float | None = None
