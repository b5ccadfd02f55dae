"""Side by side with LIGGGHTS and LAMMPS: simulated seconds a wall second at an equal error of the restitution."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from shutil import rmtree

import numpy as np

from benchmarks.peers.peer import SKIN
from benchmarks.remembered import remembered
from benchmarks.speed import processors
from benchmarks.speed.beds import SCALE, Bed, bed_of_spheres, usual_bed
from benchmarks.speed.equal_error.situations import (
    LEAN,
    LONGEST_STRIDE,
    MIXED,
    SKIN_IN_MOTION,
    SWAY,
    every_situation,
    timed,
)
from benchmarks.speed.equal_error.steps import (
    FINEST,
    LAB,
    LONGEST,
    PAIRS,
    SAME,
    SPEED,
    colliders,
    duration,
    steps_taken,
)
from benchmarks.speed.workers import ratio
from lab.report.page import Page
from lab.studies.engine import code
from solvers.grains.timestep import FURTHEST

OWN = LAB, MIXED, LONGEST
HEADS = "grains", "step by", "bed", "code", "steps a collision", "step (µs)", "simulated s a wall s"


@dataclass(frozen=True)
class Effort:
    """What the study takes: grains of a bed, copies of it in the large one, turns of either.

    At rest a code takes as many steps as make `grain_steps`; what moves is followed for a `course` (s). In the large
    bed each code takes `few_steps`.
    """

    count: int = 2000
    copies: int = 100
    turns: int = 5
    few: int = 3
    grain_steps: float = 5e6
    course: float = 0.02
    few_steps: int = 100
    spheres: bool = False

    @property
    def words(self) -> str:
        """Of what a bed is, beside its situation."""
        return ", spheres in space" if self.spheres else ""

    def bed(self, work: Path) -> Bed:
        """The settled bed."""
        return bed_of_spheres(work, self.count) if self.spheres else usual_bed(work, self.count)

    def steps(self, dt: float) -> float:
        """How long (s) the large bed is followed with steps of dt (s)."""
        return self.few_steps * dt


HASTY = Effort(500, 4, 2, 1, 2e5, 2e-3, 20)


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section on a bed of usual size to the page."""
    effort = HASTY if fast else Effort()
    page.section("Beside other codes at equal error")
    say_how(page, effort)
    report(page, work, effort, 1, fast)


def study_large(page: Page, work: Path, fast: bool) -> None:
    """Add the section on a large bed to the page."""
    effort = HASTY if fast else Effort()
    page.section("Beside other codes at equal error, a large bed")
    page.say(f"""As above, but {effort.copies} copies of the small bed side by side in one tank, for {effort.few_steps}
        steps of each code from the same places and speeds.""")
    report(page, work, effort, effort.copies, fast)


def study_spheres(page: Page, work: Path, fast: bool) -> None:
    """Add the section on spheres in space to the page: a bed of usual size, and ten copies of it."""
    page.section("Beside other codes at equal error, spheres in space")
    page.say("""As above, with equal spheres in a square tank twelve diameters wide, and with ten copies of it side by
        side, for fewer steps.""")
    for copies in (1, 10):
        report(page, work, _of_spheres(fast), copies, fast)


def study_many_spheres(page: Page, work: Path, fast: bool) -> None:
    """Add the section on a large bed in space to the page."""
    page.section("Beside other codes at equal error, a large bed of spheres in space")
    page.say("As above, with a hundred copies of the bed of spheres side by side.")
    report(page, work, _of_spheres(fast), 100, fast)


def _of_spheres(fast: bool) -> Effort:
    return replace(HASTY if fast else Effort(), spheres=True)


def report(page: Page, work: Path, effort: Effort, copies: int, fast: bool) -> None:
    """Time what is not timed yet, and add the table; or say that there is nobody to compare with."""
    codes = colliders()
    if len(codes) == 1:
        page.say("No other code is installed here: the comparison is left out.")
        return
    rows, found = [], []
    kept = work / f"equal-error-{'spheres-' * effort.spheres}{copies}-{code()[:12]}"
    for grains, rule, where, dts, speeds in measured(codes, work, kept, effort, copies):
        for name, values in speeds.items():
            dt = dts[LAB] if name == MIXED else dts[name]
            share, step = f"{duration() / dt:.0f}", f"{1e6 * dt:.2f}"
            times = ["" if own not in speeds or name == own else ratio(speeds[own], values) for own in (LAB, LONGEST)]
            rows.append([f"{grains:,}", rule, where, name, share, step, f"{np.median(values):.3g}", *times])
            if name not in OWN:
                bed = where + effort.words + ("" if copies == 1 else f", {grains:,} grains")
                ours = [own for own in (LAB, LONGEST) if own in speeds]
                found += [kept_ratio(name, rule, bed, speeds[own] / values, own) for own in ours]
    page.table([*HEADS, *(f"{own}: times as fast" for own in (LAB, LONGEST))], rows)
    if not fast:  # too few turns to be kept
        processors.keep(page.folder, found)
        rmtree(kept, ignore_errors=True)  # asked for again, all is timed again


def say_how(page: Page, effort: Effort) -> None:
    """What is compared, in words."""
    page.say(f"""Simulated seconds a wall second, one core, 64 bits where nothing else is said, grains of 3 mm,
        {SCALE:g} of their stiffness, springs with history. All codes take the same step; or each the longest of the
        tried steps at which, and at all shorter ones, the restitution (0.6 at {SPEED:g} m/s) errs by no more than the
        error named: the largest over {PAIRS} moments of onset within a step, against the same code at {FINEST} steps a
        collision. There "{LAB}" takes no longer steps than it derives for such collisions at the levels draft (1 %) and
        standard (0.1 %), since the slip of an undamped contact is to be right, too; "{LONGEST}" does, up to the
        {FURTHEST:g} derived steps of standard that may be forced. While grains are slow, both are up to
        {LONGEST_STRIDE} times as long, as in the lab's runs. In flow the tank leans by {np.degrees(LEAN):g} deg; swayed
        it goes to and fro by {1e3 * SWAY.amplitude:g} mm at {SWAY.frequency:g} Hz. All codes begin with the same moving
        bed and new lists, and follow it for {effort.course:g} s, each turn anew; the other codes' lists have a skin of
        {SKIN:g} mean diameters at rest and {SKIN_IN_MOTION:g} in motion, the fastest.""")


def measured(codes: Mapping[str, Callable], work: Path, kept: Path, effort: Effort, copies: int) -> Iterator[tuple]:
    """What was timed: (grains, rule, bed, steps (s) by code, speeds); `kept` is the folder that spares timing again."""
    bed = effort.bed(work)
    steps = work / f"longest-steps-{'spheres-' * effort.spheres}{code()[:12]}.npz"
    found = remembered(steps, "equal error: steps", lambda: _packed(steps_taken(codes, bed)))
    taken = {rule: dict(zip([*codes, LONGEST], values, strict=True)) for rule, values in found.items()}
    beds = every_situation(bed, work)
    for rule, dts in taken.items():
        for where, one in beds.items():
            many = one.times(copies)
            turns, course = (effort.turns, _course(where, effort)) if copies == 1 else (effort.few, effort.steps)
            said = f"equal error: {many.bed.count} grains {where}, {rule}"
            path = kept / f"{said.removeprefix('equal error: ').replace(' ', '-').replace('%', 'percent')}.npz"
            speeds = remembered(path, said, partial(timed, many, rule, dts, turns, course))
            yield many.bed.count, rule, where, dts, speeds


def _course(where: str, effort: Effort) -> float | Callable[[float], float]:
    """How long (s) a small bed is followed: for so many steps of the code's own, or for a time if it moves."""
    steps = effort.grain_steps / effort.count
    return (lambda dt: steps * dt) if where == "at rest" else effort.course


def _packed(taken: Mapping[str, Mapping[str, float]]) -> dict[str, np.ndarray]:
    return {rule: np.array([*dts.values()]) for rule, dts in taken.items()}


def kept_ratio(name: str, rule: str, where: str, ratios: np.ndarray, own: str = LAB) -> processors.Ratio:
    """What is kept of a comparison of our own step, or LONGEST, with a code."""
    unit = processors.GRAIN_STEPS if rule == SAME else f"simulated seconds at {rule}"
    unit += ", the lab's longest step" if own == LONGEST else ""
    least, most, median = (float(f"{pick(ratios):.3g}") for pick in (np.min, np.max, np.median))
    return processors.Ratio(name, *processors.SPRINGS, where, unit, least, most, median)
