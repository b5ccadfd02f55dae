"""Calibration: which value of one key of a preset gives a measure its target.

A response surface (Box and Wilson 1951) in one dimension: the measure is simulated at a few values of the key, the same
beds at each, and a parabola is fitted to the means by least squares. Its root is refined by a second round of values
around it. The error of the root is that of the beds: the fit is repeated with beds drawn anew with replacement
(bootstrap, Efron 1979), the same ones at all values.
"""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from functools import partial
from itertools import pairwise
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import brentq

from lab.axes import values
from lab.errors import LabError
from lab.plots import BLUE, GREY, STYLE, VERMILION
from lab.reader import dotted_key
from lab.runner import RENDERS
from lab.schema import Given
from lab.sweep_report import Point
from lab.sweeps import SweepResult, run_sweep
from lab.units import in_unit

POINTS = 5  # values of the key in a round
CLOSER = 0.25  # half the width of the second round, of the first one's range
DRAWS = 1000  # of beds with replacement
LEVEL = 0.95
ALIASES = {"repose": "critical_angle"}
FEWEST_BEDS = 2


@dataclass(frozen=True)
class Calibration:
    """The value of `key` that gives `measure` its `target`, with its standard error and 95 % interval.

    `x`, `mean`, `std` (N,) are what was simulated, and `beds` how many at each value; `parabola` its coefficients from
    the square down; units as in the texts.
    """

    preset: str
    key: str
    unit: str
    measure: str
    measure_unit: str
    target: float
    value: float
    error: float
    interval: tuple[float, float]
    beds: int
    x: tuple[float, ...] = field(repr=False)
    mean: tuple[float, ...] = field(repr=False)
    std: tuple[float, ...] = field(repr=False)
    parabola: tuple[float, ...] = field(repr=False)

    def text(self) -> str:
        """One line for people."""
        unit = f" {self.unit}" if self.unit else ""
        low, high = self.interval
        return (
            f"{self.key} = {self.value:.4g} ± {self.error:.2g}{unit} (95 %: {low:.4g} to {high:.4g}) gives "
            f"{self.measure.replace('_', ' ')} {self.target:g} {self.measure_unit}; "
            f"{self.beds} beds at {len(self.x)} values"
        )


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

    Leaves calibration.json, calibration.png and both rounds' sweeps in a folder (default: renders/NAME-calibration);
    asked again it goes on. cluster: as of `run_sweep`. Raises LabError: texts that cannot be read, a target out of
    reach, and as `run_sweep`.
    """
    measure, wanted = _pair("--target", target, 'repose="41.3 deg"')
    given, span = _pair("--vary", vary, "friction=0.2:0.7")
    measure, key = ALIASES.get(measure, measure), dotted_key(Given, given)
    folder = Path(out) if out is not None else RENDERS / f"{Path(str(name)).stem}-calibration"
    run = partial(run_sweep, video=False, quiet=quiet, cluster=cluster)
    first = run(name, {key: values(key, _with_count(key, span))}, overrides, folder / "round-1")
    x, unit, beds, measure_unit = _responses(first, key, measure)
    goal = in_unit(wanted, measure_unit, "--target")
    near = _root(x, beds, goal, key, measure, measure_unit)
    half = CLOSER * float(np.ptp(x))
    around = np.linspace(max(x.min(), near - half), min(x.max(), near + half), POINTS)
    listed = [f"{value:.6g} {unit}".strip() if unit else float(f"{value:.6g}") for value in around]
    second = run(name, {key: listed}, overrides, folder / "round-2")
    more, _, further, _ = _responses(second, key, measure)
    found = _solved(np.concatenate([x, more]), np.vstack([beds, further]), goal, key, measure, measure_unit)
    made = Calibration(str(name), key, unit, measure, measure_unit, goal, **found)
    _write(made, folder)
    return made


def _pair(option: str, text: str, example: str) -> tuple[str, str]:
    left, equals, right = text.partition("=")
    if not (left.strip() and equals and right.strip()):
        raise LabError(f"{option}: {text!r} cannot be read; give e.g. {example}.")
    return left.strip(), right.strip()


def _with_count(key: str, span: str) -> str:
    """The text of a range of POINTS values from "0.2:0.7" or "1 mm:2 mm"."""
    ends = [end.strip() for end in span.split(":")]
    if len(ends) != 2 or not all(ends):
        raise LabError(f'{key}: a range FROM:TO is needed, e.g. 0.2:0.7 (got "{span}").')
    return f"{ends[0]}:{ends[1]}:{POINTS}"


def _responses(result: SweepResult, key: str, measure: str) -> tuple[np.ndarray, str, np.ndarray, str]:
    """Values of the key (N,) with their unit, the measure in every bed (N, beds), NaN where not found, and its unit."""
    points = [Point({}, where) for where in result.points]
    known = [point.measures[measure] for point in points if measure in point.measures]
    if not known:
        names = sorted({name for point in points for name in point.measures})
        raise LabError(f"--target: these runs have no {measure}; they have {', '.join(names)}.")
    count = max(len(value.worlds) for value in known)
    if count < FEWEST_BEDS:
        raise LabError("--repeats: a calibration needs 2 beds at least to know its error; give --repeats 4 or more.")
    beds = np.full((len(points), count), np.nan)
    for row, point in zip(beds, points, strict=True):
        if measure in point.measures:
            row[:] = [np.nan if world is None else world for world in point.measures[measure].worlds]
    column = next(name for name in result.rows[0] if name.partition(" (")[0] == key)
    unit = column.partition(" (")[2].rstrip(")")
    return np.array([float(row[column]) for row in result.rows]), unit, beds, known[0].unit


def _solved(x: np.ndarray, beds: np.ndarray, goal: float, key: str, measure: str, unit: str) -> dict:
    """The fields of a calibration that follow from the beds."""
    value = _root(x, beds, goal, key, measure, unit)
    random = np.random.default_rng(1)
    drawn = (beds[:, random.integers(beds.shape[1], size=beds.shape[1])] for _ in range(DRAWS))
    roots = np.array([_crossing(*_fit(x, sample), goal) for sample in drawn])
    found = roots[np.isfinite(roots)]
    tail = 50.0 * (1.0 - LEVEL)
    # Beds whose parabola never meets the target lie beyond the ends of what was tried.
    low, high = np.percentile(np.where(np.isfinite(roots), roots, _end_beyond(x, beds, goal)), [tail, 100.0 - tail])
    return {
        "value": value,
        "error": float(found.std(ddof=1)),
        "interval": (float(low), float(high)),
        "beds": beds.shape[1],
        "x": tuple(x.tolist()),
        "mean": tuple(np.nanmean(beds, axis=1).tolist()),
        "std": tuple(np.nanstd(beds, axis=1, ddof=1).tolist()),
        "parabola": tuple(_fit(x, beds)[0].tolist()),
    }


def _fit(x: np.ndarray, beds: np.ndarray) -> tuple[np.ndarray, tuple[float, float]]:
    """A parabola through the means, each weighted by its number of beds, and the range in which it holds."""
    found = np.isfinite(beds).sum(axis=1)
    usable = found > 0
    mean = np.nanmean(beds[usable], axis=1)
    degree = min(2, np.unique(x[usable]).size - 1)
    return np.polyfit(x[usable], mean, degree, w=np.sqrt(found[usable])), (x[usable].min(), x[usable].max())


def _crossing(parabola: np.ndarray, span: tuple[float, float], goal: float) -> float:
    """Where the parabola meets the goal within the span; NaN where it does not."""
    grid = np.linspace(*span, 201)
    above = np.polyval(parabola, grid) - goal
    for (a, fa), (b, fb) in pairwise(zip(grid, above, strict=True)):
        if fa == 0.0:
            return float(a)
        if fa * fb < 0.0:
            return float(brentq(lambda at: np.polyval(parabola, at) - goal, a, b))
    return float("nan")


def _end_beyond(x: np.ndarray, beds: np.ndarray, goal: float) -> float:
    """The end of the range nearer to the goal."""
    parabola, span = _fit(x, beds)
    return min(span, key=lambda at: abs(np.polyval(parabola, at) - goal))


def _root(x: np.ndarray, beds: np.ndarray, goal: float, key: str, measure: str, unit: str) -> float:
    parabola, span = _fit(x, beds)
    root = _crossing(parabola, span, goal)
    if np.isnan(root):
        reached = np.polyval(parabola, np.linspace(*span, 201))
        raise LabError(
            f"--vary: between {span[0]:g} and {span[1]:g} of {key} the {measure.replace('_', ' ')} is "
            f"{reached.min():.3g} to {reached.max():.3g} {unit}, never {goal:g}: vary it further, or another key."
        )
    return root


def _write(made: Calibration, folder: Path) -> None:
    try:
        (folder / "calibration.json").write_text(json.dumps(asdict(made), indent=1) + "\n", encoding="utf-8")
        with matplotlib.rc_context(STYLE):
            figure(made).savefig(folder / "calibration.png")
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror or error}): make room there.") from error


def figure(made: Calibration) -> Figure:
    """The simulated means ± their standard errors, the parabola, target and root with its interval."""
    drawn = Figure(figsize=(6.4, 3.8), layout="constrained")
    axes = drawn.add_subplot()
    errors, label = np.array(made.std) / np.sqrt(made.beds), f"mean of {made.beds} beds ± its standard error"
    axes.errorbar(made.x, made.mean, errors, fmt="o", ms=4, capsize=2.5, color=BLUE, label=label)
    grid = np.linspace(min(made.x), max(made.x), 200)
    axes.plot(grid, np.polyval(made.parabola, grid), color=BLUE, lw=1.0, label="parabola")
    axes.axhline(made.target, color=GREY, ls=":", label="target")
    axes.axvspan(*made.interval, color=VERMILION, alpha=0.15, lw=0, label="95 % interval")
    axes.axvline(made.value, color=VERMILION)
    axes.set_xlabel(f"{made.key} ({made.unit})" if made.unit else made.key)
    axes.set_ylabel(f"{made.measure.replace('_', ' ')} ({made.measure_unit})")
    drawn.legend(loc="outside lower center", ncols=2)
    return drawn
