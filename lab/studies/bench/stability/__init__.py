"""cargolab bench stability: hard cases at the automatic step and far beyond it, and the true limit of stability.

CASES and MAPS name the tests: the cases, and each integrator's part of the map of limits. Results are kept in
stability.json and not run again where they are from the same code and the same choice of fast or full.
"""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from lab.studies.bench.stability import hard_beds, hard_few, hard_moving, hard_starts, limit_map
from lab.studies.bench.stability.case import ENERGY, OVERLAP, Case, Check, judge
from lab.studies.bench.stability.pushed import push
from lab.studies.bench.stability.report import write_page
from lab.studies.bench.stability.trial import follow
from lab.studies.engine import Kept, choose, word
from solvers.grains.integrators import INTEGRATORS
from solvers.simulation import Simulation

CASES = {case.name: case for cases in (hard_few, hard_beds, hard_moving, hard_starts) for case in cases.CASES}
MAPS = {f"map-{integrator}": integrator for integrator in INTEGRATORS}
FAST_MAP = "map-verlet"


def run_cases(names: Sequence[str], out: Path | str, fast: bool, page_only: bool = False) -> bool:
    """Run the cases that begin like one of `names`, or without names all that are not kept; whether all pass.

    Every line is printed, and the page written. A case that breaks off fails, and the others go on. `page_only`:
    nothing is run. Raises LabError for a name that is none.
    """
    quick = {name for name, case in CASES.items() if case.fast} | {FAST_MAP}
    chosen = choose(names, [*CASES, *MAPS], "case", quick if fast else None)
    kept, broken = Kept(Path(out) / "stability.json", "bench stability", {"fast": fast}), False
    for name in kept.missing([] if page_only else chosen, anew=bool(names)):
        if record := _attempt(name, fast):
            kept.keep(name, record)
        else:
            broken = True
            kept.drop(name)
    shown = kept.shown([*CASES, *MAPS])
    write_page(Path(out), kept.shown(CASES), kept.shown(MAPS))
    return not broken and all(shown[name]["passed"] for name in chosen if name in shown)


def _attempt(name: str, fast: bool) -> dict[str, object] | None:
    """The record of a case or a part of the map; None, and a line, where it breaks off."""
    try:
        return _run_map(MAPS[name], fast) if name in MAPS else run_case(CASES[name], fast)
    except Exception as error:  # whatever it is, the other cases are worth running
        print(f"{name}: FAIL, broke off: {type(error).__name__}: {error}", flush=True)
        return None


def run_case(case: Case, fast: bool) -> dict[str, object]:
    """The record of a case at the automatic step and, if it has a measure and ran to its end, at longer ones."""
    trial = case.make(fast)
    run = Simulation(trial.scene, trial.position[None], 1, arch="cpu")
    try:
        course = follow(run, trial, trial.scene.time_step())
        checks = judge(case, trial, course)
        for check in checks:
            print(_line(case.name, check), flush=True)
        pushed = []
        if case.measure and not course.stopped:
            for row in push(run, case, trial, course, fast):
                said = f"{row.outcome}: {row.said}"
                print(f"{case.name}, {row.factor:g} times the limit: {word(row.passed)}, {said}", flush=True)
                pushed.append({**asdict(row), "passed": row.passed})
    finally:
        run.close()
    by_name = {check.what: check.error for check in checks}
    return {
        "says": case.says,
        "grains": trial.count,
        "time": float(course.time[-1]) if len(course.time) else 0.0,
        "step": course.step,
        "overlap": by_name.get(OVERLAP),
        "energy": by_name.get(ENERGY),
        "checks": [{**asdict(check), "passed": check.passed} for check in checks],
        "pushed": pushed,
        "passed": all(check.passed for check in checks) and all(row["passed"] for row in pushed),
    }


def _line(name: str, check: Check) -> str:
    error = f"error {check.error:.3g}, tolerance {check.tolerance:.3g}"
    return f"{name}: {word(check.passed)}, {check.what} against {check.reference}: {error} ({check.why})"


def _run_map(integrator: str, fast: bool) -> dict[str, object]:
    """The record of one integrator's part of the map."""
    rows = []
    for found in limit_map.found(integrator, fast):
        laws = found.normal if found.tangential == "none" else f"{found.normal} and {found.tangential}"
        what = f"{laws}, {found.damping}: longest stable step {found.ratio:.3g} derived steps"
        print(f"map-{integrator}: {word(found.passed)}, {what}", flush=True)
        rows.append(found.record())
    return {"rows": rows, "passed": all(row["passed"] and row["exact_passed"] for row in rows)}
