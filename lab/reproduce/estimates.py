"""Means over beds beside one another: their ratio, their difference, and what 95 % of confidence says of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import hypot, inf

import numpy as np
from scipy import stats

from lab.measures.value import Value

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Estimate:
    """A number and its standard error, of so many degrees of freedom; of single beds there are none."""

    value: float
    error: float
    freedom: float

    @property
    def margin(self) -> float:
        """Half its confidence interval (Student 1908)."""
        return float(stats.t.ppf(0.5 + 0.5 * CONFIDENCE, self.freedom)) * self.error if self.freedom else inf

    def lies(self, low: float, high: float) -> bool | None:
        """Whether it lies between these; None where its confidence interval leaves that open."""
        least, most = self.value - self.margin, self.value + self.margin
        if most < low or least > high:
            return False
        return True if low <= least and most <= high else None

    def __str__(self) -> str:
        return f"{self.value:.3f} ± {self.error:.3f}" if self.freedom else f"{self.value:.3f}"


def ratio(value: Value | None, reference: Value | None) -> Estimate | None:
    """One mean over another, of beds of their own (Welch 1947); None without either."""
    if not _known(value, reference):
        return None
    found = value.value / reference.value
    first, second = (_error(one) / one.value for one in (value, reference))
    return Estimate(found, abs(found) * hypot(first, second), _freedom(value, reference, first, second))


def paired_ratio(value: Value | None, reference: Value | None) -> Estimate | None:
    """The same of beds that begin alike: by their differences, which scatter less than the beds; None without two."""
    pairs = zip(value.worlds, reference.worlds, strict=True) if value and reference else ()
    both = np.array([pair for pair in pairs if None not in pair])
    if len(both) < 2:
        return None
    apart, mean = both[:, 0] - both[:, 1], both[:, 1].mean()
    return Estimate(1.0 + apart.mean() / mean, apart.std(ddof=1) / len(both) ** 0.5 / abs(mean), len(both) - 1)


def are_ordered(values: Sequence[Value | None]) -> bool | None:
    """Whether means fall from one to the next; None where beds are too few, or too unlike, to tell."""
    falls = [difference(a, b) for a, b in pairwise(values)]
    if None in falls:
        return False
    told = [fall.lies(0.0, inf) for fall in falls]
    return False if False in told else None if None in told else True


def difference(first: Value | None, second: Value | None) -> Estimate | None:
    """One mean less another, of beds of their own (Welch 1947); None without either."""
    if not _known(first, second):
        return None
    errors = _error(first), _error(second)
    return Estimate(first.value - second.value, hypot(*errors), _freedom(first, second, *errors))


def _known(*values: Value | None) -> bool:
    return all(value is not None and value.value is not None for value in values)


def _count(value: Value) -> int:
    return sum(world is not None for world in value.worlds)


def _error(value: Value) -> float:
    """The standard error of a mean over beds."""
    return (value.std or 0.0) / _count(value) ** 0.5


def _freedom(first: Value, second: Value, error: float, other: float) -> float:
    """Degrees of freedom of a sum or difference of means with these errors (Welch 1947, eq. 28); 0 if none is known."""
    least = min(_count(first), _count(second)) - 1
    if least < 1 or not (error or other):
        return max(0, least)
    return (error**2 + other**2) ** 2 / (error**4 / (_count(first) - 1) + other**4 / (_count(second) - 1))
