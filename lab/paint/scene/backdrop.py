"""Sky and sea behind a ship: shades by height, the moving surface, and lines of water that move as deep as they are.

A line of water at depth d below the still level rises and falls by e^{-kd} of the surface's, as in a linear wave over
deep water (Airy 1845); k is that of the waves' main frequency. So the picture tells how deep the waves reach.
"""

import numpy as np

from lab.paint.page.theme import Theme
from lab.paint.painter import paint_below, paint_lines

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
    _, top, _, bottom = box
    height = max(bottom - still, 1.0)
    share = np.clip((np.arange(top, bottom) + 0.5 - still) / (DEEP * height), 0.0, 1.0)[:, None]
    paint_below(picture, box, surface, theme.sea[0] + share * np.subtract(theme.sea[1], theme.sea[0]))
    depth = height * np.array(LINES)[:, None]
    moved = still + depth + (surface - still) * np.exp(-decay * depth)
    faint = [(max(FINE * thick, 1.0), FAINT / (k + 1)) for k in range(len(LINES))]
    paint_lines(picture, box, np.vstack([moved, surface]), [*faint, (thick, 1.0)], theme.surface)
