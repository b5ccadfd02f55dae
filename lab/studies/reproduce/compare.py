"""Hold what runs gave against what a source states: one row for each claim.

A claim names measures (`of`) of runs, at points of their grids (`at`: a value of the grid), each one word or a list
of them; lists go together word by word. What a report leaves out is left out of its rows, too.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from math import inf
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict

from lab.measures.value import Value
from lab.studies.reproduce import registry
from lab.studies.reproduce.estimates import (
    Estimate,
    Verdict,
    alike,
    difference,
    falling,
    mean,
    mostly,
    paired_difference,
    paired_ratio,
    ratio,
    scatters_more,
    together,
)
from lab.studies.reproduce.experiment import (
    Found,
    Kind,
    Row,
    Tolerance,
    all_against,
    alone,
    counted,
    held,
    less,
    observed,
    stated,
)
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships.rolls import end

ALL, LAST = "*", "last"  # all runs of the report; the last of them
FROZEN = "frozen_"  # measures of ships with frozen cargo, which do not vary from bed to bed
HALF = "more than half of all beds"


def _one_of(word: str, known: Mapping) -> str:
    if word not in known:
        raise ValueError(f"{word} is none of {', '.join(known)}")
    return word


class Claim(BaseModel):
    """A row: what it `says`, "{run}" being the name of its run, and how its numbers compare with the source.

    compare: `told` is not judged; a `value` agrees `within` a tolerance by name or a `share` of it; a number lies
    `at least`, `at most` or `not before` its value, or in a `range`; numbers fall one after the other or are alike; the
    difference or ratio of two, of the same beds where paired, lies `between` two numbers; one is the `same` as another
    within a tolerance or a `share`; most beds have or ship's `capsizes`; the first `scatters` most. `tolerance` says
    how words of the source are read, `shows` how ours are written, `given` is a number that a function of
    `registry.DERIVED` needs, or a list within a list of them. `judged`: with false a verdict on a trend is told as a
    word that does not count, and a value has a difference and no verdict. `kind`: what it is held against, where that
    is not its experiment's.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    says: str = ""
    source: str = ""
    of: str | list[str] = ""
    runs: str | list[str] = ALL
    at: str | list[str] = ""
    given: float | list[float] | list[list[float]] | None = None
    compare: Annotated[str, AfterValidator(lambda word: _one_of(word, COMPARISONS))] = "told"
    value: float | None = None
    within: str = ""
    share: float | None = None
    between: tuple[float, float] | None = None
    tolerance: str = ""
    shows: str = ""
    judged: bool = True
    kind: Kind | None = None
    by: str = ""


@dataclass(frozen=True)
class Number:
    """A number that a claim looks at: of which run and measure, the outcomes it comes from, and its value."""

    run: str
    of: str
    outcomes: Sequence[Outcome]
    value: Value | None

    @property
    def exact(self) -> bool:
        """Whether it does not vary from bed to bed."""
        alone = self.value is None or self.value.n < 2
        return self.of.startswith(FROZEN) or (self.of in registry.OF_ONE_RUN and alone)

    def text(self) -> str:
        """For a reader."""
        return alone(self.value) if self.exact else counted(self.value)


def rows(claims: Sequence[Claim], found: Found, tolerances: Mapping[str, Tolerance]) -> list[Row]:
    """The rows of claims on what was found."""
    told: list[Row] = []
    for claim in claims:
        if claim.by:
            told += all_against(registry.ROWS[claim.by](found), claim.kind)
        elif numbers := _numbers(claim, found):
            named = claim.model_copy(update={"says": claim.says.replace("{run}", numbers[0].run)})
            row = COMPARISONS[claim.compare](named, numbers, _tolerance(claim, numbers, tolerances))
            told.append(row.against(claim.kind))
    return told


def _numbers(claim: Claim, found: Found) -> list[Number]:
    """The numbers of a claim; none where the report lacks one of a pair, or all."""
    runs = {ALL: list(found), LAST: list(found)[-1:]}[claim.runs] if claim.runs in (ALL, LAST) else claim.runs
    lists = [one if isinstance(one, list) else [one] for one in (runs, claim.of, claim.at, claim.given)]
    size = max(map(len, lists))
    asked = list(zip(*(one * size if len(one) == 1 else one for one in lists), strict=True))
    numbers = []
    for run, of, at, given in asked:
        outcomes = [one for one in found.get(run, ()) if not at or at in map(_word, one.setting.values())]
        if outcomes:
            numbers.append(number_of(run, of, outcomes, given))
    least = {"told": 1, "fall": 2, "alike": 2}.get(claim.compare, size)
    return numbers if len(numbers) >= least else []


def number_of(run: str, of: str, outcomes: Sequence[Outcome], given: object = None) -> Number:
    """A number of the first outcome of a run, or one that a function gives."""
    value = registry.DERIVED[of](outcomes, given) if of in registry.DERIVED else outcomes[0][of]
    return Number(run, of, outcomes, value)


def _word(value: object) -> str:
    """A value of a grid as a claim names it; of descriptors the last."""
    return str(value[-1]) if isinstance(value, list) else str(value)


def _tolerance(claim: Claim, numbers: Sequence[Number], known: Mapping[str, Tolerance]) -> Tolerance:
    """What is allowed, with its words."""
    if claim.share is not None:
        sizes = [abs(one.value.value) for one in numbers if mean(one.value) is not None]
        sizes = sizes if claim.value is None else [abs(claim.value)]
        return Tolerance(claim.share * max(sizes, default=0.0), claim.tolerance)
    return known[claim.within] if claim.within else Tolerance(inf, claim.tolerance)


def _words(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> str:
    if not claim.within:
        return claim.tolerance
    unit = next((one.value.unit for one in numbers if one.value), "")
    return allowed.words(unit) + (f", {claim.tolerance}" if claim.tolerance else "")


def _ours(claim: Claim, numbers: Sequence[Number]) -> str:
    """Our numbers as the claim shows them."""
    if claim.shows == "end":
        return end(numbers[0].outcomes[0])
    if "{value}" in claim.shows:
        return ", ".join(claim.shows.format(run=one.run, value=one.text()) for one in numbers)
    texts = [one.text() for one in numbers]
    return claim.shows.format(*texts) if claim.shows else ", ".join(texts)


def _row(claim: Claim, numbers: Sequence[Number], allowed: Tolerance, verdict: Verdict | None) -> Row:
    return observed(claim.says, claim.source, _ours(claim, numbers), verdict, _words(claim, numbers, allowed))


def _told(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    return _row(claim, numbers, allowed, None)


def _value(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    row = stated(claim.says, claim.value, numbers[0].value, allowed, exact=numbers[0].exact)
    return replace(row, source=claim.source or row.source, verdict=row.verdict if claim.judged else None)


def _range(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    found, value = numbers[0], numbers[0].value
    unit = "" if value is None or value.unit == "1" else value.unit
    return held(claim.says, claim.source, mean(value, found.exact), claim.between, claim.tolerance, unit)


def _bounded(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    """A number on one side of another; where no bed of `not before` has one, it was not reached."""
    low, high = {
        "at least": (claim.value, inf),
        "at most": (-inf, claim.value),
        "not before": (claim.value - allowed.within, inf),
    }[claim.compare]
    value = numbers[0].value
    found = mean(value, numbers[0].exact)
    verdict = Verdict.CANNOT_TELL if found is None else found.lies(low, high)
    if claim.compare == "not before" and found is None and value is not None:
        verdict = mostly(len(value.worlds), len(value.worlds))
    return _row(claim, numbers, allowed, verdict)


def _fall(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    verdict = falling([one.value for one in numbers])
    if claim.judged:
        return _row(claim, numbers, allowed, verdict)
    return observed(claim.says, claim.source, verdict.value, None)


def _alike(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    values = [one.value for one in numbers]
    known = [value.value for value in values if mean(value) is not None]
    said = "not found" if len(known) < len(values) else f"{max(known) - min(known):.1f} {values[0].unit}"
    return observed(claim.says, claim.source, said, alike(values, allowed.within), _words(claim, numbers, allowed))


def _pair(of: Callable[[Value | None, Value | None], Estimate | None]) -> Callable:
    """The kind that looks at one estimate from two numbers."""

    def kind(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
        first, second = (one.value for one in numbers)
        estimate = of(first, second)
        unit = first.unit if of in (difference, paired_difference) and first else ""
        if claim.between:
            return held(claim.says, claim.source, estimate, claim.between, claim.tolerance, unit)
        ours, known = ("not found", "") if estimate is None else (estimate.told(unit), estimate.interval(unit))
        return Row(claim.says, claim.source, ours, known, "", None)

    return kind


def _same(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    first, second = numbers
    apart = difference(first.value, second.value)
    if apart is not None and second.of.startswith(FROZEN):
        apart = mean(first.value).less(second.value.value)
    row = _row(claim, numbers[:1], allowed, Verdict.CANNOT_TELL)
    if apart is None:
        return row
    verdict = apart.lies(-allowed.within, allowed.within)
    return Row(row.quantity, row.source, row.ours, less(apart, first.value.unit), row.tolerance, verdict)


def _most(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    value = numbers[0].value
    seen = [bool(one) for one in value.worlds if one is not None] if value else []
    ours = claim.shows.format(sum(seen), len(seen))
    return observed(claim.says, claim.source, ours, mostly(sum(seen), len(seen)), claim.tolerance)


def _capsizes(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    """Whether she capsizes with loose cargo in more than half of all beds, where the source says that she does."""
    one = numbers[0].outcomes[0]
    if not claim.source:
        return observed(claim.says, "", end(one), None)
    ends = one["capsized_at"].worlds
    verdict = mostly(sum(end is not None for end in ends), len(ends))
    return observed(claim.says, claim.source, end(one), verdict, HALF)


def _scatters(claim: Claim, numbers: Sequence[Number], allowed: Tolerance) -> Row:
    values = [one.value for one in numbers]
    stds = ", ".join("?" if value is None or value.std is None else f"{value.std:.1f} {value.unit}" for value in values)
    most = together([scatters_more(values[0], other) for other in islice(values, 1, None)])
    return observed(claim.says, claim.source, stds, most, claim.tolerance)


COMPARISONS = {
    "told": _told,
    "value": _value,
    "range": _range,
    "at least": _bounded,
    "at most": _bounded,
    "not before": _bounded,
    "fall": _fall,
    "alike": _alike,
    "difference": _pair(difference),
    "ratio": _pair(ratio),
    "paired difference": _pair(paired_difference),
    "paired ratio": _pair(paired_ratio),
    "same": _same,
    "most": _most,
    "capsizes": _capsizes,
    "scatters": _scatters,
}
