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
from lab.preset.find import load
from lab.preset.merge import nested
from lab.preset.reader import dotted_key, taken_by
from lab.preset.schema import Given
from lab.preset.units import NUMBER, in_unit, quoted
from lab.runs.runner import RENDERS
from lab.sweeps.asked import Asked, check_folder, read_asked, write_asked
from lab.sweeps.axes import values
from lab.sweeps.calibration_report import Calibration, Tried, write_report
from lab.sweeps.inverse import LEAST_BEDS, Response, beds_for, crossings, fitted, misfit, solved
from lab.sweeps.rehearsal import rehearsed
from lab.sweeps.report import Point, numeric
from lab.sweeps.sweep import SweepResult, ask, run_sweep

POINTS = 5  # values of the key in a round
CLOSER = 0.25  # half the width of the second round's range, over the first one's range
WITHIN = 0.05  # half the width of an interval that counts as narrow, over the range
ALIASES = {"repose": ("critical_angle", "heap_angle")}


@dataclass(frozen=True)
class Plan:
    """The parsed request: the values of the first round, the target (with its standard error), its unit."""

    asked: Asked
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
        taken = taken_by(Given, self.key)
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

    A target may have a standard error, "repose=41.3 ± 0.8 deg". Unless `overrides` say otherwise, at least LEAST_BEDS
    beds are run. Writes summary.md, calibration.json, calibration.png and both rounds' sweeps to a folder (default:
    renders/NAME-calibration); called again with the same request, it continues. cluster: as for `run_sweep`. Raises
    LabError, one sentence, if something cannot be read, run or measured, or if no value in the range gives the target;
    and as `run_sweep`.
    """
    preset = os.path.abspath(name) if os.path.isfile(name) else str(name)
    asked = Asked(preset, target, vary, json.loads(json.dumps(nested(overrides or {}), default=str)))
    folder = Path(out) if out is not None else RENDERS / f"{Path(preset).stem}-calibration"
    check_folder(asked, folder)
    plan = understood(asked)
    write_asked(asked, folder)
    try:
        return _carried_out(plan, folder, quiet, cluster)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"interrupted; go on with: cargolab resume {shlex.quote(str(folder))}") from None


def resume_calibration(folder: Path | str, *, quiet: bool = False) -> Calibration:
    """Continue the calibration in a folder as it was requested. Raises as `calibrate`."""
    asked = read_asked(Path(folder))
    return calibrate(asked.preset, asked.target, asked.vary, asked.overrides, folder, quiet=quiet)


def understood(asked: Asked) -> Plan:
    """Parse and check a request as far as is possible before a run. Raises LabError."""
    said, wanted = _pair("--target", asked.target, 'repose="41.3 deg"')
    given, span = _pair("--vary", asked.vary, "friction=0.2:0.7")
    key = dotted_key(Given, given)
    listed = _listed(key, span)
    scale = numeric(listed)
    overrides = _with_beds(asked)
    points = ask(asked.preset, {key: listed}, overrides).points
    measures = rehearsed(points[len(points) // 2])
    measure = next((name for name in ALIASES.get(said, (said,)) if name in measures), None)
    if measure is None:
        raise LabError(f"--target: runs of this preset have no {said}; they have {', '.join(measures)}.")
    measure_unit = measures[measure].unit
    goal = _target(wanted, measure_unit)
    return Plan(asked, key, scale[1], listed, overrides, measure, measure_unit, *goal)


def _target(text: str, unit: str) -> tuple[float, float]:
    """Parse "41.3 deg" or "41.3 ± 0.8 deg" into value and standard error in `unit`. Raises LabError."""
    value, _, error = (part.strip() for part in text.replace("+-", "±").partition("±"))
    if not error:
        return in_unit(value, unit, "--target"), 0.0
    number = NUMBER.match(error)
    spread = in_unit(error, unit, "--target")
    if spread < 0.0:
        raise LabError(f"--target: a standard error is not negative (got {quoted(text)[1:-1]}).")
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
    taken = taken_by(Given, key)
    if taken and taken.kind not in (float, int):
        raise LabError(f"{key}: takes no single number, so no range of it can be varied.")
    ends = [end.strip() for end in span.split(":")]
    listed = values(key, ":".join([*ends, str(POINTS)])) if len(ends) == 2 and all(ends) else []
    if len(listed) < 2 or numeric(listed) is None:
        raise LabError(f'{key}: a range FROM:TO is needed, e.g. 0.2:0.7 (got "{quoted(span)[1:-1]}").')
    if taken and taken.kind is int:
        return sorted({round(number) for number in numeric(listed)[0].tolist()})
    return sorted(listed, key=lambda value: numeric([value])[0][0])


def _with_beds(asked: Asked) -> dict:
    """The overrides, with as many beds as an interval needs unless they set the number of beds."""
    run = asked.overrides.get("run")
    if isinstance(run, Mapping) and "repeats" in run:
        return asked.overrides
    own = load(asked.preset, asked.overrides).resolved.run.repeats
    return nested({**asked.overrides, "run": {**(run or {}), "repeats": max(own, LEAST_BEDS)}})


def _carried_out(plan: Plan, folder: Path, quiet: bool, cluster: str | None) -> Calibration:
    run = partial(run_sweep, plan.asked.preset, video=False, quiet=quiet, cluster=cluster)
    tried = _tried(plan, run({plan.key: plan.listed}, plan.overrides, folder / "round-1"), 1)
    made = _empty(plan, folder, tried)
    near = _met(made, plan.range)
    around = _around(plan, near)
    if len(around) > 1:
        second = _tried(plan, run({plan.key: around}, plan.overrides, folder / "round-2"), 2)
        known = {point.x for point in tried}
        tried = sorted([*tried, *(point for point in second if point.x not in known)], key=lambda point: point.x)
    half = CLOSER * (plan.range[1] - plan.range[0])
    made = replace(_empty(plan, folder, tried), window=(near - half, near + half))
    return write_report(_solved(made))


def _tried(plan: Plan, result: SweepResult, number: int) -> list[Tried]:
    """The results of each value of a round."""
    column = next(name for name in result.rows[0] if name.partition(" (")[0] == plan.key)
    found = []
    for row, where in zip(result.rows, result.points, strict=True):
        point = Point({}, where)
        value = point.measures.get(plan.measure)
        stopped = "" if point.status == "complete" else point.status
        beds = tuple(value.worlds) if value and not stopped else ()
        note = stopped or (value.note if value else f"no {plan.measure}")
        found.append(Tried(float(row[column]), f"round-{number}", beds, note))
    return found


def _empty(plan: Plan, folder: Path, tried: list[Tried]) -> Calibration:
    """A calibration with the values tried, and no result yet."""
    return Calibration(
        folder=folder,
        preset=plan.asked.preset,
        key=plan.key,
        unit=plan.unit,
        measure=plan.measure,
        measure_unit=plan.measure_unit,
        target=plan.target,
        target_error=plan.target_error,
        range=plan.range,
        asked_beds=_beds(plan),
        tried=tuple(tried),
    )


def _beds(plan: Plan) -> int:
    return load(plan.asked.preset, plan.overrides).resolved.run.repeats


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
        told = " and ".join(f"{root:.3g}" for root in roots)
        _give_up(made, f"--vary: about {told} of {made.key} give the target alike; narrow the range to one of them")
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


def _with_solution(made: Calibration, response: Response, root: float, beside: list) -> Calibration:
    found = solved(response, made.target, root, made.target_error)
    wanted = WITHIN * (made.range[1] - made.range[0])
    enough = None if found.std is None else beds_for(wanted, found.std)
    return replace(
        made,
        response=response,
        value=root,
        standard_error=found.standard_error,
        std=found.std,
        interval=found.interval,
        beds=found.beds,
        wanted=wanted,
        enough=None if enough is None else max(enough, LEAST_BEDS),
        beside=tuple(beside),
        worthless=found.beds < LEAST_BEDS,
    )


def _give_up(made: Calibration, sentence: str) -> None:
    """Write the report of what was tried, and raise LabError."""
    write_report(replace(made, refused=sentence))
    raise LabError(f"{sentence}; see {made.folder / 'summary.md'}.")
