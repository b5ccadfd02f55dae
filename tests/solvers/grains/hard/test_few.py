"""Hard cases of a few grains that have closed forms: one that bounces, corners, wedges, a column, unequal sizes."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from solvers.grains.restitution import restitution
from tests.oracles.courses import RADIUS, Trial, hard, wall_stiffness
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

G = 9.81  # m/s²
ACETATE = material()

pytestmark = pytest.mark.slow


def alone(outline: np.ndarray, height: float, duration: float, looks: int = 200) -> Trial:
    """One grain at a height (m) in the middle of a tank."""
    return Trial(scene_of([RADIUS], outline, ACETATE, ACETATE), np.array([[0.0, height]]), duration, looks=looks)


def overlap(course) -> float:
    """The largest overlap (radii) at the end."""
    return course.rows["overlap"][-1]


def test_a_grain_bounces_to_the_height_of_its_restitution():
    """It falls 10 mm: e² h, with the restitution of the viscoelastic law at its speed, by DOP853.

    3e-3: twice 0.1 % of e, weight, and the looks, of which some are in the collision.
    """
    fall = 0.01
    trial = alone(box(0.02, 0.02), RADIUS + fall, 0.08, looks=4000)

    def rebound(course) -> float:
        z = course.position[:, 0, 1] - RADIUS
        return z[int(np.argmax(np.diff(z) > 0.0)) :].max()

    mass, speed = trial.mass[0], np.sqrt(2.0 * G * fall)
    time = trial.scene.grains.interfaces[1].dissipative_time
    e = restitution(1.5 * time * (wall_stiffness(trial) / mass) ** 0.4 * speed**0.2)
    assert rebound(hard(trial, rebound, 0.05)) == pytest.approx(e**2 * fall, rel=3e-3)


def test_a_grain_comes_to_rest_in_a_corner():
    """Two walls at 15° bear m g/(2 sin α) each, ξ = (F/k)^(2/3); 1e-3: creep that is left."""
    half = np.radians(15.0)
    deep = 20.0 * RADIUS
    outline = np.array([[0.0, 0.0], [deep * np.tan(half), deep], [-deep * np.tan(half), deep]])
    trial = alone(outline, RADIUS / np.sin(half) + 0.5 * RADIUS, 0.3)
    at_rest = (trial.weight / (2.0 * np.sin(half)) / wall_stiffness(trial)) ** (2.0 / 3.0) / RADIUS
    assert overlap(hard(trial, overlap, 0.05)) == pytest.approx(at_rest, rel=1e-3)


def test_a_wedged_grain_creeps_as_its_friction_says():
    """Between walls 0.999 diameters apart: Haff and Werner's friction has no memory, so it creeps at m g/(2 γ_s)."""
    tight = 0.999
    trial = alone(box(2.0 * tight * RADIUS, 0.05), 0.03, 0.05)

    def creep(course) -> float:
        half, z = len(course.time) // 2, course.position[:, 0, 1]
        return (z[half] - z[-1]) / (course.time[-1] - course.time[half])

    course = hard(trial, creep, 0.01)
    assert creep(course) == pytest.approx(trial.weight / (2.0 * ACETATE.shear_damping), rel=1e-3)
    assert overlap(course) == pytest.approx(1.0 - tight, rel=1e-6)


def test_the_lowest_contact_of_a_column_bears_all_its_weight():
    """A hundred grains of 50 mm upon one another in a shaft, for a minute; 1e-3: their lowest mode rings on."""
    layers, radius = 100, 25e-3
    places = np.column_stack([np.zeros(layers), radius * (1.0 + 2.0 * np.arange(layers))])
    scene = scene_of(np.full(layers, radius), box(2.0002 * radius, 2.1 * layers * radius), ACETATE, ACETATE)
    trial = Trial(scene, places, 60.0)
    trial = replace(trial, load=trial.weight)
    course = hard(trial, overlap, 0.01)
    at_rest = (trial.weight / wall_stiffness(trial)) ** (2.0 / 3.0)
    assert radius - course.position[-1, 0, 1] == pytest.approx(at_rest, rel=1e-3)
    assert np.ptp(course.position[course.late(0.25)], axis=0).max() < 1e-3 * radius


LARGE, SMALL = 3e-3, 0.3e-3  # m, radii
DOME, BEGIN, LEAVE = np.array([-0.03, 0.004]), np.radians(20.0), np.radians(45.0)
DIMPLE = np.arcsin(SMALL / (LARGE + SMALL))  # the steepest slope whose dimples hold a large grain, 5.2°


def time_to_leave() -> float:
    """Time (s) in which a sphere rolls down a dome from rest at BEGIN to LEAVE, θ̈ = (5/7) g sin θ/(R + r)."""

    def motion(_, state):
        return [state[1], 5.0 / 7.0 * G * np.sin(state[0]) / (LARGE + SMALL)]

    def leaves(_, state):
        return state[0] - LEAVE

    leaves.terminal = True
    path = solve_ivp(motion, (0.0, 1.0), [BEGIN, 0.0], "DOP853", events=leaves, rtol=1e-10, atol=1e-12)
    return float(path.t[-1])


def test_unequal_grains_roll_where_they_must_and_stay_where_dimples_hold_them():
    """A small grain on a dome ten times its size, large ones on fixed rows of small ones at 4° and 7°, with μ = 1.

    The small one rolls as a sphere must: there is no static friction that is not there. The dimples of a row hold up to
    5.2°, whatever the friction.
    """
    rough = material(friction=1.0)
    fixed, places = [[*DOME, LARGE]], [DOME + (LARGE + SMALL) * np.array([np.sin(BEGIN), np.cos(BEGIN)])]
    for y, slope in zip((-0.005, 0.02), np.radians([4.0, 7.0]), strict=True):
        down, up = np.array([np.cos(slope), -np.sin(slope)]), np.array([np.sin(slope), np.cos(slope)])
        first = np.array([y, 0.006])
        fixed += [[*(first + 2.0 * SMALL * k * down), SMALL] for k in range(25)]
        places.append(first + 9.0 * SMALL * down + (LARGE + SMALL) * np.cos(DIMPLE) * up)
    scene = scene_of([SMALL, LARGE, LARGE], box(0.1, 0.02), rough, rough, fixed=np.array(fixed))

    def rolled(course) -> float:
        return float(np.arctan2(*(course.position[len(course.time) // 2, 0] - DOME)))

    course = hard(Trial(scene, np.array(places), 2.0 * time_to_leave(), looks=100), rolled, 0.01)
    assert rolled(course) == pytest.approx(LEAVE, rel=1e-3)  # overlaps in R + r
    stays, leaves = np.linalg.norm(course.position[-1, 1:] - course.position[0, 1:], axis=1) / (2.0 * SMALL)
    assert stays < 0.01 and leaves > 1.0
