"""The figures of a run as PNG files: those of its measures, and its quantities against time.

A measure draws its figures itself (`FIGURES` in its file in `lab/measures`); here is what all figures share: style,
title, layout, legend, saving. A quantity declared with `plot=True` is drawn against time without further code.
Import this module only where figures are drawn: Matplotlib is slow to load.
"""

import textwrap
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from lab import measures
from lab.base.errors import LabError
from lab.base.files import replacing
from lab.base.text import heading
from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, band
from lab.measures.value import Value
from lab.recording import Recording
from lab.report.numbers import number
from solvers.machine.quantity import Quantity

__all__ = ["BELOW", "BLUE", "GREEN", "GREY", "STYLE", "VERMILION", "canvas", "figures", "write_plots"]

STYLE = {
    "font.size": 9,
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "legend.framealpha": 0.9,
    "legend.edgecolor": "none",
    "legend.fancybox": False,
    "legend.fontsize": 8,
    "lines.linewidth": 1.5,
    "savefig.dpi": 180,
}
SIZE = (6.4, 4.2)  # inches, of a figure with one or two rows of panels
TALLER = 0.9  # inches for each further row
BELOW = "outside lower center"  # where a legend covers no curve
TITLE = 88  # letters in a line
AXIS = 36  # letters in a line beside an axis


def canvas(size: tuple[float, float], rows: int = 1, columns: int = 1, **how: object) -> tuple[Figure, object]:
    """A figure of a size (inches), and its panel or panels, which are laid out as matplotlib's `subplots` says."""
    figure = Figure(figsize=size, layout="constrained")
    return figure, figure.subplots(rows, columns, **how)


def as_written(figure: Figure) -> None:
    """Let titles, labels, legends and notes of a figure show a $ as it is; only tick labels, made here, are formulas.

    The others may hold texts of users and of files, where a $ that begins no formula would be an error.
    """
    texts = [text for legend in figure.legends for text in legend.get_texts()] + figure.texts
    texts += [figure._suptitle] if figure._suptitle else []
    for axes in figure.axes:
        legend = axes.get_legend()
        texts += [axes.title, axes._left_title, axes._right_title, axes.xaxis.label, axes.yaxis.label, *axes.texts]
        texts += legend.get_texts() if legend else []
    for text in texts:
        text.set_parse_math(False)


class Sheet:
    """One figure of a run, with the run's title; empty until panels are asked for."""

    def __init__(self, recording: Recording) -> None:
        self.figure = Figure(figsize=SIZE, layout="constrained")
        self._columns = 2
        count = f"{recording.radius.shape[1]} grains" if recording.preset.grains else "an empty tank"
        count = f"{recording.volume.shape[1]} particles of water" if recording.preset.water else count
        count = f"bulk of {recording.bulk_volume.shape[1]} points" if recording.preset.bulk else count
        if recording.worlds > 1:
            count = f"{recording.worlds} beds of {count}; bands: ± std over beds, unless the legend says otherwise"
        title = f"{textwrap.fill(heading(recording.preset.title), TITLE)}\n{count}"
        self.figure.suptitle(title, x=0.02, ha="left", fontsize=9.5)

    def panels(self, heights: tuple = (1,), widths: tuple = (1,), columns: int = 2) -> np.ndarray:
        """Axes by row and column; those of a column share x, those of a row share y. `columns`: of the legend."""
        self._columns = columns
        self.figure.set_figheight(SIZE[1] + TALLER * max(0, len(heights) - 2))
        return self.figure.subplots(
            len(heights),
            len(widths),
            squeeze=False,
            sharex="col",
            sharey="row",
            height_ratios=heights,
            width_ratios=widths,
        )

    def words(self, value: Value) -> str:
        """A measured value with its scatter or its error, as the summary writes it."""
        return number(value)

    def finished(self) -> Figure | None:
        """The figure with a legend of all labelled curves; None if nothing is drawn on it."""
        if not self.figure.axes:
            return None
        handles = {}
        for axes in self.figure.axes:
            for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
                handles.setdefault(label, handle)
        if handles:
            self.figure.legend(handles.values(), handles.keys(), loc=BELOW, ncols=self._columns)
        as_written(self.figure)
        return self.figure


def write_plots(recording: Recording, values: Mapping[str, Value], folder: Path | str) -> dict[str, Path]:
    """Draw every figure that applies as PNG in `folder`; returns the files by name.

    Raises LabError when the folder cannot be written.
    """
    written = {}
    with matplotlib.rc_context(STYLE):
        for name, figure in figures(recording, values):
            written[name] = Path(folder) / f"{name}.png"
            try:
                with replacing(written[name]) as part:
                    figure.savefig(part)
            except OSError as error:
                reason = error.strerror or error
                raise LabError(f"{folder} cannot be written ({reason}): choose another folder.") from error
    return written


def figures(recording: Recording, values: Mapping[str, Value]) -> Iterator[tuple[str, Figure]]:
    """The figures of the measures that apply, then those of the quantities, by name; none with fewer than two samples.

    `values`: what was measured on the recording, by name.
    """
    if len(recording.series["time"]) < 2:
        return
    draws = [item for measure in measures.applicable(recording) for item in getattr(measure, "FIGURES", {}).items()]
    plotted = [quantity for quantity in recording.series.quantities.values() if quantity.plot]
    draws += [(quantity.name, partial(draw_quantity, quantity)) for quantity in plotted]
    for name, draw in draws:
        sheet = Sheet(recording)
        draw(sheet, recording, values)
        if (figure := sheet.finished()) is not None:
            yield name, figure


def draw_quantity(quantity: Quantity, sheet: Sheet, recording: Recording, _values: Mapping[str, Value]) -> None:
    """A quantity of the series against time, a panel for each component."""
    time, values = recording.series["time"], recording.series[quantity.name]
    panels = sheet.panels(heights=(1,) * quantity.width)
    for k, (axes, unit) in enumerate(zip(panels[:, 0], quantity.units, strict=True)):
        band(axes, time, values[..., k] if quantity.components else values, BLUE)
        label = quantity.components[k] if quantity.components else textwrap.fill(quantity.label, AXIS)
        axes.set_ylabel(label if unit == "1" else f"{label} ({unit})")
    panels[-1, 0].set_xlabel("time (s)")
    panels[-1, 0].set_xlim(time[0], time[-1])
    if quantity.components:
        panels[0, 0].set_title(quantity.label)
