"""Water at rest round the parts in a tank, and beside gates with other levels behind them."""

from collections.abc import Sequence

import numpy as np

from solvers.fluid.bodies.solids import is_solid
from solvers.fluid.start.lattice import CLOSE, NEAR, from_edges, lattice
from solvers.tank.parts import Part
from solvers.tank.tank import Tank

FINER = 8  # points of a finer lattice along a spacing, by which the area that bodies take is counted


def cleared(points: np.ndarray, parts: Sequence[Part], close: float) -> np.ndarray:
    """Which of the points (n, 2) m are outside of all bodies, and at least `close` (m) from their faces and plates."""
    free = np.ones(len(points), dtype=bool)
    for part in parts:
        corners, seen = np.array(part.points), 2.0 * close  # beyond that round its box all points are free
        near = ((points >= corners.min(axis=0) - seen) & (points <= corners.max(axis=0) + seen)).all(axis=1)
        free[near] &= from_edges(points[near], corners) >= close
        if is_solid(part):
            free[near] &= ~Tank(corners, 1.0).holds(points[near])
    return free


def free_share(polygon: np.ndarray, level: float, parts: Sequence[Part], spacing: float) -> float:
    """Which share of a polygon (m, 2) up to a level (m) bodies leave free, by a lattice finer than the `spacing`."""
    solid = [part for part in parts if is_solid(part)]
    return float(cleared(lattice(polygon, level, spacing / FINER)[0], solid, 0.0).mean()) if solid else 1.0


def clear_of(points: np.ndarray, parts: Sequence[Part], spacing: float) -> np.ndarray:
    """Which places (n, 2) m of particles bodies and plates leave free."""
    return cleared(points, parts, (CLOSE - NEAR) * spacing)
