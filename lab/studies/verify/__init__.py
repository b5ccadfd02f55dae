"""Verification: small scenes, run as any experiment is, compared with references that do not need the solver.

A case is a function in a module of this package that returns its results, and a line in that module's CASES.
"""

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from lab.studies.engine import Kept, choose
from lab.studies.verify import (
    chung_ooi,
    cohesion,
    collisions,
    columns,
    conservation,
    convergence,
    frames,
    friction,
    oblique,
    restitution,
    rolling,
    sameness,
)
from lab.studies.verify.case import Case, Outcome
from lab.studies.verify.report import record, show, write_page

MODULES = (
    chung_ooi,
    collisions,
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
)
CASES: tuple[Case, ...] = tuple(case for module in MODULES for case in module.CASES)


def run_cases(names: Sequence[str], out: Path | str, fast: bool, page_only: bool = False) -> bool:
    """Run the cases whose names begin with any of `names`, or without names all that are not kept; whether all passed.

    They are printed, kept in verify.json and written on the page. With `fast` only what takes seconds; `page_only`:
    nothing is run. A case that fails or breaks does not stop the others. Raises LabError for a name that no case begins
    with.
    """
    chosen, console = {case.name: case for case in select(names, fast)}, Console(highlight=False)
    kept = Kept(Path(out) / "verify.json", "verify", {"fast": fast})
    for name in kept.missing([] if page_only else chosen, anew=bool(names)):
        outcome = carried_out(chosen[name], fast)
        show(outcome, console)
        kept.keep(name, record(outcome, Path(out)))
    shown = kept.shown([case.name for case in CASES])
    page = write_page(shown, Path(out))
    done = [name for name in chosen if name in shown]
    bad = [name for name in done if not shown[name]["passed"]]
    console.print(f"failed: {', '.join(bad)}" if bad else f"all {len(done)} cases passed", soft_wrap=True)
    console.print(str(page), soft_wrap=True)
    return not bad


def select(names: Sequence[str], fast: bool) -> list[Case]:
    """The cases whose names begin with any of `names`, all where there are none; with `fast` the quick ones.

    Raises LabError for a name that no such case begins with.
    """
    possible = {case.name: case for case in CASES if case.quick or not fast}
    return [possible[name] for name in choose(names, possible, "fast case" if fast else "case")]


def carried_out(case: Case, fast: bool) -> Outcome:
    """Run a case and return its outcome; an exception counts as one."""
    try:
        return Outcome(case, case.check(fast))
    except Exception as error:
        return Outcome(case, fault=f"{type(error).__name__}: {error}")
