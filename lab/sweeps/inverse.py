"""Inverse regression: the value of a key at which the mean of a measure over beds meets a target, with its interval.

The same seeds are run at every value of the key, so the measures of a bed at all values belong together and each bed is
one draw (common random numbers; Law and Kelton 2000, section 11.2). A parabola is fitted to each bed's measures by
least squares; the mean of the beds' parabolas is the response (a response surface in one dimension, Box and Wilson
1951). The value sought is where the response meets the target. Its interval comes from inverting Student's test along
the curve: it contains every value at which the beds' deviations from the target, y_b(x) − target, have a mean that
differs from zero by no more than t times its standard error (Fieller 1954; for calibration curves Seber 1977, section
7.2). Where the response is flat compared with its scatter, the interval is correspondingly wide.

The standard error is that of first order: the standard error of the mean over the slope. The scatter of the key over
beds is the scatter of the beds over the slope; it gives the number of beds for an interval of a given width.
"""

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np
from scipy.special import stdtrit

from lab.measures.value import LEVEL, half_width

DEGREE = 2  # of the polynomial; 1 if there are fewer than LEAST_FOR_PARABOLA values
LEAST_FOR_PARABOLA = 4
LEAST_BEDS = 8  # for a useful interval: t is 2.4 with eight beds, 12.7 with two
GRID = 4001  # points at which the curve is evaluated
MOST_BEDS = 100_000


@dataclass(frozen=True)
class Response:
    """The beds' polynomials in u = (x − middle)/half: coefficients (n, degree + 1), the highest power first.

    They hold in `span`, from the smallest to the largest value that was run.
    """

    coefficients: np.ndarray
    span: tuple[float, float]

    @property
    def beds(self) -> int:
        """How many beds have a curve."""
        return len(self.coefficients)

    def at(self, x: np.ndarray) -> np.ndarray:
        """The beds' curves (n, k) at values (k,) of the key."""
        low, high = self.span
        u = (np.asarray(x, dtype=float) - 0.5 * (low + high)) / (0.5 * (high - low))
        return self.coefficients @ np.vander(u, self.coefficients.shape[1]).T

    def mean(self, x: np.ndarray) -> np.ndarray:
        """Mean of the beds' curves (k,) at values (k,) of the key."""
        return self.at(x).mean(axis=0)

    def error(self, x: np.ndarray) -> np.ndarray:
        """Standard error of the mean (k,); NaN for a single bed."""
        if self.beds < 2:
            return np.full(np.shape(x), np.nan)
        return self.at(x).std(axis=0, ddof=1) / sqrt(self.beds)

    def slope(self, x: float) -> float:
        """Slope of the mean curve at a value of the key."""
        low, high = self.span
        step = 1e-4 * (high - low)
        return float(np.diff(self.mean(np.array([x - step, x + step])))[0] / (2.0 * step))


@dataclass(frozen=True)
class Solution:
    """The value of the key, its standard error, the standard deviation over beds of each bed's own value, its interval.

    An end of the interval is infinite if it is not within the range that was run. None: only a single bed.
    """

    value: float
    standard_error: float | None
    std: float | None
    interval: tuple[float, float] | None
    beds: int


def fitted(x: np.ndarray, measures: np.ndarray) -> Response | None:
    """Fit the response to measures (N, B), NaN if missing, at values (N,) of a key; None if there are too few.

    Beds with fewer measures than the polynomial has coefficients are left out.
    """
    degree = DEGREE if len(x) >= LEAST_FOR_PARABOLA else 1
    found = np.isfinite(measures)
    enough = found.sum(axis=0) > degree
    if len(np.unique(x)) < 2 or not enough.any():
        return None
    span = float(x.min()), float(x.max())
    u = (x - 0.5 * (span[0] + span[1])) / (0.5 * (span[1] - span[0]))
    rows = [np.polyfit(u[found[:, b]], measures[found[:, b], b], degree) for b in np.flatnonzero(enough)]
    return Response(np.array(rows), span)


def crossings(response: Response, target: float) -> list[float]:
    """The values in the span at which the mean response meets the target, in ascending order."""
    x = np.linspace(*response.span, GRID)
    above = response.mean(x) - target
    exact = x[above == 0.0].tolist()
    k = np.flatnonzero(above[:-1] * above[1:] < 0.0)
    between = x[k] - above[k] * (x[k + 1] - x[k]) / (above[k + 1] - above[k])
    return sorted([*exact, *between.tolist()])


def solved(response: Response, target: float, root: float, target_error: float = 0.0) -> Solution:
    """The root with its errors, from the scatter of the beds and the target's own standard error."""
    n = response.beds
    if n < 2:
        return Solution(root, None, None, None, n)
    slope, error = abs(response.slope(root)), float(response.error(np.array([root]))[0])
    std = error * sqrt(n) / slope if slope else inf
    whole = float(np.hypot(error, target_error)) / slope if slope else inf
    return Solution(root, whole, std, _interval(response, target, root, target_error), n)


def _interval(response: Response, target: float, root: float, target_error: float) -> tuple[float, float]:
    """The interval around the root in which Student's test does not reject that the mean equals the target.

    Degrees of freedom by Welch (1947) and Satterthwaite (1946) if the target has a standard error of its own.
    """
    x = np.linspace(*response.span, GRID)
    square = response.error(x) ** 2
    whole = square + target_error**2
    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = np.where(square > 0.0, (response.beds - 1) * (whole / square) ** 2, inf)
    bound = stdtrit(freedom, 0.5 + 0.5 * LEVEL) * np.sqrt(whole)
    held = np.abs(response.mean(x) - target) <= bound
    near = int(np.argmin(np.abs(x - root)))
    refused = np.flatnonzero(~held)
    below, above = refused[refused < near], refused[refused > near]
    low = float(x[below[-1]]) if len(below) else -inf
    high = float(x[above[0]]) if len(above) else inf
    return low, high


def beds_for(half: float, std: float) -> int | None:
    """The fewest beds n with an interval of half width `half` or less, at this scatter; None: more than MOST_BEDS.

    t(n − 1) std/√n ≤ half the width (Student 1908).
    """
    low, high = 2, MOST_BEDS
    if not half_of(high, std) <= half:
        return None
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if half_of(middle, std) <= half else (middle + 1, high)
    return low


def half_of(beds: int, std: float) -> float:
    """Half the width of the interval with this number and scatter of beds."""
    return half_width(std / sqrt(beds), beds - 1)


def misfit(response: Response, x: np.ndarray, measures: np.ndarray) -> list[tuple[float, float]]:
    """Values at which the measures deviate significantly from the fitted curves, with the mean deviation.

    Student's test of the beds' residuals at each value, at a level divided among all values (Bonferroni; Dunn 1961).
    Beds with a missing measure are left out.
    """
    whole = np.isfinite(measures).all(axis=0)
    if whole.sum() < 3:
        return []
    curves = fitted(x, measures[:, whole])
    residual = measures[:, whole] - curves.at(x).T
    mean, error = residual.mean(axis=1), residual.std(axis=1, ddof=1) / sqrt(whole.sum())
    bound = stdtrit(whole.sum() - 1, 1.0 - 0.5 * (1.0 - LEVEL) / len(x)) * error
    floor = 1e-9 * np.abs(measures[:, whole]).max()
    return [(float(a), float(m)) for a, m, b in zip(x, mean, bound, strict=True) if abs(m) > max(b, floor)]
