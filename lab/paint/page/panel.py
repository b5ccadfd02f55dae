"""The panel of a page: clock, readings, gravity dial, plots and legend, each in its box."""

from collections.abc import Sequence

import numpy as np
from PIL import Image

from lab.paint import decorations as deco
from lab.paint.curves import TOLERANCE, Plot
from lab.paint.page.layout import CLOCK, READING, TEXT, Layout
from lab.paint.page.live_plot import LivePlot
from lab.paint.page.texts import Texts
from lab.paint.page.theme import Theme

LONG = 1.0  # m: where sway or heave are ever as large, both are told in metres


class Panel:
    """Draws the panel; `moved` (F, K, 3): sway, heave, roll of the beds as shown; together: whether all are alike."""

    def __init__(self, layout: Layout, theme: Theme, time: np.ndarray, moved: np.ndarray, together: bool) -> None:
        self._layout, self._theme, self._time, self._moved = layout, theme, time, moved
        self._together, self._in_metres = together, bool(np.abs(moved[..., :2]).max() >= LONG)
        self._plots: list[tuple[LivePlot, list[np.ndarray], tuple[int, int]]] = []

    def prepare(self, drawn: Sequence[Plot]) -> None:
        """Lay out the plots one above the other, their axes below each other."""
        layout, text = self._layout, TEXT * self._layout.unit
        left, top, right, bottom = layout["plots"]
        gap, below = (layout.u(0.8), layout.u(1.2)) if len(drawn) > 1 else (0, 0)  # the last one says what is across
        height = (bottom - top - below - gap * (len(drawn) - 1)) // len(drawn)
        found, indent = [], 0.0
        for plot in (*drawn, *drawn):  # twice, for the indent
            last = plot is drawn[-1]
            labels, size = (plot.labels[0] if last else "", plot.labels[1]), (right - left, height + last * below)
            live = LivePlot(size, plot.curves, plot.colours, labels, text, plot.names, indent, self._theme)
            found.append((live, plot.samples, (left, top + (len(found) % len(drawn)) * (height + gap))))
            indent = max(indent, live.indent)
        self._plots = found[len(drawn) :]

    def draw(self, image: Image.Image, texts: Texts, frame: int, moments: Sequence[float] | None = None) -> None:
        """Draw what changes; moments: times up to which the curves are drawn, in place of the picture's."""
        layout, theme, unit = self._layout, self._theme, self._layout.unit
        if moments is None:
            clock = f"{deco.number(self._time[frame], 2)} s"
            texts.write("clock", layout["clock"], clock, CLOCK * unit, theme.ink, bold=True, anchor="lm")
            if self._together:
                self._draw_readings(image, texts, frame)
        now = (self._time[frame] if moments is None else max(moments)) + 1e-9
        for plot, samples, corner in self._plots:
            image.paste(plot.picture([max(1, int(np.searchsorted(time, now, "right"))) for time in samples]), corner)

    def _draw_readings(self, image: Image.Image, texts: Texts, frame: int) -> None:
        layout, theme = self._layout, self._theme
        left, top, right, _ = layout["readings"]
        if "dial" in layout.boxes:
            box = layout["dial"]
            image.paste(deco.gravity_dial(box[2] - box[0], float(self._moved[frame, 0, 2]), theme), box[:2])
        step = round(1.75 * READING * layout.unit)
        for line, (name, value) in enumerate(self.readings(frame, 0)):
            box = left, top + line * step, right, top + (line + 1) * step
            texts.write(f"reading {line}", box, f"{name} {value}", READING * layout.unit, theme.ink, anchor="lm")

    def readings(self, frame: int, k: int) -> list[tuple[str, str]]:
        """Names and values of tilt, sway and heave of a shown bed, without those that never change."""
        sway, heave, tilt = self._moved[frame, k].tolist()
        moves = moving(self._moved)
        told = [
            ("φ =", f"{deco.number(np.degrees(tilt), 1)}°"),
            ("sway", self._length(sway)),
            ("heave", self._length(heave)),
        ]
        return [reading for reading, moves_so in zip(told, moves, strict=True) if moves_so]

    def _length(self, metres: float) -> str:
        """A sway or a heave, in the same unit throughout."""
        return f"{deco.number(metres, 2)} m" if self._in_metres else f"{deco.number(1000 * metres, 1)} mm"


def moving(moved: np.ndarray) -> np.ndarray:
    """Whether roll, sway and heave (3,) ever differ from rest, of sway, heave and roll (F, K, 3)."""
    return (np.abs(moved) > TOLERANCE).any(axis=(0, 1))[[2, 0, 1]]
