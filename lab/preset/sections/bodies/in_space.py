"""Bodies in space as a preset gives them: spheres and prisms, and what they are if they float."""

from collections.abc import Iterator

import numpy as np

from lab.preset.outline import Point, simple_polygon
from solvers.machine.quantity import SPACE
from solvers.tank import parts as solved
from solvers.tank.shapes import PrismShape, SphereShape

IN_SPACE = "along", "radius", "x", "pitch_inertia", "yaw_inertia"  # keys of bodies in space alone
ROUND = 48  # corners by which a sphere is drawn in the section


def shape_of(part) -> SphereShape | PrismShape | None:
    """The shape of a body in space; None of a part in the plane."""
    if part.radius is not None:
        return SphereShape((*part.points[0], part.x), part.radius)
    if part.along is not None:
        return PrismShape(tuple(simple_polygon(part.points)), part.along, part.x)
    return None


def circle(middle: Point, radius: float) -> tuple[Point, ...]:
    """Corners (m) of a circle, counter-clockwise."""
    turn = 2.0 * np.pi / ROUND * np.arange(ROUND)
    return tuple(
        zip((middle[0] + radius * np.cos(turn)).tolist(), (middle[1] + radius * np.sin(turn)).tolist(), strict=True)
    )


def of_contacts(part) -> dict[str, float]:
    """Friction and restitution of a body that floats, where they are given."""
    return {name: getattr(part, name) for name in ("friction", "restitution") if getattr(part, name) is not None}


def rooms_in_space(part, sections: dict[str, tuple[Point, ...]]) -> dict[str, PrismShape]:
    """The rooms of a hull in space by name, of their sections (m); without a length a wall shorter at each end."""
    found = {}
    for name, section in sections.items():
        room = part.rooms.get(name)
        along, x = (None, None) if room is None else (room.along, room.x)
        length = part.along - 2.0 * part.wall if along is None else along
        found[name] = PrismShape(section, length, part.x if x is None else x)
    return found


def freedom_in_space(
    part, shape: SphereShape | PrismShape, rooms: tuple[SphereShape | PrismShape, ...] = ()
) -> solved.Free:
    """What moves freely in space: its mass, centre and inertia, those of an even body, or a hull's walls, unless given.

    A centre that is given is in the middle of the body along x. Products of inertia are those of an even body where no
    moment of inertia is given, else none.
    """
    volume = shape.volume - sum(room.volume for room in rooms)
    mass = part.density * volume if part.mass is None else part.mass
    centroid = (shape.volume * shape.centroid - sum((one.volume * one.centroid for one in rooms), np.zeros(3))) / volume
    centre = centroid if part.centre is None else np.array([*part.centre, part.x])
    tensor = _about(shape, centroid) - sum((_about(room, centroid) for room in rooms), np.zeros((SPACE, SPACE)))
    tensor *= mass / volume
    given = part.pitch_inertia, part.yaw_inertia, part.inertia  # about y, z, x
    if any(moment is not None for moment in given):
        tensor = np.diag([tensor[k, k] if given[k] is None else given[k] for k in range(SPACE)])
    rows = tuple(map(tuple, tensor.tolist()))
    return solved.Free(mass, rows, tuple(centre.tolist()), part.release, **of_contacts(part))


def _about(shape: SphereShape | PrismShape, point: np.ndarray) -> np.ndarray:
    """Moments of inertia (3, 3) m⁵ of a shape of unit density about a point (3,) m."""
    off = shape.centroid - point
    return shape.volume * (shape.gyration + off @ off * np.eye(SPACE) - np.outer(off, off))


def faults_in_space(part) -> Iterator[tuple[str, str]]:
    """The keys at fault of a part that says that it is in space."""
    if part.radius is not None and part.along is not None:
        yield "along", "a sphere has its radius alone; give one of the two"
    if part.radius is not None and len(part.points) != 1:
        yield "points", f"a sphere has one point, its middle (got {len(part.points)})"
    if part.radius is not None and part.wall is not None:
        yield "wall", "a hull is a prism; give its points and its length along, or leave out its wall"
    if key := next((key for key in ("radius", "along") if getattr(part, key) is not None), None):
        if not part.closed:
            yield "closed", f"a body with {key} is solid; set closed = true, or leave out {key}"
        if key == "along" and part.wall is not None:
            yield from _faults_of_hull(part)
    else:
        for key in ("x", "pitch_inertia", "yaw_inertia"):
            if getattr(part, key):
                yield key, "goes with a body in space; give its length along, or its radius, or leave this out"
    given = [part.pitch_inertia, part.yaw_inertia, part.inertia]
    if None not in given and 2.0 * max(given) > sum(given):
        yield "inertia", "no body has one moment of inertia larger than the sum of the two others; make it smaller"


def _faults_of_hull(part) -> Iterator[tuple[str, str]]:
    """The keys at fault of a hull in space: rooms that reach through its end walls, holes that reach beyond it."""
    low, high = part.x - 0.5 * part.along, part.x + 0.5 * part.along
    if part.along <= 2.0 * part.wall:
        yield "along", "leaves no room between the two end walls; take a thinner wall"
    for name, room in part.rooms.items():
        x, half = part.x if room.x is None else room.x, 0.5 * (room.along or part.along - 2.0 * part.wall)
        if x - half < low + 0.99 * part.wall or x + half > high - 0.99 * part.wall:
            yield f"rooms.{name}.along", "this room reaches into an end wall of its hull; make it shorter, or move it"
    for name, hole in part.openings.items():
        x, half = part.x if hole.x is None else hole.x, 0.5 * float(np.hypot(*np.subtract(*hole.points)))
        if x - half < low + part.wall or x + half > high - part.wall:
            yield f"openings.{name}.x", "this opening reaches into an end wall of its hull; move it, or make it smaller"
