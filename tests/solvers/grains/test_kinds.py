"""Several kinds of grains in one tank: each pair of kinds, and each kind and the walls, have their own interface."""

from itertools import combinations_with_replacement
from math import pi

import numpy as np
import pytest

from solvers.grains.bed.filling import start_positions
from solvers.grains.materials import interface
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

RADIUS, SPEED = 1.5e-3, 1.0
KINDS = (
    material(restitution=0.9, friction=0.2),
    material(restitution=0.5, density=4450.0, young=1e9, friction=0.6),
    material(restitution=0.7, density=2700.0, friction=0.4),
)
AGAINST = material(restitution=0.3, friction=0.1)  # how kind 1 touches kind 0
EXPECTED = {(0, 0): 0.9, (1, 1): 0.5, (2, 2): 0.7, (0, 1): 0.3, (0, 2): 0.8, (1, 2): 0.6}  # the last two: means
LAWS = [("hertz-viscoelastic", "haff-werner"), ("linear", "mindlin"), ("hysteretic", "cundall-strack")]


def scene(kind, outline, **more) -> Scene:
    """Grains of these kinds (W, n), all of one size."""
    radius = np.full(np.shape(kind), RADIUS)
    kinds = {"others": KINDS[1:], "unlike": (((0, 1), AGAINST),)}
    return scene_of(radius, outline, KINDS[0], material(restitution=0.8), kind=np.asarray(kind), **kinds, **more)


@pytest.mark.slow
@pytest.mark.parametrize("schedule", ["per-world", "per-grain"])
@pytest.mark.parametrize(("normal", "tangential"), LAWS)
def test_each_pair_of_kinds_has_its_own_collision(normal, tangential, schedule):
    """Head-on, by masses as they are: the restitution is that of the pair, from either side, exactly where the law has
    the pair's own masses in it and elsewhere by the mass that the scene takes for the pair, which is the same."""
    pairs = [pair for both in combinations_with_replacement(range(3), 2) for pair in {both, both[::-1]}]
    place = np.tile([[-RADIUS * 1.01, 0.1], [RADIUS * 1.01, 0.1]], (len(pairs), 1, 1))
    velocity = np.zeros_like(place)
    velocity[:, 0, 0] = SPEED
    laws = {"normal": normal, "tangential": tangential, "schedule": schedule}
    made = scene(pairs, box(0.2, 0.2), gravity=1e-9, start_speed=SPEED, velocity=velocity, **laws)
    run = Simulation(made, place, threads=1)
    mass = run.grains.mass
    assert mass == pytest.approx(
        np.array([[KINDS[k].density for k in pair] for pair in pairs]) * 4 / 3 * pi * RADIUS**3
    )
    run.advance(round(4e-4 / run.dt))
    after, rows = run.snapshot()["velocity"][:, :, 0], run.observe()
    run.close()
    assert np.all(rows["contacts"] == 0.0)
    assert (mass * after).sum(axis=1) == pytest.approx(mass[:, 0] * SPEED, rel=1e-12)
    assert after[:, 1] - after[:, 0] == pytest.approx([EXPECTED[tuple(sorted(pair))] for pair in pairs], rel=3e-3)


def test_moduli_follow_from_both_kinds_and_the_rest_from_the_pair():
    rows = scene([[0, 1]], box(0.1, 0.1)).grains.interfaces_of[0]
    assert len(rows) == 9 + 3
    assert rows[1] == rows[3] and rows[5] == rows[7]  # symmetric
    soft, stiff, both = rows[4].young_modulus, rows[0].young_modulus, rows[1].young_modulus
    assert 2.0 / both == pytest.approx(1.0 / soft + 1.0 / stiff, rel=1e-12, abs=0.0)  # in series
    assert [rows[k].friction for k in (0, 1, 2, 4, 5, 8)] == pytest.approx([0.2, 0.1, 0.3, 0.6, 0.5, 0.4])
    mass = KINDS[1].density * 4 / 3 * pi * RADIUS**3
    assert rows[10] == interface(KINDS[1], material(restitution=0.8), mass, RADIUS, 1.0)


@pytest.mark.slow
def test_equal_kinds_behave_as_one_kind():
    """The gathered coefficients of several kinds against the plain ones of one, with history, to rounding."""
    rng, outline = np.random.default_rng(2), box(0.03, 0.06)
    radius = 1.5e-3 * (1.0 + 0.1 * rng.uniform(-1.0, 1.0, 40))
    place = start_positions(radius, outline, rng)[None]
    states = []
    for more in ({}, {"kind": rng.integers(0, 2, (1, 40)), "others": (KINDS[0],)}):
        made = scene_of(radius, outline, KINDS[0], KINDS[2], tangential="mindlin", stiffness_scale=1e-3, **more)
        run = Simulation(made, place, threads=1)
        run.advance(round(0.06 / run.dt))
        states.append(run.snapshot() | run.observe())
        run.close()
    assert states[0]["contacts"][0] > 15
    for name in ("position", "velocity", "angle", "elastic", "wall_force"):
        np.testing.assert_allclose(states[1][name], states[0][name], rtol=1e-7, atol=1e-9, err_msg=name)
