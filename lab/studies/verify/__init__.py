"""Verification: small scenes, run as any experiment is, compared with references that do not need the solver.

A case is a function in a module of this package that returns its results, and a line in that module's CASES.
"""

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
    water,
)
from lab.studies.verify.impacts import chung_ooi, oblique, restitution

MODULES = (
    chung_ooi,
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
    water,
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
