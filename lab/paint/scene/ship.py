"""A ship in a picture: plated hull with frames, waterline, deck and coaming, and the silhouette of her superstructure.

Hull, coaming and waterline are those of the preset. The superstructure stands behind the section and is our drawing, in
proportion to her breadth; a section whose outline is given has none.
"""

from functools import cache

import numpy as np

from lab.paint.page.theme import Theme, blend
from lab.paint.painter import Camera, paint_strokes, paint_tank
from lab.preset.sections.ship import Ship

HATCH = 4  # the edge of a box's outline that its hatch leaves open: see `Ship.corners`
FRAMES = 14  # webs across the breadth of a hull
WEB, BOOT = 0.05, 0.09  # half thickness of a web and of the line on the waterline, in u
HOUSE = (  # half of the silhouette: y over half the breadth, height over deck in breadths
    *((0.70, 0.0), (0.70, 0.18), (0.90, 0.18), (0.90, 0.25), (0.62, 0.25), (0.62, 0.28), (0.10, 0.28), (0.10, 0.33)),
    *((0.025, 0.33), (0.025, 0.38)),
)
TIERS = 0.055, 0.125, 0.215  # heights of the rows of windows, in breadths
WINDOWS = 0.62, 9  # half the length of such a row over half the breadth, and how many windows it has


@cache
def silhouette(ship: Ship) -> np.ndarray | None:
    """The corners (m, 2) of the superstructure in the hull's axes, m; None for a section with an outline of its own."""
    if ship.outline is not None:
        return None
    half = np.array(HOUSE) * [0.5 * ship.breadth, ship.breadth] + [0.0, ship.deck_height]
    return np.concatenate([half, half[::-1] * [-1.0, 1.0]])


def paint_superstructure(picture: np.ndarray, camera: Camera, ship: Ship, theme: Theme) -> None:
    """Paint the superstructure; camera: of the tank's points."""
    corners = silhouette(ship)
    if corners is None:
        return
    breadth = ship.breadth
    paint_tank(picture, camera, corners - np.array(ship.hold), 0.0, theme.far, theme.far)
    ends = camera.pixels(_windows(ship)).reshape(-1, 2, 2)
    half = np.full(len(ends), 0.016 * breadth * camera.scale)
    paint_strokes(picture, np.column_stack([ends[:, 0], half, ends[:, 1], half]), blend(theme.far, theme.sky[0], 0.75))


@cache
def _windows(ship: Ship) -> np.ndarray:
    """The ends (2 n, 2) of the windows in the tank's axes, m."""
    length, count = WINDOWS
    starts, deck, breadth = np.linspace(-length, length, count) * 0.5 * ship.breadth, ship.deck_height, ship.breadth
    half = 0.225 * (starts[1] - starts[0])
    ends = [(y + side * half, deck + tier * breadth) for tier in TIERS for y in starts for side in (-1, 1)]
    return np.array(ends) - np.array(ship.hold)


def paint_hull(picture: np.ndarray, camera: Camera, ship: Ship, thick: float, theme: Theme, unit: float = 0.0) -> None:
    """Paint the section: plates `thick` pixels thick, webs between them, and the trunk below an open hatch.

    camera: of the tank's points; unit: pixels of a page's unit, 0 without webs and waterline.
    """
    hull, hold = ship.corners - np.array(ship.hold), np.array(ship.hold)
    opened = (HATCH,) if ship.hatch else ()
    paint_tank(picture, camera, hull, thick, theme.hull, theme.steel, opened)
    level = float(ship.corners[:, 1].min()) + ship.draught - hold[1]
    below = clipped(hull, level)
    if unit and len(below) > 2:
        top = [k for k in range(len(below)) if min(below[k, 1], below[(k + 1) % len(below), 1]) > level - 1e-9]
        paint_tank(picture, camera, below, thick, theme.bottom, theme.steel, top)
        _paint_webs(picture, camera, ship, unit, theme)
        _paint_waterline(picture, camera, below[below[:, 1] > level - 1e-9], thick, unit, theme)
    if ship.hatch:
        inside = hull[[HATCH + 2, HATCH - 1, HATCH, HATCH + 1]]
        paint_tank(picture, camera, inside, thick, theme.hull, theme.hold, (0, 2))


def clipped(corners: np.ndarray, level: float) -> np.ndarray:
    """The part of a polygon (m, 2) below a level (Sutherland and Hodgman 1974)."""
    found = []
    for one, two in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if one[1] <= level:
            found.append(one)
        if (one[1] <= level) != (two[1] <= level):
            share = (level - one[1]) / (two[1] - one[1])
            found.append(np.array([one[0] + share * (two[0] - one[0]), level]))
    return np.array(found).reshape(-1, 2)


def _paint_webs(picture: np.ndarray, camera: Camera, ship: Ship, unit: float, theme: Theme) -> None:
    """Webs from keel to deck, and stringers from side to side, evenly spaced."""
    ends = camera.pixels(_webs(ship)).reshape(-1, 2, 2)
    half = np.full(len(ends), max(WEB * unit, 0.4))
    paint_strokes(picture, np.column_stack([ends[:, 0], half, ends[:, 1], half]), blend(theme.steel, theme.hull, 0.3))


@cache
def _webs(ship: Ship) -> np.ndarray:
    """The ends (2 n, 2) of webs and stringers in the tank's axes, m."""
    hull = ship.corners - np.array(ship.hold)
    low, high = hull.min(axis=0), hull.max(axis=0)
    pitch = (high[0] - low[0]) / FRAMES
    lines = []
    for axis in (0, 1):
        for place in np.arange(low[axis] + pitch, high[axis] - 0.5 * pitch, pitch):
            lines += _spans(hull, axis, place)
    return np.array(lines).reshape(-1, 2)


def _spans(corners: np.ndarray, axis: int, place: float) -> list[list[tuple[float, float]]]:
    """The parts inside a polygon of the line along which coordinate `axis` is `place`."""
    one, two = corners, np.roll(corners, -1, axis=0)
    crossed = (one[:, axis] <= place) != (two[:, axis] <= place)
    share = (place - one[crossed, axis]) / (two[crossed, axis] - one[crossed, axis])
    other = 1 - axis
    met = np.sort(one[crossed, other] + share * (two[crossed, other] - one[crossed, other]))
    pairs = zip(met[::2], met[1::2], strict=False)
    return [[(place, a), (place, b)] if axis == 0 else [(a, place), (b, place)] for a, b in pairs]


def _paint_waterline(
    picture: np.ndarray, camera: Camera, ends: np.ndarray, thick: float, unit: float, theme: Theme
) -> None:
    """The line on the plates at the waterline at rest, on both sides."""
    half, out = BOOT * unit, (thick - 1.0) / camera.scale
    for y, z in ends[[np.argmin(ends[:, 0]), np.argmax(ends[:, 0])]] if len(ends) else ():
        across = camera.pixels(np.array([(y, z), (y + np.sign(y) * out, z)]))
        paint_strokes(picture, np.array([[*across[0], half, *across[1], half]]), theme.boot)
