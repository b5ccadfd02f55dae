"""Contact forces in numbers: those on one grain, and how many contacts there are."""

import numpy as np

from solvers.grains.pressing import NOBODY, Pressing


def on_grain(pressing: Pressing, grain: int) -> np.ndarray:
    """The forces (k,) N that press on a grain."""
    return np.hypot(*pressing.force[(pressing.grains == grain).any(axis=1)].T)


def contacts_each(pressing: Pressing, count: int) -> float:
    """Mean number of contacts per grain; a contact between grains counts for both, one with a wall for one grain."""
    return float((pressing.grains != NOBODY).sum()) / count
