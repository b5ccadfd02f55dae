"""The wetted surface of a hull by the girths of its stations."""

from collections.abc import Sequence

import numpy as np

from solvers.ship.section import Section


def wetted_surface(sections: Sequence[Section | None], weights: np.ndarray, level: np.ndarray) -> float:
    """S = ∫ G dx + A_ends, by definition for a prism: girths G under water along her, and flat ends.

    weights (n,) m sum along the stations; level (n,) m: heights of the water at them. A_ends is what is immersed of the
    outermost stations, such as a transom. At a station without an area the girth is that of a stem or stern frame as
    deep as the station beside it.

    Limits: that the girths slope along her is left out, half the mean square of that slope, some (B/L)² of S.
    Units: m, m².
    """
    pairs = zip(sections, level, strict=True)
    girths = np.array([0.0 if one is None else wetted_girth(one.outline, z) for one, z in pairs])
    for end, beside in ((0, 1), (-1, -2)):
        if sections[end] is None and sections[beside] is not None:
            girths[end] = 2.0 * max(level[end] - float(sections[beside].outline[:, 1].min()), 0.0)
    ends = [(sections[k], level[k]) for k in (0, -1) if sections[k] is not None]
    return float(weights @ girths + sum(section.immersion(-z, 0.0).area for section, z in ends))


def wetted_girth(outline: np.ndarray, level: float) -> float:
    """Length (m) of a closed outline (m, 2) under water up to the height `level` (m); an edge in its surface is dry."""
    after = np.roll(outline, -1, axis=0)
    low = np.minimum(outline[:, 1], after[:, 1])
    high = np.maximum(outline[:, 1], after[:, 1])
    rise = np.where(high > low, high - low, 1.0)
    share = np.where(high > low, np.clip((level - low) / rise, 0.0, 1.0), low < level)
    return float(share @ np.hypot(*(after - outline).T))
