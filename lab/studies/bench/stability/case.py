"""A hard case: its trial, its checks, and the verdict on the result."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lab.studies.bench.stability.trial import Course, Trial, overlap_of
from lab.studies.case import Line

OVERLAP, ENERGY = "largest overlap (radii)", "energy made (share)"  # checks that every case has
DEEPEST = 0.05  # radii: a contact of small strain, which Hertz's law is for
IMPACTS = 3.0  # Hertz estimates: grains that push from behind deepen an impact
RESTING_ENERGY = 1e-6  # of the scale: what a scheme of second order errs by in contacts, and rounding
MOVING_ENERGY = 1e-3  # of the scale: the tank's work is a sum over looks


@dataclass(frozen=True)
class Measure:
    """The number that a longer step must not change by more than the share `tolerance` of it, and why so much.

    In a chaotic case it is the mean over `starts`, which differ by a nanometre: a single course is as good as a draw.
    """

    what: str
    of: Callable[[Trial, Course], float]
    tolerance: float
    why: str
    starts: int = 1


@dataclass(frozen=True)
class HardCase:
    """A hard case: `make` builds its trial, in full or fast; `ask` checks what is particular to it.

    Without a measure it is not tried at longer steps. `fast`: whether it belongs to what takes seconds. `may_stop`: a
    sentence of the watch is an answer, too. `energy`: the share of the scale that it may make, and why, if not the
    usual.
    """

    name: str
    says: str
    make: Callable[[bool], Trial]
    ask: Callable[[Trial, Course], list[Line]] = lambda trial, course: []
    measure: Measure | None = None
    fast: bool = False
    may_stop: bool = False
    energy: tuple[float, str] | None = None


def judge(case: HardCase, trial: Trial, course: Course) -> list[Line]:
    """All checks of a course at the automatic step."""
    if case.may_stop and course.stopped:
        return [Line.off("the run", "its end, or a sentence", 0.0, 0.0, course.stopped)]
    checks = [_finished(course)]
    if len(course.time):
        checks += [_overlap(trial, course), _energy(case, trial, course)]
    return checks if course.stopped else checks + case.ask(trial, course)


def made_energy(trial: Trial, course: Course) -> float:
    """The largest rise of the energy less the tank's work above any earlier value, as a share of the scale.

    The scale is the energy at the start, weight counted from the tank's lowest point, and the range of the work.
    """
    left = course.energy - course.work
    rise = np.max(left - np.minimum.accumulate(left))
    start = course.energy[0] - course.rows["potential"][0] + trial.weight * trial.height
    return float(rise / (start + np.ptp(course.work)))


def energy_bound(case: HardCase, trial: Trial) -> tuple[float, str]:
    """The share of the scale that may be made, and why."""
    if case.energy:
        return case.energy
    if trial.scene.motions[0]:
        return MOVING_ENERGY, "work summed over looks"
    return RESTING_ENERGY, "scheme O(Δt²), rounding"


def _finished(course: Course) -> Line:
    """The watch, which sees grains that escape and numbers that are none, has not stopped it."""
    why = course.stopped or "nobody escaped, all numbers finite"
    return Line.off("the run", "its end", 1.0 if course.stopped else 0.0, 0.0, why)


def _overlap(trial: Trial, course: Course) -> Line:
    speed = trial.scene.credible_speed()
    estimate = IMPACTS * overlap_of(trial.scene, speed, trial.load)
    bound = min(DEEPEST, estimate)
    why = "small strain" if bound == DEEPEST else f"3 times Hertz's at {speed:.3g} m/s"
    return Line.off(OVERLAP, "0", float(course.rows["overlap"].max()), bound, why)


def _energy(case: HardCase, trial: Trial, course: Course) -> Line:
    reference = "start and work of the tank" if trial.scene.motions[0] else "start"
    return Line.off(ENERGY, reference, made_energy(trial, course), *energy_bound(case, trial))
