"""Spheres that fall together in space, far from walls: what symmetries and the plane say of their motion."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from solvers.machine.quantity import PLANE, SPACE
from solvers.tank.solids.solid import Prism
from tests.oracles.scenes import box, material, simulation

COUNT, RADIUS, DT, ROOM = 48, 1.5e-3, 1e-5, 0.2
MIDDLE = np.array([0.0, 0.5 * ROOM, 0.0])  # of the tank, in the order y, z, x
GRAIN = material(friction=0.4)
MASS = 4.0 / 3.0 * np.pi * RADIUS**3 * GRAIN.density
INERTIA = 0.4 * MASS * RADIUS**2
OBLIQUE = Rotation.from_rotvec(np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0))  # by 1 rad; no axis is spared


def cloud(flat=False):
    """Places, velocities and spins (n, 3) of a cloud about the origin whose grains fly towards its middle."""
    rng = np.random.default_rng(4)
    rows = (8, 6, 1) if flat else (4, 4, 3)
    place = np.stack(np.meshgrid(*map(np.arange, rows), indexing="ij"), axis=-1).reshape(-1, 3) * 3.1e-3
    place = place - place.mean(axis=0) + rng.uniform(-3e-5, 3e-5, place.shape)
    velocity, spin = -60.0 * place + rng.uniform(-0.2, 0.2, place.shape), rng.uniform(-100.0, 100.0, place.shape)
    if flat:
        place[:, 2], velocity[:, 2], spin[:, :2] = 0.0, 0.0, 0.0
    return place, velocity, spin


@pytest.fixture(scope="module")
def room():
    """A cube in space with the grains of a cloud, which are placed anew for each test."""
    run = made(cloud()[0], solid=Prism(ROOM))
    yield run
    run.arrays.release()


def made(place, **scene):
    """A simulation of a cloud without gravity."""
    common = {"tangential": "mindlin", "gravity": 0.0, "stiffness_scale": 1e-3, "step": DT}
    return simulation((place + MIDDLE[: place.shape[1]])[None], RADIUS, box(ROOM, ROOM), GRAIN, **common, **scene)


def fly(run, place, velocity, spin, steps):
    """A cloud after some steps, its velocities and spins in the middle of the last one, and its most contacts."""
    contacts, axes = 0, run.scene.axes
    about = spin[None] if axes == SPACE else spin[None, :, -1]
    run.place((place + MIDDLE)[None, :, :axes], velocity[None, :, :axes], about)
    for _ in range(10):
        run.advance(steps // 10)
        contacts = max(contacts, int(run.observe()["contacts"][0]))
    state = {name: values[0] for name, values in run.snapshot().items()}
    of_step = run.grains.grains.velocity, run.grains.grains.spin
    middle = [np.stack([field.to_numpy()[0, :COUNT] for field in fields], axis=1) for fields in of_step]
    return state, middle, contacts


def test_momentum_and_angular_momentum_are_kept(room):
    """Forces act on both grains alike and levers add up to the distance: to rounding of the sums of their sizes.

    Angular momentum is that of places at the end of a step with velocities of its middle, which leapfrog keeps.
    """
    start = cloud()
    state, (middle, spin), contacts = fly(room, *start, 400)
    assert contacts > 40
    place = state["position"] - MIDDLE
    size = MASS * np.abs(start[1]).sum()
    np.testing.assert_allclose(MASS * (middle - start[1]).sum(axis=0), 0.0, atol=1e-12 * size)
    assert np.abs(middle - start[1]).max() > 0.1
    before = MASS * np.cross(start[0], start[1]) + INERTIA * start[2]
    after = MASS * np.cross(place, middle) + INERTIA * spin
    moment = MASS * (np.linalg.norm(start[0], axis=1) * np.linalg.norm(start[1], axis=1)).sum()
    moment += INERTIA * np.abs(start[2]).sum()
    np.testing.assert_allclose((after - before).sum(axis=0), 0.0, atol=1e-12 * moment)


@pytest.mark.slow
def test_grains_in_a_plane_move_as_the_discs_of_the_plane(room):
    """The same laws, masses and inertias: to rounding, which chaos lets grow in a thousand steps."""
    start = cloud(flat=True)
    space, _, contacts = fly(room, *start, 1000)
    flat = made(start[0][:, :PLANE])
    plane, _, as_many = fly(flat, *start, 1000)
    flat.arrays.release()
    assert contacts == as_many > 20
    np.testing.assert_array_equal(space["position"][:, 2], 0.0)
    np.testing.assert_array_equal(space["spin"][:, :2], 0.0)
    np.testing.assert_allclose(space["position"][:, :2], plane["position"], rtol=0, atol=1e-10 * 2.0 * RADIUS)
    np.testing.assert_allclose(space["spin"][:, 2], plane["spin"], rtol=0, atol=1e-7)


def test_a_turned_cloud_moves_as_the_turned_one(room):
    """No direction is preferred: rotated by 1 rad about (1, 2, 3) all goes as before, to rounding."""
    start = cloud()
    straight, *_, contacts = fly(room, *start, 300)
    turned, *_ = fly(room, *(OBLIQUE.apply(values) for values in start), 300)
    assert contacts > 40
    for name, size in (("position", 2.0 * RADIUS), ("velocity", 1.0), ("spin", 100.0)):
        about = MIDDLE if name == "position" else 0.0
        back = OBLIQUE.inv().apply(turned[name] - about)
        np.testing.assert_allclose(back, straight[name] - about, rtol=0, atol=1e-9 * size, err_msg=name)
