"""The colours of a page, light and dark, in 0..255.

Every text reaches a contrast of 4.5 on what it stands on (WCAG 2.2, success criterion 1.4.3). The colours of curves are
after Okabe and Ito (2008), who chose theirs for the colour-blind, darkened or lightened for the paper, so that
they still differ as those see them who lack a kind of cones.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lab.paint import palette

RGB = tuple[int, int, int]


@dataclass(frozen=True)
class Theme:
    """The colours of one page.

    paper: around the tanks; panel: below readings and plots; ink, quiet: of texts; line, grid: of axes; wall, hold: of
    a tank and what is empty in it; glass: between the faces of a pane; ghost: a tank at rest; accent: the arrow of the
    drive; force: chains; lost, on_lost: a band and its text; sky, sea: from top to bottom; surface: the sea's line;
    on_sea: of texts over deep water; far: what stands against the sky; hull, boot, bottom, steel: a ship's side,
    waterline, underwater hull, structure; fixed: grains that line a wall; part: what moves in the tank; series: of
    curves.
    """

    paper: RGB
    panel: RGB
    ink: RGB
    quiet: RGB
    line: RGB
    grid: RGB
    wall: RGB
    hold: RGB
    glass: RGB
    ghost: RGB
    accent: RGB
    force: RGB
    lost: RGB
    on_lost: RGB
    sky: tuple[RGB, RGB]
    sea: tuple[RGB, RGB]
    surface: RGB
    on_sea: RGB
    far: RGB
    hull: RGB
    boot: RGB
    bottom: RGB
    steel: RGB
    fixed: RGB
    part: RGB
    series: tuple[RGB, ...]


LIGHT = Theme(
    paper=(240, 243, 246),
    panel=palette.PAPER,
    ink=palette.INK,
    quiet=(88, 98, 110),
    line=palette.LINE,
    grid=palette.GRID,
    wall=palette.WALL,
    hold=(251, 252, 253),
    glass=(176, 208, 220),
    ghost=(204, 211, 219),
    accent=(180, 66, 0),
    force=(136, 16, 44),
    lost=palette.LOST,
    on_lost=(255, 255, 255),
    sky=((198, 221, 239), (240, 246, 250)),
    sea=((92, 160, 201), (20, 72, 116)),
    surface=(236, 246, 252),
    on_sea=(255, 255, 255),
    far=(176, 190, 204),
    hull=(43, 58, 76),
    boot=(244, 246, 248),
    bottom=(150, 52, 44),
    steel=(205, 211, 217),
    fixed=palette.FIXED,
    part=palette.PART,
    series=palette.SERIES,
)
DARK = Theme(
    paper=(15, 20, 28),
    panel=(22, 29, 39),
    ink=(236, 240, 244),
    quiet=(162, 173, 185),
    line=(96, 108, 122),
    grid=(42, 52, 64),
    wall=(142, 154, 168),
    hold=(29, 37, 48),
    glass=(52, 84, 98),
    ghost=(58, 69, 82),
    accent=(255, 158, 74),
    force=(255, 128, 108),
    lost=palette.LOST,
    on_lost=(255, 255, 255),
    sky=((12, 20, 36), (52, 72, 98)),
    sea=((30, 84, 122), (7, 22, 40)),
    surface=(150, 196, 224),
    on_sea=(255, 255, 255),
    far=(62, 80, 102),
    hull=(96, 112, 130),
    boot=(222, 228, 234),
    bottom=(146, 58, 50),
    steel=(78, 89, 102),
    fixed=(112, 122, 134),
    part=(206, 140, 92),
    series=(
        (96, 184, 240),
        (255, 140, 64),
        (64, 204, 158),
        (236, 150, 210),
        (246, 214, 90),
        (226, 232, 238),
    ),
)
THEMES = {"light": LIGHT, "dark": DARK}


def luminance(colour: Sequence[float]) -> float:
    """Relative luminance of an sRGB colour in 0..255, 0 to 1 (WCAG 2.2)."""
    share = np.asarray(colour, dtype=float) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(one: Sequence[float], other: Sequence[float]) -> float:
    """Contrast of two colours, 1 to 21 (WCAG 2.2)."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def blend(one: RGB, other: RGB, share: float) -> RGB:
    """A colour between two others."""
    return tuple(round(a + share * (b - a)) for a, b in zip(one, other, strict=True))
