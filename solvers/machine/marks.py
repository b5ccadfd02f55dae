"""Markers of a parameter's SI unit and of the range it may take.

They annotate the fields of the solvers' parameter classes, `Annotated[float, Unit("Pa"), Interval(gt=0)]`, so that code
that reads user input (the presets of `lab`) can check it without a second list of keys.
"""

from dataclasses import dataclass


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
