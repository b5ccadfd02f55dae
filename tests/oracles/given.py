"""Scenes from the fields of all their parts at once."""

import numpy as np

from solvers.grains.given import Grains
from solvers.scene import Scene

GRAINS = Grains.__dataclass_fields__


def scene_of(radius, outline, grain=(), wall=(), *laws, **given) -> Scene:
    """A scene of grains with `radius` (n,) or (W, n) in a tank; fields of the grains and of the scene go by name."""
    of_grains = {name: given.pop(name) for name in list(given) if name in GRAINS}
    fluid = given.pop("fluid", None)
    matters = (fluid,) if fluid else ()
    if np.size(radius):
        matters = (Grains(radius, grain, wall, *laws, **of_grains), *matters)
    else:
        given.setdefault("motions", [()] * len(radius))
    return Scene(outline, matters, **given)
