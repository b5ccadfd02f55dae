"""cargolab bench stability: the longest stable step of each integrator under each law, a case an integrator."""

from functools import partial

from benchmarks.stability import limit_case
from lab.studies.case import Case
from lab.studies.suite import Suite
from solvers.grains.integrators import INTEGRATORS
from solvers.machine.quantity import SPACE

IN_SPACE = "verlet", "symplectic-euler"
LIMITS = "Where steps do become unstable"
CASES = tuple(
    Case(f"map-{one}", LIMITS, f"Longest stable steps of {one}", partial(limit_case.check, integrator=one), quick)
    for one, quick in ((name, name == "verlet") for name in INTEGRATORS)
) + tuple(
    Case(
        f"map-space-{one}",
        LIMITS,
        f"Longest stable steps of {one} in space",
        partial(limit_case.check, integrator=one, axes=SPACE),
        quick=False,
    )
    for one in IN_SPACE
)
SUITE = Suite("bench stability", "Stability", CASES, "", {LIMITS: limit_case.SAYS}, shown="limits-verlet")
