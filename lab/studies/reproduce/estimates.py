"""Compare means over beds: their ratio or difference with its interval, and a verdict.

A verdict comes from two one-sided tests (Schuirmann 1987): a number agrees if its whole interval lies within the
allowed range, and differs if its whole interval lies outside. At LEVEL = 95 % each is wrong once in forty times at
most. Everything else is left open, so wide scatter, or a single bed, can neither agree nor differ.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations, pairwise
from math import hypot, inf, isfinite, sqrt

import numpy as np
from scipy.special import fdtri, ndtri, stdtrit

from lab.measures.value import LEVEL, Value
from lab.report.numbers import interval, with_error


class Verdict(StrEnum):
    """The verdict on a statement of the source."""

    AGREES = "agrees"
    DIFFERS = "differs"
    CANNOT_TELL = "cannot tell"


@dataclass(frozen=True)
class Estimate:
    """A number, its standard error and the degrees of freedom; a single bed has none."""

    value: float
    error: float
    freedom: float

    @classmethod
    def exact(cls, value: float) -> "Estimate":
        """An estimate without scatter from bed to bed: a ship with frozen cargo, an equation."""
        return cls(value, 0.0, inf)

    def ends(self, level: float = LEVEL) -> tuple[float, float]:
        """The ends of its interval (Student 1908)."""
        margin = float(stdtrit(self.freedom, 0.5 + 0.5 * level)) * self.error if self.freedom else inf
        return self.value - margin, self.value + margin

    def lies(self, low: float, high: float, level: float = LEVEL) -> Verdict:
        """The verdict on whether it lies between `low` and `high`."""
        least, most = self.ends(level)
        if most < low or least > high:
            return Verdict.DIFFERS
        return Verdict.AGREES if low <= least and most <= high and self.freedom else Verdict.CANNOT_TELL

    def less(self, number: float) -> "Estimate":
        """The estimate minus a number."""
        return Estimate(self.value - number, self.error, self.freedom)

    def told(self, unit: str = "", sign: str = "") -> str:
        """As text, with its standard error if there is one: "0.733 ± 0.067 (s.e.)"."""
        if self.freedom and isfinite(self.freedom):
            return with_error(self.value, self.error, unit, sign)
        return f"{self.value:{sign}.4g} {unit}".rstrip()

    def interval(self, unit: str = "") -> str:
        """The interval as text; "" if it is not known or a point."""
        return interval(*self.ends(), unit) if self.freedom and isfinite(self.freedom) else ""


def mean(value: Value | None, exact: bool = False) -> Estimate | None:
    """A mean over beds; `exact` if it does not vary from bed to bed. None without one."""
    if not _known(value):
        return None
    if exact:
        return Estimate.exact(value.value)
    return Estimate(value.value, _error(value), max(0, value.n - 1))


def difference(first: Value | None, second: Value | None) -> Estimate | None:
    """Difference of two means of independent beds (Welch 1947); None if one is missing."""
    if not _known(first, second):
        return None
    errors = _error(first), _error(second)
    return Estimate(first.value - second.value, hypot(*errors), _freedom(first, second, *errors))


def ratio(value: Value | None, reference: Value | None) -> Estimate | None:
    """Ratio of two means of independent beds (Welch 1947); None if one is missing."""
    if not _known(value, reference) or not reference.value:
        return None
    found = value.value / reference.value
    first, second = _error(value) / reference.value, found * _error(reference) / reference.value
    return Estimate(found, hypot(first, second), _freedom(value, reference, first, second))


def paired_difference(value: Value | None, reference: Value | None) -> Estimate | None:
    """Mean difference of paired numbers, of beds that start alike or of the same cycles; None without two pairs."""
    both = _pairs(value, reference)
    if len(both) < 2:
        return None
    apart = both[:, 0] - both[:, 1]
    return Estimate(float(apart.mean()), float(apart.std(ddof=1)) / len(both) ** 0.5, len(both) - 1)


def paired_ratio(value: Value | None, reference: Value | None) -> Estimate | None:
    """Ratio of two means of paired beds, which start alike: by their differences; None without two beds."""
    apart = paired_difference(value, reference)
    if apart is None:
        return None
    middle = _pairs(value, reference)[:, 1].mean()
    return Estimate(1.0 + apart.value / middle, apart.error / abs(middle), apart.freedom)


def _pairs(value: Value | None, reference: Value | None) -> np.ndarray:
    """Numbers (n, 2) of worlds in which both are known."""
    pairs = zip(value.worlds, reference.worlds, strict=True) if value and reference else ()
    return np.array([pair for pair in pairs if None not in pair])


def together(verdicts: Sequence[Verdict]) -> Verdict:
    """The verdict on a statement that holds if all its parts hold (intersection-union test, Berger 1982)."""
    if Verdict.DIFFERS in verdicts:
        return Verdict.DIFFERS
    return Verdict.CANNOT_TELL if Verdict.CANNOT_TELL in verdicts else Verdict.AGREES


def falling(values: Sequence[Value | None]) -> Verdict:
    """Whether means fall from one to the next."""
    return _all_between([difference(a, b) for a, b in pairwise(values)], 0.0, inf)


def alike(values: Sequence[Value | None], within: float) -> Verdict:
    """Whether any two means differ by no more than this."""
    return _all_between([difference(a, b) for a, b in combinations(values, 2)], -within, within)


def _all_between(found: Sequence[Estimate | None], low: float, high: float) -> Verdict:
    """Whether all estimates lie between `low` and `high`; "differs" needs one outside at the Bonferroni level."""
    strict = 1.0 - (1.0 - LEVEL) / max(1, len(found))
    if any(one is not None and one.lies(low, high, strict) is Verdict.DIFFERS for one in found):
        return Verdict.DIFFERS
    agrees = all(one is not None and one.lies(low, high) is Verdict.AGREES for one in found)
    return Verdict.AGREES if agrees else Verdict.CANNOT_TELL


def scatters_more(first: Value | None, second: Value | None) -> Verdict:
    """Whether beds of one kind scatter more than those of another: the ratio of variances (Snedecor's F)."""
    if not _known(first, second) or not (first.std and second.std):
        return Verdict.CANNOT_TELL
    found = (first.std / second.std) ** 2
    freedom = first.n - 1, second.n - 1
    tail = 0.5 * (1.0 - LEVEL)
    if found / fdtri(*freedom, 1.0 - tail) > 1.0:
        return Verdict.AGREES
    return Verdict.DIFFERS if found / fdtri(*freedom, tail) < 1.0 else Verdict.CANNOT_TELL


def chance(seen: int, beds: int) -> tuple[float, float]:
    """The interval of the share of beds with an outcome that `seen` of `beds` had (Wilson 1927)."""
    sure = float(ndtri(0.5 + 0.5 * LEVEL))
    share, square = seen / beds, sure**2 / beds
    middle = (share + 0.5 * square) / (1.0 + square)
    half = sure / (1.0 + square) * sqrt(share * (1.0 - share) / beds + 0.25 * square / beds)
    return middle - half, middle + half


def mostly(seen: int, beds: int) -> Verdict:
    """Whether more than half of all beds have an outcome that `seen` of `beds` had."""
    if not beds:
        return Verdict.CANNOT_TELL
    low, high = chance(seen, beds)
    return Verdict.AGREES if low > 0.5 else Verdict.DIFFERS if high < 0.5 else Verdict.CANNOT_TELL


def surely(holds: bool) -> Verdict:
    """The verdict on something that does not vary from bed to bed."""
    return Verdict.AGREES if holds else Verdict.DIFFERS


def _known(*values: Value | None) -> bool:
    return all(value is not None and value.value is not None for value in values)


def _error(value: Value) -> float:
    """The standard error of a mean over beds; unknown for one bed, which has no degrees of freedom."""
    return value.standard_error or 0.0


def _freedom(first: Value, second: Value, error: float, other: float) -> float:
    """Degrees of freedom of a sum or difference of means with these errors (Welch 1947, eq. 28); 0 if none is known."""
    least = min(first.n, second.n) - 1
    if least < 1 or not (error or other):
        return max(0, least)
    return (error**2 + other**2) ** 2 / (error**4 / (first.n - 1) + other**4 / (second.n - 1))
