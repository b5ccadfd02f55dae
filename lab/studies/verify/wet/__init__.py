"""Wet cargo against closed forms: a grain, suspensions, beds that water flows through, and beds at rest."""

from lab.studies.case import Case
from lab.studies.verify.wet import consolidation, fluidised, grain, percolation, rest, settling

MODULES = (grain, settling, percolation, fluidised, consolidation, rest)
CASES: tuple[Case, ...] = tuple(case for module in MODULES for case in module.CASES)
