"""Colours and curves of the figures that measures draw, on axes that the report lends them.

This module does not load Matplotlib: it calls methods of the axes it is given.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol

import numpy as np

from lab.measures.value import Value
from lab.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe and Ito's colours, which colour-blind readers can tell apart too.
BLUE, VERMILION, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#777777"
POINTS = 1500  # of a curve; more cannot be seen
PERIODS = 4  # of a driven run, shown close up
DRIVE = {  # how the driving motion is written on an axis, and the factor to that unit
    "sway": ("sway of the\ntank (mm)", 1e3),
    "heave": ("heave of the\ntank (mm)", 1e3),
    "roll": ("roll of the\ntank (deg)", np.degrees(1.0)),
}


class Sheet(Protocol):
    """An empty figure that the report lends to a measure; it brings the title, and the legend when it is saved."""

    def panels(self, heights: tuple = (1,), widths: tuple = (1,), columns: int = 2) -> np.ndarray:
        """Axes by row and column; those of a column share x, those of a row share y. `columns`: of the legend."""
        ...

    def mark(self, axes: "Axes", value: Value | None, name: str, colour: str, style: str = "-") -> None:
        """An upright line at a measured value, which the legend gives as a number; nothing for a value not found."""
        ...


class Draw(Protocol):
    """Draws one figure of a measure; a sheet on which no panels were asked for is left out of the report."""

    def __call__(self, sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
        """`values`: everything that was measured on the recording, by name."""
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
