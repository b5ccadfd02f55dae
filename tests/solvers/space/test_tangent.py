"""Slip, force, torque and moment of a contact: in space by r × F and v + ω × r, in the plane as in space with x = 0."""

import numpy as np
import pytest
import taichi as ti

from solvers.machine import runtime
from solvers.machine.quantity import PLANE, SPACE
from solvers.space import tangent
from solvers.space.axes import turns

COUNT, LEVER = 50, 0.5
ROUNDING = 2e-14  # of ten operations on numbers up to ten


@ti.kernel
def evaluate(axes: ti.template(), about: ti.template(), given: ti.types.ndarray(), found: ti.types.ndarray()):
    """Of rows of five vectors, a normal force and a cap: slip, force, torque, moment and capped force, three each."""
    for n in range(given.shape[0]):
        along = ti.static(range(axes))
        across = ti.static(range(about))
        normal, velocity = [given[n, k] for k in along], [given[n, 3 + k] for k in along]
        place, surfaces = [given[n, 6 + k] for k in along], [given[n, 9 + k] for k in across]
        shearing = [given[n, 12 + k] for k in across]
        slip, force = tangent.slip(velocity, normal, surfaces), tangent.force(normal, given[n, 15], shearing)
        torque = tangent.torque(LEVER, tangent.arm(normal, shearing), surfaces)
        moment, capped = tangent.moment(place, force), tangent.capped(shearing, given[n, 16])
        for k in ti.static(along):
            found[n, 3 + k] = force[k]
        for k in ti.static(across):
            found[n, k], found[n, 6 + k], found[n, 9 + k], found[n, 12 + k] = slip[k], torque[k], moment[k], capped[k]


def asked(axes, normal, velocity, place, surfaces, shearing, pressing, cap):
    """Slip, force, torque with a rolling torque like `surfaces`, moment and capped force, (n, 3) each."""
    runtime.initialise(1)
    given, found = np.zeros((len(normal), 17)), np.zeros((len(normal), 15))
    for first, vector in zip(range(0, 15, 3), (normal, velocity, place, surfaces, shearing), strict=True):
        given[:, first : first + vector.shape[1]] = vector
    given[:, 15], given[:, 16] = pressing, cap
    evaluate(axes, turns(axes), given, found)
    return np.split(found, 5, axis=1)


@pytest.fixture
def drawn():
    """Normals, velocities and places (n, 3) in the order y, z, x, normal forces and caps (n,), and the generator."""
    rng = np.random.default_rng(3)
    normal, velocity, place = rng.normal(size=(3, COUNT, 3))
    return normal / np.linalg.norm(normal, axis=1)[:, None], velocity, place, *rng.uniform(0.1, 1.0, (2, COUNT)), rng


def across(vector, normal):
    return vector - (vector * normal).sum(axis=1)[:, None] * normal


def test_in_space_they_are_vector_products(drawn):
    """The surfaces pass each other at v + ω_i × (−l_i n) − ω_j × l_j n; torques are r × F, whatever the direction."""
    normal, velocity, place, pressing, cap, rng = drawn
    (spin_i, spin_j), (lever_i, lever_j) = rng.normal(size=(2, COUNT, 3)), rng.uniform(0.1, 1.0, (2, COUNT, 1))
    shearing, surfaces = across(rng.normal(size=(COUNT, 3)), normal), lever_i * spin_i + lever_j * spin_j
    found = asked(SPACE, normal, velocity, place, surfaces, shearing, pressing, cap)
    passing = velocity + np.cross(spin_i, -lever_i * normal) - np.cross(spin_j, lever_j * normal)
    force = pressing[:, None] * normal + shearing
    size = np.linalg.norm(shearing, axis=1)
    share = np.minimum(size, cap) / size
    assert 0 < np.count_nonzero(share == 1.0) < COUNT
    torque = surfaces + np.cross(-LEVER * normal, force)
    wanted = across(passing, normal), force, torque, np.cross(place, force), share[:, None] * shearing
    for one, other in zip(found, wanted, strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=ROUNDING)


def test_the_plane_is_space_without_x(drawn):
    normal, velocity, place, pressing, cap, rng = drawn
    for vector in (normal, velocity, place):
        vector[:, 2] = 0.0
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    surfaces, shearing = rng.normal(size=(2, COUNT, 1))
    along = normal[:, [1, 0, 2]] * [-1.0, 1.0, 0.0]  # the normal turned counter-clockwise by 90°
    about = np.array([0.0, 0.0, 1.0])
    plane = asked(PLANE, normal[:, :2], velocity[:, :2], place[:, :2], surfaces, shearing, pressing, cap)
    space = asked(SPACE, normal, velocity, place, surfaces * about, shearing * along, pressing, cap)
    slip, force, torque, moment, capped = plane
    wanted = slip[:, :1] * along, force, torque[:, :1] * about, moment[:, :1] * about, capped[:, :1] * along
    for one, other in zip(space, wanted, strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=ROUNDING)
    assert capped[:, 0].tolist() == np.clip(shearing[:, 0], -cap, cap).tolist()


@ti.kernel
def turn_pair(
    steps: ti.i32, dt: ti.f64, rate: ti.types.ndarray(), start: ti.types.ndarray(), found: ti.types.ndarray()
):
    """Turn a pair with its normal (row 0 of `start`) and what it remembers (row 1) at a rate (rad/s) by exact poses."""
    size = ti.sqrt(rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2])
    axis = ti.Vector([rate[0], rate[1], rate[2]]) / size
    first = ti.Vector([start[0, 0], start[0, 1], start[0, 2]])
    for _ in range(1):
        kept = [start[1, 0], start[1, 1], start[1, 2]]
        for n in range(1, steps + 1):
            angle = size * dt * n
            normal = ti.cos(angle) * first + ti.sin(angle) * axis.cross(first)
            normal += (1.0 - ti.cos(angle)) * axis.dot(first) * axis
            moved = size * axis.cross(normal)  # the velocity of one centre relative to the other, over their distance
            spin = [size * axis[k] for k in ti.static(range(3))]
            way = tangent.way([moved[0], moved[1], moved[2]], [normal[0], normal[1], normal[2]], 1.0, spin, spin, dt)
            turned = tangent.carried(kept, way)
            for k in ti.static(range(3)):
                kept[k] = turned[k]
        for k in ti.static(range(3)):
            found[k] = kept[k]


@pytest.mark.parametrize("axis", [(0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 2.0, 3.0)], ids=["across", "about", "skew"])
def test_a_loaded_pair_that_turns_once_keeps_the_size_and_the_direction_of_its_force(axis):
    """Turned rigidly by steps of 1 mrad; each errs by θ³ in direction, 6283 of them by less than 1e-5."""
    runtime.initialise(1)
    normal, loaded = np.array([0.0, 0.0, 1.0]), np.array([0.6, -0.8, 0.0])
    rate, found = np.array(axis) / np.linalg.norm(axis), np.zeros(3)
    turn_pair(6283, 2.0 * np.pi / 6283, rate, np.array([normal, loaded]), found)
    np.testing.assert_allclose(found, loaded, atol=1e-5)
