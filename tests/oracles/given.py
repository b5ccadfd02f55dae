"""Scenes from the fields of all their parts at once, and with some of them changed."""

from dataclasses import replace

import numpy as np

from solvers.fluid.given import Fluid
from solvers.grains.given import Grains
from solvers.scene import Scene

GRAINS, FLUID = Grains.__dataclass_fields__, Fluid.__dataclass_fields__


def scene_of(radius, outline, grain=(), wall=(), *laws, **given) -> Scene:
    """A scene of grains with `radius` (n,) or (W, n) in a tank; fields of the grains and of the scene go by name."""
    of_grains = {name: given.pop(name) for name in list(given) if name in GRAINS}
    if np.size(radius):
        return Scene(outline, Grains(radius, grain, wall, *laws, **of_grains), **given)
    given.setdefault("motions", [()] * len(radius))
    return Scene(outline, **given)


def changed(scene: Scene, **changes) -> Scene:
    """The scene with some fields of its own, of its grains or its fluid changed."""
    of_grains = {name: changes.pop(name) for name in list(changes) if name in GRAINS}
    of_fluid = {name: changes.pop(name) for name in list(changes) if name in FLUID}
    if of_grains:
        changes["grains"] = replace(scene.grains, **of_grains)
    if of_fluid:
        changes["fluid"] = replace(scene.fluid, **of_fluid)
    return replace(scene, **changes)
