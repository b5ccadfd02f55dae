"""Hard cases with bad starts or very many grains: grains on top of each other, a gas, a million grains."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.optimize import curve_fit

from lab.preset.bed_file import DEEPEST
from solvers.grains.bed.relaxing import relaxed_start
from solvers.grains.materials import hertz_stiffness
from solvers.scene import Scene
from tests.oracles.courses import RADIUS, Course, Trial, followed, hard, running, sound, square
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

ACETATE = material()

pytestmark = pytest.mark.slow


def test_a_hopeless_crowd_is_sound_or_ends_in_a_sentence():
    """A hundred grains at random places in a room that they cover one and a half times."""
    side = RADIUS * sqrt(100 * pi / 1.5)
    random = np.random.default_rng(1)
    position = random.uniform([RADIUS - 0.5 * side, RADIUS], [0.5 * side - RADIUS, side - RADIUS], (100, 2))
    trial = Trial(scene_of(np.full(100, RADIUS), box(side, 2.0 * side), ACETATE, ACETATE), position, 0.1)
    with running(trial) as run:
        course = followed(run, trial, trial.scene.time_step())
    if course.stopped:
        assert course.stopped.endswith(".")
    else:
        sound(trial, course)


def test_grains_put_a_little_too_close_come_apart_and_do_not_fly_up():
    """On a square lattice they overlap by as much as a bed's file may say, relaxed as the lab does it."""
    pitch = (2.0 - DEEPEST) * RADIUS
    scene = scene_of(np.full(100, RADIUS), box(11.0 * pitch, 30.0 * pitch), ACETATE, ACETATE)
    course = hard(Trial(scene, relaxed_start(scene, square(10, 10, pitch)), 0.1))
    height = course.rows["centre_of_mass"][..., 1]
    assert height.max() - height[0] < 2.0 * RADIUS  # they rearrange


MOLECULES, SHARE, THERMAL, RESTITUTION = 600, 0.1, 2.5, 0.9  # number, share of the area, m/s along an axis, e
SCATTER = 0.1  # of Haff's law: twice the scatter of such small gases between seeds


def gas() -> Scene:
    """Smooth grains that lose a tenth of their speed in every collision, between walls that take nothing."""
    side = RADIUS * sqrt(MOLECULES * pi / SHARE)
    velocity = np.random.default_rng(1).normal(0.0, THERMAL, (1, MOLECULES, 2))
    velocity -= velocity.mean(axis=1, keepdims=True)
    return scene_of(
        np.full(MOLECULES, RADIUS),
        box(side, side),
        material(restitution=RESTITUTION),
        material(restitution=1.0),
        normal="linear",
        tangential="none",
        gravity=0.0,
        velocity=velocity,
        spin=np.zeros((1, MOLECULES)),
        start_speed=float(np.linalg.norm(velocity, axis=2).max()),
    )


def cooling_time(scene: Scene) -> float:
    """Haff's τ (s) in two dimensions, 1/τ = (1 − e²) ω/4, from the collision rate ω of a grain at the start.

    ω = 2 √π d n g(φ) √(T/m), g = (1 − 7φ/16)/(1 − φ)² (Henderson 1975); each collision takes (1 − e²) T on average
    (Haff 1983). The centres have the room that the walls leave them.
    """
    density = MOLECULES / (np.ptp(scene.outline[:, 0]) - 2.0 * RADIUS) ** 2
    covered = density * pi * RADIUS**2
    crowding = (1.0 - 7.0 / 16.0 * covered) / (1.0 - covered) ** 2
    temperature = 0.5 * float((scene.grains.velocity**2).sum(axis=2).mean())  # T/m, m²/s²
    rate = 2.0 * sqrt(pi) * 2.0 * RADIUS * density * crowding * sqrt(temperature)
    return 4.0 / ((1.0 - RESTITUTION**2) * rate)


def test_a_gas_cools_by_haffs_law():
    """T = T0 (1 + t/τ)^−2 for five cooling times: the exponent with his τ, and the τ with his exponent."""
    scene = gas()
    tau, along = cooling_time(scene), int(np.ceil(sqrt(MOLECULES)))
    pitch = (np.ptp(scene.outline[:, 0]) - 2.0 * RADIUS) / along
    place = square(along, along, pitch)[:MOLECULES] + np.array([0.0, RADIUS])

    def slower(course: Course) -> float:
        """The τ that his law takes, as a share of his, by least squares of log T."""

        def law(time: np.ndarray, start: float, times: float) -> np.ndarray:
            return start - 2.0 * np.log1p(time / (times * tau))

        kinetic = course.rows["kinetic"]
        return float(curve_fit(law, course.time, np.log(kinetic / kinetic[0]), p0=[0.0, 1.0])[0][1])

    course = hard(Trial(scene, place, 5.0 * tau), slower, SCATTER)
    exponent = -np.polyfit(np.log1p(course.time / tau), np.log(course.rows["kinetic"]), 1)[0]
    assert exponent == pytest.approx(2.0, rel=SCATTER) and slower(course) == pytest.approx(1.0, rel=SCATTER)


def test_every_contact_of_a_million_grains_is_found():
    """A square lattice of touching grains that its tank squeezes: each holds (2/5) k ξ^(5/2); ten steps."""
    many, pressed = 1000, 1e-4  # grains along a side; overlap in diameters
    pitch = 2.0 * RADIUS * (1.0 - pressed)
    scene = scene_of(np.full(many**2, RADIUS), box(many * pitch, many * pitch), ACETATE, ACETATE)
    course = hard(Trial(scene, square(many, many, pitch), 10 * scene.time_step(), looks=1))
    pairs, walls = 2 * many * (many - 1), 4 * many
    assert course.rows["contacts"][0] == pairs + walls
    between = zip(scene.grains.interfaces, (0.5, 1.0), (2.0, 1.0), (pairs, walls), strict=True)
    elastic = sum(
        number * 0.4 * hertz_stiffness(each.young_modulus, share * RADIUS) * (deep * RADIUS * pressed) ** 2.5
        for each, share, deep, number in between
    )
    assert course.rows["elastic"][0] == pytest.approx(elastic, rel=1e-6)  # rounding of places 3 m wide
