"""What stands behind the walls of a tank for its water: dummies, and the probes of gauges among them."""

import numpy as np

from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS
from solvers.fluid.walls.gauges import probes
from solvers.fluid.walls.layers import edge_of, firm, layers
from solvers.space.axes import NAMES
from solvers.tank.tank import Tank

OF_NONE = -1  # the edge of probes, which are no part of a wall


class Behind:
    """Dummies and probes of a tank: `points` (n, 2) m, `volumes` (n,) m² and `edges` (n,) of each.

    An edge is named by its first corner; probes have no volume and no edge. `probes` are each gauge's, by their
    numbers, `open` what dummies leave of their kernels.
    """

    def __init__(self, water: Water, tank: Tank):
        self.probes: list[np.ndarray] = []
        self.open: list[np.ndarray] = []
        if not water.walls:
            self.points, self.volumes, self.firm = np.zeros((0, 2)), np.zeros(0), np.zeros(0)
            self.edges = np.zeros(0, dtype=int)
            return
        rows = int(np.ceil(water.reach / water.spacing - 1e-9))
        points, volumes, depths = layers(tank.outline, water.spacing, rows, tank.open_edges)
        for axis, (low, high) in enumerate(zip(tank.outline.min(axis=0), tank.outline.max(axis=0), strict=True)):
            if NAMES[axis] in water.periodic:
                kept = (points[:, axis] >= low) & (points[:, axis] < high)
                points, volumes, depths = points[kept], volumes[kept], depths[kept]
        edges = edge_of(points, tank.outline)
        for gauge in water.gauges:
            of_gauge = probes(gauge, tank.outline, water.spacing)
            self.probes.append(len(points) + np.arange(len(of_gauge)))
            points, volumes = np.concatenate([points, of_gauge]), np.append(volumes, np.zeros(len(of_gauge)))
            depths = np.append(depths, np.zeros(len(of_gauge)))
            edges = np.append(edges, np.full(len(of_gauge), OF_NONE))
        self.points, self.volumes, self.edges = points, volumes, edges
        self.firm = depths if water.air else firm(depths, water.spacing)  # each layer holds air, see `Constants`
        self.open = [1.0 - covered(points[probe], points, volumes, water) for probe in self.probes]


def covered(places: np.ndarray, points: np.ndarray, volumes: np.ndarray, water: Water) -> np.ndarray:
    """What share of the kernel at each place (k, 2) m dummies (n, 2) m cover, (k,)."""
    away = np.linalg.norm(places[:, None] - points, axis=2)
    kernel = KERNELS[water.kernel]
    near = np.where(away < water.reach, kernel.printed(np.minimum(away, water.reach), water.length), 0.0)
    return near @ volumes
