"""Hard cases in a moving tank: a strong sway, a tank turned over, and a very slow tilt."""

from math import pi, radians

import numpy as np

from lab.studies.bench.stability.beds import RADIUS, bed
from lab.studies.bench.stability.case import HardCase, Measure
from lab.studies.bench.stability.trial import Course, Trial
from lab.studies.case import Line
from solvers.motion import Sway, Tilt

SOFT = 1e-3  # of the stiffness, for the long tilt
RATE, LASTING = radians(0.15), 300.0  # rad/s, s


def swayed(fast: bool) -> Trial:
    """100 mm at 2 Hz: 1.6 g sideways."""
    return bed(60, 1.0, motions=[(Sway(0.1, 2.0),)])


def dissipated(trial: Trial, course: Course) -> float:
    """Energy (J) that the grains have lost or, with the tank's work, turned into heat until the end."""
    return float(course.work[-1] - (course.energy[-1] - course.energy[0]))


def turned(fast: bool) -> Trial:
    """Half a turn at 270 deg/s about the middle of the floor, and then rest."""
    return bed(60, 1.2, motions=[(Tilt(1.5 * pi, pi),)])


def end_height(trial: Trial, course: Course) -> float:
    """Height (m) of the centre of mass above the floor at the end."""
    return course.last("centre_of_mass")[1]


def upside_down(trial: Trial, course: Course) -> list[Line]:
    """All the grains lie on the lid, which bears their weight."""
    late = course.time > 0.9 * course.time[-1]
    load = float(course.rows["wall_force"][late, 1].mean())
    lid = trial.scene.outline[:, 1].max()
    higher = float((course.position[-1, :, 1] > 0.5 * lid).mean())
    return [
        Line.off(
            "load on the lid in the last tenth (share)", "weight", abs(load / trial.weight - 1.0), 0.02, "bounces"
        ),
        Line.off("grains that are not in the upper half", "0", 1.0 - higher, 0.0, "exact"),
    ]


def slowly_tilted(fast: bool) -> Trial:
    """0.15 deg/s up to 45 deg, softened: at full stiffness it would take sixteen times as many steps."""
    tilt = Tilt(RATE, RATE * LASTING)
    return bed(40, LASTING, diameter=4.0 * RADIUS, looks=3000, stiffness_scale=SOFT, motions=[(tilt,)])


def slid(trial: Trial, course: Course) -> list[Line]:
    """The tank stands at 45 deg at last; no bed of spheres keeps such a slope, so the centre of mass has shifted.

    A bed that has frozen would not shift at all. Courses that start a nanometre apart shift by 0.8 to 1.4 diameters.
    """
    angle = abs(course.last("pose")[2] - RATE * LASTING)
    shift = float(np.ptp(course.rows["centre_of_mass"][..., 0])) / (2.0 * trial.scene.mean_radius)
    return [
        Line.off("angle at the end (rad)", "45 deg", angle, RATE * 0.2, "the ease at its ends"),
        Line.off(
            "missing of a shift by half a diameter", "a slope of 45 deg flows", max(0.0, 0.5 - shift), 0.0, "must flow"
        ),
    ]


CASES = (
    HardCase(
        "sway",
        "60 grains of 3 mm ± 10 % in a tank that sways by 100 mm at 2 Hz, 1 s (reduced: few grains).",
        swayed,
        measure=Measure(
            "energy dissipated (J)", dissipated, 0.1, "single courses scatter by 8 %: 2.6 s.e. of two means", 8
        ),
    ),
    HardCase(
        "turned-over",
        "60 grains of 3 mm ± 10 % in a tank that turns through 180 deg in 0.77 s, 1.2 s (reduced: few grains).",
        turned,
        upside_down,
        Measure("height of the centre of mass at the end (m)", end_height, 0.05, "chaos of a small bed"),
    ),
    HardCase(
        "slow-tilt",
        "40 grains of 6 mm ± 10 % tilted at 0.15 deg/s for 300 s (reduced: stiffness_scale = 1e-3, few and large "
        "grains; not tried at longer steps).",
        slowly_tilted,
        slid,
    ),
)
