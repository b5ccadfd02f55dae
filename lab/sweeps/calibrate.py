"""Calibration: find the value of one key of a preset at which a measure has its target value.

The first round simulates the measure at POINTS values of the key over the whole range, the second at as many around
the value where the mean over the beds meets the target; all values have the same beds. `lab.sweeps.inverse` derives
value and interval from the second round's range. Errors in the request are reported before anything is simulated.
"""

import json
import os
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.files import named
from lab.base.lock import only_one
from lab.preset.fields import dotted_key, taken_by
from lab.preset.find import load
from lab.preset.merge import nested
from lab.preset.schema import Preset
from lab.preset.units import NUMBER, in_unit, quoted
from lab.runs.runner import RENDERS
from lab.sweeps.axes import values
from lab.sweeps.calibration_report import Calibration, Trial, write_report
from lab.sweeps.dry_run import available_measures
from lab.sweeps.grid import define_sweep
from lab.sweeps.inverse import LEAST_BEDS, Response, beds_for, crossings, fitted, misfit, solved
from lab.sweeps.point import Point
from lab.sweeps.report import numeric
from lab.sweeps.request import Request, check_folder, read_request, write_request
from lab.sweeps.sweep import SweepResult, run_sweep

POINTS = 5  # values of the key in a round
CLOSER = 0.25  # half width of the second round's range, relative to the width of the first one's
WITHIN = 0.05  # half width of an interval that counts as narrow, relative to the width of the range
ALIASES = {"repose": ("critical_angle", "heap_angle")}


@dataclass(frozen=True)
class Plan:
    """The parsed request: the values of the first round (`listed`), the target with its standard error and unit."""

    request: Request
    key: str
    unit: str
    listed: list
    overrides: dict
    measure: str
    measure_unit: str
    target: float
    target_error: float

    @property
    def whole(self) -> bool:
        """Whether the key takes whole numbers."""
        taken = taken_by(Preset, self.key)
        return bool(taken) and taken.kind is int

    @property
    def range(self) -> tuple[float, float]:
        """The ends of the range in the key's unit."""
        numbers = numeric(self.listed)[0]
        return float(numbers.min()), float(numbers.max())


def calibrate(
    name: str | Path,
    target: str,
    vary: str,
    overrides: Mapping | None = None,
    out: Path | str | None = None,
    *,
    quiet: bool = False,
    cluster: str | None = None,
) -> Calibration:
    """Find the value of the key in `vary`, "friction=0.2:0.7", at which a measure is as in `target`, "repose=41.3 deg".

    A target may have a standard error, "repose=41.3 ± 0.8 deg". At least LEAST_BEDS beds are run unless `overrides` set
    the number. Writes summary.md, calibration.json, calibration.png and both rounds' sweeps to a folder (default:
    renders/NAME-calibration); called again with the same request, it continues. cluster: as for `run_sweep`. Raises
    LabError, one sentence, if something cannot be read, run or measured, or if no value in the range gives the target;
    and as `run_sweep`.
    """
    preset = os.path.abspath(name) if os.path.isfile(name) else str(name)
    request = Request(preset, target, vary, json.loads(json.dumps(nested(overrides or {}), default=str)))
    folder = named(out) if out is not None else RENDERS / f"{Path(preset).stem}-calibration"
    check_folder(request, folder)  # early, and again under the lock
    plan = parse_request(request)
    try:
        with only_one(folder):
            check_folder(request, folder)
            write_request(request, folder)
            return _run_rounds(plan, folder, quiet, cluster)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"interrupted; continue with: cargolab resume {shlex.quote(str(folder))}") from None


def resume_calibration(folder: Path | str, *, quiet: bool = False) -> Calibration:
    """Continue the calibration in a folder as it was requested. Raises as `calibrate`."""
    request = read_request(Path(folder))
    return calibrate(request.preset, request.target, request.vary, request.overrides, folder, quiet=quiet)


def parse_request(request: Request) -> Plan:
    """Parse and check a request as far as is possible before a run. Raises LabError."""
    name, wanted = _pair("--target", request.target, 'repose="41.3 deg"')
    name = name.replace(" ", "_")  # summaries print it with blanks
    given, span = _pair("--vary", request.vary, "friction=0.2:0.7")
    key = dotted_key(Preset, given)
    listed = _listed(key, span)
    scale = numeric(listed)
    overrides = _with_beds(request)
    points = define_sweep(request.preset, {key: listed}, overrides).points
    measures = available_measures(points[len(points) // 2])
    measure = next((known for known in ALIASES.get(name, (name,)) if known in measures), None)
    if measure is None:
        raise LabError(f"--target: runs of this preset have no {name}; they have {', '.join(measures)}.")
    measure_unit = measures[measure].unit
    goal = _target(wanted, measure_unit)
    return Plan(request, key, scale[1], listed, overrides, measure, measure_unit, *goal)


def _target(text: str, unit: str) -> tuple[float, float]:
    """Parse "41.3 deg" or "41.3 ± 0.8 deg" into value and standard error in `unit`. Raises LabError."""
    value, _, error = (part.strip() for part in text.replace("+-", "±").partition("±"))
    if not error:
        return in_unit(value, unit, "--target"), 0.0
    number = NUMBER.match(error)
    spread = in_unit(error, unit, "--target")
    if spread < 0.0:
        raise LabError(f"--target: a standard error cannot be negative (got {quoted(text)[1:-1]}).")
    if NUMBER.fullmatch(value):  # one unit for both
        value = f"{value} {error[number.end() :].strip()}".strip()
    return in_unit(value, unit, "--target"), spread


def _pair(option: str, text: str, example: str) -> tuple[str, str]:
    left, equals, right = text.partition("=")
    if not (left.strip() and equals and right.strip()):
        raise LabError(f"{option}: {text!r} cannot be read; give e.g. {example}.")
    return left.strip(), right.strip()


def _listed(key: str, span: str) -> list:
    """POINTS values of a range "0.2:0.7" or "1 mm:2 mm" in ascending order, whole numbers if the key takes these."""
    taken = taken_by(Preset, key)
    if taken and taken.kind not in (float, int):
        raise LabError(f"{key}: its value is not a single number, so it cannot be varied over a range.")
    ends = [end.strip() for end in span.split(":")]
    listed = values(key, ":".join([*ends, str(POINTS)])) if len(ends) == 2 and all(ends) else []
    if len(listed) < 2 or numeric(listed) is None:
        raise LabError(f'{key}: a range FROM:TO is needed, e.g. 0.2:0.7 (got "{quoted(span)[1:-1]}").')
    if taken and taken.kind is int:
        return sorted({round(number) for number in numeric(listed)[0].tolist()})
    return sorted(listed, key=lambda value: numeric([value])[0][0])


def _with_beds(request: Request) -> dict:
    """The overrides, with at least LEAST_BEDS beds unless they set the number of beds."""
    run = request.overrides.get("run")
    if isinstance(run, Mapping) and "repeats" in run:
        return request.overrides
    own = load(request.preset, request.overrides).resolved.run.repeats
    return nested({**request.overrides, "run": {**(run or {}), "repeats": max(own, LEAST_BEDS)}})


def _run_rounds(plan: Plan, folder: Path, quiet: bool, cluster: str | None) -> Calibration:
    run = partial(run_sweep, plan.request.preset, video=False, quiet=quiet, cluster=cluster)
    trials = _trials(plan, run({plan.key: plan.listed}, plan.overrides, folder / "round-1"), 1)
    made = _without_result(plan, folder, trials)
    near = _met(made, plan.range)
    around = _around(plan, near)
    if len(around) > 1:
        second = _trials(plan, run({plan.key: around}, plan.overrides, folder / "round-2"), 2)
        known = {point.x for point in trials}
        trials = sorted([*trials, *(point for point in second if point.x not in known)], key=lambda point: point.x)
    half = CLOSER * (plan.range[1] - plan.range[0])
    made = replace(_without_result(plan, folder, trials), window=(near - half, near + half))
    return write_report(_solved(made))


def _trials(plan: Plan, result: SweepResult, number: int) -> list[Trial]:
    """The results of each value of a round."""
    column = next(name for name in result.rows[0] if name.partition(" (")[0] == plan.key)
    found = []
    for row, where in zip(result.rows, result.points, strict=True):
        point = Point({}, where)
        value = point.measures.get(plan.measure)
        stopped = "" if point.status == "complete" else point.status
        beds = tuple(value.worlds) if value and not stopped else ()
        note = stopped or (value.note if value else f"no {plan.measure}")
        found.append(Trial(float(row[column]), f"round-{number}", beds, note))
    return found


def _without_result(plan: Plan, folder: Path, trials: list[Trial]) -> Calibration:
    """A calibration with the values tried, and no result yet."""
    return Calibration(
        folder=folder,
        preset=plan.request.preset,
        key=plan.key,
        unit=plan.unit,
        measure=plan.measure,
        measure_unit=plan.measure_unit,
        target=plan.target,
        target_error=plan.target_error,
        range=plan.range,
        requested_beds=_beds(plan),
        trials=tuple(trials),
    )


def _beds(plan: Plan) -> int:
    return load(plan.request.preset, plan.overrides).resolved.run.repeats


def _met(made: Calibration, span: tuple[float, float]) -> float:
    """The value at which the means of a round meet the target; without one, writes a report and raises LabError."""
    x, means = made.means()
    response = fitted(*made.measures())
    if len(x) < 2 or response is None:
        _give_up(made, "--target: too few of the runs have this measure to calibrate by")
    off = means - made.target
    if off.min() > 0.0 or off.max() < 0.0:
        _give_up(made, made.nowhere())
    roots = crossings(response, made.target)
    if len(roots) > 1:
        listed = " and ".join(f"{root:.3g}" for root in roots)
        _give_up(made, f"--vary: several values of {made.key} give the target, about {listed}; narrow the range")
    if roots:
        return roots[0]
    k = int(np.flatnonzero(off[:-1] * off[1:] <= 0.0)[0])
    return float(x[k] - off[k] * (x[k + 1] - x[k]) / (off[k + 1] - off[k]))


def _around(plan: Plan, near: float) -> list:
    """The values of the second round."""
    low, high = plan.range
    half = CLOSER * (high - low)
    around = np.linspace(max(low, near - half), min(high, near + half), POINTS)
    if plan.whole:
        return sorted({round(value) for value in around.tolist()})
    return [f"{value:.6g} {plan.unit}".strip() if plan.unit else float(f"{value:.6g}") for value in around]


def _solved(made: Calibration) -> Calibration:
    """The calibration with its value and interval. If there is none, writes a report and raises LabError."""
    for near in (made, replace(made, window=None)):  # around the value, else over all values
        x, measures = near.measures()
        response = fitted(x, measures)
        roots = crossings(response, made.target) if response else []
        if len(roots) == 1:
            made = _with_solution(near, response, roots[0], misfit(response, x, measures))
            if near.window is None or made.interval is None or np.isfinite(made.interval).all():
                return made
    if made.value is not None:
        return made
    _give_up(made, made.nowhere())
    return made


def _with_solution(made: Calibration, response: Response, root: float, misfits: list) -> Calibration:
    found = solved(response, made.target, root, made.target_error)
    wanted = WITHIN * (made.range[1] - made.range[0])
    beds_needed = None if found.std is None else beds_for(wanted, found.std)
    return replace(
        made,
        response=response,
        value=root,
        standard_error=found.standard_error,
        std=found.std,
        interval=found.interval,
        beds=found.beds,
        wanted=wanted,
        beds_needed=None if beds_needed is None else max(beds_needed, LEAST_BEDS),
        misfits=tuple(misfits),
        too_few_beds=found.beds < LEAST_BEDS,
    )


def _give_up(made: Calibration, sentence: str) -> None:
    """Write the report of what was tried, and raise LabError."""
    write_report(replace(made, refused=sentence))
    raise LabError(f"{sentence}; see {made.folder / 'summary.md'}.")
