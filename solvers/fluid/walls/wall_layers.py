"""The set-up of wall layers: the wall particles behind the walls of tanks, and the probes of gauges among them."""

from collections.abc import Sequence

import numpy as np

from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS
from solvers.fluid.walls.gauges import probes
from solvers.fluid.walls.layers import edge_of, faces, firm, layers, sharp, straight
from solvers.machine.quantity import DIRECTIONS
from solvers.tank.tank import Tank

OF_NONE = -1  # the edge of probes, which are no part of a wall


class WallLayers:
    """Wall particles and probes of tanks: `points` (n, 2) m, `volumes` (n,) m², `edges` and `tanks` (n,) of each.

    `along` (n, 2) are unit vectors along the faces before them (`faces`), zero of probes; `straight` (n, 2) are those
    away from all corners, `sliding` (n, 2) those away from `sharp` corners, which point into the water, else zero. An
    edge is named by its first corner; probes have no volume and no edge. `probes` are each gauge's, by their numbers,
    `open` what wall particles leave of their kernels. Gauges are in the first tank that has water. `fills` are the
    numbers of particles in each tank; none stands behind a dry one.
    """

    def __init__(self, water: Water, tanks: Sequence[Tank], fills: Sequence[int]):
        self.blocks = 0  # how many the grid arranges them in
        self.probes: list[np.ndarray] = []
        self.open: list[np.ndarray] = []
        self.points, self.volumes, self.firm = np.zeros((0, 2)), np.zeros(0), np.zeros(0)
        self.edges, self.tanks = np.zeros(0, dtype=int), np.zeros(0, dtype=int)
        self.along = self.straight = self.sliding = np.zeros((0, 2))
        wet = [number for number, fill in enumerate(fills) if fill]
        for number in wet if water.walls else ():
            points, volumes, depths = _round(water, tanks[number])
            self._add(points, volumes, edge_of(points, tanks[number].outline), number)
            along = faces(points, tanks[number].outline)
            self.along = np.concatenate([self.along, along])
            away = straight(points, along, tanks[number].outline, water.reach)
            self.straight = np.concatenate([self.straight, away])
            ends = sharp(tanks[number].outline)
            self.sliding = np.concatenate([self.sliding, straight(points, along, ends, water.reach)])
            hold = depths if water.air else firm(depths, water.spacing)  # each layer holds air, see `Constants`
            self.firm = np.append(self.firm, hold)
        if not len(self.points):
            return
        first = tanks[wet[0]].outline
        own = slice(0, np.count_nonzero(self.tanks == wet[0]))
        points, volumes = self.points[own], self.volumes[own]
        for gauge in water.gauges:
            of_gauge = probes(gauge, first, water.spacing)
            self.probes.append(len(self.points) + np.arange(len(of_gauge)))
            self.open.append(1.0 - covered(of_gauge, points, volumes, water))
            none = np.zeros(len(of_gauge))
            self._add(of_gauge, none, np.full(len(of_gauge), OF_NONE), wet[0])
            self.firm, self.along = np.append(self.firm, none), np.concatenate([self.along, 0.0 * of_gauge])
            self.straight = np.concatenate([self.straight, 0.0 * of_gauge])
            self.sliding = np.concatenate([self.sliding, 0.0 * of_gauge])

    def rows(self, values: np.ndarray, of_bodies: np.ndarray, slots: np.ndarray, lanes: int) -> np.ndarray:
        """Values of the points, at their `slots` among lanes, and after them those of bodies, by rows and lanes."""
        rows = np.zeros((self.blocks * lanes, *values.shape[1:]))
        rows[slots] = values
        rows = rows.reshape(-1, lanes, *values.shape[1:])
        return np.concatenate([rows, of_bodies]) if len(of_bodies) else rows

    def _add(self, points: np.ndarray, volumes: np.ndarray, edges: np.ndarray, tank: int) -> None:
        self.points, self.volumes = np.concatenate([self.points, points]), np.append(self.volumes, volumes)
        self.edges = np.append(self.edges, edges)
        self.tanks = np.append(self.tanks, np.full(len(points), tank))


def _round(water: Water, tank: Tank) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Wall particles round a tank, see `layers`, without those beyond the ends of periodic space."""
    rows = int(np.ceil(water.reach / water.spacing - 1e-9))
    points, volumes, depths = layers(tank.outline, water.spacing, rows, tank.open_edges)
    for axis, (low, high) in enumerate(zip(tank.outline.min(axis=0), tank.outline.max(axis=0), strict=True)):
        if DIRECTIONS[axis] in water.periodic:
            kept = (points[:, axis] >= low) & (points[:, axis] < high)
            points, volumes, depths = points[kept], volumes[kept], depths[kept]
    return points, volumes, depths


def covered(places: np.ndarray, points: np.ndarray, volumes: np.ndarray, water: Water) -> np.ndarray:
    """What share of the kernel at each place (k, D) m wall particles (n, D) m cover, (k,)."""
    away = np.linalg.norm(places[:, None] - points, axis=2)
    kernel, axes = KERNELS[water.kernel], places.shape[1]
    near = np.where(away < water.reach, kernel.printed(np.minimum(away, water.reach), water.length, axes), 0.0)
    return near @ volumes
