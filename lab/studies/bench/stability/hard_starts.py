"""Hard cases with bad starts or very many grains: grains on top of each other, a gas, a million grains."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
from scipy.optimize import curve_fit

from lab.preset.bed_file import DEEPEST
from lab.studies.bench.stability.beds import ACETATE, RADIUS, square, tank
from lab.studies.bench.stability.case import HardCase, Measure
from lab.studies.bench.stability.trial import Course, Trial
from lab.studies.case import Line
from solvers.grains.materials import hertz_stiffness
from solvers.scene import Scene

CROWD, CROWDED = 100, 1.5  # grains thrown together, and how many times their area covers the room
RISE = 1.0  # diameters
MOLECULES, SHARE, THERMAL, RESTITUTION = 600, 0.1, 2.5, 0.9  # of the gas: number, area, m/s along an axis, e
COOLING_TIMES = 5.0
SCATTER = 0.1  # of Haff's law: twice the scatter of such small gases between seeds
MANY, PRESSED, FEW_STEPS = 1000, 1e-4, 10  # grains along a side, overlap in diameters, steps


def crowded(fast: bool) -> Trial:
    """Grains at random places, many on top of each other."""
    side = RADIUS * sqrt(CROWD * pi / CROWDED)
    random = np.random.default_rng(1)
    position = random.uniform([RADIUS - 0.5 * side, RADIUS], [0.5 * side - RADIUS, side - RADIUS], (CROWD, 2))
    return Trial(Scene(np.full(CROWD, RADIUS), tank(side, 2.0 * side), ACETATE, ACETATE), position, 0.1)


def squeezed(fast: bool) -> Trial:
    """A square lattice of grains that overlap by as much as a bed's file may say, relaxed as the app does it."""
    pitch = (2.0 - DEEPEST) * RADIUS
    scene = Scene(np.full(100, RADIUS), tank(11.0 * pitch, 30.0 * pitch), ACETATE, ACETATE)
    return Trial(scene, scene.relaxed(square(10, 10, pitch)), 0.1)


def settles(trial: Trial, course: Course) -> list[Line]:
    """Grains that are put a little too close should come apart, not fly up."""
    height = course.rows["centre_of_mass"][..., 1]
    risen = float(height.max() - height[0]) / (2.0 * RADIUS)
    return [Line.off("rise of the centre of mass (diameters)", "relaxed, not burst", risen, RISE, "rearranging")]


def gas(fast: bool) -> Trial:
    """Smooth grains that lose a tenth of their speed in every collision, between walls that take nothing."""
    random = np.random.default_rng(1)
    side = RADIUS * sqrt(MOLECULES * pi / SHARE)
    along = int(np.ceil(sqrt(MOLECULES)))
    position = square(along, along, (side - 2.0 * RADIUS) / along)[:MOLECULES] + np.array([0.0, RADIUS])
    velocity = random.normal(0.0, THERMAL, (1, MOLECULES, 2))
    velocity -= velocity.mean(axis=1, keepdims=True)
    scene = Scene(
        np.full(MOLECULES, RADIUS),
        tank(side, side),
        replace(ACETATE, restitution=RESTITUTION),
        replace(ACETATE, restitution=1.0),
        normal="linear",
        tangential="none",
        gravity=0.0,
        velocity=velocity,
        spin=np.zeros((1, MOLECULES)),
        start_speed=float(np.linalg.norm(velocity, axis=2).max()),
    )
    return Trial(scene, position, COOLING_TIMES * cooling_time(scene))


def cooling_time(scene: Scene) -> float:
    """Haff's τ (s) in two dimensions, 1/τ = (1 − e²) ω/4, from the collision rate ω of a grain at the start.

    ω = 2 √π d n g(φ) √(T/m), g = (1 − 7φ/16)/(1 − φ)² (Henderson 1975); each collision takes (1 − e²) T on average
    (Haff 1983). The centres have the room that the walls leave them.
    """
    side = np.ptp(scene.outline[:, 0]) - 2.0 * RADIUS
    density = MOLECULES / side**2
    covered = density * pi * RADIUS**2
    crowding = (1.0 - 7.0 / 16.0 * covered) / (1.0 - covered) ** 2
    temperature = 0.5 * float((scene.velocity**2).sum(axis=2).mean())  # T/m, m²/s²
    rate = 2.0 * sqrt(pi) * 2.0 * RADIUS * density * crowding * sqrt(temperature)
    return 4.0 / ((1.0 - RESTITUTION**2) * rate)


def exponent(trial: Trial, course: Course) -> float:
    """The exponent α of T = T0 (1 + t/τ)^−α with Haff's own τ, by least squares of log T."""
    age = np.log1p(course.time / cooling_time(trial.scene))
    return -float(np.polyfit(age, np.log(course.rows["kinetic"]), 1)[0])


def slower(trial: Trial, course: Course) -> float:
    """The τ that Haff's law with its own exponent takes, as a share of his, by least squares of log T."""
    tau, kinetic = cooling_time(trial.scene), course.rows["kinetic"]

    def law(time: np.ndarray, start: float, times: float) -> np.ndarray:
        return start - 2.0 * np.log1p(time / (times * tau))

    return float(curve_fit(law, course.time, np.log(kinetic / kinetic[0]), p0=[0.0, 1.0])[0][1])


def cools(trial: Trial, course: Course) -> list[Line]:
    """Haff's law: the exponent with its τ, and the τ with its exponent."""
    power, time = abs(exponent(trial, course) / 2.0 - 1.0), abs(slower(trial, course) - 1.0)
    return [
        Line.off("exponent of the cooling", "2 (Haff 1983), τ of kinetic theory", power, SCATTER, "600 grains"),
        Line.off("cooling time, exponent 2", "4/((1 - e²) ω)", time, SCATTER, "600 grains"),
    ]


def million(fast: bool) -> Trial:
    """A square lattice of touching grains, a thousand by a thousand, that its tank squeezes."""
    pitch = 2.0 * RADIUS * (1.0 - PRESSED)
    scene = Scene(np.full(MANY**2, RADIUS), tank(MANY * pitch, MANY * pitch), ACETATE, ACETATE)
    return Trial(scene, square(MANY, MANY, pitch), FEW_STEPS * scene.time_step(), looks=1)


def counted(trial: Trial, course: Course) -> list[Line]:
    """Every contact is found, and holds (2/5) k ξ^(5/2)."""
    pairs, walls = 2 * MANY * (MANY - 1), 4 * MANY
    missing = abs(course.rows["contacts"][0] - (pairs + walls))
    between = zip(trial.scene.interfaces, (0.5, 1.0), (2.0, 1.0), (pairs, walls), strict=True)
    elastic = sum(
        number * 0.4 * hertz_stiffness(each.young_modulus, share * RADIUS) * (deep * RADIUS * PRESSED) ** 2.5
        for each, share, deep, number in between
    )
    error = abs(course.rows["elastic"][0] / elastic - 1.0)
    return [
        Line.off("contacts missing", f"{pairs + walls}", float(missing), 0.0, "exact"),
        Line.off("elastic energy", "sum of (2/5) k ξ^(5/2)", float(error), 1e-6, "rounding of places 3 m wide"),
    ]


CASES = (
    HardCase(
        "overlapping",
        "100 grains of 3 mm at random places in a room that they cover one and a half times: hopeless, so a sentence "
        "of the watch is an answer.",
        crowded,
        may_stop=True,
        fast=True,
    ),
    HardCase(
        "squeezed",
        f"100 grains of 3 mm on a lattice where each overlaps its neighbours by {100 * DEEPEST:g} % of a radius, which "
        "the file of a bed may say; where a bed is to settle, as here, the lab relaxes it first; 0.1 s.",
        squeezed,
        settles,
    ),
    HardCase(
        "gas",
        "600 smooth grains of 3 mm without gravity, e = 0.9 at every speed (linear law), elastic walls, a tenth of the "
        "area, for five of Haff's cooling times.",
        gas,
        cools,
        Measure("cooling time (of Haff's)", slower, SCATTER, "600 grains"),
    ),
    HardCase(
        "million", "1 000 000 grains, pressed together, ten steps (reduced: it is about memory).", million, counted
    ),
)
