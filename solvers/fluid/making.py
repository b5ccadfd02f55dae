"""Water of a scene, once nothing in it is what water cannot have."""

from solvers.fluid.checks import refuse_reduced, refuse_scene, refuse_space
from solvers.fluid.matter import WaterMatter
from solvers.tank.context import Context


def make_water(scene, context: Context) -> WaterMatter | None:
    """The water of a scene (`solvers.scene.Scene`); None where they do not move one by one. Raises Unavailable."""
    if not scene.fluid.moved:
        return None
    refuse_scene(scene.fills, scene.hold if scene.grains and not scene.mixture else None)
    refuse_reduced(scene)
    refuse_space(scene)
    return WaterMatter(scene, context)
