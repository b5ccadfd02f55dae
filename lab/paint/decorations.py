"""Parts of a picture other than grains and walls: scale bar, colour bar, gravity dial."""

from functools import cache
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.ticker import MaxNLocator
from PIL import Image, ImageDraw, ImageFont

from lab.paint.colours import Colouring
from lab.paint.page.theme import LIGHT, Theme

SMALLER = 0.65  # smallest size of a text relative to its normal size; a longer text is cut
FINER = 3  # a plot and the dial are drawn this many times larger and then reduced, for smooth lines


@cache
def font(size: float, bold: bool = False) -> ImageFont.FreeTypeFont:
    """DejaVu Sans as it comes with matplotlib, `size` pixels high."""
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name, size)


def number(value: float, digits: int) -> str:
    """A number with `digits` decimals, a true minus sign, and no minus before zero."""
    text = f"{value:.{digits}f}"
    return text.replace("-", "\N{MINUS SIGN}" if float(text) else "")


def plain(value: float) -> str:
    """A round number for a tick or a scale."""
    return f"{value:g}".replace("-", "\N{MINUS SIGN}")


def fitted(text: str, width: float, size: float, bold: bool = False) -> tuple[str, ImageFont.FreeTypeFont]:
    """A text that is `width` pixels wide at most, and its font: made smaller, then cut, if it is too long."""
    natural = font(size, bold).getlength(text)
    face = font(min(size, max(SMALLER * size, 0.99 * size * width / max(natural, 1.0))), bold)
    whole = text
    while whole and face.getlength(text) > width:
        whole = whole[:-1].rstrip()
        text = whole + "…"
    return text, face


def fits(text: str, width: float, size: float, bold: bool = False) -> bool:
    """Whether `fitted` leaves a text whole."""
    return fitted(text, width, size, bold)[0] == text


def wrapped(text: str, width: float, size: float, most: int) -> list[str]:
    """A text in lines that are `width` pixels wide at most; the last of `most` is cut where it is too long."""
    face, lines = font(size), [""]
    for word in text.split():
        longer = f"{lines[-1]} {word}".strip()
        if len(lines) == most or not lines[-1] or face.getlength(longer) <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    while face.getlength(lines[-1]) > width:
        lines[-1] = lines[-1].rstrip("…")[:-1].rstrip() + "…"
    return lines


def ticks(low: float, high: float, most: int) -> list[float]:
    """At most `most` + 1 round numbers between low and high."""
    places = MaxNLocator(nbins=most, steps=[1, 2, 5, 10]).tick_values(low, high)
    slack = 1e-9 * (high - low)
    return [float(place) for place in places if low - slack <= place <= high + slack]


def clear_ticks(low: float, high: float, width: float, face: ImageFont.FreeTypeFont) -> list[float]:
    """Round numbers between low and high, few enough for their labels to be well separated on `width` pixels."""
    for most in (5, 4, 3, 2, 1):
        places = ticks(low, high, most)
        widest = max((face.getlength(plain(place)) for place in places), default=0.0)
        if len(places) < 2 or width * (places[1] - places[0]) / (high - low) > 1.9 * widest:
            break
    return places


def round_length(longest: float) -> float:
    """The longest of 1, 2, 5, 10, 20 ... (m) that is not longer than `longest`."""
    power = 10.0 ** np.floor(np.log10(longest))
    return float(power * max(step for step in (1, 2, 5) if step <= longest / power + 1e-9))


def draw_scale_bar(
    draw: ImageDraw.ImageDraw, corner: tuple, longest: float, scale: float, size: float, colour: tuple = LIGHT.ink
) -> tuple:
    """A bar of a round length with its length to the right; returns the box of both.

    corner: its lower left, longest: its length at most (pixels); scale: pixels a metre.
    """
    length = round_length(longest / scale)
    left, bottom = corner
    right, tick, thick = left + length * scale, 0.3 * size, max(1, round(size / 9))
    draw.line([(left, bottom - tick), (right, bottom - tick)], fill=colour, width=thick)
    for end in (left, right):
        draw.line([(end, bottom - 2 * tick), (end, bottom)], fill=colour, width=thick)
    text = f"{plain(length)} m" if length >= 1 else f"{plain(1000 * length)} mm"
    place = right + 0.6 * size, bottom - tick
    draw.text(place, text, colour, font(size), anchor="lm")
    written = draw.textbbox(place, text, font(size), anchor="lm")
    return left, min(bottom - 2 * tick, written[1]), written[2], max(bottom, written[3])


def draw_band(draw: ImageDraw.ImageDraw, box: tuple, text: str, size: float, theme: Theme = LIGHT) -> None:
    """A prominent sentence: white on a coloured bar, in the middle of a box (left, top, right, bottom)."""
    left, top, right, bottom = (round(edge) for edge in box)
    draw.rectangle((left, top, right, bottom), fill=theme.lost)
    words, face = fitted(text, right - left - size, size, bold=True)
    draw.text((0.5 * (left + right), 0.5 * (top + bottom)), words, theme.on_lost, face, anchor="mm")


def draw_colour_bar(image: Image.Image, box: tuple, colouring: Colouring, size: float, theme: Theme = LIGHT) -> None:
    """Label, bar and ticks inside the box (left, top, right, bottom) of pixels; of cargo, dots with its names."""
    left, top, right, _ = (round(edge) for edge in box)
    draw = ImageDraw.Draw(image)
    label, face = fitted(colouring.label, right - left, size)
    draw.text((left, top), label, theme.ink, face, anchor="la")
    if colouring.look:
        _draw_dots(draw, (left, top + 1.8 * size, right), colouring, size, theme)
        return
    upper, lower = round(top + 1.7 * size), round(top + 2.5 * size)
    columns = np.arange(right - left) * len(colouring.table) // (right - left)
    bar = np.tile(colouring.table[columns].astype(np.uint8), (lower - upper, 1, 1))
    image.paste(Image.fromarray(bar), (left, upper))
    low, high = colouring.low, colouring.high
    places = colouring.ticks or {place: plain(place) for place in clear_ticks(low, high, right - left, font(size))}
    for place, text in places.items():
        x = left + (right - left) * (place - low) / (high - low)
        half = font(size).getlength(text) / 2
        x_text = min(max(x, left + half), right - half)
        draw.line([(x, lower), (x, lower + 0.3 * size)], fill=theme.quiet)
        draw.text((x_text, lower + 0.5 * size), text, theme.quiet, font(size), anchor="ma")


def _draw_dots(draw: ImageDraw.ImageDraw, line: tuple, colouring: Colouring, size: float, theme: Theme) -> None:
    """A dot and a name for each colour of a table, from the left of a line (left, top, right) on; at most what fits."""
    x, top, right = line
    for colour, name in zip(colouring.table, colouring.ticks.values(), strict=True):
        text, face = fitted(name, right - x - 1.6 * size, size)
        if right - x < 4.0 * size:
            break
        draw.ellipse((x, top, x + 1.1 * size, top + 1.1 * size), fill=tuple(colour.astype(int)), outline=theme.quiet)
        draw.text((x + 1.6 * size, top + 0.55 * size), text, theme.quiet, face, anchor="lm")
        x += 2.8 * size + face.getlength(text)


def gravity_dial(diameter: int, tilt: float, theme: Theme = LIGHT) -> Image.Image:
    """A dial with an arrow in the direction of gravity in the tank's frame (tilt in rad)."""
    size = FINER * diameter
    image = Image.new("RGB", (size, size), theme.panel)
    draw = ImageDraw.Draw(image)
    middle, radius, thick = size / 2, 0.48 * size, max(FINER, size // 60)
    down = np.array([-np.sin(tilt), np.cos(tilt)])  # R(-phi) (0, -1), the picture's rows downwards
    level = np.array([down[1], -down[0]])

    def place(along: float, across: float) -> tuple[float, float]:
        return tuple(middle + radius * (along * down + across * level))

    rim = (middle - radius, middle - radius, middle + radius, middle + radius)
    draw.ellipse(rim, fill=theme.hold, outline=theme.line, width=thick)
    draw.line([place(0, -0.96), place(0, 0.96)], fill=theme.line, width=thick)
    draw.line([place(-0.55, 0), place(0.45, 0)], fill=theme.ink, width=2 * thick)
    draw.polygon([place(0.8, 0), place(0.35, 0.2), place(0.35, -0.2)], fill=theme.ink)
    draw.text(place(-0.3, 0.35), "g", theme.ink, font(0.24 * size), anchor="mm")
    return image.reduce(FINER)
