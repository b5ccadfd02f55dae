"""Hard cases of beds: dense, small, mixed, struck, lossy, elastic, smooth and rough grains in a tank at rest."""

from dataclasses import replace

import numpy as np

from lab.studies.bench.stability.beds import ACETATE, GOLD_ORE, RADIUS, bed, hexagonal, square, tank
from lab.studies.bench.stability.case import HardCase, Measure
from lab.studies.bench.stability.trial import Course, Trial
from lab.studies.case import Line
from solvers.scene import Scene

LATE = 0.75  # of the run: when a bed has come to rest
BOUNCES = 0.02  # of the weight: what the last bounces may do to its mean over a quarter of the run
BIG, SMALL, RATIO = 12, 120, 10.0  # grains of the mixed bed
PROJECTILE = (2.0, -9.8)  # m/s, together 10


def height(trial: Trial, course: Course) -> float:
    """Height (m) of the centre of mass above the floor at the last look."""
    return course.last("centre_of_mass")[1]


HEIGHT = Measure("height of the centre of mass at the end (m)", height, 0.05, "chaos of a small bed")


def weighed(trial: Trial, course: Course) -> list[Line]:
    """The mean load on the floor over the last quarter, against the weight."""
    late = course.time > LATE * course.time[-1]
    passed = np.diff(course.time, prepend=0.0)[late]
    load = -float(course.rows["wall_force"][late, 1] @ passed) / passed.sum()
    error = abs(load / trial.weight - 1.0)
    return [Line.off("load on the floor in the last quarter (share)", "weight", error, BOUNCES, "last bounces")]


def still_spins(trial: Trial, course: Course) -> list[Line]:
    """Without friction nothing ever turns."""
    turning = float(np.abs(course.spin).max())
    return [*weighed(trial, course), Line.off("largest spin (rad/s)", "0, no friction", turning, 0.0, "exact")]


def kept_energy(trial: Trial, course: Course) -> float:
    """Energy at the end as a share of that at the start, weight counted from the floor."""
    return float(course.energy[-1] / course.energy[0])


def lost_energy(trial: Trial, course: Course) -> float:
    """Energy (J) lost until the end."""
    return float(course.energy[0] - course.energy[-1])


def gold_ore(fast: bool) -> Trial:
    """Grains of material C of Spandonidis (2016), table 5.1."""
    count, across, duration = (100, 10, 0.12) if fast else (300, 20, 0.15)
    return bed(count, duration, GOLD_ORE, diameter=1e-3, across=across)


def tiny(fast: bool) -> Trial:
    """Grains of 0.1 mm, whose shear damper no explicit step could follow."""
    return bed(100, 0.04, replace(ACETATE, shear_damping=20.0), diameter=1e-4)


def made_of(**changes: object):
    """A builder of a bed of acetate with some of its properties changed."""
    return lambda fast: bed(100, 0.25, replace(ACETATE, **changes))


def single_precision(fast: bool) -> Trial:
    """The bed in 32-bit floats."""
    return bed(100, 0.25, precision="f32")


def mixed(fast: bool) -> Trial:
    """Grains of 0.3 mm under grains of 3 mm."""
    small = RADIUS / RATIO
    wide = tank(13.0 * RADIUS, 24.0 * RADIUS)
    below = square(60, 2, 2.1 * small) + np.random.default_rng(1).uniform(-0.04, 0.04, (SMALL, 2)) * small
    above = square(6, 2, 2.1 * RADIUS) + np.array([0.0, 0.6 * RADIUS])
    radius = np.repeat([RADIUS, small], [BIG, SMALL])
    return Trial(Scene(radius, wide, ACETATE, ACETATE), np.vstack([above, below]), 0.12)


def struck(fast: bool) -> Trial:
    """A grain at 10 m/s upon hexagonal rows of grains."""
    place = hexagonal(10, 8, RADIUS)
    place = np.vstack([place, [0.3 * RADIUS, place[:, 1].max() + 2.5 * RADIUS]])
    velocity = np.zeros((1, len(place), 2))
    velocity[0, -1] = PROJECTILE
    scene = Scene(
        np.full(len(place), RADIUS),
        tank(21.002 * RADIUS, 80.0 * RADIUS),
        ACETATE,
        ACETATE,
        velocity=velocity,
        spin=np.zeros((1, len(place))),
        start_speed=float(np.hypot(*PROJECTILE)),
    )
    return Trial(scene, place, 0.005, looks=500)


ROUNDING = 1e-4, "places rounded to 1e-9 m, overlaps of 1e-7 m"
CASES = (
    HardCase(
        "gold-ore",
        "300 grains of gold ore, 1 mm ± 10 %, 17.8 g/cm³, Y = 3.2 GPa, fall as a loose lattice and settle, 0.15 s "
        "(fast: 100 grains, 0.12 s).",
        gold_ore,
        weighed,
        HEIGHT,
        fast=True,
    ),
    HardCase(
        "tiny-grains",
        "100 grains of 0.1 mm ± 10 % with a shear damping of 20 N s/m settle in 0.04 s: the damper alone would want "
        "steps far below a nanosecond.",
        tiny,
        weighed,
        HEIGHT,
    ),
    HardCase(
        "lossy", "100 grains of 3 mm ± 10 % with e = 0.05 settle in 0.25 s.", made_of(restitution=0.05), weighed, HEIGHT
    ),
    HardCase(
        "elastic",
        "100 grains of 3 mm ± 10 % with e = 0.999 and no friction bounce for 0.25 s.",
        made_of(restitution=0.999, friction=0.0),
        measure=Measure("energy kept (share)", kept_energy, 0.01, "what 1 - e² loses"),
    ),
    HardCase(
        "smooth", "100 grains of 3 mm ± 10 % with μ = 0 settle in 0.25 s.", made_of(friction=0.0), still_spins, HEIGHT
    ),
    HardCase("rough", "100 grains of 3 mm ± 10 % with μ = 2 settle in 0.25 s.", made_of(friction=2.0), weighed, HEIGHT),
    HardCase(
        "mixed-sizes",
        "12 grains of 3 mm fall upon 120 of 0.3 mm, 0.12 s; overlaps count in radii of the smaller grain.",
        mixed,
        weighed,
        HEIGHT,
    ),
    HardCase(
        "impact",
        "A grain of 3 mm strikes 80 of its like, in hexagonal rows, at 10 m/s; 5 ms.",
        struck,
        measure=Measure("energy lost (J)", lost_energy, 0.05, "chaos of the collisions"),
        fast=True,
    ),
    HardCase(
        "single-precision",
        "100 grains of 3 mm ± 10 % settle in 0.25 s in 32-bit floats.",
        single_precision,
        weighed,
        HEIGHT,
        energy=ROUNDING,
    ),
)
