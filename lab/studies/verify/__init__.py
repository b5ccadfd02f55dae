"""Verification: small scenes, run as any experiment is, compared with references that do not need the solver.

A case is a function in a module of this package that returns its results, and a line in that module's CASES.
"""

from dataclasses import replace

from lab.preset.accuracy import LEVELS
from lab.studies.case import Case
from lab.studies.suite import Suite
from lab.studies.verify import (
    cohesion,
    columns,
    conservation,
    convergence,
    frames,
    friction,
    rolling,
    sameness,
    turntable,
    water,
    wet,
)
from lab.studies.verify.impacts import chung_ooi, in_space, oblique, restitution

MODULES = (
    chung_ooi,
    in_space,
    restitution,
    oblique,
    friction,
    rolling,
    cohesion,
    columns,
    conservation,
    convergence,
    frames,
    sameness,
    turntable,
    water,
    wet,
)
CASES: tuple[Case, ...] = tuple(case for module in MODULES for case in module.CASES)
SUITE = Suite(
    "verify",
    "The physics against closed forms, independent integrations and published numbers",
    CASES,
    """The references do not use the solver. A tolerance, to either side, is what the physics and the scheme at its step
    allow, not what came out.""",
    water.TEXTS,
)
# Cases whose step is a preset's: those of `impacts` have steps of draft beside the derived ones in any case.
BY_LEVEL = tuple(case for module in MODULES if module not in (*MODULES[:4], water, wet) for case in module.CASES)


def suite_at(level: str) -> Suite:
    """The cases whose step a level of accuracy sets, with a page of their own."""
    longer = LEVELS[level].longer_steps
    about = f"""With the steps of the level {level}, {longer:g} times the derived ones. Tolerances are those of the
    derived steps: what is due to the step may be {longer**2:.2g} times as large here, and its line then fails. What a
    case calls the derived step is the level's."""
    named = {"command": f"verify --level {level}", "title": f"The physics at the level {level}"}
    return replace(SUITE, **named, cases=BY_LEVEL, about=about, texts={}, file=f"verify-{level}")
