"""A case: what is tried, what is asked of it, and the verdict on what came of it."""

from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np

from lab.bench.stability.trial import Course, Trial, overlap_of

DEEPEST = 0.05  # radii: a contact that is still one of small strain
IMPACTS = 3.0  # Hertz estimates: grains that push from behind deepen an impact
RESTING_ENERGY = 1e-6  # of the scale: the energy that a scheme of second order leaves in contacts, and rounding
MOVING_ENERGY = 1e-3  # of the scale: the tank's work is a sum over looks
NOT_STOPPED = "ran to its end"


@dataclass(frozen=True)
class Check:
    """One line of a verdict: what is compared with which reference, the error and what it may be, and why."""

    what: str
    reference: str
    error: float
    tolerance: float
    why: str

    @property
    def passed(self) -> bool:
        """Whether the error is a number within its tolerance."""
        return self.error <= self.tolerance

    def record(self) -> dict[str, object]:
        """For the JSON file."""
        return {**asdict(self), "passed": self.passed}


@dataclass(frozen=True)
class Measure:
    """The number that a longer step must not change by more than the share `tolerance` of it, and why so much."""

    what: str
    of: Callable[[Trial, Course], float]
    tolerance: float
    why: str


@dataclass(frozen=True)
class Case:
    """A hard case: `make` builds its trial, fast or in full; `ask` checks what is particular to it.

    Without a measure it is not tried at longer steps. `fast`: whether it belongs to what takes seconds. `may_stop`: a
    sentence of the watch is an answer, too. `energy` is what it may make of its scale, None: the usual.
    """

    name: str
    says: str
    make: Callable[[bool], Trial]
    ask: Callable[[Trial, Course], list[Check]] = lambda trial, course: []
    measure: Measure | None = None
    fast: bool = False
    may_stop: bool = False
    energy: float | None = None


def made_energy(trial: Trial, course: Course) -> float:
    """The largest rise of the energy less the tank's work above any earlier value, as a share of the scale.

    The scale is the energy at the start, weight counted from the tank's lowest point, and the range of the work.
    """
    left = course.energy - course.work
    rise = np.max(left - np.minimum.accumulate(left))
    rows = course.rows
    start = course.energy[0] - rows["potential"][0] + trial.weight * trial.depth
    return float(rise / (start + np.ptp(course.work)))


def judge(case: Case, trial: Trial, course: Course) -> list[Check]:
    """All checks of a course at the reference step."""
    if case.may_stop and course.stopped:
        return []
    checks = [_finished(course)]
    if len(course.time):
        checks += [_overlap(trial, course), _energy(case, trial, course)]
    return checks if course.stopped else checks + case.ask(trial, course)


def _finished(course: Course) -> Check:
    """The watch, which sees grains that escape and numbers that are none, has not stopped it."""
    stopped = float("inf") if course.stopped else 0.0
    return Check("the run", "its end", stopped, 0.0, course.stopped or "nobody escaped, all numbers finite")


def _overlap(trial: Trial, course: Course) -> Check:
    estimate = IMPACTS * overlap_of(trial.scene, trial.scene.credible_speed(), trial.load)
    bound = min(DEEPEST, estimate)
    what, why = "largest overlap (radii)", "5 % is small strain" if bound == DEEPEST else "3 times Hertz's estimate"
    return Check(what, "0", float(course.rows["overlap"].max()), bound, why)


def _energy(case: Case, trial: Trial, course: Course) -> Check:
    moves = bool(trial.scene.motions[0])
    usual = MOVING_ENERGY if moves else RESTING_ENERGY
    why = "work summed over looks" if moves else "scheme O(Δt²), rounding"
    bound = usual if case.energy is None else case.energy
    return Check("energy made (share)", "start and work of the tank", made_energy(trial, course), bound, why)
