"""The bulk of a scene, and its points at rest, from a preset."""

import numpy as np

from lab.base.errors import LabError
from lab.preset.schema import Preset
from solvers.bulk.given import Bulk
from solvers.bulk.grid import grid_of
from solvers.bulk.start import at_rest
from solvers.scene import Scene
from solvers.tank.tank import Tank


def bulk_of(preset: Preset) -> Bulk:
    """The bulk of a scene, the same in all repeats. Raises LabError if it is too thin for its cells."""
    corners, gravity, bulk = np.array(preset.tank.corners), preset.run.gravity, preset.bulk
    grid = grid_of([Tank(corners, preset.thickness)], bulk.spacing)
    material, filled = bulk.material(corners, gravity), bulk.filled(corners)
    try:
        points = at_rest(filled, grid, 0, bulk.density, material.bulk_modulus, material.friction, gravity)
    except ValueError as error:
        raise LabError(f"bulk.spacing: {error}; make it smaller.") from None
    return Bulk(np.tile(points, (preset.run.repeats, 1)), material, grid, (len(points),))


def points_of(scene: Scene) -> np.ndarray | None:
    """The volumes (W, n) m² that the points of a scene's bulk stand for, in all that of the bed; None without bulk."""
    bulk = scene.of(Bulk)
    return bulk.points["mass"] / bulk.material.density if bulk else None
