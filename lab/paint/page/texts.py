"""Texts on a page, each within a box; what is written is noted, so that nothing can be cut off or overlap unseen."""

from PIL import Image, ImageDraw, ImageFont

from lab.base.text import heading
from lab.paint import decorations as deco
from lab.paint.page.layout import Box

LEAST = 0.75  # size of a text relative to its normal size, below which it is broken into two lines
SMALLEST = 0.45  # of a text in two lines
LEADING = 1.25  # distance of two lines over the height of letters


class Texts:
    """Writes on an image; `written`: the box of each text by its slot."""

    def __init__(self, image: Image.Image) -> None:
        self.draw, self.written = ImageDraw.Draw(image), {}

    def write(
        self,
        slot: str,
        box: Box,
        text: str,
        size: float,
        colour: tuple,
        *,
        bold: bool = False,
        anchor: str = "la",
    ) -> None:
        """Write a text into a box, smaller or in two lines if it is long; the anchor's letters say where in it.

        anchor: l, m, r across, and a (top), m, s (bottom) down.
        """
        text = heading(text)
        if not text:
            return
        width, height = box[2] - box[0], box[3] - box[1]
        lines, face = fitted_lines(text, width, height, size, bold)
        step = LEADING * face.size
        across = {"l": box[0], "m": 0.5 * (box[0] + box[2]), "r": box[2]}[anchor[0]]
        tall = step * (len(lines) - 1) + face.size
        top = {"a": box[1], "m": 0.5 * (box[1] + box[3] - tall), "s": box[3] - tall}[anchor[1]]
        found = []
        for k, line in enumerate(lines):
            place = across, top + k * step + 0.5 * face.size
            self.draw.text(place, line, colour, face, anchor=f"{anchor[0]}m")
            found.append(self.draw.textbbox(place, line, face, anchor=f"{anchor[0]}m"))
        self.written[slot] = (
            min(one[0] for one in found),
            min(one[1] for one in found),
            max(one[2] for one in found),
            max(one[3] for one in found),
        )


def fitted_lines(
    text: str, width: float, height: float, size: float, bold: bool = False
) -> tuple[list[str], ImageFont.FreeTypeFont]:
    """A text in one line, or in two if it would be too small, and its font; cut only if even that is too small."""
    size = min(size, height)
    natural = max(deco.font(size, bold).getlength(text), 1.0)
    if natural * LEAST <= width or height < (1.0 + LEADING) * SMALLEST * size:
        line, face = deco.fitted(text, width, size, bold)
        return [line], face
    at = min(
        (k for k, letter in enumerate(text) if letter == " "),
        key=lambda k: max(deco.font(size, bold).getlength(part) for part in (text[:k], text[k + 1 :])),
        default=None,
    )
    parts = [text] if at is None else [text[:at], text[at + 1 :]]
    longest = max(deco.font(size, bold).getlength(part) for part in parts)
    smaller = min(size, 0.98 * size * width / longest, height / (1.3 + LEADING))
    face = deco.font(max(smaller, SMALLEST * size), bold)
    return [_cut(part, width, face) for part in parts], face


def _cut(text: str, width: float, face: ImageFont.FreeTypeFont) -> str:
    whole = text
    while whole and face.getlength(text) > width:
        whole = whole[:-1].rstrip()
        text = whole + "…"
    return text
