"""Water in space round bodies: a lattice, of which what is near the bodies is packed."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from solvers.fluid.bodies.solids_in_space import shell
from solvers.fluid.given import Water
from solvers.fluid.start.lattice import lattice_in_space
from solvers.fluid.start.packing import PUSH, Crowd, relax
from solvers.fluid.walls.prism_layers import PrismLayers
from solvers.tank.parts import Part
from solvers.tank.solids.solid import Prism
from solvers.tank.tank import Tank

NEAR = 3.0  # spacings from a body up to which water is packed
FINER = 2  # times as fine as in the run are wall particles within DEEP of a face: they leave no gap at the surface
DEEP = 2  # spacings
STEPS = 60  # at most: what is left is far below what the first steps of a run even out


def packed_round(
    polygon: np.ndarray, level: float, water: Water, parts: Sequence[Part], along: float
) -> tuple[np.ndarray, float]:
    """Places (n, 3) m of particles in a prism over a polygon up to a level (m) round bodies, and the volume of each.

    So many places of the lattice of the prism as the bodies leave volume for, those that are farthest out of them.
    Within NEAR of a body they push each other apart, as of `packed`, among the others and wall particles, which all
    stand; the surface is a plane of symmetry. Volumes are equal, and their sum is exactly that of the water. Raises
    ValueError if no particle fits in.
    """
    lattice, volume = lattice_in_space(polygon, level, water.spacing, along)
    shapes, spacing = [part.shape for part in parts], water.spacing
    count = len(lattice) - sum(shape.below(level) for shape in shapes) / volume
    if count < 1.0:
        raise ValueError("the bodies leave no room for a particle of this spacing")
    away, wet = _away(lattice, shapes), [shape for shape in shapes if shape.bounds[0][1] < level]
    kept = np.argsort(-away, kind="stable")[: round(count)]
    points, away = lattice[np.sort(kept)], away[np.sort(kept)]
    near = _away(points, wet) < NEAR * spacing if wet else np.zeros(len(points), dtype=bool)
    if near.any():
        tank = PrismLayers(water, Tank(polygon, 1.0), Prism(along))
        points[near] = _packed(points, near, level, volume, water, wet, tank)
    return points, volume * count / round(count)


def _away(points: np.ndarray, shapes: Sequence) -> np.ndarray:
    """How far (n,) m points are out of all bodies."""
    return np.min([shape.distance(points) for shape in shapes], axis=0)


def _packed(
    points: np.ndarray,
    near: np.ndarray,
    level: float,
    volume: float,
    water: Water,
    shapes: Sequence,
    tank: PrismLayers,
) -> np.ndarray:
    """Those of the points (n, 3) m that are `near` bodies, pushed apart."""
    spacing, reach = water.spacing, water.reach
    rows = int(np.ceil(reach / spacing - 1e-9))
    low, high = points[near].min(axis=0) - 2.0 * reach, points[near].max(axis=0) + 2.0 * reach
    others = points[~near]
    others = others[((others > low) & (others < high)).all(axis=1)]
    fine, shells = replace(water, spacing=spacing / FINER, smoothing=FINER * water.smoothing), []
    for shape in shapes:
        for (places, volumes, depths, *_), behind in (
            (shell(shape, fine, FINER * DEEP), False),
            (shell(shape, water, rows), True),
        ):
            kept = (depths > DEEP * spacing) == behind
            shells.append((places[kept], volumes[kept]))
    walls = np.concatenate([others, tank.points, *(one[0] for one in shells)])
    volumes = np.concatenate([np.full(len(others), volume), tank.volumes, *(one[1] for one in shells)])
    below = walls[:, 1] < level
    crowd = CrowdBelow(points[near], volume, walls[below], volumes[below], water.length, level)
    relax(crowd, spacing, PUSH * min(1.0, water.smoothing / 2.0) ** 2, STEPS)
    return crowd.points


class CrowdBelow(Crowd):
    """A crowd below a plane of symmetry at a `level` (m): above it stand the mirror images of all."""

    def __init__(
        self, points: np.ndarray, volume: float, walls: np.ndarray, volumes: np.ndarray, length: float, level: float
    ):
        self.level, self.below = level, walls
        shares = np.concatenate([volumes, volumes, np.full(len(points), volume)])
        super().__init__(points, volume, self.with_images(points), shares, length)

    def with_images(self, points: np.ndarray) -> np.ndarray:
        """The walls, with the images of themselves and of points (n, 3) m."""
        images = np.concatenate([self.below, points])
        images[:, 1] = 2.0 * self.level - images[:, 1]
        return np.concatenate([self.below, images])

    def move(self, way: np.ndarray) -> None:
        """Move the particles by (n, 3) m, and their images with them."""
        self.walls = self.with_images(self.points + way)
        super().move(way)
