"""cargolab bench stability: hard cases at the automatic step and far beyond it, and the true limit of stability.

The hard cases are in the modules `hard_…`; each integrator's part of the map of limits is a case, too. The same list is
run by slow tests.
"""

from functools import partial

from lab.preset.accuracy import FURTHEST
from lab.studies.bench.stability import hard_beds, hard_few, hard_moving, hard_starts, limit_case
from lab.studies.bench.stability.case import DEEPEST, IMPACTS, HardCase, judge
from lab.studies.bench.stability.pushed import RIPPLE, Pushed, push
from lab.studies.bench.stability.trial import follow
from lab.studies.case import Case, Found, Line, Table
from lab.studies.engine import word
from lab.studies.suite import Suite
from solvers.grains.integrators import INTEGRATORS
from solvers.simulation import Simulation

HARD, LIMITS = "Hard cases", "Where steps do become unstable"
SAYS = f"""At the step that the lab derives and, where nothing else is said, at full stiffness. Each is to run to its
end: nobody escapes and no number is not one. Overlaps, the largest at any look, count in radii of the smallest grain
and are to stay below {100 * DEEPEST:g} % and below {IMPACTS:g} times Hertz's estimate of the hardest impact (of the
largest grain upon the smallest at the highest credible speed) or of the weight. The energy made is the largest rise
of the energy (kinetic, rotational, potential and elastic, in the earth's frame), less the work of the tank's motion,
above any earlier value, as a share of the energy at the start. Tables: the same with the step forced to multiples of
the derived limit. The app refuses more than {FURTHEST:g} times the limit; what would come of it is shown all the
same. Still right: the measure within its tolerance of that at the automatic step, and no energy made beyond
{100 * RIPPLE:g} % of the scale, the ripple of the scheme while grains touch. What is neither right nor stopped
misleads, and fails. The height of a settled bed says little of its restitution; one-grain does."""
PUSHED = ("times the limit", "step (µs)", "tolerance", "energy error", "outcome", "what it was", "verdict")


def check(hard: HardCase, fast: bool) -> Found:
    """A hard case at the automatic step and, if it has a measure and ran to its end, at longer ones."""
    trial = hard.make(fast)
    run = Simulation(trial.scene, trial.position[None], 1, arch="cpu")
    try:
        course = follow(run, trial, trial.scene.time_step())
        lines = judge(hard, trial, course)
        longer = list(push(run, hard, trial, course, fast)) if hard.measure and not course.stopped else []
    finally:
        run.close()
    lines += [_misleads(row) for row in longer]
    time = course.time[-1] if len(course.time) else 0.0
    note = f"{trial.count} grain{'s' if trial.count > 1 else ''}, {time:.3g} s, steps of {1e6 * course.step:.3g} µs."
    return Found(lines, notes=[note], tables=[Table(PUSHED, [_row(row) for row in longer])] if longer else [])


def _misleads(row: Pushed) -> Line:
    said = f"wrong results at {row.factor:g} times the limit"
    return Line.off(said, "right, or stopped", 0.0 if row.passed else 1.0, 0.0, f"{row.outcome}: {row.said}")


def _row(row: Pushed) -> tuple[str, ...]:
    tolerance = f"{100 * row.tolerance:g} %" if row.tolerance else ""
    energy = "none" if row.energy != row.energy else f"{row.energy:.3g}"
    return f"{row.factor:g}", f"{1e6 * row.step:.3g}", tolerance, energy, row.outcome, row.said, word(row.passed)


ALL = (*hard_few.CASES, *hard_beds.CASES, *hard_moving.CASES, *hard_starts.CASES)
CASES = tuple(Case(hard.name, HARD, hard.says, partial(check, hard), hard.fast) for hard in ALL)
CASES += tuple(
    Case(f"map-{name}", LIMITS, f"Longest stable steps of {name}", partial(limit_case.check, integrator=name), quick)
    for name, quick in ((one, one == "verlet") for one in INTEGRATORS)
)
SUITE = Suite("bench stability", "Stability", CASES, "", {HARD: SAYS, LIMITS: limit_case.SAYS})
