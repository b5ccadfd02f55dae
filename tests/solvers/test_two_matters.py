"""Grains beside water: kernels of both are on real vectors together, and compute what scalars do, up to rounding."""

import numpy as np
import pytest

from solvers.fluid.given import Fluid, Water
from solvers.grains.shapes.given import Shapes
from solvers.machine import wide
from solvers.simulation import Simulation
from solvers.tank.tank import Tank
from tests.oracles.given import scene_of
from tests.oracles.outlines import ellipse
from tests.oracles.scenes import box, material
from tests.oracles.water import lattice
from tests.solvers.motion.test_several_tanks import ship

RADIUS, SPACING, STEPS = 3e-3, 5e-3, 2000
POOL, DEPTH = 0.06, 0.03  # m, width and depth of the water
EGG = ellipse(1.06, 0.95)


def beside(monkeypatch, lanes: int, rule: str | None = None, **scene) -> Simulation:
    """A ship with grains that fall in her hold, and a tank of water above it, where vectors have so many lanes."""
    monkeypatch.setattr(wide, "lanes", lambda: lanes)
    row, column = np.divmod(np.arange(24), 8)
    place = np.column_stack([6.1e-3 * (column - 3.5) + 1e-3 * (row % 2), 3.02e-3 + 6.02e-3 * row])
    if rule:
        angle = np.random.default_rng(1).uniform(-np.pi, np.pi, (1, len(place)))
        scene["shapes"] = Shapes((EGG,), np.zeros((1, len(place)), dtype=int), angle, rule, 60)
    above = Tank(np.add(box(POOL, 0.05), [0.0, 0.1]), 2.0 * RADIUS)
    start = lattice(POOL, DEPTH, SPACING, 6.0)
    start["position"][..., 1] += 0.1
    fluid = Fluid(Water(SPACING, 6.0), start, (0, start.shape[1]))
    made = scene_of(
        np.full((1, len(place)), RADIUS), box(0.08, 0.08), material(), material(), stiffness_scale=1e-3,
        more_tanks=(above,), fluid=fluid, vessels=[ship()], **scene,
    )  # fmt: skip
    return Simulation(made, place[None], threads=1, arch="cpu")


@pytest.mark.parametrize(
    ("lanes", "rule", "scene", "together"),
    [
        (8, None, {}, True),
        (0, None, {}, False),
        (8, "area", {}, False),
        (8, "continuous", {"precision": "mixed"}, False),
    ],
)
def test_both_are_on_real_vectors_or_none_is(monkeypatch, lanes, rule, scene, together):
    """Taichi ends the process if it compiles particles on scalars together with others on vectors."""
    run = beside(monkeypatch, lanes, rule, **scene)
    assert [matter.wide for matter in run.matters.values()] == [together, together]
    run.close()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rule", "scene"),
    [(None, {"tangential": "mindlin"}), (None, {"precision": "mixed"}), ("continuous", {}), ("nodes", {})],
)
def test_real_vectors_move_both_as_scalars_do(monkeypatch, rule, scene):
    found = []
    for lanes in (0, wide.registers() // 32 or 8):
        run = beside(monkeypatch, lanes, rule, **scene)
        run.advance(run.whole(STEPS))
        found.append({**run.snapshot(), **run.observe()})
        run.close()
    one, other = found
    assert one["contacts"].min() > 2 and np.abs(one["water_velocity"]).max() > 1e-3
    rough = 2e-4 if scene.get("precision") == "mixed" else 1e-7  # rounding, which collisions have made grow
    for name in ("position", "velocity", "water_position", "water_velocity", "wall_force", "pose"):
        size = np.abs(one[name]).max()
        np.testing.assert_allclose(other[name], one[name], atol=rough * size, rtol=rough, err_msg=name)


@pytest.mark.slow
def test_a_state_in_which_neither_was_on_vectors_goes_on(monkeypatch):
    """States that tell their numbers without names are of a time when matters beside each other were on scalars."""
    run = beside(monkeypatch, 0)
    run.advance(run.whole(100))
    state = run.state()
    names = ("steps", "room", "unkicked", "observed", "units", "schedule", "vectors", "among")
    old = {name: value for name, value in state.items() if not name.startswith("run.")}
    old["numbers"] = np.array([int(state[f"run.{name}"]) if name != "vectors" else 8 for name in names])
    other = beside(monkeypatch, 8)
    other.restore(old)
    assert not other.wide
    for one in (run, other):
        one.advance(one.whole(100))
    for name, values in run.state().items():
        np.testing.assert_array_equal(other.state()[name], values, err_msg=name)
    run.close()
    other.close()
