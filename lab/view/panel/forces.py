"""Contact forces as they are drawn: force chains, and the forces on one grain."""

import numpy as np

from solvers.grains.pressing import NOBODY, Pressing

TYPICAL = 0.99  # quantile of the forces that is drawn with thickness 1
MOST = 1.5  # largest thickness, for still larger forces


def chains(pressing: Pressing, place: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Lines (k, 2, 2) m from grains' centres to contact points, their thickness, and the force (N) of thickness 1.

    place: positions (n, 2) m of the grains. A force between grains is two lines; only for discs are they collinear.
    """
    force = np.hypot(*pressing.force.T)
    if not len(force):
        return np.zeros((0, 2, 2)), force, 0.0
    largest = float(np.quantile(force, TYPICAL))
    mutual = pressing.grains[:, 1] != NOBODY
    grains = np.concatenate([pressing.grains[:, 0], pressing.grains[mutual, 1]])
    ends = np.concatenate([pressing.place, pressing.place[mutual]])
    forces = np.concatenate([force, force[mutual]])
    return np.stack([place[grains], ends], axis=1), np.minimum(forces / largest, MOST), largest


def on_grain(pressing: Pressing, grain: int) -> np.ndarray:
    """The forces (k,) N that press on a grain."""
    return np.hypot(*pressing.force[(pressing.grains == grain).any(axis=1)].T)


def contacts_each(pressing: Pressing, count: int) -> float:
    """Mean number of contacts per grain; a contact between grains counts for both, one with a wall for one grain."""
    return float((pressing.grains != NOBODY).sum()) / count


def newtons(force: float) -> str:
    """A force with its unit."""
    return f"{force:.2g} N" if force >= 0.1 else f"{1e3 * force:.2g} mN" if force >= 1e-4 else f"{1e6 * force:.2g} µN"
