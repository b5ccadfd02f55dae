"""The parts in the tank, as a preset gives them, and their checks."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, make_dataclass
from math import isfinite
from typing import Annotated

from lab.base.errors import LabError
from lab.preset.outline import MOST_CORNERS, Point
from lab.preset.sections.history import Record, check_record, check_start
from lab.preset.units import needed, show
from solvers.machine.marks import Doc
from solvers.motion import MOTIONS
from solvers.tank import parts as solved

MOST_PARTS = 50


@dataclass(frozen=True)
class PartGroup(solved.Part):
    """A part of the tank: thin plates along a polyline, or in water a plate between two points, or a solid body.

    From `start` (s after the tank's motion begins) it is displaced by `move` in the tank's frame: it accelerates with
    `acceleration` up to `speed`, and brakes likewise at the end. If the way is too short to reach `speed`, the top
    speed is lower. A part whose `move` is zero stands still. In water it may also have motions as the tank has.
    """

    @property
    def moves(self) -> dict[str, object]:
        """The motions in use by name; those from a record are outermost."""
        used = {name: getattr(self, name) for name in MOTIONS if getattr(self, name) is not None}
        recorded = self.history.history.motions if self.history else {}
        return used | {f"history.{name}": motion for name, motion in recorded.items()}

    def fastest(self) -> float:
        """Bound on its speed (m/s), by its move and its motions."""
        return self.wet.fastest()

    @property
    def line(self) -> tuple[Point, ...]:
        """The corners (m) as a line to draw; that of a body ends where it begins."""
        return (*self.points, self.points[0]) if self.closed else self.points

    @property
    def dry(self) -> solved.Part:
        """The part among grains."""
        return solved.Part(self.points, self.move, self.start, self.speed, self.acceleration)

    @property
    def wet(self) -> solved.Body:
        """The part in water."""
        motions = tuple(self.moves.values())
        return solved.Body(self.points, self.move, self.start, self.speed, self.acceleration, self.closed, motions)


KEYS = [("closed", Annotated[bool, Doc("Whether it is a solid body, for water alone.")], False)]
KEYS += [(name, Annotated[kind | None, Doc(f"Its {name}, in water.")], None) for name, kind in MOTIONS.items()]
KEYS.append(("history", Annotated[Record | None, Doc("Its motion from a file, in water.")], None))
Part = make_dataclass("Part", KEYS, bases=(PartGroup,), frozen=True)
"""A part, with its motions in water, any of which may be left out."""
Part.__module__ = __name__  # so that it can be sent to another process


def check_parts(parts: Mapping[str, Part], outline: Sequence[Point], wet: bool) -> None:
    """Raise LabError for the first fault of a part; `outline` is the tank's (m); `wet`: it holds water."""
    if len(parts) > MOST_PARTS:
        raise LabError(f"parts: at most {MOST_PARTS} are possible (got {len(parts)}).")
    for name, part in parts.items():
        for key, fault in _faults(part, outline):
            raise LabError(f"parts.{name}.{key}: {fault}.")
        for key, _, default in () if wet else KEYS:
            if getattr(part, key) != default:
                raise LabError(f"parts.{name}.{key}: goes with water, and there is none; leave this out.")
        _check_motions(part, f"parts.{name}", _larger_side(outline))


def _check_motions(part: Part, key: str, side: float) -> None:
    """Raise LabError for a motion that starts elsewhere than where the part is drawn, or a record that is no motion.

    `side` is the larger of the tank (m).
    """
    if part.history:
        try:
            check_record(part.history, side)
            check_start(part.history.history, 0.0)
        except LabError as error:
            fault, *_ = str(error).replace("motion.history", f"{key}.history").partition("; let it")
            raise LabError(fault if fault.endswith(".") else f"{fault}.") from None
    for name in ("sway", "heave", "roll"):
        motion = getattr(part, name)
        if motion and motion.phase:
            raise LabError(f"{key}.{name}.phase: a part starts where it is drawn; leave the phase out.")


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
    bounds, size = [(min(axis), max(axis)) for axis in zip(*outline, strict=True)], _larger_side(outline)
    return all(low - size <= x <= high + size for x, (low, high) in zip(point, bounds, strict=True))


def _larger_side(outline: Sequence[Point]) -> float:
    return max(max(axis) - min(axis) for axis in zip(*outline, strict=True))
