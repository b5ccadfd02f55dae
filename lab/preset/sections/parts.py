"""Checks of the parts in the tank, as a preset gives them."""

from collections.abc import Iterator, Mapping, Sequence
from math import isfinite

from lab.base.errors import LabError
from lab.preset.outline import MOST_CORNERS, Point
from lab.preset.units import needed, show
from solvers.tank.parts import Part

MOST_PARTS = 50


def check_parts(parts: Mapping[str, Part], outline: Sequence[Point]) -> None:
    """Raise LabError for the first fault of a part; `outline` is the tank's (m)."""
    if len(parts) > MOST_PARTS:
        raise LabError(f"parts: at most {MOST_PARTS} are possible (got {len(parts)}).")
    for name, part in parts.items():
        for key, fault in _faults(part, outline):
            raise LabError(f"parts.{name}.{key}: {fault}.")


def _faults(part: Part, outline: Sequence[Point]) -> Iterator[tuple[str, str]]:
    """The keys at fault, each with what is wrong."""
    points = part.points
    if not 2 <= len(points) <= MOST_CORNERS:
        yield "points", f"from 2 to {MOST_CORNERS} points are needed (got {len(points)})"
    for k in range(1, len(points)):
        if points[k] == points[k - 1]:
            yield f"points[{k}]", "the same point as the one before; a plate needs a length"
    for k, point in enumerate(points):
        if not _near(point, outline):
            place = ", ".join(show(x, "m") for x in point)
            yield f"points[{k}]", f"{place} is farther from the tank than the tank is large"
    if part.way:
        yield from _faults_of_move(part)


def _faults_of_move(part: Part) -> Iterator[tuple[str, str]]:
    for key, symbol in (("speed", "m/s"), ("acceleration", "m/s^2")):
        if not getattr(part, key):
            yield key, f"missing for a part that moves; {needed(symbol)}"
    if not isfinite(part.way) or not part.fastest() or not isfinite(part.duration()):
        yield "move", "this move at this speed and acceleration is beyond all measure"


def _near(point: Point, outline: Sequence[Point]) -> bool:
    """Whether a point is in the tank's bounding box widened by its larger side; a funnel may stand above the tank."""
    bounds = [(min(axis), max(axis)) for axis in zip(*outline, strict=True)]
    size = max(high - low for low, high in bounds)
    return all(low - size <= x <= high + size for x, (low, high) in zip(point, bounds, strict=True))
