"""Bodies that float, and hulls with rooms and openings, as a preset gives them, and their checks."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated

import numpy as np

from lab.base.errors import LabError
from lab.preset.kept.content import INSIDE
from lab.preset.kept.openings import beside
from lab.preset.outline import Point, simple_polygon
from lab.preset.sections.tank import Tank as PresetTank
from lab.preset.units import show
from solvers.machine.marks import Doc, Interval, Unit
from solvers.tank import parts as solved
from solvers.tank.outline import area_below, moments
from solvers.tank.tank import Tank

FREE = "centre", "inertia", "release", "friction", "restitution"  # keys of bodies that float alone
OF_HULLS = "rooms", "openings"  # keys of hulls alone
IN_WALL = ""  # where an opening that does not lead through the wall ends
Corners = Annotated[tuple[Point, ...], Unit("m")]


@dataclass(frozen=True)
class Room:
    """A room in a hull."""

    points: Annotated[Corners, Doc("Its corners, y and z each, a wall's thickness from those of the hull.")]
    depth: Annotated[float, Unit("m"), Interval(ge=0), Doc("Depth of the water in it at the start.")] = 0.0


@dataclass(frozen=True)
class Opening:
    """An opening in the wall of a hull."""

    points: Annotated[Corners, Doc("Its two ends, in the wall.")]
    opens: Annotated[float, Unit("s"), Interval(ge=0), Doc("When its cover is gone.")] = 0.0


def _key(name: str, kind: object, doc: str, default: object = None) -> tuple:
    return name, Annotated[kind, Doc(doc)], default


Positive = Interval(gt=0)
KEYS = [
    _key(
        "density",
        Annotated[float | None, Unit("kg/m^3"), Positive],
        "Mean density of a body that floats; of a hull that of its walls.",
    ),
    _key(
        "mass",
        Annotated[float | None, Unit("kg"), Positive],
        "Mass of a body that floats, in a slab as thick as the tank; instead of its density.",
    ),
    _key("centre", Annotated[Point | None, Unit("m")], "Its centre of mass as drawn; by default that of an even body."),
    _key(
        "inertia",
        Annotated[float | None, Unit("kg m^2"), Positive],
        "Moment of inertia about the centre of mass; by default that of an even body.",
    ),
    _key(
        "release",
        Annotated[float, Unit("s"), Interval(ge=0)],
        "When it is let go; until then it stands in the tank.",
        0.0,
    ),
    _key(
        "friction",
        Annotated[float | None, Interval(ge=0, le=10)],
        f"Friction of what floats where it touches the tank or another body; {solved.Free.friction:g} without it.",
    ),
    _key(
        "restitution",
        Annotated[float | None, Interval(ge=0.05, le=1)],
        f"Restitution there; {solved.Free.restitution:g} without it.",
    ),
    _key(
        "wall",
        Annotated[float | None, Unit("m"), Positive],
        "Thickness of a hull's walls, which makes a body hollow; by default with one room, inside.",
    ),
    _key("rooms", dict[str, Room], "The rooms of a hull.", field(default_factory=dict)),
    _key("openings", dict[str, Opening], "The openings in the walls of a hull.", field(default_factory=dict)),
]


class WithBodies:
    """What a preset's parts are, by name: the bodies that float, the rooms and the openings of hulls."""

    @cached_property
    def hold(self) -> PresetTank:
        """The tank that the grains are in: [tank], or a room of a hull that floats, in the axes of its drawing."""
        if self.grains is None or self.grains.room is None:
            return self.tank
        name, _, room = self.grains.room.rpartition(".")
        corners = tuple(map(tuple, rooms_of(self.parts[name])[room].tolist()))
        return replace(self.tank, width=None, height=None, outline=corners, lid=True)

    @property
    def bodies(self) -> tuple[str, ...]:
        """The names of the parts that float."""
        return tuple(name for name, part in self.parts.items() if part.floats)

    @property
    def rooms(self) -> tuple[str, ...]:
        """The rooms of all hulls, by the hull's name and their own."""
        return tuple(f"{name}.{room}" for name, part in self.parts.items() for room in rooms_of(part))

    @property
    def open_rooms(self) -> set[str]:
        """Those of the rooms to which openings lead."""
        sides = (
            (name, side)
            for name, part in self.parts.items()
            for one in part.openings.values()
            for side in sides_of(part, one)
        )
        return {f"{name}.{side}" for name, side in sides if side}

    @property
    def soaks(self) -> bool:
        """Whether water may enter the room of a hull that the grains are in."""
        return self.grains is not None and self.grains.room is not None and self.grains.room in self.open_rooms

    @property
    def openings(self) -> tuple[str, ...]:
        """The openings of all hulls, by the hull's name and their own."""
        return tuple(f"{name}.{opening}" for name, part in self.parts.items() for opening in part.openings)


def floats(part) -> bool:
    """Whether a part moves freely."""
    return part.density is not None or part.mass is not None


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
    openings = tuple(solved.Opening(tuple(one.points), one.opens) for one in part.openings.values())
    rooms = tuple(tuple(map(tuple, corners.tolist())) for corners in rooms_of(part).values())
    return solved.Hull(part.wall, rooms, openings)


def freedom(part, thickness: float) -> solved.Free | None:
    """What moves freely: its mass, inertia and centre, those of an even body or of a hull's walls unless given.

    The slab has this `thickness` (m). None of a part that does not float.
    """
    if not floats(part):
        return None
    area, centre, polar = even(part)
    mass = part.density * area * thickness if part.mass is None else part.mass
    inertia = mass * polar / area if part.inertia is None else part.inertia
    of_contacts = {name: getattr(part, name) for name in ("friction", "restitution") if getattr(part, name) is not None}
    return solved.Free(mass, inertia, part.centre or centre, part.release, **of_contacts)


def even(part) -> tuple[float, tuple[float, float], float]:
    """Area (m²), centroid (m) and polar moment (m⁴) about it of a body, or of the walls of a hull."""
    shapes = [np.array(simple_polygon(part.points)), *rooms_of(part).values()]
    areas, centres, polars = map(np.array, zip(*(moments(shape) for shape in shapes), strict=True))
    signs = np.where(np.arange(len(shapes)) == 0, 1.0, -1.0) * np.sign(areas)
    area = float(signs @ areas)
    centre = (signs * areas) @ centres / area
    polar = signs @ (polars + areas * ((centres - centre) ** 2).sum(axis=1))
    return area, (float(centre[0]), float(centre[1])), float(polar)


def offset_inwards(corners: np.ndarray, wall: float) -> np.ndarray:
    """A polygon (m, 2) m, counter-clockwise, moved inwards by a thickness (m), with mitred corners."""
    edges = np.roll(corners, -1, axis=0) - corners
    along = edges / np.linalg.norm(edges, axis=1)[:, None]
    inwards = np.stack([-along[:, 1], along[:, 0]], axis=1)
    before = np.roll(inwards, 1, axis=0)
    mitre = (before + inwards) / (1.0 + (before * inwards).sum(axis=1))[:, None]
    return corners + wall * mitre


def faults(part) -> Iterator[tuple[str, str]]:
    """The keys at fault of a body that floats or of a hull, or that say something of one where none is."""
    if part.wall is None:
        for key in OF_HULLS:
            if getattr(part, key):
                yield key, "goes with a hull; give the thickness of its wall, or leave this out"
    elif not part.closed:
        yield "closed", "a hull is a solid body with rooms; set closed = true, or leave out its wall"
    else:
        yield from _faults_of_hull(part)
    if not floats(part):
        for key in FREE:
            if getattr(part, key) not in (None, 0.0):
                yield key, "goes with a body that floats; give its density, or leave this out"
        return
    if part.mass is not None and part.density is not None:
        yield "mass", "the density says it already; give one of the two"
    if not part.closed:
        yield "closed", "a body that floats is solid; set closed = true, or leave out its density"
    for key in part.moves or (["move"] if part.way else []):
        yield key, "a body that floats moves as what pushes it says; leave this out, or its density"


def _faults_of_hull(part) -> Iterator[tuple[str, str]]:
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


def draught(part, displaced: float) -> float:
    """How deep (m) a body floats upright, as it is drawn, if it displaces so much (m²); ∞ if it sinks."""
    corners = np.array(simple_polygon(part.points))
    if displaced >= moments(corners)[0]:
        return np.inf
    low, high = 0.0, float(np.ptp(corners[:, 1]))
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if area_below(corners, middle) < displaced else (low, middle)
    return high
