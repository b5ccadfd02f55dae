"""A plot whose curves grow with the film."""

import math
from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw

from lab.paint import decorations as deco
from lab.paint.decorations import FINER
from lab.paint.page.theme import LIGHT, Theme


class _Growing:
    """A curve that is drawn on as it grows, since a long curve takes more time than all else on a picture.

    points (T, 2): in pixels, not all finite; size: of the picture; thick: of the line, pixels.
    """

    def __init__(self, points: np.ndarray, colour: tuple, size: tuple[int, int], thick: int) -> None:
        finite = np.isfinite(points).all(axis=1)
        self._points = [tuple(point) for point in points[finite].tolist()]
        self._finite = np.concatenate([[0], np.cumsum(finite)])
        self._size, self._thick, self.colour = size, thick, colour
        self.end: tuple[float, float] | None = None
        self._clear()

    def _clear(self) -> None:
        self._drawn, self._mask = 0, Image.new("1", self._size)

    def grow(self, count: int) -> tuple | None:
        """Grow to the first `count` samples, the last of which is `end`; returns the box that has changed, if any."""
        shown, changed = int(self._finite[min(count, len(self._finite) - 1)]), None
        if shown < self._drawn:
            self._clear()
            changed = (0, 0, *self._size)
        if shown > max(self._drawn, 1):
            # Two points back, since the joint at the last point needs the segments on both of its sides.
            new = self._points[max(0, self._drawn - 2) : shown]
            ImageDraw.Draw(self._mask).line(new, fill=1, width=self._thick, joint="curve")
            changed = changed or _around(new, 2.0 * self._thick)
            self._drawn = shown
        self.end = self._points[shown - 1] if shown else None
        return changed

    def draw(self, part: Image.Image, box: tuple) -> None:
        """Draw it on a part of the picture, that in a box (left, top, right, bottom)."""
        part.paste(self.colour, (0, 0), self._mask.crop(box))


def _around(points: Sequence[tuple[float, float]], reach: float) -> tuple[float, float, float, float]:
    """The box (left, top, right, bottom) within reach of some points."""
    across, down = zip(*points, strict=True)
    return min(across) - reach, min(down) - reach, max(across) + reach, max(down) + reach


class LivePlot:
    """Curves that grow with the film; the axes are drawn once.

    size: (width, height) in pixels; curves: pairs of arrays x, y; colours: one each;
    labels: of x and y; text: height of the letters in pixels; names: texts and colours, at the upper right;
    indent: least distance of the axis from the left, for plots that stand one above the other.
    """

    def __init__(
        self,
        size: tuple,
        curves: list,
        colours: list,
        labels: tuple[str, str],
        text: float,
        names: Sequence = (),
        indent: float = 0.0,
        theme: Theme = LIGHT,
    ) -> None:
        self._text, self._names, self._theme = FINER * text, names, theme
        width, height = (FINER * round(side) for side in size)
        self._image = Image.new("RGB", (width, height), self._theme.panel)
        self._low, self._high = _limits(curves)
        top, bottom = 1.7 * self._text, height - (3.1 if labels[0] else 1.9) * self._text
        room = int((bottom - top) / (1.6 * self._text))  # number of labels that fit without touching
        self._levels = deco.ticks(self._low[1], self._high[1], min(4, max(1, room)))
        while len(self._levels) > max(2, room):  # a locator gives more than it is asked for
            self._levels = self._levels[::2]
        widest = max(deco.font(self._text).getlength(deco.plain(level)) for level in self._levels)
        self.indent = max(widest + 0.5 * self._text, indent)
        left, right = self.indent, width - 0.4 * self._text
        self._box = (left, top, right, bottom)
        placed = [self._place(np.column_stack(curve)) for curve in curves]
        self._curves = [
            _Growing(points, colour, self._image.size, round(0.16 * self._text))
            for points, colour in zip(placed, colours, strict=True)
        ]
        self._draw_axes(labels)
        self._reduced = self._image.reduce(FINER)

    def picture(self, counts: Sequence[int]) -> Image.Image:
        """The plot with the first `counts` samples of each curve; quick if they are those of the last one or more.

        Only what changes is drawn and reduced anew: the curves' new ends, and the dots on them.
        """
        grown = [curve.grow(count) for curve, count in zip(self._curves, counts, strict=True)]
        for box in filter(None, grown):
            self._renew(self._reduced, box, dots=False)
        image, ends = self._reduced.copy(), [curve.end for curve in self._curves if curve.end]
        if ends:
            self._renew(image, _around(ends, 0.32 * self._text + 1.0), dots=True)
        return image

    def _renew(self, reduced: Image.Image, around: tuple, dots: bool) -> None:
        """Draw the curves, and the dots at their ends, in the pixels of the reduced plot that a box has a part of."""
        most = (*reduced.size, *reduced.size)
        bounds = (*(math.floor(edge / FINER) for edge in around[:2]), *(math.ceil(edge / FINER) for edge in around[2:]))
        small = tuple(min(max(edge, 0), high) for edge, high in zip(bounds, most, strict=True))
        if small[0] >= small[2] or small[1] >= small[3]:
            return
        box = tuple(FINER * edge for edge in small)
        part, dot = self._image.crop(box), 0.32 * self._text
        draw = ImageDraw.Draw(part)
        for curve in self._curves:
            curve.draw(part, box)
            if dots and curve.end:
                x, y = curve.end[0] - box[0], curve.end[1] - box[1]
                draw.ellipse((x - dot, y - dot, x + dot, y + dot), fill=curve.colour, outline=self._theme.panel)
        reduced.paste(part.reduce(FINER), small[:2])

    def _place(self, points: np.ndarray) -> np.ndarray:
        left, top, right, bottom = self._box
        share = (points - self._low) / (self._high - self._low)
        return np.array([left, bottom]) + share * np.array([right - left, top - bottom])

    def _draw_axes(self, labels: tuple[str, str]) -> None:
        draw = ImageDraw.Draw(self._image)
        face, thin = deco.font(self._text), FINER
        left, top, right, bottom = self._box
        draw.text((0, 0), labels[1], self._theme.ink, face, anchor="la")
        draw.text((right, self._image.height), labels[0], self._theme.ink, face, anchor="rd")
        x, strong = float(self._image.width), deco.font(self._text, bold=True)
        gap, widths = 0.55 * self._text, [strong.getlength(name) for name, _ in self._names]
        ends = np.cumsum(np.add(widths, gap))
        fitting = int((ends < x - face.getlength(labels[1])).sum())  # of many names the last ones are left out
        for (name, colour), width in list(zip(self._names, widths, strict=True))[:fitting][::-1]:
            draw.text((x, 0), name, colour, strong, anchor="ra")
            x -= width + gap
        for value in self._levels:
            y = self._place(np.array([[self._low[0], value]]))[0, 1]
            draw.line([(left, y), (right, y)], fill=self._theme.grid, width=thin)
            draw.text((left - 0.4 * self._text, y), deco.plain(value), self._theme.quiet, face, anchor="rm")
        for value in deco.clear_ticks(self._low[0], self._high[0], right - left, face):
            x, half = self._place(np.array([[value, self._low[1]]]))[0, 0], face.getlength(deco.plain(value)) / 2
            draw.line([(x, bottom), (x, bottom + 0.3 * self._text)], fill=self._theme.line, width=thin)
            text_x = min(x, self._image.width - half)
            draw.text((text_x, bottom + 0.5 * self._text), deco.plain(value), self._theme.quiet, face, anchor="ma")
        draw.line([(left, top), (left, bottom), (right, bottom)], fill=self._theme.line, width=thin)


def _limits(curves: list) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper end of both axes: x as given, y with a margin."""
    x, y = (np.concatenate([np.asarray(curve[k], dtype=float) for curve in curves]) for k in (0, 1))
    y = y[np.isfinite(y)] if np.isfinite(y).any() else np.zeros(1)
    low, high = y.min(), y.max()
    air = max(0.06 * (high - low), 0.05)
    near, far = np.nanmin(x), np.nanmax(x)
    return np.array([near, low - air]), np.array([far if far > near else near + 1.0, high + air])
