"""Spheres under every schedule, precision and law: a cloud that flies as it does world by world in 64 bits."""

import numpy as np
import pytest

from solvers.machine import wide
from solvers.tank.solids.solid import Prism
from tests.oracles.scenes import box, material, simulation

COUNT, RADIUS, DT, ROOM, STEPS = 48, 1.5e-3, 1e-5, 0.02, 240
GRAIN = material(friction=0.4, rolling_friction=0.1, rolling_damping=0.3)
LIQUID = {"friction": 0.4, "surface_tension": 0.072, "contact_angle": 0.0}
WET = {
    "humid": material(humidity=0.5, asperities=1e-9, **LIQUID),
    "bridge": material(bridge_volume=1e-11, **LIQUID),
}


def flown(threads=1, grain=GRAIN, **scene):
    """Positions (n, 3) of a cloud that falls into the corner of a box with two kinds of grains, and its contacts."""
    rng = np.random.default_rng(4)
    rows = np.stack(np.meshgrid(range(4), range(3), range(4), indexing="ij"), axis=-1).reshape(-1, 3)
    place = 3.1e-3 * rows + rng.uniform(-3e-5, 3e-5, rows.shape)
    place += 1.05 * RADIUS - place.min(axis=0) - np.array([0.5 * ROOM, 0.0, 0.5 * ROOM])
    velocity = np.array([-0.3, -0.3, -0.3]) + rng.uniform(-0.1, 0.1, place.shape)
    spin = rng.uniform(-50.0, 50.0, place.shape)
    common = {"tangential": "mindlin", "stiffness_scale": 1e-3, "step": DT, "solid": Prism(ROOM)} | scene
    run = simulation(place[None], RADIUS, box(ROOM, ROOM), grain, None, velocity, spin[None], threads, **common)
    assert run.wide == (wide.lanes() > 0) or run.schedule_name == "per-grain"
    run.advance(STEPS)
    found, contacts = run.snapshot()["position"][0], int(run.observe()["contacts"][0])
    run.arrays.release()
    assert contacts > COUNT
    return found


@pytest.fixture(scope="module")
def usual():
    """The positions world by world in 64 bits, on one thread."""
    return flown()


@pytest.mark.slow
def test_two_threads_change_no_bit_of_a_world(usual):
    np.testing.assert_array_equal(flown(threads=2), usual)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("schedule", "precision", "most"),
    [
        pytest.param("per-band", "f64", 1e-9, id="per-band"),
        pytest.param("per-grain", "f64", 1e-9, id="per-grain"),
        pytest.param("per-world", "mixed", 1e-3, id="mixed"),
        pytest.param("per-grain", "f32", 1e-2, id="f32"),
    ],
)
def test_a_schedule_or_precision_changes_no_more_than_rounding(usual, schedule, precision, most):
    """In diameters: sums in another order grow by collisions, those in 32 bits from 1e-7 by some thousand times."""
    found = flown(threads=2, schedule=schedule, precision=precision)
    np.testing.assert_allclose(found, usual, rtol=0.0, atol=most * 2.0 * RADIUS)


@pytest.mark.slow
@pytest.mark.parametrize("rolling", ["constant-torque", "elastic-plastic"])
@pytest.mark.parametrize("tangential", ["haff-werner", "cundall-strack", "coulomb"])
def test_laws_with_several_directions_keep_a_cloud_together(tangential, rolling):
    """No number is lost, none is made: a bed in a corner with each pair of laws stays in its box."""
    found = flown(tangential=tangential, rolling=rolling)
    assert np.isfinite(found).all()


@pytest.mark.slow
@pytest.mark.parametrize("cohesion", WET)
def test_wet_spheres(cohesion):
    """Liquid bridges act along the normal, in space as in the plane."""
    assert np.isfinite(flown(grain=WET[cohesion], cohesion=cohesion)).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    "models",
    [
        {},
        {"twisting": "marshall", "rolling": "elastic-plastic"},
        {"tangential": "haff-werner", "rolling": "constant-torque"},
        {"solid": Prism(ROOM, periodic=True)},
    ],
    ids=str,
)
def test_real_vectors_move_spheres_as_scalars_do(monkeypatch, models):
    """Blocks of pairs on eight real lanes: to rounding, which collisions make grow."""
    monkeypatch.setattr(wide, "lanes", lambda: 0)
    scalars = flown(**models)
    monkeypatch.setattr(wide, "lanes", lambda: 8)
    np.testing.assert_allclose(flown(**models), scalars, rtol=0.0, atol=1e-6 * 2.0 * RADIUS)
