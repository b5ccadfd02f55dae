"""Beds whose grains are listed one by one in a CSV file, for scenes that verify the physics."""

from collections.abc import Sequence

import numpy as np

from lab.base.errors import LabError
from lab.preset.fields import Table
from lab.preset.outline import Point
from lab.preset.units import show
from solvers.grains.bed.filling import clear_of_walls

NEEDED = ("y", "z", "radius")
MOTION = ("vy", "vz", "omega")
MOST = 100_000
SMALLEST = 1e-7  # m, of a radius
FASTEST = 1e6  # m/s or rad/s: larger numbers are probably in another unit
# Overlap of two grains, or of a grain and a wall, in radii of the smaller: of grains as stiff as their material, and at
# most, of softer ones. A given force presses Hertz's contacts of moduli times s together s^(-2/3) times as deep.
DEEPEST, DEEPEST_OF_ALL = 0.01, 0.05

Grain = tuple[float, float, float, float, float, float]


def listed(table: Table) -> tuple[Grain, ...]:
    """y, z, radius (m), v_y, v_z (m/s), ω (rad/s) of each grain of a file, in SI."""
    zero = (0.0,) * len(table.columns["y"])
    return tuple(zip(*(table.columns.get(name, zero) for name in (*NEEDED, *MOTION)), strict=True))


def check_radii(grains: Sequence[Grain]) -> None:
    """Raise LabError for radii that no grain has."""
    radius = np.array(grains)[:, 2]
    wrong = np.flatnonzero(radius < SMALLEST)
    if len(wrong):
        least = "greater than 0" if radius[wrong[0]] <= 0.0 else f"at least {SMALLEST:g} m"
        raise LabError(f"grains.bed: the radius in row {wrong[0] + 1} must be {least} (got {radius[wrong[0]]:g}).")


def check_listed(grains: Sequence[Grain], outline: Sequence[Point], moving: bool, scale: float = 1.0) -> None:
    """Raise LabError for grains that no bed can have.

    They are outside the tank (`outline`, m), overlap by more than 1 % of a radius, or more the softer they are made by
    the factor `scale` on their moduli, or have velocities though they are to settle first (`moving` false).
    """
    rows = np.array(grains)
    _check(rows, np.array(outline), min(DEEPEST_OF_ALL, DEEPEST * scale ** (-2.0 / 3.0)))
    if not moving and np.any(rows[:, 3:]):
        raise LabError(
            "grains.bed: its grains move, but settle first; say run.settle = false or leave vy, vz and omega out."
        )


def _check(grains: np.ndarray, outline: np.ndarray, deepest: float) -> None:
    """Raise LabError for invalid grains. Messages count grains from 1, as rows below the header."""
    position, radius = grains[:, :2], grains[:, 2]
    wrong = np.flatnonzero(np.abs(grains[:, 3:]).max(axis=1) > FASTEST)
    if len(wrong):
        raise LabError(f"grains.bed: the grain in row {wrong[0] + 1} is too fast; look at its numbers and their units.")
    with np.errstate(over="ignore", invalid="ignore"):  # absurdly large positions
        wrong = np.flatnonzero(~clear_of_walls(position, outline, (1.0 - deepest) * radius))
    if len(wrong):
        place = ", ".join(show(x, "m") for x in position[wrong[0]])
        raise LabError(f"grains.bed: the grain in row {wrong[0] + 1}, at {place}, is not inside the tank.")
    _check_overlaps(position, radius, deepest)


def _check_overlaps(position: np.ndarray, radius: np.ndarray, deepest: float) -> None:
    from scipy.spatial import cKDTree  # slow to import, and only such files need it

    order = np.argsort(radius)
    tree = cKDTree(position[order])
    for rank, i in enumerate(order):  # only against smaller grains, so its own size bounds the search
        near = order[[k for k in tree.query_ball_point(position[i], 2.0 * radius[i]) if k < rank]]
        overlap = radius[i] + radius[near] - np.linalg.norm(position[near] - position[i], axis=1)
        deep = near[overlap > deepest * radius[near]]
        if len(deep):
            first, second = sorted((int(i), int(deep.min())))
            raise LabError(f"grains.bed: the grains in rows {first + 1} and {second + 1} overlap.")
