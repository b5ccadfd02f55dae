"""Marks that fill level water evenly, for pictures."""

import numpy as np

from solvers.ship.hydrostatics import turned
from solvers.tank.outline import area_below


def marks_in(outline: np.ndarray, turn: float, level: float, count: int, spacing: float) -> np.ndarray:
    """Places (count, 2) m below a `level` (m) in a tank that is turned by `turn` (rad), in the tank's axes.

    In layers a `spacing` (m) thick from the surface down, each with as many marks as it has area, evenly from wall to
    wall. outline: (m, 2) m; the level is over the tank's origin.
    """
    upright, found, above = turned(outline.T, turn), [], 0
    floor = upright[:, 1].min()
    if not count:
        return np.zeros((0, 2))
    edges = np.maximum(level - floor - spacing * np.arange(np.ceil((level - floor) / spacing) + 1), 0.0)
    below = np.array([area_below(upright, depth) if depth else 0.0 for depth in edges])
    shares = np.rint(count * (1.0 - below / below[0])).astype(int)
    for high, low, more in zip(edges[:-1], edges[1:], shares[1:], strict=True):
        found.append(_in_row(upright, floor + 0.5 * (high + low), more - above))
        above = more
    return turned(np.concatenate(found).T, -turn)


def _in_row(outline: np.ndarray, height: float, count: int) -> np.ndarray:
    """So many places (count, 2) m evenly spread at a height (m) within an outline (m, 2) m."""
    (y0, z0), (y1, z1) = outline.T, np.roll(outline, -1, axis=0).T
    cut = (z0 > height) != (z1 > height)
    crossings = np.sort(y0[cut] + (height - z0[cut]) / (z1[cut] - z0[cut]) * (y1[cut] - y0[cut])).reshape(-1, 2)
    way = np.concatenate([[0.0], np.cumsum(np.diff(crossings, axis=1))])
    along = (np.arange(count) + 0.5) / max(count, 1) * way[-1]
    part = np.clip(np.searchsorted(way, along, side="right") - 1, 0, len(crossings) - 1)
    return np.column_stack([crossings[part, 0] + along - way[part], np.full(count, height)])
