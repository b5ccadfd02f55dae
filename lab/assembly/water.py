"""The water of a scene, and its particles at rest, from a preset."""

from dataclasses import replace

import numpy as np

from lab.base.errors import LabError
from lab.preset.schema import Preset
from lab.preset.sections.water.liquid import bounds, liquid
from solvers.fluid.given import EXCESS, GAS, VOLUME, Water, Y, Z
from solvers.fluid.start.air import air_above, air_round, with_air
from solvers.fluid.start.parts import clear_of, free_share, surfaces
from solvers.fluid.start.rest import at_rest, hydrostatic_excess
from solvers.scene import Scene


def water_of(preset: Preset) -> dict:
    """What a scene says of the water, by its fields; it is the same in all repeats. Raises LabError."""
    return {"water": liquid(preset), "drops": np.tile(drops_of(preset), (preset.run.repeats, 1, 1))}


def drops_of(preset: Preset) -> np.ndarray:
    """The particles (n, 6) of a world. Raises LabError if none fits in."""
    water = liquid(preset)
    if preset.parts:  # which a lattice is cut off at; a packing knows nothing of them
        water = replace(water, start="lattice")
    try:
        drops = at_rest(*bounds(preset), water, preset.run.gravity)
        if water.air:
            return with_air(drops, _air_of(preset, water))
    except ValueError as error:
        raise LabError(f"water.spacing: {error}; take smaller particles.") from None
    return _beside_parts(preset, drops) if preset.parts else drops


def _air_of(preset: Preset, water: Water) -> np.ndarray:
    """The particles (n, 7) of the air, which fills what the water leaves of the tank."""
    tank, (polygon, level) = np.array(preset.tank.corners), bounds(preset)
    if preset.water.region is None:
        return air_above(tank, level, water, preset.run.gravity)
    return air_round(tank, polygon, water, preset.run.gravity)


def _beside_parts(preset: Preset, drops: np.ndarray) -> np.ndarray:
    """The particles (n, 6) that parts leave free; in a region each stands under the surface right above it."""
    water, (polygon, level) = liquid(preset), bounds(preset)
    parts = [part.wet for part in preset.parts.values()]
    if preset.water.region is not None:
        depth = surfaces(drops[:, [Y, Z]], polygon, level) - drops[:, Z]
        drops[:, EXCESS] = hydrostatic_excess(depth, preset.run.gravity, water.sound_speed, water.state)
    whole = drops[:, VOLUME].sum()
    drops = drops[clear_of(drops[:, [Y, Z]], parts, water.spacing)]
    if not len(drops):
        raise LabError("parts: they leave no room for the water.")
    drops[:, VOLUME] *= whole * free_share(polygon, level, parts, water.spacing) / drops[:, VOLUME].sum()
    return drops


def most_drops(preset: Preset) -> int:
    """Number of particles of water and air in a world, rounded up, before any is made; 0 without water."""
    if preset.water is None:
        return 0
    polygon, level = bounds(preset)
    low, size = polygon.min(axis=0), liquid(preset).spacing
    if preset.air is not None:
        tank = np.array(preset.tank.corners)
        low, level, polygon = tank.min(axis=0), tank[:, 1].max(), tank
    wide, deep = polygon[:, 0].max() - low[0], level - low[1]
    return int(np.ceil(wide / size + 1.0) * np.ceil(deep / size + 1.0))


def volumes_of(drops: np.ndarray | None, worlds: int) -> np.ndarray:
    """Volumes (W, n) m² of the particles of water of a scene in the plane; n is 0 without water."""
    return np.zeros((worlds, 0)) if drops is None else drops[:, : _wet(drops), VOLUME]


def air_volumes_of(drops: np.ndarray | None, worlds: int) -> np.ndarray:
    """As `volumes_of`, of the particles of air."""
    return np.zeros((worlds, 0)) if drops is None else drops[:, _wet(drops) :, VOLUME]


def _wet(drops: np.ndarray) -> int:
    """How many of the particles (W, n, 6 or 7) of each world are water; they come first."""
    return drops.shape[1] - (int(drops[0, :, GAS].sum()) if drops.shape[2] > GAS else 0)


def particles(scene: Scene) -> int:
    """Number of grains and of particles of water and air in a world."""
    return scene.radius.shape[1] + scene.particles
