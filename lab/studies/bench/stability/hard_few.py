"""Hard cases of a few grains that have closed forms: one that bounces, corners, wedges, a column, unequal sizes."""

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from lab.studies.bench.stability.beds import ACETATE, RADIUS, G, tank
from lab.studies.bench.stability.case import HardCase, Measure
from lab.studies.bench.stability.trial import Course, Trial
from lab.studies.case import Line
from solvers.grains.materials import hertz_stiffness
from solvers.grains.restitution import restitution
from solvers.scene import Scene

FALL = 0.01  # m, of the single grain
HALF_ANGLE = np.radians(15.0)  # of the corner
TIGHT = 0.999  # of a diameter
LAYERS, COLUMN_RADIUS = 100, 25e-3  # m
LARGE, SMALL = 3e-3, 0.3e-3  # m, radii
DOME, BEGIN, LEAVE = np.array([-0.03, 0.004]), np.radians(20.0), np.radians(45.0)
SLOPES, ROW = (4.0, 7.0), 25  # degrees of the two rows, and their grains
DIMPLE = float(np.arcsin(SMALL / (LARGE + SMALL)))  # the steepest slope whose dimples hold a large grain


def one_grain(fast: bool) -> Trial:
    """A grain falls 10 mm and bounces; it is looked at often enough to be seen in the collision."""
    return Trial(_alone(tank(0.02, 0.02)), np.array([[0.0, RADIUS + FALL]]), 0.08, looks=4000)


def rebound(trial: Trial, course: Course) -> float:
    """Height (m) that the first bounce reaches."""
    z = course.position[:, 0, 1] - RADIUS
    lowest = int(np.argmax(np.diff(z) > 0.0))
    return float(z[lowest:].max())


def bounced(trial: Trial, course: Course) -> list[Line]:
    """e² h, with the restitution e of the viscoelastic law at the speed of the fall."""
    between, mass, speed = trial.scene.interfaces[1], trial.mass[0], np.sqrt(2.0 * G * FALL)
    damping = 1.5 * between.dissipative_time * (_stiffness(trial) / mass) ** 0.4 * speed**0.2
    expected = restitution(damping) ** 2 * FALL
    error = abs(rebound(trial, course) / expected - 1.0)
    return [Line.off("height of the first bounce", "e² h, e by DOP853", error, 3e-3, "twice 0.1 % of e, weight, looks")]


def corner(fast: bool) -> Trial:
    """A grain falls into a corner of 30°, as wide open as high."""
    deep = 20.0 * RADIUS
    outline = np.array([[0.0, 0.0], [deep * np.tan(HALF_ANGLE), deep], [-deep * np.tan(HALF_ANGLE), deep]])
    return Trial(_alone(outline), np.array([[0.0, RADIUS / np.sin(HALF_ANGLE) + 0.5 * RADIUS]]), 0.3)


def deepest(trial: Trial, course: Course) -> float:
    """The largest overlap (radii) at the end."""
    return course.last("overlap")


def held(trial: Trial, course: Course) -> list[Line]:
    """Two walls bear m g/(2 sin α) each, ξ = (F/k)^(2/3)."""
    overlap = (trial.weight / (2.0 * np.sin(HALF_ANGLE)) / _stiffness(trial)) ** (2.0 / 3.0) / RADIUS
    error = abs(deepest(trial, course) / overlap - 1.0)
    return [Line.off("overlap at rest", "(m g/(2 k sin α))^(2/3)", error, 1e-3, "creep that is left")]


def wedged(fast: bool) -> Trial:
    """A grain between walls 0.999 of its diameter apart, high above the floor."""
    return Trial(_alone(tank(2.0 * TIGHT * RADIUS, 0.05)), np.array([[0.0, 0.03]]), 0.05)


def creep(trial: Trial, course: Course) -> float:
    """Speed downwards (m/s) over the second half."""
    half = len(course.time) // 2
    z = course.position[:, 0, 1]
    return float((z[half] - z[-1]) / (course.time[-1] - course.time[half]))


def crept(trial: Trial, course: Course) -> list[Line]:
    """Haff and Werner's friction has no memory: a load creeps at m g/(2 γ_s); the overlap stays as it is."""
    expected = trial.weight / (2.0 * ACETATE.shear_damping)
    error = abs(creep(trial, course) / expected - 1.0)
    squeezed = abs(deepest(trial, course) / (1.0 - TIGHT) - 1.0)
    return [
        Line.off("creep down", "m g/(2 γ_s)", error, 1e-3, "as asserted of the law"),
        Line.off("overlap", "0.001 radii", squeezed, 1e-6, "rounding"),
    ]


def column(fast: bool) -> Trial:
    """A hundred grains upon one another in a shaft, let go of as they touch."""
    places = np.column_stack([np.zeros(LAYERS), COLUMN_RADIUS * (1.0 + 2.0 * np.arange(LAYERS))])
    shaft = tank(2.0 * COLUMN_RADIUS * 1.0001, 2.1 * LAYERS * COLUMN_RADIUS)
    scene = Scene(np.full(LAYERS, COLUMN_RADIUS), shaft, ACETATE, ACETATE)
    trial = Trial(scene, places, 60.0)
    return replace(trial, load=trial.weight)


def rested(trial: Trial, course: Course) -> list[Line]:
    """The lowest contact bears all the weight, and the column hardly stirs any more."""
    overlap = (trial.weight / _stiffness(trial)) ** (2.0 / 3.0)
    error = abs((COLUMN_RADIUS - course.position[-1, 0, 1]) / overlap - 1.0)
    late = course.position[course.time > 0.75 * course.time[-1]]
    moved = np.ptp(late, axis=0).max() / COLUMN_RADIUS
    return [
        Line.off("overlap with the floor", "(N m g/k)^(2/3)", error, 1e-3, "its lowest mode rings on"),
        Line.off("moved in the last quarter (radii)", "0", float(moved), 1e-3, "its lowest mode rings on"),
    ]


def unequal(fast: bool) -> Trial:
    """A small grain on a dome ten times its size, and two large ones on rows of small ones, one steeper than the other.

    The dome and the rows are fixed. The slopes are less and more than what the dimples of a row can hold, whatever
    the friction.
    """
    rough = replace(ACETATE, friction=1.0)
    fixed, places = [[*DOME, LARGE]], [DOME + (LARGE + SMALL) * np.array([np.sin(BEGIN), np.cos(BEGIN)])]
    for y, slope in zip((-0.005, 0.02), np.radians(SLOPES), strict=True):
        down, up = np.array([np.cos(slope), -np.sin(slope)]), np.array([np.sin(slope), np.cos(slope)])
        first = np.array([y, 0.006])
        fixed += [[*(first + 2.0 * SMALL * k * down), SMALL] for k in range(ROW)]
        places.append(first + 9.0 * SMALL * down + (LARGE + SMALL) * np.cos(DIMPLE) * up)
    scene = Scene([SMALL, LARGE, LARGE], tank(0.1, 0.02), rough, rough, fixed=np.array(fixed))
    return Trial(scene, np.array(places), 2.0 * time_to_leave(), looks=100)


@cache
def time_to_leave() -> float:
    """Time (s) in which a sphere rolls down a dome from rest at BEGIN to LEAVE, θ̈ = (5/7) g sin θ/(R + r)."""

    def motion(_, state):
        return [state[1], 5.0 / 7.0 * G * np.sin(state[0]) / (LARGE + SMALL)]

    def leaves(_, state):
        return state[0] - LEAVE

    leaves.terminal = True
    path = solve_ivp(motion, (0.0, 1.0), [BEGIN, 0.0], "DOP853", events=leaves, rtol=1e-10, atol=1e-12)
    return float(path.t[-1])


def rolled(trial: Trial, course: Course) -> float:
    """Angle (rad) of the small grain on the dome in the middle of the run."""
    y, z = course.position[len(course.time) // 2, 0] - DOME
    return float(np.arctan2(y, z))


def sticks_not(trial: Trial, course: Course) -> list[Line]:
    """The small grain rolls as a sphere must; a large one stays where dimples hold it, and leaves where they cannot."""
    error = abs(rolled(trial, course) / LEAVE - 1.0)
    moved = np.linalg.norm(course.position[-1, 1:] - course.position[0, 1:], axis=1) / (2.0 * SMALL)
    hold = f"dimples hold up to {np.degrees(DIMPLE):.1f}°"
    return [
        Line.off(
            "angle of a 0.6 mm grain on a 6 mm dome", "(5/7) g sin θ/(R + r), DOP853", error, 1e-3, "overlaps in R + r"
        ),
        Line.off(
            f"6 mm grain on 0.6 mm grains, {SLOPES[0]:g}°: moved (small grains)", hold, moved[0], 0.01, "sinks in"
        ),
        Line.off(
            f"the same, {SLOPES[1]:g}°: missing of one grain's way", hold, max(0.0, 1.0 - moved[1]), 0.0, "must roll"
        ),
    ]


def _alone(outline: np.ndarray) -> Scene:
    """One grain in a tank."""
    return Scene([RADIUS], outline, ACETATE, ACETATE)


def _stiffness(trial: Trial) -> float:
    """k (N/m^1.5) of a grain and a wall."""
    return hertz_stiffness(trial.scene.interfaces[1].young_modulus, trial.scene.sizes[0])


CASES = (
    HardCase(
        "one-grain",
        "A grain of 3 mm, alone, falls 10 mm and bounces, 0.08 s.",
        one_grain,
        bounced,
        Measure("height of the first bounce (m)", rebound, 0.05, "e to 2.5 %"),
    ),
    HardCase(
        "corner",
        "A grain of 3 mm falls into a corner of 30° and comes to rest, 0.3 s.",
        corner,
        held,
        Measure("overlap at the end (radii)", deepest, 0.05, "creep that is left"),
    ),
    HardCase(
        "wedged",
        "A grain of 3 mm between walls 0.999 diameters apart, 0.05 s.",
        wedged,
        crept,
        Measure("creep (m/s)", creep, 0.01, "creep does not depend on the step"),
        fast=True,
    ),
    HardCase(
        "size-ratio",
        "Sizes 10 : 1 with μ = 1: a grain of 0.6 mm rolls down a dome of 6 mm (no static friction that is not there), "
        "and grains of 6 mm lie on slopes of 0.6 mm grains, on one that must hold them and one that must not.",
        unequal,
        sticks_not,
        Measure("angle on the dome (rad)", rolled, 0.01, "the motion is smooth"),
        fast=True,
    ),
    HardCase(
        "column",
        "100 grains of 50 mm (reduced: large grains, since the step grows with their size) upon one another for 60 s.",
        column,
        rested,
        Measure("overlap at the end (radii)", deepest, 0.01, "at rest"),
    ),
)
