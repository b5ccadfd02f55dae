"""The marks of a scene's fields: which worlds may share a launch, and what their joined scene holds."""

from dataclasses import fields, replace

import numpy as np
import pytest

from solvers.grains.given import Grains
from solvers.grains.materials import Material
from solvers.machine.marks import EachWorld, LargestOfWorlds, marked, shared
from solvers.motion import MOTIONS
from solvers.scene import Scene
from tests.oracles.given import scene_of

SOLID = Material(density=1000.0, young=1e7, poisson=0.3, friction=0.3, restitution=0.5)
OUTLINE = [[-0.05, 0.0], [0.05, 0.0], [0.05, 0.1], [-0.05, 0.1]]
RADIUS = np.array([[1e-3, 2e-3, 1.5e-3]])
STILL = {"velocity": np.zeros((1, 3, 2)), "spin": np.zeros((1, 3))}


def scene(**changes) -> Scene:
    tilt = MOTIONS["tilt"](rate=0.1, angle=0.5)
    settings = {"grain": SOLID, "wall": SOLID, "motions": [(tilt,)], "step": 1e-5, "sizes": (1e-3, 2e-3), **STILL}
    return scene_of(**{"radius": RADIUS, "outline": OUTLINE, **settings, **changes})


DIFFER = {  # what worlds of one launch may differ in
    "radius": RADIUS[:, ::-1],
    "grain": replace(SOLID, friction=0.1, density=900.0),
    "wall": replace(SOLID, restitution=0.9),
    "motions": [(MOTIONS["tilt"](rate=0.2, angle=-0.5, hold=1.0),)],
    "velocity": np.ones((1, 3, 2)),
    "spin": np.ones((1, 3)),
    "start_speed": 2.0,
    "base_share": 1.5,
}
AGREE = {  # what they must agree in
    "radius": RADIUS[:, :2],
    "motions": [(MOTIONS["sway"](amplitude=0.01, frequency=1.0),)],
    "velocity": None,
    "outline": [*OUTLINE[:3], [-0.04, 0.1]],
    "normal": "hertz",
    "stiffness_scale": 0.1,
    "gravity": 1.0,
    "soft_start": 1.0,
    "step": 2e-5,
    "sizes": (1e-3, 3e-3),
    "others": (SOLID,),
    "fixed": np.array([[0.0, 0.0, 1e-3]]),
    "open_edges": (2,),
    "thickness": 0.02,
    "length": 1.0,
    "interval": 0.1,
    "integrator": "gear",
    "precision": "f32",
    "schedule": "per-world",
}


@pytest.mark.parametrize("name", DIFFER)
def test_worlds_that_differ_in_a_marked_field_share_a_launch(name):
    kind = Grains if name in Grains.__dataclass_fields__ else Scene
    assert name in marked(kind, EachWorld) | marked(kind, LargestOfWorlds)
    first, second = scene(), scene(**{name: DIFFER[name]})
    assert first.shared() == second.shared() and hash(first.shared()) == hash(second.shared())
    both = Scene.joined([first, second])
    assert both.worlds == 2
    found, given = (one.grains if kind is Grains else one for one in (both, second))
    if name in marked(kind, LargestOfWorlds):
        assert getattr(found, name) == DIFFER[name]
    else:
        np.testing.assert_array_equal(getattr(found, name)[1], getattr(given, name)[0])


@pytest.mark.parametrize("name", AGREE)
def test_worlds_that_differ_in_anything_else_do_not(name):
    first, second = scene(), scene(**{name: AGREE[name]})
    assert first.shared() != second.shared()
    with pytest.raises(ValueError, match="cannot run in one launch"):
        Scene.joined([first, second])


def test_every_field_is_compared_or_marked():
    for kind, told in ((Scene, scene().shared()), (Grains, shared(scene().grains))):
        compared = {field.name for field in fields(kind) if field.init} - marked(kind, LargestOfWorlds).keys()
        assert len(told) == len(compared)
