"""Dummies of the bodies and plates in the water, as they are drawn, in blocks of lanes."""

from collections.abc import Sequence

import numpy as np

from solvers.fluid.given import Water
from solvers.fluid.state import FAR, UNUSED
from solvers.fluid.walls.layers import deep, faces, firm, layers, sharp, straight
from solvers.tank.parts import Part

STRIP = 4.0  # spacings: height of the strips by which the dummies of a body are cut into blocks


def sheet(points: Sequence, spacing: float, rows: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Dummies on both sides of a plate between two points (m): places (n, 2) m, volumes (n,) m², depths (n,) m.

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
    return getattr(part, "closed", False)


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
    """The dummies of all parts in blocks of `lanes`, each block of one part.

    `places` (blocks, lanes, 2) m as drawn, `volumes` (blocks, lanes) m², `firm` (blocks, lanes) m, the distances within
    which they push water back, `along` (blocks, lanes, 2) unit vectors along the faces before them, `straight` those
    away from corners and ends (see `layers.straight`), `sliding` those away from bodies' sharp corners, `deep` (blocks,
    lanes) m how far they are off the faces, `numbers` (blocks, lanes), UNUSED in lanes without a dummy, of which the
    first lane is none; `owner` (blocks,) is the part, `radius` (blocks,) m how far a block's dummies are from its first
    one. `sides` are those of each part, see `sides_of`.
    """

    def __init__(self, parts: Sequence[Part], water: Water, lanes: int):
        rows = int(np.ceil(water.reach / water.spacing - 1e-9))
        found = [self._part(part, water, rows, lanes) for part in parts]
        places = [place for place, *_ in found]
        self.sides = [sides_of(part.points, is_solid(part)) for part in parts]
        self.ends = np.cumsum([0, *(len(place) for place in places)])
        blocks = int(self.ends[-1])
        self.places = np.concatenate([*places, np.zeros((0, lanes, 2))])
        self.volumes = np.concatenate([*(volume for _, volume, *_ in found), np.zeros((0, lanes))])
        self.firm = np.concatenate([*(held for _, _, held, *_ in found), np.zeros((0, lanes))])
        self.along = np.concatenate([*(along for *_, along, _, _, _ in found), np.zeros((0, lanes, 2))])
        self.straight = np.concatenate([*(away for *_, away, _, _ in found), np.zeros((0, lanes, 2))])
        self.sliding = np.concatenate([*(slides for *_, slides, _ in found), np.zeros((0, lanes, 2))])
        self.deep = np.concatenate([*(off for *_, off in found), np.zeros((0, lanes))])
        self.owner = np.repeat(np.arange(len(parts)), np.diff(self.ends))
        used = self.volumes > 0.0
        self.numbers = np.where(used, np.arange(blocks * lanes).reshape(blocks, lanes), UNUSED)
        away = np.linalg.norm(self.places - self.places[:, :1], axis=2)
        self.radius = np.where(used, away, 0.0).max(axis=1, initial=0.0)

    @staticmethod
    def _part(part: Part, water: Water, rows: int, lanes: int) -> tuple[np.ndarray, ...]:
        """Of one part's dummies, in blocks of lanes, what `Solids` has from `places` to `deep`."""
        spacing = water.spacing
        if is_solid(part):
            corners = counter_clockwise(part.points)
            points, volumes, depths = layers(corners[::-1], spacing, rows)
            along = faces(points, corners)
            slides = straight(points, along, sharp(corners[::-1]), water.reach)
        else:
            points, volumes, depths = sheet(part.points, spacing, rows)
            way = np.subtract(part.points[1], part.points[0])
            along = slides = np.tile(way / np.hypot(*way), (len(points), 1))
        strip = np.floor((points[:, 1] - points[:, 1].min()) / (STRIP * spacing))
        order = np.lexsort((points[:, 0], strip))
        more = -len(points) % lanes
        drawn = np.asarray(part.points, dtype=float)
        away, off = straight(points, along, drawn, water.reach), deep(points, along, drawn)
        columns = (points, FAR), *((one, 0.0) for one in (volumes, firm(depths, spacing), along, away, slides, off))
        filled = (np.concatenate([one[order], np.full((more, *one.shape[1:]), fill)]) for one, fill in columns)
        return tuple(one.reshape(-1, lanes, *one.shape[1:]) for one in filled)
