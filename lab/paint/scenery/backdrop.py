"""Sky and sea behind a ship: shades by height, the moving surface, and lines of water that move as deep as they are.

A line of water at depth d below the still level rises and falls by e^{-kd} of the surface's, as in a linear wave over
deep water (Airy 1845); k is that of the waves' main frequency. So the picture tells how deep the waves reach.
"""

import numpy as np

from lab.paint.page.theme import Theme

DEEP = 0.9  # of the height of the water in the picture at which its shade is deepest
LINES = 0.12, 0.30, 0.58  # depths of the lines over the height of the water
FAINT = 0.16  # opacity of the first line
FINE = 0.45  # thickness of such a line over that of the surface


def shades(one: tuple, other: tuple, count: int) -> np.ndarray:
    """Colours (count, 1, 3) from one to the other."""
    share = np.linspace(0.0, 1.0, max(count, 1))[:, None, None]
    return np.round(np.array(one) + share * (np.array(other) - np.array(one))).astype(np.uint8)


def paint_sky(picture: np.ndarray, box: tuple, horizon: float, theme: Theme) -> None:
    """Paint the sky into a box (left, top, right, bottom) of pixels; palest at the row of the horizon."""
    left, top, right, bottom = box
    low = int(np.clip(round(horizon), top, bottom))
    picture[top:low, left:right] = shades(*theme.sky, low - top)[: low - top]
    picture[low:bottom, left:right] = theme.sky[1]


def paint_sea(
    picture: np.ndarray, box: tuple, still: float, surface: np.ndarray, thick: float, theme: Theme, decay: float
) -> None:
    """Paint the water below a surface into a box of pixels, in place.

    still: row of the still level; surface: row of the surface in each column of the box; decay: k in 1/pixel.
    """
    left, top, right, bottom = box
    height = max(bottom - still, 1.0)
    rows = np.arange(top, bottom)
    share = np.clip((rows + 0.5 - still) / (DEEP * height), 0.0, 1.0)[:, None, None]
    shade = np.array(theme.sea[0]) + share * (np.array(theme.sea[1]) - np.array(theme.sea[0]))
    first = int(np.clip(np.floor(surface.min() - thick - 2.0), top, bottom))
    last = int(np.clip(np.ceil(surface.max() + thick + 2.0), first, bottom))
    picture[last:bottom, left:right] = np.round(shade[last - top :]).astype(np.uint8)
    part = picture[first:last, left:right].astype(np.float32)
    row = rows[first - top : last - top, None]
    below = np.clip(row + 1.0 - surface, 0.0, 1.0)[..., None]
    part += below * (shade[first - top : last - top] - part)
    picture[first:last, left:right] = np.round(part).astype(np.uint8)
    for k, depth in enumerate(LINES):
        moved = still + depth * height + (surface - still) * np.exp(-decay * depth * height)
        _paint_line(picture, box, moved, max(FINE * thick, 1.0), theme.surface, FAINT / (k + 1))
    _paint_line(picture, box, surface, thick, theme.surface, 1.0)


def _paint_line(
    picture: np.ndarray, box: tuple, place: np.ndarray, thick: float, colour: tuple, strength: float
) -> None:
    """Mix a line at a row for each column of a box into a picture."""
    left, top, right, bottom = box
    first = int(np.clip(np.floor(place.min() - thick - 1.0), top, bottom))
    last = int(np.clip(np.ceil(place.max() + thick + 1.0), first, bottom))
    if first == last:
        return
    row = np.arange(first, last)[:, None] + 0.5
    line = strength * np.clip(0.5 * thick + 0.5 - np.abs(row - place), 0.0, 1.0)[..., None]
    part = picture[first:last, left:right].astype(np.float32)
    part += line * (np.array(colour, dtype=np.float32) - part)
    picture[first:last, left:right] = np.round(part).astype(np.uint8)
