"""Hard cases of beds: dense, small, mixed, struck, lossy, elastic, smooth and rough grains in a tank at rest."""

import numpy as np
import pytest

from solvers.grains.materials import Material
from tests.oracles.courses import RADIUS, Course, Trial, bed, hard, square
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

# Spandonidis (2016), table 5.1, material C; the restitution is our choice.
GOLD_ORE = Material(density=17800.0, young=3.2e9, poisson=0.28, friction=0.25, restitution=0.6)
BOUNCES = 0.02  # of the weight: what the last bounces may do to its mean over a quarter of the run
CHAOS = 0.05  # of a height: what a small bed's ends differ by

pytestmark = pytest.mark.slow


def height(course: Course) -> float:
    """Height (m) of the centre of mass above the floor at the end."""
    return course.rows["centre_of_mass"][-1, 1]


def settled(trial: Trial, **allowed: float) -> Course:
    """The course of a bed that settles: in the last quarter the floor bears its weight."""
    course = hard(trial, height, CHAOS, **allowed)
    late = course.late(0.25)
    passed = np.diff(course.time, prepend=0.0)[late]
    load = -(course.rows["wall_force"][late, 1] @ passed) / passed.sum()
    assert load == pytest.approx(trial.weight, rel=BOUNCES)
    return course


def mixed() -> Trial:
    """Twelve grains of 3 mm above 120 of 0.3 mm."""
    small = RADIUS / 10.0
    below = square(60, 2, 2.1 * small) + np.random.default_rng(1).uniform(-0.04, 0.04, (120, 2)) * small
    above = square(6, 2, 2.1 * RADIUS) + np.array([0.0, 0.6 * RADIUS])
    scene = scene_of(np.repeat([RADIUS, small], [12, 120]), box(13.0 * RADIUS, 24.0 * RADIUS), material(), material())
    return Trial(scene, np.vstack([above, below]), 0.12)


SETTLING = {
    "gold ore, 1 mm": lambda: bed(300, 0.15, GOLD_ORE, diameter=1e-3, across=20),
    # The damper alone would want steps far below a nanosecond.
    "0.1 mm, a shear damping of 20 N s/m": lambda: bed(100, 0.04, material(shear_damping=20.0), diameter=1e-4),
    "a restitution of 0.05": lambda: bed(100, 0.25, material(restitution=0.05)),
    "a friction of 2": lambda: bed(100, 0.25, material(friction=2.0)),
    "3 mm upon 0.3 mm": mixed,
}


@pytest.mark.parametrize("name", SETTLING)
def test_a_bed_settles_and_its_floor_bears_its_weight(name):
    settled(SETTLING[name]())


def test_a_bed_in_single_precision_settles():
    """Places are rounded to 1e-9 m, overlaps are 1e-7 m."""
    settled(bed(100, 0.25, precision="f32"), energy=1e-4)


def test_without_friction_nothing_ever_turns():
    assert np.abs(settled(bed(100, 0.25, material(friction=0.0))).spin).max() == 0.0


def test_an_almost_elastic_bed_bounces_and_makes_no_energy():
    """Of its energy it keeps the same share at a longer step, to 1 %, which is what 1 − e² loses."""
    hard(bed(100, 0.25, material(restitution=0.999, friction=0.0)), lambda one: one.energy[-1] / one.energy[0], 0.01)


def test_a_grain_at_10_metres_a_second_strikes_a_bed():
    """Of 80 equal grains in hexagonal rows; the energy that is lost does not hang on the step but for chaos."""
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(10), np.arange(8), indexing="ij"))
    y = RADIUS * (2.0 * column + row % 2 - 9.5)
    place = np.column_stack([y, RADIUS * (1.0 + np.sqrt(3.0) * row)])
    place = np.vstack([place, [0.3 * RADIUS, place[:, 1].max() + 2.5 * RADIUS]])
    velocity = np.zeros((1, len(place), 2))
    velocity[0, -1] = 2.0, -9.8
    scene = scene_of(
        np.full(len(place), RADIUS),
        box(21.002 * RADIUS, 80.0 * RADIUS),
        material(),
        material(),
        velocity=velocity,
        spin=np.zeros((1, len(place))),
        start_speed=float(np.hypot(*velocity[0, -1])),
    )
    hard(Trial(scene, place, 0.005, looks=500), lambda one: one.energy[0] - one.energy[-1], 0.05)
