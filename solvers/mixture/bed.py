"""The bed between whose grains water stands: how deep it is, and the pores in it."""

import numpy as np

from solvers.fluid.start.packing import area_of, below
from solvers.tank.outline import moments

STEPS = 60  # of a bisection


def is_box(outline: np.ndarray) -> bool:
    """Whether a tank is a rectangle on a level floor, where depths and areas are in proportion."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    return len(outline) == 4 and bool(((outline == low) | (outline == high)).all())


def area_up_to(outline: np.ndarray, depth: float) -> float:
    """The area (m²) of a tank up to a depth (m) over its lowest point; above the tank none is added."""
    if is_box(outline):
        return float(np.ptp(outline[:, 0])) * float(np.clip(depth, 0.0, np.ptp(outline[:, 1])))
    deep = min(depth, float(np.ptp(outline[:, 1])))
    return area_of(below(outline, float(outline[:, 1].min()) + deep)) if deep > 0.0 else 0.0


def depth_up_to(outline: np.ndarray, area: float) -> float:
    """The depth (m) up to which a tank has an area (m²); of more than it has, as if it went on as wide as it is."""
    if is_box(outline):
        return area / float(np.ptp(outline[:, 0]))
    whole, high = area_of(outline), float(np.ptp(outline[:, 1]))
    if area >= whole:
        return high + (area - whole) / float(np.ptp(outline[:, 0]))
    return _bisected(lambda depth: area_up_to(outline, depth), area, high)


def bed_depth(outline: np.ndarray, position: np.ndarray, weight: np.ndarray) -> float:
    """The depth (m) of a bed of grains at `position` (n, 2) m: as that of an even one with the same centre of mass.

    In a rectangular tank it is twice the height of the centre; `weight` (n,) is in proportion to the grains' masses.
    Of level layers of equal grains, evenly apart, that is the height of the uppermost tops (own derivation). Throws and
    holes of single grains hardly move it.
    """
    there = np.isfinite(position).all(axis=1)
    lowest, high = float(outline[:, 1].min()), float(np.ptp(outline[:, 1]))
    centre = float(np.average(position[there, 1], weights=weight[there])) - lowest
    if is_box(outline):
        return 2.0 * centre
    return _bisected(lambda depth: moments(below(outline, lowest + depth))[1][1] - lowest, centre, high)


def pores(outline: np.ndarray, position: np.ndarray, solid: np.ndarray) -> float:
    """The area (m²) of a settled bed's pores; its grains at `position` (n, 2) m take the areas `solid` (n,) m²."""
    return area_up_to(outline, bed_depth(outline, position, solid)) - float(solid.sum())


def _bisected(rising, wanted: float, high: float) -> float:
    """Where a `rising` function of a depth (m) up to `high` has a value."""
    low, tall = 1e-6 * high, high
    for _ in range(STEPS):
        middle = 0.5 * (low + tall)
        low, tall = (middle, tall) if rising(middle) < wanted else (low, middle)
    return 0.5 * (low + tall)
