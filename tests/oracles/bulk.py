"""Beds of bulk for tests."""

import numpy as np

from solvers.bulk.given import Bulk, Granular
from solvers.bulk.grid import grid_of
from solvers.bulk.start import at_rest
from solvers.scene import Scene
from solvers.tank.tank import Tank

DENSITY, GRAVITY = 850.0, 9.81


def box(width: float, height: float) -> np.ndarray:
    """Corners of a rectangle that stands on the middle of its floor."""
    half = 0.5 * width
    return np.array([(-half, 0.0), (half, 0.0), (half, height), (-half, height)])


def bed(
    outline: np.ndarray,
    region: np.ndarray,
    spacing: float,
    friction: float = 0.32,
    wall: float = 0.32,
    law: str = "mu-of-i",
    stiffness: float = 50.0,
    worlds: int = 1,
) -> Bulk:
    """Bulk at rest in a region of a tank, of wheat."""
    region = np.asarray(region, dtype=float)
    grid = grid_of([Tank(outline, 1.0)], spacing)
    young = stiffness * DENSITY * GRAVITY * float(np.ptp(region[:, 1]))
    material = Granular(DENSITY, friction, wall, young, law, friction + 0.261, 0.279, 4e-3)
    points = at_rest(region, grid, 0, DENSITY, material.bulk_modulus, friction, GRAVITY)
    return Bulk(np.tile(points, (worlds, 1)), material, grid, (len(points),))


def scene(outline: np.ndarray, bulk: Bulk, **more: object) -> Scene:
    """The scene of a tank with bulk."""
    return Scene(outline=outline, matters=(bulk,), **{"schedule": "per-world", **more})
