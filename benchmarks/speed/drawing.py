"""Shared drawing code for the figures of speeds."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes


def draw_with_range(axes: Axes, along: Sequence[float], speeds: Sequence[np.ndarray], colour: str, label: str) -> None:
    """A curve of the medians of grain-steps a second, one array (turns,) a point, with bars from least to most."""
    values = np.array(speeds) / 1e6
    middle = np.median(values, axis=1)
    around = np.abs(np.stack([values.min(axis=1), values.max(axis=1)]) - middle)
    axes.errorbar(along, middle, around, marker="o", markersize=4, capsize=2, color=colour, label=label)
