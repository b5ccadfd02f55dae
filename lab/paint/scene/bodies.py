"""Solid bodies in a tank, and hulls cut open: their walls, rooms and openings."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from lab.paint.painter import Camera, paint_plate, paint_shape
from lab.preset.sections.bodies.hulls import rooms_of

PLATE, EDGE, COVER = 0.3, 0.12, 0.1  # thickness of plates, of outlines and of covers, in u
PALE = 0.45  # of the part's colour in a solid body; the rest is the paper's


@dataclass(frozen=True)
class SolidBody:
    """A body as it is drawn: number and name of the part, its outline, rooms and openings (m), a time (s) for each.

    `names` are those of the openings.
    """

    number: int
    name: str
    outline: np.ndarray
    rooms: tuple[np.ndarray, ...]
    openings: tuple[tuple[np.ndarray, float], ...]
    names: tuple[str, ...] = ()

    def shapes(self, time: float) -> list[np.ndarray]:
        """The polygons (m, 2) m that bound its walls by the even–odd rule at a time (s)."""
        return [self.outline, *self.rooms, *(corners for corners, opens in self.openings if opens <= time)]

    def covers(self, time: float) -> Iterator[np.ndarray]:
        """The lines (2, 2) m of the covers that are still on at a time (s)."""
        for corners, opens in self.openings:
            if opens > time:
                yield 0.5 * (corners[:2] + corners[:1:-1])


@dataclass(frozen=True)
class Hold:
    """A room of a hull that holds the grains: the hull's number among the parts, and those of the parts in the room."""

    hull: int
    parts: tuple[int, ...]


def hold_of(preset) -> Hold | None:
    """The room of a floating hull that holds a preset's grains; None if they are in the tank."""
    room = preset.grains.room if preset.grains else None
    if room is None:
        return None
    hull = list(preset.parts).index(room.rpartition(".")[0])
    return Hold(hull, tuple(k for k, part in enumerate(preset.parts.values()) if part.tank == room))


def bodies_of(preset) -> list[SolidBody]:
    """The solid bodies of a preset."""
    found = []
    for number, (name, part) in enumerate(preset.parts.items()):
        if part.closed:
            openings = tuple((passage(one.points, part.wall), one.opens) for one in part.openings.values())
            rooms = tuple(rooms_of(part).values())
            found.append(SolidBody(number, name, np.array(part.section), rooms, openings, tuple(part.openings)))
    return found


def passage(ends: tuple, wall: float) -> np.ndarray:
    """Corners (4, 2) m of the passage through a wall (m) between two ends in its middle."""
    start, end = np.array(ends)
    along = (end - start) / np.hypot(*(end - start))
    across = 0.5 * wall * np.array([-along[1], along[0]])
    return np.array([start - across, end - across, end + across, start + across])


def paint_parts(picture: np.ndarray, camera: Camera, bed, row: float, time: float, unit: float, theme) -> None:
    """Paint the parts of a bed (`lab.paint.footage.Bed`) in a row of its frames, at a time (s)."""
    bodies = bed.footage.bodies
    solid = [body.number for body in bodies]
    for number, line in enumerate(bed.plates(row)):
        if number not in solid:
            paint_plate(picture, camera, line, PLATE * unit, theme.part)
    for body in bodies:
        _paint_body(picture, camera, body, partial(bed.moved, number=body.number, frame=row), time, unit, theme)


def _paint_body(picture: np.ndarray, camera: Camera, body: SolidBody, move, time: float, unit: float, theme) -> None:
    """Paint a body at a time (s); `move` takes points (m, 2) m to where they are."""
    hollow = bool(body.rooms)
    paper, own = np.array(theme.paper, dtype=float), np.array(theme.part, dtype=float)
    fill = theme.part if hollow else tuple(paper + PALE * (own - paper))
    shapes = [move(shape) for shape in body.shapes(time)]
    paint_shape(picture, camera, shapes, 0.0 if hollow else EDGE * unit, theme.part, fill)
    for line in body.covers(time):
        paint_plate(picture, camera, move(line), COVER * unit, theme.paper)
