"""Repeat a case with longer steps than the derived one: still right, stopped by the watch, or silently wrong.

Presets cannot force steps beyond `lab.preset.accuracy.FURTHEST` times the limit. Such steps are run here all the same,
to show what they would give.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from lab.preset.accuracy import FURTHEST
from lab.studies.bench.stability.case import HardCase, energy_bound, made_energy
from lab.studies.bench.stability.trial import Course, Trial, follow
from solvers.simulation import Simulation

FACTORS = (2, 5, 10, 20, 50)  # times the derived limit
FAST_FACTORS = (5, 50)
NUDGE = 1e-9  # m
RIPPLE = 0.01  # of the scale: with few steps a contact the scheme's own energy ripples while grains touch
STOPPED, RIGHT, WRONG = "stopped by the watch", "still right", "quietly wrong"
REFUSED = "refused by the app; it would be "


@dataclass(frozen=True)
class Pushed:
    """What came of a case with a step of `factor` times the limit: its measure beside that at the automatic step."""

    factor: float
    step: float
    outcome: str
    value: float
    reference: float
    tolerance: float
    energy: float
    said: str

    @property
    def passed(self) -> bool:
        """Whether the result does not mislead: there is no number, or it is right."""
        return self.outcome != WRONG


def push(run: Simulation, case: HardCase, trial: Trial, course: Course, fast: bool) -> Iterator[Pushed]:
    """The case at every factor; `course` is that at the automatic step."""
    limit, reference = trial.scene.step_limits()[0].step, measured(run, case, trial, course)
    for factor in FAST_FACTORS if fast else FACTORS:
        longer = follow(run, trial, factor * limit)
        value = float("nan") if longer.stopped else measured(run, case, trial, longer)
        yield verdict(case, trial, longer, factor, value, reference)


def measured(run: Simulation, case: HardCase, trial: Trial, course: Course) -> float:
    """The case's measure: of a course, or the mean over all starts with the course's step, its own included."""
    found = [case.measure.of(trial, course)]
    for number in range(1, case.measure.starts):
        start = nudged(trial, number)
        other = follow(run, start, course.step)
        if not other.stopped:
            found.append(case.measure.of(start, other))
    return sum(found) / len(found)


def nudged(trial: Trial, number: int) -> Trial:
    """The trial with its grains up to a nanometre off, to sides drawn from the seed `number`."""
    off = np.random.default_rng(number).uniform(-NUDGE, NUDGE, trial.position.shape)
    return replace(trial, position=trial.position + off)


def verdict(case: HardCase, trial: Trial, course: Course, factor: float, value: float, reference: float) -> Pushed:
    """Refused, stopped, right within the measure's tolerance and with no energy made beyond a ripple, or neither."""
    if course.stopped:
        return Pushed(factor, course.step, STOPPED, float("nan"), reference, 0.0, float("nan"), course.stopped)
    energy = made_energy(trial, course)
    near = abs(value - reference) <= case.measure.tolerance * abs(reference)
    keeps = energy <= max(RIPPLE, energy_bound(case, trial)[0])
    said = f"{100.0 * (value / reference - 1.0):+.2g} % of {case.measure.what}"
    outcome = (REFUSED if factor > FURTHEST else "") + (RIGHT if near and keeps else WRONG)
    return Pushed(factor, course.step, outcome, value, reference, case.measure.tolerance, energy, said)
