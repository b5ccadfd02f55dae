"""The results of a calibration: summary.md with a figure for people, calibration.json for programs."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import isfinite, isinf
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.base.errors import LabError
from lab.base.files import replacing, write_text
from lab.base.text import code, inline
from lab.measures.value import LEVEL
from lab.report.numbers import interval, plus_minus, with_error
from lab.report.plots import BLUE, GREY, STYLE, VERMILION
from lab.sweeps.inverse import LEAST_BEDS, Response, half_of

HALF = 0.5  # a value of the key is left out if a smaller fraction of its beds has the measure
METHOD = """\
The same beds are run at every value of the key. To each bed's numbers a parabola is fitted; their mean is the \
response, and the value is where it meets the target. The interval holds every value at which Student's test does not \
reject that the beds' mean is the target (Fieller 1954; Seber 1977, section 7.2); the standard error is that of the \
mean over the slope. Where the shaded band of the figure, the interval of the mean, meets the target, the interval of \
the key ends."""


@dataclass(frozen=True)
class Trial:
    """One value of the key that was run: the measure in each bed, None if not found; `note`: what went wrong."""

    x: float
    round: str
    beds: tuple[float | None, ...]
    note: str = ""

    @property
    def found(self) -> np.ndarray:
        """The measures that were found."""
        return np.array([bed for bed in self.beds if bed is not None], dtype=float)


@dataclass(frozen=True)
class Calibration:
    """The value of `key` that gives `measure` its `target`, with its standard error and 95 % interval.

    std: standard deviation over beds of the value that each bed alone would give; `beds`: the number of beds used; an
    end of the interval is infinite if it is beyond the range. None: not known; `refused`: why there is no value.
    `window`: the range of values in which the curve is fitted (None: all); `beds_needed`: the number of beds for an
    interval of half width `wanted`; `misfits`: values where the measures deviate from the curve, with the deviation.
    """

    folder: Path = field(repr=False)
    preset: str
    key: str
    unit: str
    measure: str
    measure_unit: str
    target: float
    target_error: float
    range: tuple[float, float]
    requested_beds: int
    trials: tuple[Trial, ...] = field(repr=False)
    window: tuple[float, float] | None = None
    value: float | None = None
    standard_error: float | None = None
    std: float | None = None
    interval: tuple[float, float] | None = None
    beds: int = 0
    wanted: float = 0.0
    beds_needed: int | None = None
    misfits: tuple[tuple[float, float], ...] = ()
    too_few_beds: bool = False
    refused: str = ""
    response: Response | None = field(default=None, repr=False, compare=False)

    @property
    def usable(self) -> list[Trial]:
        """The values in the window at which at least half of the beds have the measure."""
        low, high = self.window or (-np.inf, np.inf)
        slack = 1e-4 * (self.range[1] - self.range[0])
        least = max(1.0, HALF * self.requested_beds)
        return [p for p in self.trials if len(p.found) >= least and low - slack <= p.x <= high + slack]

    def measures(self) -> tuple[np.ndarray, np.ndarray]:
        """The usable values (N,) and the measure in every bed (N, B), NaN if not found."""
        rows = [[np.nan if bed is None else bed for bed in point.beds] for point in self.usable]
        values = np.array([point.x for point in self.usable])
        return values, np.array(rows, dtype=float).reshape(len(rows), self.requested_beds)

    def means(self) -> tuple[np.ndarray, np.ndarray]:
        """The usable values (N,) and the mean over the beds at each."""
        return np.array([p.x for p in self.usable]), np.array([p.found.mean() for p in self.usable])

    @property
    def lost(self) -> int:
        """Number of beds, counted at each value, in which the measure was not found."""
        return sum(self.requested_beds - len(point.found) for point in self.trials)

    def nowhere(self) -> str:
        """The sentence that no value in the range gives the target."""
        x, means = self.means()
        beds = f"the means of {self.requested_beds} beds are" if self.requested_beds > 1 else "one bed's are"
        return (
            f"--vary: no value of {self.key} in the range {x.min():g} to {x.max():g}{_unit(self.unit)} gives "
            f"{_words(self.measure)} {self.target:g}{_unit(self.measure_unit)}: {beds} {means.min():.3g} to "
            f"{means.max():.3g}{self._nearest()}"
        )

    def _nearest(self) -> str:
        """The sentence that the nearest mean may equal the target, if its interval contains it (Student 1908)."""
        near = min(self.usable, key=lambda point: abs(point.found.mean() - self.target))
        n = len(near.found)
        if n < 2 or abs(near.found.mean() - self.target) > half_of(n, near.found.std(ddof=1)):
            return "; vary it further, or another key"
        where = f"{near.x:g}{_unit(self.unit)}"
        return f"; at {where} the difference from the target is not significant; run more beds or vary it further"

    def text(self) -> str:
        """The result in one line, and a line for each warning."""
        tried = f"{self.beds} beds at {len(self.usable)} values" if self.beds > 1 else "one bed"
        lines = [f"{self._value()} gives {_words(self.measure)} {self._target()}; {tried}"]
        lines += [f"  warning: {warning}" for warning in self.warnings()]
        return "\n".join([*lines, f"  {self.folder / 'summary.md'}"])

    @property
    def summary_text(self) -> str:
        """The text to print, under the same name as in the results of runs and sweeps."""
        return self.text()

    def _target(self) -> str:
        if self.target_error:
            return with_error(self.target, self.target_error, self.measure_unit)
        return f"{self.target:g}{_unit(self.measure_unit)}"

    def _value(self) -> str:
        if self.interval is None:
            return f"{self.key} = {self.value:.4g}{_unit(self.unit)}"
        known = with_error(self.value, self.standard_error, self.unit)
        return f"{self.key} = {known}, {interval(*self.interval, self.unit)}"

    def warnings(self) -> list[str]:
        """Warnings on the result, one sentence each."""
        found = []
        if self.value is not None and self.too_few_beds:
            found.append(self._too_few_beds())
        if self.interval and any(isinf(end) for end in self.interval):
            found.append(
                "The interval reaches beyond the range that was tried: vary the key further, or run more beds."
            )
        if self.std == 0.0:
            found.append("All beds are equal: their scatter, and the interval that follows from it, mean nothing.")
        if self.lost:
            found.append(
                f"In {self.lost} of {self.requested_beds * len(self.trials)} runs the measure was not found; the "
                "value is that of the others, which may differ from them."
            )
        for x, off in self.misfits:
            found.append(
                f"At {x:g}{_unit(self.unit)} the measures are {off:+.2g}{_unit(self.measure_unit)} off the curve, "
                "which is significant: the value may be wrong; narrow the range."
            )
        return found

    def _too_few_beds(self) -> str:
        what = "One bed gives no interval" if self.interval is None else "The interval is not reliable"
        text = f"{what}: it takes at least {LEAST_BEDS} beds, not {self.beds}"
        if self.beds_needed is None:
            return f"{text}."
        half = f"{self.wanted:.2g}{_unit(self.unit)}"
        return f"{text}; with this scatter, {self.beds_needed} beds would give a half width of {half}."


def write_report(made: Calibration) -> Calibration:
    """Write summary.md, calibration.json and calibration.png into the calibration's folder. Raises LabError."""
    try:
        write_text(made.folder / "calibration.json", json.dumps(_data(made), indent=1) + "\n")
        plain = STYLE | {"text.parse_math": False}  # labels are texts of users, and may hold a $
        with matplotlib.rc_context(plain), replacing(made.folder / "calibration.png") as part:
            figure(made).savefig(part)
        write_text(made.folder / "summary.md", "\n".join(_page(made)) + "\n")
    except OSError as error:
        raise LabError(f"{made.folder} cannot be written ({error.strerror or error}): make room there.") from error
    return made


def _data(made: Calibration) -> dict:
    """The content of calibration.json; an end of the interval beyond the range is null."""
    names = ("preset", "key", "unit", "measure", "measure_unit", "target", "target_error", "range", "value", "std")
    ends = made.interval and [end if isfinite(end) else None for end in made.interval]
    return {
        **{name: getattr(made, name) for name in names},
        "standard_error": made.standard_error,
        "interval_95": ends,
        "n": made.beds,
        "refused": made.refused,
        "warnings": made.warnings(),
        "tried": [{"x": p.x, "round": p.round, "worlds": list(p.beds), "note": p.note} for p in made.trials],
    }


def _page(made: Calibration) -> Iterator[str]:
    """The lines of summary.md."""
    yield f"# Calibration of {made.key} for {_words(made.measure)} {made._target()}\n"
    yield f"**{made._value()}**" if made.value is not None else f"**{made.refused.removeprefix('--vary: ')}.**"
    yield from (f"\n**Warning:** {warning}" for warning in made.warnings())
    yield "\n![calibration](calibration.png)\n"
    yield f"- preset {code(made.preset)}, {made.key} from {made.range[0]:g} to {made.range[1]:g}{_unit(made.unit)}"
    yield f"- {made.requested_beds} beds at each of {len(made.trials)} values"
    yield "\n## Values that were run\n"
    yield f"| {made.key}{_unit(made.unit)} | {_words(made.measure)}{_unit(made.measure_unit)} | beds | without | note |"
    yield "|---|---|---|---|---|"
    for point in made.trials:
        lost = made.requested_beds - len(point.found)
        cells = [f"{point.x:g}", _mean(point.found), str(len(point.found)), str(lost), inline(point.note)]
        yield f"| {' | '.join(cells)} |"
    yield "\n± is the standard deviation over beds. `without` counts the runs that stopped, or in which the measure was"
    yield "not found; they are left out. A value of the key is left out if that is more than half of its runs."
    if made.std is not None and made.std > 0.0:
        yield from _more_beds(made)
    yield f"\n## Method\n\n{METHOD}"
    yield "\n## Files\n"
    yield "- [calibration](calibration.json)"
    for name in dict.fromkeys(point.round for point in made.trials):
        yield f"- [{name}]({name}/summary.md)"


def _more_beds(made: Calibration) -> Iterator[str]:
    yield "\n## Interval with more beds\n"
    yield f"A single bed would give {plus_minus(made.value, made.std)}{_unit(made.unit)} (std over beds).\n"
    yield "| beds | half width of the interval |\n|---|---|"
    counts = {LEAST_BEDS, 16, 32, 64, made.beds, made.beds_needed or made.beds}
    yield from (f"| {n} | {half_of(n, made.std):.2g}{_unit(made.unit)} |" for n in sorted(counts) if n > 1)


def figure(made: Calibration) -> Figure:
    """Every bed, the means ± std over beds, the response with its interval, the target, the value with its interval."""
    drawn = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = drawn.add_subplot()
    for point in made.trials:
        axes.plot(np.full(len(point.found), point.x), point.found, ".", color=GREY, ms=3, alpha=0.6, zorder=1)
    axes.plot([], [], ".", color=GREY, label="each bed")
    filled = [point for point in made.trials if len(point.found)]
    stds = [point.found.std(ddof=1) if len(point.found) > 1 else 0.0 for point in filled]
    means = [point.found.mean() for point in filled]
    label = f"mean ± std over beds (n = {made.requested_beds})"
    axes.errorbar([p.x for p in filled], means, stds, fmt="o", ms=4, capsize=2.5, color=BLUE, label=label)
    if made.response:
        _draw_response(axes, made)
    axes.axhline(made.target, color="black", ls=":", lw=1.0, label="target")
    if made.target_error:
        ends = made.target - made.target_error, made.target + made.target_error
        axes.axhspan(*ends, color="black", alpha=0.1, lw=0, label="target ± s.e.")
    if made.value is not None:
        axes.axvline(made.value, color=VERMILION, lw=1.0, label=f"{made.value:.3g}{_unit(made.unit)}")
    if made.interval:
        ends = np.clip(made.interval, *made.range)
        axes.axvspan(*ends, color=VERMILION, alpha=0.15, lw=0, label=f"{100 * LEVEL:g} % interval")
    axes.set_xlabel(f"{made.key} ({made.unit})" if made.unit else made.key)
    axes.set_ylabel(f"{_words(made.measure)} ({made.measure_unit})")
    drawn.legend(loc="outside lower center", ncols=3)
    return drawn


def _draw_response(axes: Axes, made: Calibration) -> None:
    x = np.linspace(*made.response.span, 200)
    mean = made.response.mean(x)
    axes.plot(x, mean, color=BLUE, lw=1.2, label="mean of the beds' parabolas")
    if made.beds > 1:
        half = made.response.error(x) * half_of(made.beds, made.beds**0.5)
        axes.fill_between(x, mean - half, mean + half, color=BLUE, alpha=0.15, lw=0, label="its 95 % interval")


def _mean(found: np.ndarray) -> str:
    if not len(found):
        return ""
    if len(found) == 1:
        return f"{found[0]:.4g}"
    return plus_minus(float(found.mean()), float(found.std(ddof=1)))


def _words(name: str) -> str:
    return name.replace("_", " ")


def _unit(unit: str) -> str:
    return "" if unit in ("", "1") else f" {unit}"
