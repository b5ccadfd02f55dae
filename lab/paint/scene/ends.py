"""The bands with what came of ships."""

from collections.abc import Sequence

from PIL import Image, ImageDraw

from lab.paint import decorations as deco
from lab.paint.footage import Bed
from lab.paint.page.layout import Box
from lab.paint.page.theme import Theme

BAND = 2.6  # u, height


def draw_ends(
    image: Image.Image, beds: Sequence[Bed], boxes: Sequence[Box], time: float, unit: float, theme: Theme
) -> None:
    """Draw a band with the text on the loss of each ship lost so far (s), at the foot of her box of pixels."""
    draw = ImageDraw.Draw(image)
    for bed, (left, _, right, bottom) in zip(beds, boxes, strict=True):
        end = bed.footage.ends[bed.world]
        if end and end.time <= time + 1e-9:
            height = min(BAND * unit, 0.25 * (right - left))
            size = min(1.45 * unit, 0.6 * height)
            said = f"She {end.words}"
            if not deco.fits(said, right - left - size, size, bold=True):
                said = said.partition(",")[0]
            deco.draw_band(draw, (left, bottom - height, right, bottom), said, size, theme)
