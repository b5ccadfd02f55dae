"""How much of two simple polygons lies in both."""

import numpy as np

from solvers.ship.section import crossings


def shared_area(one: np.ndarray, other: np.ndarray) -> float:
    """Area (m²) of what is in both polygons (m, 2) and (k, 2).

    Between heights of corners and of crossings the shared width is linear in height, so its middle value counts.
    """
    levels = np.unique(np.concatenate([one[:, 1], other[:, 1], _crossing_heights(one, other)]))
    middles = 0.5 * (levels[1:] + levels[:-1])
    widths = [_shared_width(_spans(one, z), _spans(other, z)) for z in middles]
    return float(np.diff(levels) @ np.array(widths)) if len(widths) else 0.0


def _spans(outline: np.ndarray, height: float) -> np.ndarray:
    """Pieces (k, 2) m of the level line at a height that are inside."""
    closed = np.concatenate([outline, outline[:1]])
    place, sign = crossings(closed[:, 0], height - closed[:, 1])
    return np.sort(place[sign != 0.0]).reshape(-1, 2)


def _shared_width(one: np.ndarray, other: np.ndarray) -> float:
    low = np.maximum(one[:, None, 0], other[None, :, 0])
    high = np.minimum(one[:, None, 1], other[None, :, 1])
    return float(np.maximum(high - low, 0.0).sum())


def _crossing_heights(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Heights (k,) m at which edges of one polygon cross those of the other."""
    begin, way = one[:, None], (np.roll(one, -1, axis=0) - one)[:, None]
    start, along = other[None], (np.roll(other, -1, axis=0) - other)[None]
    cross = way[..., 0] * along[..., 1] - way[..., 1] * along[..., 0]
    gap = start - begin
    safe = np.where(cross == 0.0, 1.0, cross)
    share = (gap[..., 0] * along[..., 1] - gap[..., 1] * along[..., 0]) / safe
    back = (gap[..., 0] * way[..., 1] - gap[..., 1] * way[..., 0]) / safe
    met = (cross != 0.0) & (share >= 0.0) & (share <= 1.0) & (back >= 0.0) & (back <= 1.0)
    return (begin[..., 1] + share * way[..., 1])[met]
