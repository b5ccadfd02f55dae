"""Side by side with LIGGGHTS and LAMMPS: simulated seconds a wall second at an equal error of the restitution."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lab.report.page import Page
from lab.studies.bench.remembered import remembered
from lab.studies.bench.speed import processors
from lab.studies.bench.speed.beds import SCALE, usual_bed
from lab.studies.bench.speed.equal_error.situations import (
    LEAN,
    LONGEST_STRIDE,
    MIXED,
    SWAY,
    Situation,
    every_situation,
    timed,
)
from lab.studies.bench.speed.equal_error.steps import (
    FINEST,
    LAB,
    PAIRS,
    SAME,
    SPEED,
    colliders,
    duration,
    steps_taken,
)
from lab.studies.bench.speed.workers import Speeds, ratio
from lab.studies.engine import code

OWN = LAB, MIXED


@dataclass(frozen=True)
class Effort:
    """What the study takes: grains of a bed, copies of it in the large one, turns of either.

    At rest a code takes as many steps as make `grain_steps`, of the large bed too; what moves is followed for a
    `course` (s).
    """

    count: int = 2000
    copies: int = 100
    turns: int = 5
    few: int = 3
    grain_steps: float = 5e6
    large: float = 2e7
    course: float = 0.02


HASTY = Effort(500, 4, 2, 1, 2e5, 2e5, 2e-3)


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    codes, effort = colliders(), HASTY if fast else Effort()
    page.section("Beside other codes at equal error")
    if len(codes) == 1:
        page.say("No other code is installed here: the comparison is left out.")
        return
    say_how(page, effort)
    rows, found = [], []
    kept = work / f"equal-error-{code()[:12]}"
    for grains, rule, where, dts, speeds in measured(codes, work, kept, effort):
        for name, values in speeds.items():
            dt = dts[LAB] if name in OWN else dts[name]
            share, step = f"{duration() / dt:.0f}", f"{1e6 * dt:.2f}"
            times = "" if name == LAB else ratio(speeds[LAB], values)
            rows.append([f"{grains:,}", rule, where, name, share, step, f"{np.median(values):.3g}", times])
            if name not in OWN:
                bed = where if grains == effort.count else f"{where}, {grains:,} grains"
                found.append(kept_ratio(name, rule, bed, speeds[LAB] / values))
    heads = "grains", "step by", "bed", "code", "steps a collision", "step (µs)", "simulated s a wall s"
    page.table([*heads, "lab: times as fast"], rows)
    if not fast:  # too few turns to be kept
        processors.keep(page.folder, found)


def say_how(page: Page, effort: Effort) -> None:
    """What is compared, in words."""
    page.say(f"""Simulated seconds a wall second, one core, 64 bits where nothing else is said, grains of 3 mm,
        {SCALE:g} of their stiffness, springs with history. All codes take the same step; or each the longest of the
        tried steps at which, and at all shorter ones, the restitution (0.6 at {SPEED:g} m/s) errs by no more than the
        error named: the largest over {PAIRS} moments of onset within a step, against the same code at {FINEST} steps a
        collision. There the lab takes no longer steps than it derives for such collisions at the levels draft (1 %) and
        standard (0.1 %), although this collision would allow them; while grains are slow, they are up to
        {LONGEST_STRIDE} times as long, as in its runs. In flow the tank leans by {np.degrees(LEAN):g} deg; swayed it
        goes to and fro by {1e3 * SWAY.amplitude:g} mm at {SWAY.frequency:g} Hz. All codes begin with the same moving
        bed, and follow it for {effort.course:g} s, each turn anew. The large bed is {effort.copies} copies of the small
        one side by side in one tank.""")


def measured(codes: Mapping[str, Callable], work: Path, kept: Path, effort: Effort) -> Iterator[tuple]:
    """What was timed: (grains, rule, bed, steps (s) by code, speeds); `kept` is the folder that spares timing again."""
    found = remembered(kept / "steps.npz", "equal error: steps", lambda: _packed(steps_taken(codes)))
    taken = {rule: dict(zip(codes, values, strict=True)) for rule, values in found.items()}
    beds = every_situation(usual_bed(work, effort.count), work)
    for rule, dts in taken.items():
        for where, one in beds.items():
            course = _course(where, effort.grain_steps / effort.count, effort.course)
            yield effort.count, rule, where, dts, _timed(kept, one, (rule, where), dts, effort.turns, course)
    rule = next(rule for rule in taken if rule != SAME)
    for where in ("at rest", "in flow"):
        one = beds[where].times(effort.copies)
        course = _course("at rest", effort.large / one.bed.count, 0.0)
        speeds = _timed(kept, one, (rule, where), taken[rule], effort.few, course)
        yield one.bed.count, rule, where, taken[rule], speeds


def _course(where: str, steps: float, moving: float) -> float | Callable[[float], float]:
    """How long (s) a bed is followed: for so many steps of the code's own, or for a time if it moves."""
    return (lambda dt: steps * dt) if where == "at rest" else moving


def _packed(taken: Mapping[str, Mapping[str, float]]) -> dict[str, np.ndarray]:
    return {rule: np.array([*dts.values()]) for rule, dts in taken.items()}


def _timed(kept: Path, one: Situation, named: tuple, dts: Mapping[str, float], turns: int, course: object) -> Speeds:
    rule, where = named
    stretch = 1 if rule == SAME else LONGEST_STRIDE
    said = f"equal error: {one.bed.count} grains {where}, {rule}"
    path = kept / f"{said.removeprefix('equal error: ').replace(' ', '-').replace('%', 'percent')}.npz"
    return remembered(path, said, lambda: timed(one, dts, turns, course, stretch))


def kept_ratio(name: str, rule: str, where: str, ratios: np.ndarray) -> processors.Ratio:
    """What is kept of a comparison with a code."""
    unit = processors.GRAIN_STEPS if rule == SAME else f"simulated seconds at {rule}"
    least, most, median = (float(f"{pick(ratios):.3g}") for pick in (np.min, np.max, np.median))
    return processors.Ratio(name, *processors.SPRINGS, where, unit, least, most, median)
