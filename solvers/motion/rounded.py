"""Records printed to few digits: the smoothest curve that prints as the record.

A sample printed to a step q is off by up to q/2, evenly, so with a standard deviation of q/√12. A curve through samples
a time h apart turns that into accelerations of the order of q/h². So the samples are moved within their last digit, to
where the integral of the curve's acceleration squared is smallest (smoothing spline; Reinsch 1967, Numer. Math. 10,
177), while they differ from the record by no more than q/√12 in the root mean square, and nowhere by more than q/2.
"""

from decimal import Decimal

import numpy as np

from solvers.motion.history import at_rest

MANY = 20  # samples, from which on a record is smoothed: a shorter one was written by hand
DIGITS = 1e-12  # of the largest number: a smaller last digit tells nothing
ROUNDS = 16  # of bisection, over a factor of 1e24, to a thousandth
EVEN = 0.55  # last digits by which evenly spaced times may lie off a line: half a digit, and what the line is off


def last_digits(values: np.ndarray) -> np.ndarray:
    """The step (n,) of the last digit of each of the numbers (n,), all printed with as many decimals or as many digits.

    A number that was printed with zeros at its end does not tell them; the others do.
    """
    told = [Decimal(repr(x)).normalize().as_tuple() for x in values.tolist() if x]
    if not told:
        return np.zeros(len(values))
    decimals, digits = max(-one.exponent for one in told), max(len(one.digits) for one in told)
    first = np.floor(np.log10(np.abs(values), out=np.full(len(values), -np.inf), where=values != 0.0))
    return 10.0 ** np.maximum(-float(max(decimals, 0)), first + 1.0 - digits)


def even_times(time: np.ndarray) -> np.ndarray:
    """The times (n,), evenly spaced if they are so but for the rounding of their digits (0.02, 0.03, 0.05 of 60 Hz)."""
    if len(time) < MANY:
        return time
    count = np.arange(len(time))
    line = np.polynomial.Polynomial.fit(count, time, 1)(count)
    away, step = np.abs(line - time), last_digits(time)
    return line if step.max() > DIGITS * np.abs(time).max() and (away <= EVEN * step).all() else time


def smoothed(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The samples (n,) of a record at rising times (n,), moved within their digits; those at rest at an end stay."""
    step = last_digits(values)
    if len(time) < MANY or step.max() <= DIGITS * np.abs(values).max():
        return values
    free = _smoothest(time, values, step, (False, False))
    return _smoothest(time, values, step, at_rest(time, free))


def _smoothest(time: np.ndarray, values: np.ndarray, step: np.ndarray, rests: tuple[bool, bool]) -> np.ndarray:
    """The smoothest samples (n,) within the digits; `rests`: whether the curve is level at either end.

    With Q' the second differences, γ the curve's second derivatives at the samples and R their Gram matrix, R γ = Q' g;
    g = x − λ V Q γ is smoothest for (R + λ Q' V Q) γ = Q' x, V = q² (Green & Silverman 1994, section 2.3).
    """
    from scipy.linalg import solveh_banded  # slow to import

    before, middle, after, gram, beside = _differences(time, rests)
    given = (step / step.max()) ** 2
    given[[0, -1]] *= ~np.array(rests)
    left, right = np.append(0.0, given[:-1]), np.append(given[1:], 0.0)
    spread = before**2 * left + middle**2 * given + after**2 * right
    next_one = middle[:-1] * given[:-1] * before[1:] + after[:-1] * given[1:] * middle[1:]
    second = after[:-2] * given[1:-1] * before[2:]
    bend = middle * values
    bend[1:] += before[1:] * values[:-1]
    bend[:-1] += after[:-1] * values[1:]

    def moved(weight: float) -> np.ndarray:
        bands = np.zeros((3, len(time)))
        bands[2], bands[1, 1:], bands[0, 2:] = gram + weight * spread, beside + weight * next_one, weight * second
        curve = solveh_banded(bands, bend)
        push = middle * curve
        push[:-1] += before[1:] * curve[1:]
        push[1:] += after[:-1] * curve[:-1]
        return -weight * given * push

    low, high = np.log(gram.mean() / spread.mean()) + np.log(10.0) * np.array([-12.0, 12.0])
    for _ in range(ROUNDS):
        weight = 0.5 * (low + high)
        away = np.abs(moved(np.exp(weight))) / step
        within = away.max() <= 0.5 and 12.0 * (away**2).mean() <= 1.0
        low, high = (weight, high) if within else (low, weight)
    return values + moved(np.exp(low))


def _differences(time: np.ndarray, rests: tuple[bool, bool]) -> tuple[np.ndarray, ...]:
    """The three diagonals (n,) of Q', those of R, and R's (n−1,) beside it; an end that is not at rest has no bend."""
    gap = np.diff(time)
    before, after, gram, beside = np.zeros(len(time)), np.zeros(len(time)), np.ones(len(time)), gap / 6.0
    before[1:-1], after[1:-1], gram[1:-1] = 1.0 / gap[:-1], 1.0 / gap[1:], (gap[:-1] + gap[1:]) / 3.0
    if rests[0]:
        after[0], gram[0] = 1.0 / gap[0], gap[0] / 3.0
    else:
        beside[0] = 0.0
    if rests[1]:
        before[-1], gram[-1] = 1.0 / gap[-1], gap[-1] / 3.0
    else:
        beside[-1] = 0.0
    return before, -before - after, after, gram, beside
