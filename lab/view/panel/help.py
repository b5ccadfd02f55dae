"""The help card over the picture: actions of keys and mouse."""

from collections.abc import Sequence

from PIL import Image, ImageDraw

from lab.paint import decorations as deco
from lab.paint import palette

MOUSE = (
    ("drag", "move the picture"),
    ("right drag", "tilt the tank"),
    ("drag the cross", "move the centre of roll"),
    ("click a grain", "its speed, spin and forces"),
    ("wheel", "zoom in or out"),
)
EDGE, ROW, NAME = 1.5, 1.6, 8.8  # margin, height of a row, width of the names' column, in letter heights


def draw_help(image: Image.Image, keys: Sequence[tuple[str, str]], size: float) -> None:
    """Draw the card in the middle of the picture, with letters `size` pixels high; keys: names and actions."""
    rows = [*keys, *MOUSE]
    half = -(-len(rows) // 2)
    widths = [max(deco.font(size).getlength(text) for _, text in part) for part in (rows[:half], rows[half:])]
    width, height = sum(widths) + (2 * NAME + 3 * EDGE) * size, (half * ROW + 2 * EDGE) * size
    left, top = 0.5 * (image.width - width), 0.5 * (image.height - height)
    draw = ImageDraw.Draw(image)
    draw.rectangle((left, top, left + width, top + height), fill=palette.PAPER, outline=palette.LINE, width=2)
    for k, (name, text) in enumerate(rows):
        x = left + EDGE * size + k // half * (widths[0] + (NAME + EDGE) * size)
        y = top + (EDGE + (k % half + 0.5) * ROW) * size
        draw.text((x, y), name, palette.INK, deco.font(size, True), anchor="lm")
        draw.text((x + NAME * size, y), text, palette.INK, deco.font(size), anchor="lm")
