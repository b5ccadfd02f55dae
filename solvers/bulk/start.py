"""Bulk at rest: points in a region of a tank, under the weight of what lies over them."""

from itertools import pairwise
from math import sqrt

import numpy as np

from solvers.bulk.given import POISSON
from solvers.bulk.grid import Grid
from solvers.tank.outline import inside, moments

PER_CELL = 2  # points along an axis of a cell
FINE = 8  # samples along an axis of what a point stands for
LEAST = 0.05  # of a whole point: smaller pieces of the region have none, and the rest its volume
CALLED = 0.9  # of the friction that may be called on at the start

POINT = np.dtype([("position", float, 2), ("volume", float), ("mass", float), ("pressure", float)])


def at_rest(
    region: np.ndarray, grid: Grid, tank: int, density: float, modulus: float, friction: float, gravity: float
) -> np.ndarray:
    """Points (n,) of POINT, four a cell, in a `region` (m, 2) m, counter-clockwise, of the mass that fills it.

    The pressure is that under the weight of the column above, with the stress sideways as of `sideways`. Raises
    ValueError if no point fits in.
    """
    places, volume = _laid(region, grid, tank)
    if not len(places):
        raise ValueError("the bulk's region holds no material point of this spacing")
    found = np.zeros(len(places), POINT)
    found["position"] = places
    over = density * gravity * np.maximum(0.0, _top(region, places[:, 0]) - places[:, 1])
    found["pressure"] = (1.0 + 2.0 * sideways(friction)) / 3.0 * over
    found["volume"] = volume * (1.0 + found["pressure"] / modulus)
    found["mass"] = found["volume"] * (density * volume.sum() / found["volume"].sum())
    return found


def sideways(friction: float) -> float:
    """The stress sideways over that along z of a bed at rest: that of a confined elastic one, or as friction has it.

    A confined bed has ν/(1 − ν). With both stresses sideways equal to K times the upright one, |s|/p = √3 (1 − K)/(1 +
    2 K), of which CALLED times the friction is allowed.
    """
    called = CALLED * friction
    return max(POISSON / (1.0 - POISSON), (sqrt(3.0) - called) / (sqrt(3.0) + 2.0 * called))


def _laid(region: np.ndarray, grid: Grid, tank: int) -> tuple[np.ndarray, np.ndarray]:
    """Middles (n, 2) m of the pieces of a region in quarters of cells, and their volumes (n,) m²."""
    size = grid.spacing[tank] / PER_CELL
    lower = np.floor((region.min(axis=0) - grid.origin[tank]) / size - 1e-9)
    upper = np.ceil((region.max(axis=0) - grid.origin[tank]) / size + 1e-9)
    counts = (upper - lower).astype(int)
    along = [lower[a] + (np.arange(counts[a] * FINE) + 0.5) / FINE for a in range(2)]
    samples = grid.origin[tank] + np.stack(np.meshgrid(*along, indexing="ij"), axis=-1) * size
    held = inside(samples.reshape(-1, 2), region).reshape(counts[0], FINE, counts[1], FINE)
    samples = samples.reshape(counts[0], FINE, counts[1], FINE, 2)
    number = held.sum(axis=(1, 3))
    middle = (samples * held[..., None]).sum(axis=(1, 3)) / np.maximum(number, 1)[..., None]
    wanted = number >= max(1.0, LEAST * FINE**2)
    volume = number[wanted] / FINE**2 * np.prod(size)
    return middle[wanted], volume * (moments(region)[0] / volume.sum() if volume.size else 1.0)


def _top(region: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The height (m) of the top of a region over each place (n,) m along y."""
    top = np.full(len(y), -np.inf)
    for (y0, z0), (y1, z1) in pairwise(np.vstack([region, region[:1]])):
        there = (np.minimum(y0, y1) <= y) & (y <= np.maximum(y0, y1)) & (y0 != y1)
        with np.errstate(divide="ignore", invalid="ignore"):
            top = np.where(there, np.maximum(top, z0 + (y - y0) * (z1 - z0) / (y1 - y0)), top)
    return top
