"""Bodies that float, and hulls with rooms and openings, as a preset gives them, and their checks."""

from collections.abc import Iterator
from dataclasses import field, replace
from functools import cached_property
from typing import Annotated

import numpy as np

from lab.preset.outline import Point, simple_polygon
from lab.preset.sections.bodies.hulls import Opening, Room, faults_of_hull, hull_of, rooms_of, sides_of
from lab.preset.sections.bodies.in_space import freedom_in_space, of_contacts, shape_of
from lab.preset.sections.tank import Tank as PresetTank
from solvers.machine.marks import Doc, Interval, Unit
from solvers.tank import parts as solved
from solvers.tank.outline import moments
from solvers.tank.shapes import PrismShape

FREE = "centre", "inertia", "pitch_inertia", "yaw_inertia", "release", "friction", "restitution"  # of bodies that float
OF_HULLS = "rooms", "openings"  # keys of hulls alone


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
        "pitch_inertia",
        Annotated[float | None, Unit("kg m^2"), Positive],
        "Moment of inertia about y of a body in space; by default that of an even body.",
    ),
    _key(
        "yaw_inertia",
        Annotated[float | None, Unit("kg m^2"), Positive],
        "Moment of inertia about z of a body in space; by default that of an even body.",
    ),
    _key(
        "along",
        Annotated[float | None, Unit("m"), Positive],
        "Length along x of a body in space, of which the points are the section.",
    ),
    _key(
        "radius",
        Annotated[float | None, Unit("m"), Positive],
        "Radius of a sphere in space; its only point is its middle.",
    ),
    _key("x", Annotated[float, Unit("m")], "Where the middle of a body in space is along x.", 0.0),
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


def freedom(part, thickness: float) -> solved.Free | None:
    """What moves freely: its mass, inertia and centre, those of an even body or of a hull's walls unless given.

    The slab has this `thickness` (m). None of a part that does not float.
    """
    if not floats(part):
        return None
    if (shape := shape_of(part)) is not None:
        hull = hull_of(part)
        return freedom_in_space(part, shape, hull.rooms if hull else ())
    area, centre, polar = even(part)
    mass = part.density * area * thickness if part.mass is None else part.mass
    inertia = mass * polar / area if part.inertia is None else part.inertia
    return solved.Free(mass, inertia, part.centre or centre, part.release, **of_contacts(part))


def even(part) -> tuple[float, tuple[float, float], float]:
    """Area (m²), centroid (m) and polar moment (m⁴) about it of a body, or of the walls of a hull."""
    shapes = [np.array(simple_polygon(part.points)), *rooms_of(part).values()]
    areas, centres, polars = map(np.array, zip(*(moments(shape) for shape in shapes), strict=True))
    signs = np.where(np.arange(len(shapes)) == 0, 1.0, -1.0) * np.sign(areas)
    area = float(signs @ areas)
    centre = (signs * areas) @ centres / area
    polar = signs @ (polars + areas * ((centres - centre) ** 2).sum(axis=1))
    return area, (float(centre[0]), float(centre[1])), float(polar)


def faults(part) -> Iterator[tuple[str, str]]:
    """The keys at fault of a body that floats or of a hull, or that say something of one where none is."""
    if part.wall is None:
        for key in OF_HULLS:
            if getattr(part, key):
                yield key, "goes with a hull; give the thickness of its wall, or leave this out"
    elif not part.closed:
        yield "closed", "a hull is a solid body with rooms; set closed = true, or leave out its wall"
    else:
        yield from faults_of_hull(part)
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


def draught(part, displaced: float, thickness: float) -> float:
    """How deep (m) a body floats upright, as it is drawn, if it displaces so much (m³); ∞ if it sinks.

    In the plane it is a slab of this `thickness` (m).
    """
    shape = shape_of(part) or PrismShape(simple_polygon(part.points), thickness)
    lowest, highest = (float(bound[1]) for bound in shape.bounds)
    if displaced >= shape.volume:
        return np.inf
    low, high = 0.0, highest - lowest
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if shape.below(lowest + middle) < displaced else (low, middle)
    return high
