"""From a resolved preset to the solver's scene and the grains' starting places."""

from math import ceil

import numpy as np

from lab.errors import LabError
from lab.schema import Resolved
from lab.units import show
from solvers.filling import DoesNotFit, count_for_depth, radii, start_positions
from solvers.scene import Scene


def grain_count(preset: Resolved) -> int:
    """Number of grains in one tank."""
    grains = preset.grains
    if grains.count is not None:
        return grains.count
    return count_for_depth(grains.depth, preset.tank.width, grains.diameter, grains.spread)


def build(preset: Resolved) -> tuple[Scene, np.ndarray]:
    """The scene of all repeats and positions (W, n, 2) m to settle from; repeat w has the seed run.seed + w.

    The step divides the sampling interval of the series, so samples fall on steps. Raises LabError where the grains
    do not fit or a given step is past the limit.
    """
    outline = np.array(preset.tank.outline)
    count, size = grain_count(preset), preset.grains
    worlds = range(preset.run.repeats)
    random = [np.random.default_rng(preset.run.seed + w) for w in worlds]
    radius = np.stack([radii(count, size.diameter, size.spread, r) for r in random])
    try:
        position = np.stack([start_positions(radius[w], outline, random[w]) for w in worlds])
    except DoesNotFit as error:
        raise LabError(f"grains.{'count' if size.count else 'depth'}: {error}") from None
    scene = Scene(
        radius=radius,
        outline=outline,
        grain=preset.material,
        wall=preset.wall,
        normal=preset.contact.normal,
        tangential=preset.contact.tangential,
        stiffness_scale=preset.contact.stiffness_scale,
        gravity=preset.run.gravity,
        motions=[tuple(preset.motion.parts.values())] * len(radius),
        soft_start=preset.motion.soft_start,
        sizes=(0.5 * size.diameter * (1.0 - size.spread), 0.5 * size.diameter * (1.0 + size.spread)),
    )
    scene.step = _step(preset, scene)
    return scene, position


def _step(preset: Resolved, scene: Scene) -> float:
    limit = scene.step_limits()[0]
    wanted = limit.step if preset.run.step == "auto" else preset.run.step
    if wanted > limit.step and not preset.run.force_step:
        raise LabError(
            f"run.step: {show(wanted, 's')} is past the limit of {show(limit.step, 's')} ({limit.reason}); "
            "leave it out, or set run.force_step = true."
        )
    interval = 1.0 / preset.record.series_rate
    return interval / ceil(interval / wanted - 1e-9)
