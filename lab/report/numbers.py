"""How numbers are written: ± is the standard deviation over beds and nothing else (docs/numbers.md).

Summaries, reports, figures and the terminal take the text of a number with its scatter, error or interval from here.
"""

from collections.abc import Sequence
from math import isfinite, isinf

from lab.measures.value import LEVEL
from lab.measures.written import digits_of, number, own, plus_minus, with_blank, with_error

__all__ = ["BARS", "RULE", "count_of", "interval", "mean_within", "number", "own", "plus_minus", "with_error"]

MOST_DIGITS = 6  # after the point
RULE = (
    "± is the standard deviation over beds, whose number is in brackets; a single bed has none. A measure's own "
    "uncertainty is given with its name: see `docs/numbers.md`."
)
# For the axis of a figure whose bars are standard deviations
BARS = "mean ± std over beds"


def interval(low: float, high: float, unit: str = "", level: float = LEVEL) -> str:
    """An interval with its level: "[18.2, 23.1] deg (95 %)"."""
    width = high - low
    digits = digits_of(0.5 * width) if width > 0.0 and isfinite(width) else 3
    ends = ", ".join(_end(end, digits) for end in (low, high))
    return f"[{ends}]{with_blank(unit)} ({100.0 * level:g} %)"


def mean_within(mean: float, ends: Sequence[float] | None, digits: int) -> str:
    """A mean and its interval, for tables whose heading gives the level: "31.10 [27.37, 34.83]"."""
    if ends is None:
        return f"{mean:.{digits}f}"
    return f"{mean:.{digits}f} [{', '.join(f'{end:.{digits}f}' for end in ends)}]"


def count_of(count: int, noun: str) -> str:
    """A number of things in words: "3 grains"."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def _end(number: float, digits: int) -> str:
    if isinf(number):
        return "−∞" if number < 0.0 else "∞"
    return f"{number:.{digits}f}" if digits <= MOST_DIGITS else f"{number:.2g}"
