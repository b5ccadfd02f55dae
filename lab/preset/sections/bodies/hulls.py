"""Hulls with rooms and openings, as a preset gives them, and their checks."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from lab.base.errors import LabError
from lab.preset.kept.content import INSIDE
from lab.preset.kept.openings import beside
from lab.preset.outline import Point, simple_polygon
from lab.preset.sections.bodies.in_space import rooms_in_space, shape_of
from lab.preset.units import show
from solvers.machine.marks import Doc, Interval, Unit
from solvers.tank import parts as solved
from solvers.tank.tank import Tank

IN_WALL = ""  # where an opening that does not lead through the wall ends
Corners = Annotated[tuple[Point, ...], Unit("m")]


@dataclass(frozen=True)
class Room:
    """A room in a hull."""

    points: Annotated[Corners, Doc("Its corners, y and z each, a wall's thickness from those of the hull.")]
    depth: Annotated[float, Unit("m"), Interval(ge=0), Doc("Depth of the water in it at the start.")] = 0.0
    along: Annotated[
        float | None,
        Unit("m"),
        Interval(gt=0),
        Doc("Length of the room along x in space; without it, that of the hull less a wall at each end."),
    ] = None
    x: Annotated[
        float | None, Unit("m"), Doc("Where the room's middle is along x in space; without it, that of the hull's.")
    ] = None


@dataclass(frozen=True)
class Opening:
    """An opening in the wall of a hull, in space a round one."""

    points: Annotated[Corners, Doc("Its two ends, in the wall; in space those of its diameter, square to x.")]
    opens: Annotated[float, Unit("s"), Interval(ge=0), Doc("When its cover is gone.")] = 0.0
    x: Annotated[
        float | None, Unit("m"), Doc("Where its middle is along x in space; without it, that of the hull's.")
    ] = None


def rooms_of(part) -> dict[str, np.ndarray]:
    """The rooms (m, 2) m of a hull by name, counter-clockwise; without any that are drawn, all within its walls."""
    if part.wall is None:
        return {}
    if part.rooms:
        return {name: np.array(room.points) for name, room in part.rooms.items()}
    return {INSIDE: offset_inwards(np.array(simple_polygon(part.points)), part.wall)}


def depths_of(part) -> dict[str, float]:
    """The depths (m) of the water in the rooms of a hull at the start, by name."""
    return {name: part.rooms[name].depth if name in part.rooms else 0.0 for name in rooms_of(part)}


def hull_of(part) -> solved.Hull | None:
    """The hull as the solver takes it; None of a body that is not hollow."""
    if part.wall is None:
        return None
    openings = tuple(
        solved.Opening(tuple(one.points), one.opens, part.x if one.x is None else one.x)
        for one in part.openings.values()
    )
    sections = {name: tuple(map(tuple, corners.tolist())) for name, corners in rooms_of(part).items()}
    rooms = sections if shape_of(part) is None else rooms_in_space(part, sections)
    return solved.Hull(part.wall, tuple(rooms.values()), openings)


def offset_inwards(corners: np.ndarray, wall: float) -> np.ndarray:
    """A polygon (m, 2) m, counter-clockwise, moved inwards by a thickness (m), with mitred corners."""
    edges = np.roll(corners, -1, axis=0) - corners
    along = edges / np.linalg.norm(edges, axis=1)[:, None]
    inwards = np.stack([-along[:, 1], along[:, 0]], axis=1)
    before = np.roll(inwards, 1, axis=0)
    mitre = (before + inwards) / (1.0 + (before * inwards).sum(axis=1))[:, None]
    return corners + wall * mitre


def faults_of_hull(part) -> Iterator[tuple[str, str]]:
    """The keys at fault of a hull: rooms that are none or overlap, openings that lead nowhere."""
    outer = np.array(simple_polygon(part.points))
    rooms = rooms_of(part)
    for name, corners in rooms.items():
        key = f"rooms.{name}.points" if part.rooms else "wall"
        try:
            simple_polygon(tuple(map(tuple, corners.tolist())))
        except LabError as error:
            yield key, f"{error}".rstrip(".") + ("" if part.rooms else "; take a thinner wall, or draw the rooms")
            continue
        near = _distance(corners, outer)
        if not Tank(outer, 1.0).holds(corners).all() or near < 0.99 * part.wall:
            if not part.rooms:
                yield key, "leaves no room in this hull; take a thinner wall"
                continue
            yield key, f"this room is not in the hull, its walls of {show(part.wall, 'm')} round it; move its corners"
        for other, theirs in rooms.items():
            if other < name and (_overlap(corners, theirs) or _distance(corners, theirs) < 0.99 * part.wall):
                yield key, f"this room meets {other}; leave a wall of {show(part.wall, 'm')} between them"
    for name, opening in part.openings.items():
        yield from _faults_of_opening(part, name, opening)


def _faults_of_opening(part, name: str, opening: Opening) -> Iterator[tuple[str, str]]:
    key = f"openings.{name}.points"
    if len(opening.points) != 2 or opening.points[0] == opening.points[1]:
        yield key, f"an opening has two ends (got {len(opening.points)})"
        return
    one, other = sides_of(part, opening)
    if one == other or IN_WALL in (one, other):
        yield key, "this opening does not lead from a room through the wall; lay its ends in the middle of the wall"


def sides_of(part, opening: Opening) -> list[str | None]:
    """What an opening joins: the names of rooms, None for the water outside, `IN_WALL` where it ends in a wall."""
    rooms = rooms_of(part)
    shapes = [np.array(simple_polygon(part.points)), *rooms.values()]
    found = []
    for point in beside(opening.points, part.wall):
        inside, *within = (Tank(shape, 1.0).holds(point[None])[0] for shape in shapes)
        room = next((name for name, there in zip(rooms, within, strict=True) if there), IN_WALL)
        found.append(room if inside else None)
    return found


def _distance(corners: np.ndarray, other: np.ndarray) -> float:
    """The least distance (m) between the outlines of two polygons (m, 2) m that do not cross."""
    return min(_from_corners(corners, other), _from_corners(other, corners))


def _from_corners(points: np.ndarray, polygon: np.ndarray) -> float:
    way = np.roll(polygon, -1, axis=0) - polygon
    off = points[:, None] - polygon
    share = np.clip((off * way).sum(axis=2) / (way**2).sum(axis=1), 0.0, 1.0)
    return float(np.linalg.norm(off - share[..., None] * way, axis=2).min())


def _overlap(corners: np.ndarray, other: np.ndarray) -> bool:
    """Whether one of two polygons has a corner of the other, or its middle, in it."""
    pairs = (corners, other), (other, corners)
    return any(Tank(one, 1.0).holds(np.vstack([two, two.mean(axis=0)])).any() for one, two in pairs)
