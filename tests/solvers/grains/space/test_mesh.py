"""Spheres in a tank that is a mesh: in a box of many triangles they move as between the walls of a prism."""

import numpy as np
import pytest

from solvers.motion import Sway
from solvers.tank.solids.solid import Prism
from tests.oracles.holds import fine_box
from tests.oracles.scenes import box, material, simulation

WIDE, HIGH, LONG, RADIUS = 0.08, 0.06, 0.1, 2e-3
SPIN, STEPS = 1.0 / RADIUS, 3000
SWAY = Sway(amplitude=5e-3, frequency=4.0)  # so that spheres which roll need friction to do so


def bed():
    """Places, velocities and spins (n, 3) of spheres that roll on the floor and of a cloud that falls apart over it."""
    rng = np.random.default_rng(5)
    rolling = np.stack(np.meshgrid([-0.03, 0.0, 0.03], [RADIUS], [-0.04, 0.0, 0.04], indexing="ij"), axis=-1)
    rolling = rolling.reshape(-1, 3)
    velocity = rng.uniform(-0.3, 0.3, rolling.shape) * [1.0, 0.0, 1.0]
    spin = SPIN * np.column_stack([velocity[:, 2], 0.0 * velocity[:, 0], -velocity[:, 0]])  # v = ω × R n
    cloud = np.stack(np.meshgrid(*[np.arange(3)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) * 4.2e-3
    cloud = cloud - cloud.mean(axis=0) + [0.0, 0.04, 0.0] + rng.uniform(-5e-5, 5e-5, cloud.shape)
    flying = rng.uniform(-1.0, 1.0, cloud.shape)
    return (
        np.concatenate([rolling, cloud]),
        np.concatenate([velocity, flying]),
        np.concatenate([spin, rng.uniform(-100.0, 100.0, cloud.shape)]),
    )


def flown(solid):
    """Places, spins and tangential springs at the walls after some steps."""
    place, velocity, spin = bed()
    run = simulation(
        place[None], RADIUS, box(WIDE, HIGH), material(friction=0.4), velocity=velocity[None], spin=spin[None],
        tangential="mindlin", stiffness_scale=1e-3, step=1e-5, solid=solid,
        motions=[(SWAY,)],
    )  # fmt: skip
    run.advance(STEPS)
    state = {name: values[0] for name, values in run.snapshot().items()}
    run.arrays.release()
    return state


@pytest.mark.slow
def test_spheres_in_a_box_of_triangles_move_as_in_a_prism():
    """Rolling, they pass dozens of edges, and keep their springs: to rounding, as far as chaos lets it."""
    low, high = np.array([-0.5 * WIDE, 0.0, -0.5 * LONG]), np.array([0.5 * WIDE, HIGH, 0.5 * LONG])
    mesh = fine_box(low, high, 7, np.random.default_rng(1))
    assert len(mesh.triangles) == 6 * 49 * 2
    plain, fine = flown(Prism(LONG)), flown(mesh)
    gone = np.linalg.norm(plain["position"] - bed()[0], axis=1)
    assert gone[:9].min() > 2e-3
    np.testing.assert_allclose(fine["position"], plain["position"], atol=2e-9 * RADIUS)
    np.testing.assert_allclose(fine["spin"], plain["spin"], atol=1e-6 * SPIN)
