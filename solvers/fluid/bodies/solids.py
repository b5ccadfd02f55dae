"""Wall particles of the bodies and plates in the water, as they are drawn, in blocks of lanes."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from solvers.fluid.given import Water
from solvers.fluid.state import FAR, UNUSED
from solvers.fluid.walls.layers import deep, faces, firm, layers, offset_from, sharp, straight
from solvers.tank.parts import Opening, Part
from solvers.tank.shapes import PrismShape

TOUCHES = 0.25  # spacings between a plate's end and a wall or a part from which on no water passes between them
STRIP = 4.0  # spacings: height of the strips by which the wall particles of a body are cut into blocks


def sheet(points: Sequence, spacing: float, rows: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Wall particles on both sides of a plate between two points (m): places (n, 2) m, volumes (n,) m², depths (n,) m.

    Each side has `rows` rows; those on one side are seen by the water on the other, which looks through the plate. So
    they reach beyond the plate's ends as well, where what is seen past an end and through the plate lies side by side.
    """
    start, end = np.asarray(points, dtype=float)
    length = float(np.hypot(*(end - start)))
    along = (end - start) / length
    normal = np.array([-along[1], along[0]])
    count = int(np.ceil(length / spacing - 1e-9)) + 2 * rows
    ways = (np.arange(count) + 0.5 - rows) * spacing
    depths = (np.arange(-rows, rows) + 0.5) * spacing
    places = start + ways[:, None, None] * along + depths[None, :, None] * normal
    return places.reshape(-1, 2), np.full(count * 2 * rows, spacing**2), np.tile(np.abs(depths), count)


def is_solid(part: Part) -> bool:
    """Whether a part is a solid polygon; else it is a plate without thickness."""
    return part.closed


def prolonging(parts: Sequence[Part], spacing: float) -> np.ndarray:
    """Which parts (k, k) go on as one plate: plates in one line whose ends touch, and that move alike.

    Also by way of others between them, and each plate itself; no solid body.
    """
    plates = [not is_solid(part) and len(part.points) == 2 and not part.sieve for part in parts]
    found = np.diag(np.array(plates, dtype=bool))
    for k, first in enumerate(parts):
        for m, second in enumerate(parts[:k]):
            if plates[k] and plates[m] and replace(first, points=second.points) == second:
                found[k, m] = found[m, k] = _in_line(np.array(first.points), np.array(second.points), spacing)
    for k in range(len(parts)):
        found |= found[:, k : k + 1] & found[k]
    return found


def _in_line(first: np.ndarray, second: np.ndarray, spacing: float) -> bool:
    """Whether a plate (2, 2) m goes on in the line of another, from an end that touches one of its ends."""
    apart = np.linalg.norm(first[:, None] - second, axis=2)
    ours, theirs = np.unravel_index(apart.argmin(), apart.shape)
    away = first[ours] - first[1 - ours]
    off = second - first[ours]
    across = np.abs(away[0] * off[:, 1] - away[1] * off[:, 0]) / np.hypot(*away)
    return bool(max(apart.min(), across.max()) < TOUCHES * spacing and off[1 - theirs] @ away > 0.0)


def line_of(parts: Sequence[Part], members: Sequence[int]) -> np.ndarray:
    """The outermost ends (2, 2) m, as drawn, of plates that go on as one, in the direction of the first of them."""
    ends = np.concatenate([np.asarray(parts[k].points, dtype=float) for k in members])
    ways = (ends - ends[0]) @ (ends[1] - ends[0])
    return ends[[ways.argmin(), ways.argmax()]]


def nearest_of(parts: Sequence[Part], members: Sequence[int], points: np.ndarray) -> np.ndarray:
    """Which of plates that go on as one is nearest to each point (n, 2) m, (n,)."""
    away = [np.linalg.norm(offset_from(points, np.asarray(parts[k].points, dtype=float)), axis=1) for k in members]
    return np.asarray(members)[np.argmin(away, axis=0)]


def sides_of(points: Sequence, closed: bool = True) -> np.ndarray:
    """The sides (n, 4) of a polygon, or of a line, through points (m): where each begins, and the way to its end."""
    corners = np.asarray(points, dtype=float)
    sides = np.hstack([corners, np.roll(corners, -1, axis=0) - corners])
    return sides if closed else sides[:-1]


def counter_clockwise(points: Sequence) -> np.ndarray:
    """Corners (m, 2) of a polygon in counter-clockwise order."""
    corners = np.asarray(points, dtype=float)
    y, z = corners.T
    return corners if y @ np.roll(z, -1) > z @ np.roll(y, -1) else corners[::-1]


class Solids:
    """The wall particles of the parts that are `wet`, in blocks of `lanes`, each block of one part.

    `places` (blocks, lanes, 2) m as drawn, `volumes` (blocks, lanes) m², `firm` (blocks, lanes) m, the distances within
    which they push water back, `along` (blocks, lanes, 2) unit vectors along the faces before them, `straight` those
    away from corners and ends (see `layers.straight`), `sliding` those away from bodies' sharp corners, `deep` (blocks,
    lanes) m how far they are off the faces, `numbers` (blocks, lanes), UNUSED in lanes without a wall particle, of
    which the first lane is none; `owner` (blocks,) is the part, `radius` (blocks,) m how far a block's wall particles
    are from its first one. `sides` are those of each part, see `sides_of`, `prolongs` (parts, parts) as of
    `prolonging`.
    """

    def __init__(self, parts: Sequence[Part], water: Water, lanes: int, wet: Sequence[bool]):
        rows = int(np.ceil(water.reach / water.spacing - 1e-9))
        self.prolongs = prolonging(parts, water.spacing)
        self.openings = openings_of(parts)
        none = (*(np.zeros((0, lanes, *more)) for more in ((2,), (), (), (2,), (2,), (2,), (), (), (), ())),)
        found = [self._part(k, parts, water, rows, lanes) if of_water else none for k, of_water in enumerate(wet)]
        places = [place for place, *_ in found]
        self.sides = [sides_of(part.points, is_solid(part)) for part in parts]
        self.ends = np.cumsum([0, *(len(place) for place in places)])
        blocks = int(self.ends[-1])
        columns = zip(none, *found, strict=True)
        self.places, self.volumes, self.firm, *further = (np.concatenate(column) for column in columns)
        self.along, self.straight, self.sliding, self.deep, rooms, holes, self.beyond = further
        self.rooms, self.holes = rooms.astype(int), holes.astype(int)
        self.owner = np.repeat(np.arange(len(parts)), np.diff(self.ends))
        used = self.volumes > 0.0
        self.numbers = np.where(used, np.arange(blocks * lanes).reshape(blocks, lanes), UNUSED)
        away = np.linalg.norm(self.places - self.places[:, :1], axis=2)
        self.radius = np.where(used, away, 0.0).max(axis=1, initial=0.0)

    def _part(self, k: int, parts: Sequence[Part], water: Water, rows: int, lanes: int) -> tuple[np.ndarray, ...]:
        """Of the wall particles of part k, in blocks of lanes, what `Solids` has from `places` to `holes`."""
        part, spacing = parts[k], water.spacing
        if is_solid(part):
            faces_of = [(0, counter_clockwise(part.points)[::-1], np.asarray(part.points, dtype=float))]
            faces_of += [(number, room, room) for number, room in rooms_of(parts, k)]
            found = [behind(*face, self.openings[k], water, rows) for face in faces_of]
            columns = map(np.concatenate, zip(*found, strict=True))
            points, volumes, depths, along, away, slides, off, rooms, holes = columns
            beyond = depths > (part.hull.wall if part.hull else np.inf)
        else:  # of plates that go on as one, those that are nearest to this one
            members = np.flatnonzero(self.prolongs[k])
            drawn = line_of(parts, members)
            whole = sheet(drawn, spacing, rows)
            mine = nearest_of(parts, members, whole[0]) == k
            points, volumes, depths = (one[mine] for one in whole)
            way = drawn[1] - drawn[0]
            along = slides = np.tile(way / np.hypot(*way), (len(points), 1))
            away, off = straight(points, along, drawn, water.reach), deep(points, along, drawn)
            rooms = holes = beyond = np.zeros(len(points))
        strip = np.floor((points[:, 1] - points[:, 1].min()) / (STRIP * spacing))
        order = np.lexsort((points[:, 0], strip))
        more = -len(points) % lanes
        rest = volumes, firm(depths, spacing), along, away, slides, off, rooms, holes, beyond
        columns = (points, FAR), *((one, 0.0) for one in rest)
        filled = (np.concatenate([one[order], np.full((more, *one.shape[1:]), fill)]) for one, fill in columns)
        return tuple(one.reshape(-1, lanes, *one.shape[1:]) for one in filled)


def behind(
    room: int, corners: np.ndarray, drawn: np.ndarray, openings: Sequence, water: Water, rows: int
) -> tuple[np.ndarray, ...]:
    """Wall particles behind the face of a polygon (m, 2) m, clockwise round a body, else round a room of this number.

    `drawn` is the same polygon as it is drawn. Their places, volumes, depths, and what `Solids` has from `along` to
    `holes`; none of them slides near the ends of openings, as near those of plates.
    """
    points, volumes, depths = layers(corners, water.spacing, rows)
    along, holes = faces(points, corners if room else corners[::-1]), np.zeros(len(points))
    foot = points - offset_from(points, corners)
    for number, opening, wall in openings:
        holes[in_opening(foot, opening, wall)] = number
    ends = np.concatenate([np.zeros((0, 2)), *(np.array(opening.ends) for _, opening, _ in openings)])
    away = straight(points, along, np.concatenate([drawn, ends]), water.reach)
    slides = straight(points, along, np.concatenate([sharp(corners), ends]), water.reach)
    off, seen_from = deep(points, along, drawn), np.full(len(points), float(room))
    return points, volumes, depths, along, away, slides, off, seen_from, holes


def rooms_of(parts: Sequence[Part], k: int) -> list[tuple[int, np.ndarray | PrismShape]]:
    """The rooms of part k, if it is a hull, by their numbers among those of all parts, from 1 on.

    Of each the corners (m, 2) m, or in space the prism.
    """
    before = sum(len(part.hull.rooms) for part in parts[:k] if part.hull)
    rooms = enumerate(parts[k].hull.rooms if parts[k].hull else (), start=before + 1)
    return [(number, room if isinstance(room, PrismShape) else counter_clockwise(room)) for number, room in rooms]


def openings_of(parts: Sequence[Part]) -> list[list[tuple[int, Opening, float]]]:
    """The openings in each part, each with its number among those of all parts, from 1 on, and the wall (m) there."""
    found, number = [], 0
    for part in parts:
        mine = part.hull.openings if part.hull else ()
        found.append([(number + n, opening, part.hull.wall) for n, opening in enumerate(mine, start=1)])
        number += len(mine)
    return found


def in_opening(points: np.ndarray, opening: Opening, wall: float) -> np.ndarray:
    """Which points (n, 2) m, or (n, 3), on the faces of a wall of this thickness (m) an opening leads through."""
    middle, normal, half = opening.place(points.shape[1])
    off = points - middle
    across = off @ normal
    return (np.linalg.norm(off - across[:, None] * normal, axis=1) < half) & (np.abs(across) < 1.01 * wall)
