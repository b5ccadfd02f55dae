"""The parts in the tank, as a preset gives them, and their checks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, make_dataclass, replace
from math import isfinite
from typing import Annotated

from lab.base.errors import LabError
from lab.preset.outline import MOST_CORNERS, Point
from lab.preset.sections.bodies import floating as bodies
from lab.preset.sections.bodies import hulls
from lab.preset.sections.bodies.in_space import circle, faults_in_space, shape_of
from lab.preset.sections.history import Record, check_record, check_start
from lab.preset.sections.solids.funnel import NAMES
from lab.preset.sections.tank import check_tank
from lab.preset.units import needed, show
from solvers.machine.marks import Doc
from solvers.motion import MOTIONS
from solvers.tank import parts as solved

MOST_PARTS = 50


@dataclass(frozen=True)
class PartGroup(solved.Part):
    """A part of the tank: thin plates along a polyline, or a solid body; in water a plate has two points.

    From `start` (s after the tank's motion begins) it is displaced by `move` in the tank's frame: it accelerates with
    `acceleration` up to `speed`, and brakes likewise at the end. If the way is too short to reach `speed`, the top
    speed is lower. A part whose `move` is zero stands still. It may also have motions as the tank has. It is drawn in
    the axes of [tank], in whichever tank it stands. A body with a `density`, or a `mass`, floats in the water: from its
    `release` on it moves as what pushes it says.
    """

    @property
    def floats(self) -> bool:
        """Whether it moves freely."""
        return bodies.floats(self)

    @property
    def moves(self) -> dict[str, object]:
        """The motions in use by name; those from a record are outermost."""
        used = {name: getattr(self, name) for name in MOTIONS if getattr(self, name) is not None}
        recorded = self.history.history.motions if self.history else {}
        return used | {f"history.{name}": motion for name, motion in recorded.items()}

    def fastest(self) -> float:
        """Bound on its speed (m/s), by its move and its motions."""
        return self.solved().fastest()

    @property
    def line(self) -> tuple[Point, ...]:
        """The corners (m) as a line to draw; that of a body ends where it begins."""
        return (*self.section, self.section[0]) if self.closed else self.section

    @property
    def section(self) -> tuple[Point, ...]:
        """The corners (m) in the section; of a sphere those of a polygon in its place."""
        return self.points if self.radius is None else circle(self.points[0], self.radius)

    def solved(self, tank: int = 0, thickness: float = 1.0) -> solved.Body:
        """The part as the solver takes it, in the tank of this number, of a `thickness` (m)."""
        motions, move = tuple(self.moves.values()), (self.move, self.start, self.speed, self.acceleration)
        free, hull = bodies.freedom(self, thickness), hulls.hull_of(self)
        return solved.Body(self.section, *move, self.closed, motions, tank, free, hull, self.sieve, shape_of(self))


WHERE = "The tank in which it stands, by its name in [tanks]; by default it is [tank]."
KEYS = [("closed", Annotated[bool, Doc("Whether it is a solid body.")], False)]
KEYS.append(("sieve", Annotated[bool, Doc("Whether it holds grains back and lets water pass.")], False))
KEYS.append(("tank", Annotated[str | None, Doc(WHERE)], None))
KEYS += bodies.KEYS
KEYS += [(name, Annotated[kind | None, Doc(f"Its {name}.")], None) for name, kind in MOTIONS.items()]
KEYS.append(("history", Annotated[Record | None, Doc("Its motion from a file.")], None))
Part = make_dataclass("Part", KEYS, bases=(PartGroup,), frozen=True)
"""A part, with its motions, any of which may be left out."""
Part.__module__ = __name__  # so that it can be sent to another process


def furnished(preset):
    """The preset with the parts of the tank's funnel, and its grains in it. Raises LabError.

    `lab.preset.schema.Preset`, of which all that follows from the funnel's keys are keys, too: a recording has them.
    """
    tank, grains = preset.tank, preset.grains
    if tank.funnel is None:
        return preset
    check_tank(tank)
    if twice := [name for name in NAMES if name in preset.parts]:
        raise LabError(f"parts.{twice[0]}: tank.funnel has a part of this name; call it otherwise.")
    port, starboard, gate = tank.funnel.plates(tank.corners)
    drop = {"move": (0.0, -tank.funnel.way(tank.corners)), "start": tank.funnel.opens}
    drop |= {"speed": tank.funnel.gate_speed, "acceleration": tank.funnel.gate_acceleration}
    made = dict(zip(NAMES, (Part(port), Part(starboard), Part(gate, **drop)), strict=True))
    if grains is not None and not (grains.region or grains.bed or grains.depth or grains.room):
        grains = replace(grains, region=tank.funnel.inside(tank.corners))
    return replace(preset, parts={**made, **preset.parts}, grains=grains)


def parts_of(preset) -> tuple[solved.Body, ...]:
    """The parts of a preset as the solver takes them."""
    numbers = {name: number for number, name in enumerate([*preset.tanks, *rooms_of_grains(preset)], start=1)}
    return tuple(part.solved(numbers.get(part.tank, 0), preset.thickness) for part in preset.parts.values())


def rooms_of_grains(preset) -> list[str]:
    """The room of a hull that holds a preset's grains, by both names; none if they are in a tank."""
    return [preset.grains.room] if preset.grains is not None and preset.grains.room is not None else []


def check_parts(preset) -> None:
    """Raise LabError for the first fault of a preset's parts."""
    parts, outline, tanks = preset.parts, preset.tank.corners, [*preset.tanks, *rooms_of_grains(preset)]
    if len(parts) > MOST_PARTS:
        raise LabError(f"parts: at most {MOST_PARTS} are possible (got {len(parts)}).")
    for name, part in parts.items():
        for key, fault in _faults(part, outline):
            raise LabError(f"parts.{name}.{key}: {fault}.")
        if part.tank is not None and part.tank not in tanks:
            others = f"one of {', '.join(tanks)}" if tanks else "no further tanks here"
            raise LabError(f"parts.{name}.tank: is {part.tank!r}, and there are {others}; leave it out for [tank].")
        _check_motions(part, f"parts.{name}", _larger_side(outline))
        for key, fault in (*faults_in_space(part), *bodies.faults(part)):
            raise LabError(f"parts.{name}.{key}: {fault}.")


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
    if not (1 if part.radius is not None else 2) <= len(points) <= MOST_CORNERS:
        yield "points", f"from 2 to {MOST_CORNERS} points are needed (got {len(points)})"
    for k in range(1, len(points)):
        if points[k] == points[k - 1]:
            yield f"points[{k}]", "the same point as the one before; a plate needs a length"
    for k, point in enumerate(points):
        if part.tank is None and not _near(point, outline):
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
