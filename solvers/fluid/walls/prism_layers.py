"""Layers of wall particles behind the walls of a prism in space."""

import numpy as np

from solvers.fluid.given import Gauge, Water
from solvers.fluid.start.lattice import lattice
from solvers.fluid.walls.faces import spot_on
from solvers.fluid.walls.layers import FAR, distance, edge_of, firm, layers, offset_from, sharp, straight
from solvers.fluid.walls.wall_layers import OF_NONE, WallLayers, covered
from solvers.tank.solids.solid import Prism
from solvers.tank.tank import Tank


class PrismLayers(WallLayers):
    """As `WallLayers` has them in the plane: `points` (n, 3) m and `volumes` (n,) m³ of wall particles.

    The layers round the outline are repeated along x, at equal distances of about a spacing, within the prism and
    beyond its ends; behind an end wall a lattice fills them up. `along`, `straight` and `sliding` (n, 3) are unit
    normals from the faces, `straight` zero near edges and corners, `sliding` zero near edges that point into the water.
    `depths` (n,) m is how far their layers lie behind the faces. A periodic prism has no ends.
    """

    def __init__(self, water: Water, tank: Tank, solid: Prism):
        self.blocks, self.probes, self.open = 0, [], []
        self.points, self.volumes, self.firm = np.zeros((0, 3)), np.zeros(0), np.zeros(0)
        self.along = self.straight = self.sliding = np.zeros((0, 3))
        self.edges, self.tanks, self.depths = np.zeros(0, dtype=int), np.zeros(0, dtype=int), np.zeros(0)
        if water.walls:
            self._lay(water, tank, solid)
            for gauge in water.gauges:
                self._add_probes(gauge, water, tank, solid)

    def _add_probes(self, gauge: Gauge, water: Water, tank: Tank, solid: Prism) -> None:
        """Add the probes of a gauge, a disc in the face that is nearest to its middle."""
        middle = np.array([*gauge.place, gauge.x])
        spot = spot_on(middle, tank.outline, 0.5 * solid.along, not solid.periodic, tank.open_edges)
        found = spot.disc(gauge.radius, water.spacing)
        images = (-1, 0, 1) if solid.periodic else (0,)
        points = np.concatenate([self.points + image * solid.along * np.eye(3)[2] for image in images])
        near = np.linalg.norm(points - spot.foot, axis=1) < gauge.radius + water.reach
        self.probes.append(len(self.points) + np.arange(len(found)))
        volumes = np.tile(self.volumes, len(images))
        self.open.append(1.0 - covered(found, points[near], volumes[near], water))
        none, no_way = np.zeros(len(found)), np.zeros_like(found)
        self._add(found, none, np.full(len(found), OF_NONE), 0)
        self.firm = np.append(self.firm, none)
        self.along = np.concatenate([self.along, no_way])
        self.straight, self.sliding = (np.concatenate([one, no_way]) for one in (self.straight, self.sliding))

    def _lay(self, water: Water, tank: Tank, solid: Prism) -> None:
        rows, half = int(np.ceil(water.reach / water.spacing - 1e-9)), 0.5 * solid.along
        count = max(1, round(solid.along / water.spacing))
        step, more = solid.along / count, 0 if solid.periodic else rows
        x = (np.arange(-more, count + more) + 0.5) * step - half
        within = np.abs(x) < half
        ring, areas, depths = layers(tank.outline, water.spacing, rows, tank.open_edges)
        cap, area = lattice(tank.outline, float(tank.outline[:, 1].max()), water.spacing)
        away = offset_from(ring, tank.outline)
        parts = [
            (ring, areas, depths, away, x),
            (cap, np.full(len(cap), area), np.zeros(len(cap)), 0.0 * cap, x[~within]),
        ]
        found = [self._drawn(*part, half) for part in parts]
        self.points, offset, areas, depths = (np.concatenate(columns) for columns in zip(*found, strict=True))
        self.volumes = step * areas
        size = np.linalg.norm(offset, axis=1)[:, None]
        self.along, section, reach = offset / size, self.points[:, :2], water.reach
        behind_end = np.abs(self.points[:, 2]) > half
        off_edge = np.where(behind_end, distance(section, tank.outline), half - np.abs(self.points[:, 2]))
        clear = (np.hypot(off_edge, size[:, 0]) > FAR * reach) | solid.periodic
        self.straight = self.along * clear[:, None]
        self.straight[~behind_end] = straight(section, self.straight, tank.outline, reach)[~behind_end]
        self.sliding = straight(section, self.along, sharp(tank.outline), reach)
        self.firm, self.depths = firm(depths, water.spacing), depths
        self.edges, self.tanks = edge_of(section, tank.outline), np.zeros(len(section), dtype=int)
        self.edges[behind_end] = OF_NONE

    @staticmethod
    def _drawn(
        points: np.ndarray, areas: np.ndarray, depths: np.ndarray, away: np.ndarray, x: np.ndarray, half: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Points (n, 2) of a section at places x (k,): (n k, 3) m, their offsets from the prism, areas and depths."""
        beyond = np.sign(x) * np.maximum(np.abs(x) - half, 0.0)
        all_x, all_beyond = np.repeat(x, len(points)), np.repeat(beyond, len(points))
        drawn = np.column_stack([np.tile(points, (len(x), 1)), all_x])
        offset = np.column_stack([np.tile(away, (len(x), 1)), all_beyond])
        deep = np.maximum(np.tile(depths, len(x)), np.abs(all_beyond))
        return drawn, offset, np.tile(areas, len(x)), deep


def layers_of(scene, water: Water) -> WallLayers:
    """The wall particles of the tanks of a scene (`solvers.scene.Scene`), in the plane or in space."""
    if scene.solid is None:
        return WallLayers(water, scene.tanks, scene.fills)
    return PrismLayers(water, scene.tanks[0], scene.solid)
