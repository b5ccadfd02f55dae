"""Observations before the first step: they give the present state and do not change it."""

import numpy as np
import pytest

from solvers.fluid.given import Fluid, Water, particles
from solvers.machine.errors import BadState
from tests.oracles.scenes import box, material, simulation

RADIUS, OVERLAP, SPEED = 3e-3, 2e-6, 0.05  # m, m, m/s
APART = 2.0 * RADIUS - OVERLAP
SCHEDULES = ("per-world", pytest.param("per-grain", marks=pytest.mark.slow))


@pytest.fixture(scope="module", params=SCHEDULES)
def pressed(request):
    """Two grains pressed onto the floor and against one another, at rest; a third flies. And how it goes on unseen."""
    place = [[[0.0, RADIUS - OVERLAP], [APART, RADIUS - OVERLAP], [0.0, 5.0 * RADIUS]]]
    velocity = [[[0.0, 0.0], [0.0, 0.0], [SPEED, 0.0]]]
    run = simulation(place, RADIUS, box(0.05, 0.05), material(young=1e7), velocity=velocity, schedule=request.param)
    start = run.state()
    seen, again = run.observe(), run.observe()
    assert all(np.array_equal(seen[name], again[name]) for name in seen)
    run.advance(100)
    later = run.snapshot() | run.observe()
    run.restore(start)
    run.advance(100)
    rest = run.snapshot() | run.observe()
    scene, mass = run.scene, run.grains.mass
    run.close()
    return scene, mass, seen, later, rest


@pytest.mark.slow
def test_contacts_before_the_first_step_follow_hertz(pressed):
    """Hertz (1882; Johnson 1985, eq. 4.22): F = (4/3) E* √R δ^(3/2), of energy (2/5) F δ."""
    scene, mass, seen, _, _ = pressed
    pair, wall = scene.grains.interfaces
    of_pair = 4.0 / 3.0 * pair.young_modulus * np.sqrt(RADIUS / 2.0) * OVERLAP**1.5
    of_floor = 4.0 / 3.0 * wall.young_modulus * np.sqrt(RADIUS) * OVERLAP**1.5
    assert seen["contacts"] == [3.0]
    assert seen["overlap"] == pytest.approx([OVERLAP / RADIUS], rel=1e-6)
    assert seen["elastic"] == pytest.approx([0.4 * OVERLAP * (of_pair + 2.0 * of_floor)], rel=1e-6, abs=0.0)
    assert seen["wall_force"][..., 1] == pytest.approx([-2.0 * of_floor], rel=1e-6)
    assert seen["wall_force"][..., 2] == pytest.approx([-of_floor * APART], rel=1e-6)
    assert seen["kinetic"] == pytest.approx([0.5 * mass[0, 2] * SPEED**2], rel=1e-12, abs=0.0)
    assert seen["centre_of_mass"][..., 1] == pytest.approx([(7.0 * RADIUS - 2.0 * OVERLAP) / 3.0])


@pytest.mark.slow
def test_observing_changes_nothing(pressed):
    *_, later, rest = pressed
    for name in rest.keys() - {"wall_force"}:  # a mean since the last look
        assert later[name].tobytes() == rest[name].tobytes(), name


@pytest.mark.slow
def test_grains_do_not_answer_for_water_that_stopped_a_world():
    """Beside water they raise only if they are too fast; alone always."""
    run = simulation([[[0.0, RADIUS]]], RADIUS, box(0.05, 0.05), material(young=1e7), velocity=[[[SPEED, 0.0]]])
    grains, far = run.grains, RADIUS / SPEED
    with pytest.raises(BadState, match="a grain moves at"):
        grains.refuse(0, 0.0, run.dt)
    grains.scene = run.scene.holding(Fluid(Water(0.01, 10.0), particles(1, 1)))
    grains.refuse(0, 0.0, run.dt)
    with pytest.raises(BadState, match="a grain moves at"):
        grains.refuse(0, 0.0, far)
    run.close()
