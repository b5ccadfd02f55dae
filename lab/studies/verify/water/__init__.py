"""Water against closed forms: rest, waves, sloshing, viscous flow, free drops, and what must be kept."""

from lab.studies.case import Case
from lab.studies.verify.water import air, balance, bubbles, drops, patch, rest, sloshing, vortices, waves

MODULES = (rest, waves, sloshing, vortices, drops, patch, balance, air, bubbles)
CASES: tuple[Case, ...] = tuple(case for module in MODULES for case in module.CASES)
