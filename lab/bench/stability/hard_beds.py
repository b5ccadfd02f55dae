"""Hard cases with many grains: hard and small materials, rough and smooth, thrown, shaken, turned, and very many."""

import numpy as np

from lab.bench.stability.beds import ACETATE, GOLD_ORE, G, bed, hexagonal, tank
from lab.bench.stability.case import Case, Check, Measure
from lab.bench.stability.trial import Course, Trial
from solvers.motions import Sway, Tilt
from solvers.scene import Scene
from dataclasses import replace

PACKED = 0.05  # of a height: what beds that met by other roundings differ by
HEIGHT = Measure(
    "height of the centre of mass at the end",
    lambda trial, course: height(trial, course),
    PACKED,
    "chaos of a small bed",
)


def height(trial: Trial, course: Course) -> float:
    """Height (m) of the centre of mass above the tank's floor at the last look."""
    return course.last("centre_z") - trial.scene.outline[:, 1].min()


def weighed(trial: Trial, course: Course) -> list[Check]:
    """The mean load on the floor over the last quarter, against the weight."""
    time, load = course.time, course.rows["wall_z"]
    late = time > 0.75 * time[-1]
    passed = np.diff(time, prepend=0.0)[late]
    error = abs(-(load[late] @ passed) / passed.sum() / trial.weight - 1.0)
    return [Check("load on the floor over the last quarter (share)", "weight", float(error), 0.02, "bounces left")]


def gold_ore(fast: bool) -> Trial:
    return bed(60 if fast else 300, 1e-3, 0.05 if fast else 0.15, GOLD_ORE, across=10 if fast else 20)


def tiny(fast: bool) -> Trial:
    return bed(100, 1e-4, 0.015, replace(ACETATE, shear_damping=20.0))


def lossy(fast):
    return bed(60 if fast else 100, 3e-3, 0.1, replace(ACETATE, restitution=0.05))


def elastic(fast):
    return bed(100, 3e-3, 0.1, replace(ACETATE, restitution=0.999, friction=0.0))


def smooth(fast):
    return bed(100, 3e-3, 0.1, replace(ACETATE, friction=0.0))


def rough(fast):
    return bed(100, 3e-3, 0.1, replace(ACETATE, friction=2.0))


def single(fast):
    return bed(100, 3e-3, 0.1, ACETATE, precision="f32")


def swayed(fast):
    return bed(60, 3e-3, 1.0, motions=[(Sway(0.1, 2.0),)])


def turned(fast):
    return bed(60, 3e-3, 1.0, motions=[(Tilt(1.5 * np.pi, np.pi),)])


def long_tilt(fast):
    return replace(
        bed(40, 6e-3, 300.0, stiffness_scale=1e-3, motions=[(Tilt(np.radians(0.15), np.radians(45.0)),)]), looks=1000
    )


def ratio_bed(fast):
    big, small = 12, 150
    random = np.random.default_rng(1)
    R, r = 1.5e-3, 1.5e-4
    outline = tank(7 * 2.1 * R, 30e-3)
    row = np.array([[(k - 2.5) * 2.2 * R, R * (1.1)] for k in range(6)])
    places = np.concatenate([row + [0, 0.9e-3], row + [R, 3.0 * R + 0.9e-3]])
    k = np.arange(small)
    cols = 6 * 10
    places = np.concatenate([places, np.column_stack([(k % 60 - 29.5) * 1.05 * 2 * r, 1.1 * r + (k // 60) * 2.1 * r])])
    places[big:] += random.uniform(-0.04, 0.04, (small, 2)) * r
    radius = np.concatenate([np.full(big, R), np.full(small, r)])
    return Trial(Scene(radius, outline, ACETATE, ACETATE), places, 0.1)


def impact(fast):
    columns, rows, radius = 10, 8, 1.5e-3
    place = hexagonal(columns, rows, radius)
    top = place[:, 1].max() + 2.5 * radius
    place = np.vstack([place, [[0.3 * radius, top]]])
    v = np.zeros((1, len(place), 2))
    v[0, -1] = [2.0, -9.8]
    outline = tank(2 * radius * (columns + 0.5) * 1.0001, 0.12)
    sc = Scene(
        np.full(len(place), radius),
        outline,
        ACETATE,
        ACETATE,
        velocity=v,
        spin=np.zeros((1, len(place))),
        start_speed=10.0,
    )
    return Trial(sc, place, 0.02)
