"""A slice of a tank without an end: what leaves it on one side enters on the other."""

import numpy as np
import pytest

from solvers.tank.solids.solid import Prism
from tests.oracles.scenes import box, material, simulation

COUNT, RADIUS, DT, ALONG, ROOM = 48, 1.5e-3, 1e-5, 0.02, 0.2
GRAIN = material(friction=0.4)


@pytest.fixture(scope="module")
def slice_of_tank():
    """A slice of a tank with a cloud in the air."""
    run = simulation(cloud()[0][None], RADIUS, box(ROOM, ROOM), GRAIN, solid=Prism(ALONG, periodic=True), **ALIKE)
    yield run
    run.arrays.release()


ALIKE = {"tangential": "mindlin", "gravity": 0.0, "stiffness_scale": 1e-3, "step": DT}


def cloud():
    """Places, velocities and spins (n, 3) of a cloud that flies to the middle of its length, in the order y, z, x."""
    rng = np.random.default_rng(4)
    rows = np.stack(np.meshgrid(range(4), range(4), range(3), indexing="ij"), axis=-1).reshape(-1, 3)
    place = 3.1e-3 * (rows - rows.mean(axis=0)) + rng.uniform(-3e-5, 3e-5, rows.shape)
    velocity, spin = -60.0 * place + rng.uniform(-0.2, 0.2, place.shape), rng.uniform(-100.0, 100.0, place.shape)
    return np.add(place, [0.0, 0.5 * ROOM, 0.0]), velocity, spin


def fly(run, shift, along=0.0, steps=300):
    """Positions and velocities (n, 3) of the cloud, shifted by so much and moving so much faster along x."""
    place, velocity, spin = cloud()
    place = np.add(place, [0.0, 0.0, shift])
    place[:, 2] -= ALONG * np.round(place[:, 2] / ALONG)
    run.place(place[None], velocity[None] + [0.0, 0.0, along], spin[None])
    contacts = 0
    for _ in range(10):
        run.advance(steps // 10)
        contacts = max(contacts, int(run.observe()["contacts"][0]))
    assert contacts > 40
    state = run.snapshot()
    return state["position"][0], state["velocity"][0]


@pytest.mark.slow
def test_a_cloud_across_the_end_of_a_slice_moves_as_one_in_its_middle(slice_of_tank):
    """Shifted by half the length, half of the cloud is on either side; all differences are to the nearest image."""
    place, velocity = fly(slice_of_tank, 0.0)
    other, as_fast = fly(slice_of_tank, 0.5 * ALONG)
    gone = other - place - [0.0, 0.0, 0.5 * ALONG]
    gone[:, 2] -= ALONG * np.round(gone[:, 2] / ALONG)
    assert np.abs(other[:, 2]).max() <= 0.5 * ALONG
    np.testing.assert_allclose(gone, 0.0, atol=1e-9 * 2.0 * RADIUS)
    np.testing.assert_allclose(as_fast, velocity, atol=1e-9)


@pytest.mark.slow
def test_a_cloud_that_flies_round_and_round_collides_as_one_that_stays(slice_of_tank):
    """At 10 m/s it passes the end once or twice; in its own axes all is as at rest, but for the digits of its speed."""
    place, velocity = fly(slice_of_tank, 0.0)
    other, faster = fly(slice_of_tank, 0.0, along=10.0)
    gone = other - place - [0.0, 0.0, 10.0 * 300 * DT]
    gone[:, 2] -= ALONG * np.round(gone[:, 2] / ALONG)
    np.testing.assert_allclose(gone, 0.0, atol=1e-6 * 2.0 * RADIUS)
    np.testing.assert_allclose(faster - [0.0, 0.0, 10.0], velocity, atol=1e-6)
