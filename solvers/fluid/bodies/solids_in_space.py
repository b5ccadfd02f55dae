"""Wall particles of the bodies in the water in space, as they are drawn, in blocks of lanes."""

from collections.abc import Sequence

import numpy as np

from solvers.fluid.bodies.solids import in_opening, openings_of, rooms_of
from solvers.fluid.given import Water
from solvers.fluid.state import FAR, UNUSED
from solvers.fluid.walls.layers import FAR as CLEAR
from solvers.fluid.walls.layers import firm, layers, offset_from
from solvers.fluid.walls.prism_layers import PrismLayers
from solvers.machine.quantity import SPACE
from solvers.tank.parts import Part
from solvers.tank.shapes import PrismShape, SphereShape, signed_distance
from solvers.tank.solids.solid import Prism
from solvers.tank.tank import Tank

COLUMNS = (SPACE,), (), (), (SPACE,), (SPACE,), (SPACE,), (), (), ()  # shapes of the columns of a part
GOLDEN = np.pi * (3.0 - np.sqrt(5.0))  # rad, the golden angle
CELL = 2.0  # spacings: side of the cubes by which the wall particles of a body are cut into blocks
SHARPER = 1e-9  # of a spacing by which a wall particle may be out of its shell


class SolidsInSpace:
    """The wall particles of the parts that are `wet`, in blocks of `lanes`, each block of one part.

    As `Solids` has them in the plane; `places`, `along`, `straight` and `sliding` are (blocks, lanes, 3), `volumes`
    (blocks, lanes) m³. `along` are normals of the faces, out of the body; `straight` those away from edges and corners,
    `sliding` those of smooth faces alone, for all edges of a convex body point into the water.
    """

    def __init__(self, parts: Sequence[Part], water: Water, lanes: int, wet: Sequence[bool]):
        self.openings = openings_of(parts)
        none = tuple(np.zeros((0, *more)) for more in COLUMNS)
        found = [self._part(parts, k, water) if of_water else none for k, of_water in enumerate(wet)]
        blocks = [in_blocks(one, water.spacing, lanes) for one in found]
        empty = in_blocks(none, water.spacing, lanes)
        columns = (np.concatenate(column) for column in zip(empty, *blocks, strict=True))
        self.places, self.volumes, depths, self.along, self.straight, self.sliding, rooms, holes, self.beyond = columns
        self.firm, self.rooms, self.holes = firm(depths, water.spacing), rooms.astype(int), holes.astype(int)
        self.ends = np.cumsum([0, *(len(places) for places, *_ in blocks)])
        self.owner = np.repeat(np.arange(len(parts)), np.diff(self.ends))
        used = self.volumes > 0.0
        self.numbers = np.where(used, np.arange(used.size).reshape(used.shape), UNUSED)
        away = np.linalg.norm(self.places - self.places[:, :1], axis=2)
        self.radius = np.where(used, away, 0.0).max(axis=1, initial=0.0)

    def _part(self, parts: Sequence[Part], k: int, water: Water) -> tuple[np.ndarray, ...]:
        """Of the wall particles of part k, in columns, what `Solids` has: places, volumes, depths, and the rest."""
        part, rows = parts[k], int(np.ceil(water.reach / water.spacing - 1e-9))
        found = [self._seen(0, shell(part.shape, water, rows), k, part, water)]
        found += [self._seen(number, round_room(room, water), k, part, water) for number, room in rooms_of(parts, k)]
        return tuple(np.concatenate(column) for column in zip(*found, strict=True))

    def _seen(
        self, room: int, behind: tuple[np.ndarray, ...], k: int, part: Part, water: Water
    ) -> tuple[np.ndarray, ...]:
        """The columns of what stands `behind` the face of part k, or of a room in it, and is seen from this room.

        None of it slides near the rims of openings.
        """
        points, volumes, depths, along, straight, sliding = behind
        holes, clear = np.zeros(len(points)), np.ones(len(points), dtype=bool)
        foot = points + (depths if room == 0 else -depths)[:, None] * along
        for number, opening, wall in self.openings[k]:
            holes[in_opening(foot, opening, wall)] = number
            middle, normal, half = opening.place(SPACE)
            across = (points - middle) @ normal
            aside = np.linalg.norm(points - middle - across[:, None] * normal, axis=1)
            clear &= np.hypot(aside - half, across) > CLEAR * water.reach
        beyond = depths > (part.hull.wall if part.hull else np.inf)
        away = straight * clear[:, None], sliding * clear[:, None]
        return points, volumes, depths, along, *away, np.full(len(points), float(room)), holes, beyond.astype(float)


def round_room(room: PrismShape, water: Water) -> tuple[np.ndarray, ...]:
    """As `shell`, round a room: its normals lead out of the room."""
    laid = PrismLayers(water, Tank(room.polygon, 1.0), Prism(room.along))
    points = laid.points + np.array([0.0, 0.0, room.middle])
    return points, laid.volumes, laid.depths, laid.along, laid.straight, laid.sliding


def shell(shape: SphereShape | PrismShape, water: Water, rows: int) -> tuple[np.ndarray, ...]:
    """Wall particles in `rows` layers behind the faces of a body: places (n, 3) m, volumes (n,) m³, depths (n,) m.

    Then unit normals (n, 3) of the faces before them, those away from edges, and those along which walls may slide.
    """
    if isinstance(shape, SphereShape):
        return of_sphere(shape, water.spacing, rows)
    return of_prism(shape, water, rows)


def of_sphere(shape: SphereShape, spacing: float, rows: int) -> tuple[np.ndarray, ...]:
    """As `shell`, on concentric spheres: on each the points of a spiral at equal shares of its area.

    z_k = 1 − (2 k + 1)/n, turned by the golden angle from one to the next (Swinbank & Purser 2006, Q. J. R. Meteorol.
    Soc. 132, 1769). Each has its share of its layer's volume. The innermost layer may be a ball.
    """
    found = []
    for row in range(rows):
        outer, inner = shape.radius - row * spacing, max(0.0, shape.radius - (row + 1.0) * spacing)
        if outer <= 0.0:
            break
        volume = 4.0 / 3.0 * np.pi * (outer**3 - inner**3)
        radius = 0.5 * (outer + inner)
        count = max(1, round(volume / spacing**3))
        k = np.arange(count)
        z, turn = 1.0 - (2.0 * k + 1.0) / count, GOLDEN * k
        flat = np.sqrt(1.0 - z * z)
        normal = np.column_stack([flat * np.cos(turn), z, flat * np.sin(turn)])
        depth = np.full(count, (row + 0.5) * spacing)
        found.append((shape.centroid + radius * normal, np.full(count, volume / count), depth, normal))
    points, volumes, depths, normal = (np.concatenate(column) for column in zip(*found, strict=True))
    return points, volumes, depths, normal, normal, normal


def of_prism(shape: PrismShape, water: Water, rows: int) -> tuple[np.ndarray, ...]:
    """As `shell`, in layers round the section, drawn out along x, and in lattices of what these leave at the ends."""
    spacing, polygon = water.spacing, shape.polygon
    count = max(1, round(shape.along / spacing))
    step = shape.along / count
    x = step * (np.arange(count) + 0.5) - 0.5 * shape.along
    ring, areas, depths = layers(polygon[::-1], spacing, rows)
    core, area = core_of(polygon, spacing, rows)
    near_end = 0.5 * shape.along - np.abs(x) < rows * spacing
    sections = [(ring, areas, depths, x), (core, area, np.full(len(core), np.inf), x[near_end])]
    points, volumes, deep = (
        np.concatenate(column) for column in zip(*(drawn_out(*one, step) for one in sections), strict=True)
    )
    normal, straight = normals(points, shape, CLEAR * water.reach)
    behind = 0.5 * shape.along - np.abs(points[:, 2])
    depths = np.minimum(deep, (np.floor(behind / spacing + SHARPER) + 0.5) * spacing)
    points = points + np.array([0.0, 0.0, shape.middle])
    return points, volumes, depths, normal, straight, straight


def drawn_out(
    section: np.ndarray, areas: np.ndarray, depths: np.ndarray, x: np.ndarray, step: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (n, 2) of a section at places x (k,): (n k, 3) m, their volumes and depths."""
    points = np.column_stack([np.tile(section, (len(x), 1)), np.repeat(x, len(section))])
    return points, step * np.tile(areas, len(x)), np.tile(depths, len(x))


def core_of(polygon: np.ndarray, spacing: float, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """A lattice (n, 2) m of what so many layers leave of a polygon, and the areas (n,) m² of its points."""
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    sides = [low[a] + spacing * (np.arange(int((high - low)[a] / spacing) + 1) + 0.5) for a in (0, 1)]
    points = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
    points = points[signed_distance(points, polygon) < -rows * spacing]
    return points, np.full(len(points), spacing**2)


def normals(points: np.ndarray, shape: PrismShape, clear: float) -> tuple[np.ndarray, np.ndarray]:
    """Normals (n, 3) of the faces before points in a prism about x = 0, and those of points away from edges.

    These are more than a length (m) from any other face than the nearest.
    """
    polygon, half = shape.polygon, 0.5 * shape.along
    away = offset_from(points[:, :2], polygon)  # from the nearest side
    to_side, to_end = np.linalg.norm(away, axis=1), half - np.abs(points[:, 2])
    by_end = to_end < to_side
    found = np.zeros_like(points)
    found[~by_end, :2] = -away[~by_end] / np.maximum(to_side[~by_end], 1e-300)[:, None]
    found[by_end, 2] = np.sign(points[by_end, 2])
    corner = np.linalg.norm(points[:, None, :2] - polygon, axis=2).min(axis=1)
    other = np.where(by_end, to_side, np.minimum(to_end, corner))
    return found, found * (other > clear)[:, None]


def in_blocks(columns: tuple[np.ndarray, ...], spacing: float, lanes: int) -> list[np.ndarray]:
    """Columns (n, …) of wall particles, places first and volumes next, in blocks of lanes that lie near each other."""
    places, side = columns[0], CELL * spacing
    cell = np.floor((places - places.min(axis=0, initial=np.inf)) / side) if len(places) else places
    order = np.lexsort((places[:, 0], cell[:, 0], cell[:, 2], cell[:, 1]))
    more = -len(places) % lanes
    filled = []
    for number, one in enumerate(columns):
        rest = np.full((more, *one.shape[1:]), FAR if number == 0 else 0.0)
        filled.append(np.concatenate([one[order], rest]).reshape(-1, lanes, *one.shape[1:]))
    return filled
