"""Colours and curves of the figures that measures draw, on axes that the report lends them.

This module does not load Matplotlib: it calls methods of the axes it is given.
"""

from typing import TYPE_CHECKING, Protocol

import numpy as np

from lab.measures.value import Value

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe and Ito's colours, which colour-blind readers can tell apart too.
BLUE, VERMILION, GREEN, PURPLE, GREY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#777777"
POINTS = 1500  # of a curve; more cannot be seen
PERIODS = 4  # of a driven run, shown close up
DRIVE = {  # how the driving motion is written on an axis, and the factor to that unit
    "sway": ("sway of the\ntank (mm)", 1e3),
    "heave": ("heave of the\ntank (mm)", 1e3),
    "roll": ("roll of the\ntank (deg)", np.degrees(1.0)),
}


class Sheet(Protocol):
    """An empty figure that the report lends to a measure; it brings title, legend and the wording of numbers."""

    def panels(self, heights: tuple = (1,), widths: tuple = (1,), columns: int = 2) -> np.ndarray:
        """Axes by row and column; those of a column share x, those of a row share y. `columns`: of the legend."""
        ...

    def words(self, value: Value) -> str:
        """A measured value with its scatter or its error, as the summary writes it: "25.0 ± 1.3 deg (4 beds)"."""
        ...


def band(axes: "Axes", x: np.ndarray, curves: np.ndarray, colour: str, label: str | None = None) -> None:
    """Mean of curves (T, W) over x (T,), with their standard deviation as a band; NaN in a world is left out."""
    x, curves = thinned(x, curves)
    known = np.ma.masked_invalid(curves)
    mean = known.mean(axis=1).filled(np.nan)
    axes.plot(x, mean, color=colour, label=label)
    if curves.shape[1] > 1:
        std = np.ma.filled(known.std(axis=1, ddof=1), 0.0)
        axes.fill_between(x, mean - std, mean + std, color=colour, alpha=0.2, lw=0)


def median_band(axes: "Axes", x: np.ndarray, curves: np.ndarray, colour: str, label: str) -> None:
    """Median of positive curves (T, W) over x (T,), with all of them inside a band."""
    x, curves = thinned(x, np.where(curves > 0, curves, np.nan))
    middle = np.ma.median(np.ma.masked_invalid(curves), axis=1)
    text = f"{label}: median, band: all beds" if curves.shape[1] > 1 else label
    axes.plot(x, np.ma.filled(middle, np.nan), color=colour, label=text, lw=1.0)
    if curves.shape[1] > 1:
        low, high = np.fmin.reduce(curves, axis=1), np.fmax.reduce(curves, axis=1)
        axes.fill_between(x, low, high, color=colour, alpha=0.2, lw=0)


def mark(sheet: Sheet, axes: "Axes", value: Value | None, name: str, colour: str, style: str = "-") -> None:
    """An upright line at a measured value, its number in the legend; nothing for a value that was not found.

    A solid line has a band: ± the standard deviation over beds, of a single bed ± the measure's own uncertainty.
    """
    if value is None or value.value is None:
        return
    axes.axvline(value.value, color=colour, lw=1.0, ls=style, label=f"{name} {sheet.words(value)}")
    if style == "-" and error_of(value):
        axes.axvspan(value.value - error_of(value), value.value + error_of(value), color=colour, alpha=0.12, lw=0)


def level(
    sheet: Sheet, axes: "Axes", value: Value | None, name: str, colour: str, span: tuple[float, float] | None = None
) -> None:
    """A level line at a measured value with a band as `mark` has it, between two x or over the whole width."""
    if value is None or value.value is None:
        return
    begin, end = axes.get_xlim() if span is None else span
    _level(axes, value.value, error_of(value), colour, (begin, end), f"{name} {sheet.words(value)}")


def swing(
    sheet: Sheet, axes: "Axes", middle: float, value: Value | None, name: str, colour: str, span: tuple[float, float]
) -> None:
    """Two level lines a measured amplitude above and below a middle, between two x; bands as `mark` has them."""
    if value is None or value.value is None:
        return
    _level(axes, middle + value.value, error_of(value), colour, span, f"{name} {sheet.words(value)}")
    _level(axes, middle - value.value, error_of(value), colour, span, None)


def _level(
    axes: "Axes", height: float, error: float, colour: str, span: tuple[float, float], label: str | None
) -> None:
    """One level line with its band."""
    axes.plot(span, (height, height), color=colour, lw=1.0, ls="--", label=label)
    axes.fill_between(span, height - error, height + error, color=colour, alpha=0.12, lw=0)


def note(sheet: Sheet, axes: "Axes", value: Value | None, name: str) -> None:
    """A measured value in the legend alone."""
    if value is not None and value.value is not None:
        axes.plot([], [], " ", label=f"{name} {sheet.words(value)}")


def error_of(value: Value) -> float:
    """Standard deviation over beds, of a single bed the measure's own uncertainty; 0 where neither is known."""
    return value.std if value.std is not None else value.uncertainty or 0.0


def middle_of(curves: np.ndarray) -> float:
    """Mean of all finite numbers of curves (T, W); NaN if there are none."""
    known = curves[np.isfinite(curves)]
    return float(known.mean()) if len(known) else np.nan


def mean_label(worlds: int) -> str:
    """What the legend calls the curve of `band`."""
    return f"mean ± std of {worlds} beds" if worlds > 1 else "bed"


def millimetres(axes: "Axes", scale: float) -> None:
    """A second scale on the right, `scale` millimetres for each unit of the left one."""
    right = axes.secondary_yaxis("right", functions=(lambda y: y * scale, lambda y: y / scale))
    right.set_ylabel("(mm)", rotation=0, ha="left", va="bottom", y=1.0)
    right.spines["right"].set_visible(True)


def thinned(x: np.ndarray, curves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """At most about POINTS rows of both."""
    stride = max(1, len(x) // POINTS)
    return x[::stride], curves[::stride]


def close_up(time: np.ndarray, frequency: float) -> float:
    """Where the last PERIODS of a driven run begin (s)."""
    return max(time[-1] - PERIODS / frequency, time[0])
