"""The bulk of a scene, and its points at rest, from a preset."""

import numpy as np

from lab.base.errors import LabError
from lab.preset.schema import Preset
from lab.preset.sections.bulk.beds import beds_of
from solvers.bulk.given import Bulk
from solvers.bulk.grid import grid_of
from solvers.bulk.start import at_rest
from solvers.scene import Scene
from solvers.tank.tank import Tank


def bulk_of(preset: Preset) -> Bulk:
    """The bulk of a scene, the same in all repeats. Raises LabError if it is too thin for its cells."""
    gravity, bulk, beds = preset.run.gravity, preset.bulk, beds_of(preset)
    grid = grid_of([Tank(bed.corners, preset.thickness) for bed in beds], bulk.spacing)
    material = bulk.material(max(bed.high for bed in beds), gravity)
    how = bulk.density, material.bulk_modulus, material.friction, gravity
    try:
        points = [at_rest(bed.filled, grid, number, *how) for number, bed in enumerate(beds)]
    except ValueError as error:
        raise LabError(f"bulk.spacing: {error}; make it smaller.") from None
    whole = np.tile(np.concatenate(points), (preset.run.repeats, 1))
    return Bulk(whole, material, grid, tuple(map(len, points)))


def points_of(scene: Scene) -> np.ndarray | None:
    """The volumes (W, n) m² that the points of a scene's bulk stand for, in all that of the bed; None without bulk."""
    bulk = scene.of(Bulk)
    return bulk.points["mass"] / bulk.material.density if bulk else None
