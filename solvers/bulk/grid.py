"""The grid of the bulk in its tanks: nodes, how much of each is inside, and what walls hold it."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from solvers.tank.outline import inside, moments
from solvers.tank.tank import Tank

MARGIN = 2  # cells outside a tank, on all sides
FINE = 8  # samples of a cell along an axis, of which it is found how much of it lies in the tank
HELD = 0.5  # cells from a wall up to which its nodes are held: on average the wall is then where it is drawn
BEYOND = 2.5  # cells behind a wall up to which nodes are held
MOST = 3  # walls that hold one node
FREE = 1e-6  # of a whole node: with less inside it has no density


@dataclass(frozen=True, eq=False)
class Grid:
    """Columns of nodes of all tanks side by side, each with so many `rows`.

    `spacing` (tanks, 2) m between nodes, `origin` (tanks, 2) m of the first one, `first` (tanks + 1,) of their columns.
    `share` (columns, rows): the volume (m²) of a node inside its tank, ∫ N over the tank. `walls` (columns, rows, MOST,
    2): unit normals, into the tank, of the walls that hold a node; none: zero. `kept`: number of a column's tank.
    """

    spacing: np.ndarray
    origin: np.ndarray
    first: np.ndarray
    share: np.ndarray
    walls: np.ndarray

    @property
    def columns(self) -> int:
        """How many columns there are."""
        return len(self.share)

    @property
    def rows(self) -> int:
        """How many nodes are in a column."""
        return self.share.shape[1]

    @property
    def kept(self) -> np.ndarray:
        """The tank (columns,) of each column."""
        return np.searchsorted(self.first[1:], np.arange(self.columns), side="right")

    @property
    def smallest(self) -> float:
        """The smallest distance (m) between two nodes."""
        return float(self.spacing.min())


def grid_of(tanks: Sequence[Tank], spacing: float) -> Grid:
    """The grid in tanks, of cells about as wide as a `spacing` (m): a whole number goes across each tank."""
    sizes = [_size(tank.outline, spacing) for tank in tanks]
    rows = max(across[1] for across, _ in sizes) + 2 * MARGIN + 2
    counts = [across[0] + 2 * MARGIN + 2 for across, _ in sizes]
    first = np.concatenate([[0], np.cumsum(counts)])
    share, walls = np.zeros((first[-1], rows)), np.zeros((first[-1], rows, MOST, 2))
    lower = np.array([tank.outline.min(axis=0) for tank in tanks])
    origin = lower - MARGIN * np.array([size for _, size in sizes])
    for k, (tank, (_, size)) in enumerate(zip(tanks, sizes, strict=True)):
        own = slice(first[k], first[k + 1])
        places = origin[k] + np.stack(np.meshgrid(np.arange(counts[k]), np.arange(rows), indexing="ij"), axis=-1) * size
        share[own] = _inside(tank.outline, origin[k], np.array(size), counts[k], rows)
        walls[own] = _held(tank.outline, places, np.array(size))
    return Grid(np.array([size for _, size in sizes]), origin, first, share, walls)


def _size(outline: np.ndarray, spacing: float) -> tuple[tuple[int, int], tuple[float, float]]:
    """Cells across a tank and up it, and their sizes (m): square ones nearly, whole across its widest floor."""
    width, height = np.ptp(outline, axis=0)
    across = max(1, round(width / spacing))
    size = width / across
    return (across, int(np.ceil(height / size - 1e-9))), (size, size)


def _inside(outline: np.ndarray, origin: np.ndarray, size: np.ndarray, columns: int, rows: int) -> np.ndarray:
    """The integral (m²) of each node's weight over the tank, by samples, which add up to its area."""
    along = [(np.arange(FINE * count) + 0.5) / FINE for count in (columns, rows)]
    samples = np.stack(np.meshgrid(*along, indexing="ij"), axis=-1)
    held = inside((origin + samples.reshape(-1, 2) * size), outline).reshape(samples.shape[:2]).astype(float)
    weights = [_weights(place, count) for place, count in zip(along, (columns, rows), strict=True)]
    return weights[0].T @ held @ weights[1] * (moments(outline)[0] / held.sum())


def _weights(place: np.ndarray, count: int) -> np.ndarray:
    """Weights (samples, count) of nodes for places in cells: quadratic B-splines."""
    apart = np.abs(place[:, None] - np.arange(count)[None, :])
    return np.where(apart < 0.5, 0.75 - apart**2, np.where(apart < 1.5, 0.5 * (1.5 - apart) ** 2, 0.0))


def _held(outline: np.ndarray, places: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Normals (columns, rows, MOST, 2) of the walls that hold nodes at `places` (columns, rows, 2) m."""
    found = np.zeros((*places.shape[:2], MOST, 2))
    count, length = np.zeros(places.shape[:2], dtype=int), float(size.min())
    corners = np.vstack([outline[-1:], outline, outline[:2]])
    directions = [(b - a) / np.hypot(*(b - a)) for a, b in pairwise(corners)]
    for k, (start, end) in enumerate(pairwise(corners[1:-1])):
        along, normal = directions[k + 1], np.array([-directions[k + 1][1], directions[k + 1][0]])
        reach = [BEYOND * length if _turns_in(directions[j], directions[j + 1]) else 0.0 for j in (k, k + 1)]
        way, off = (places - start) @ along, (places - start) @ normal
        holds = (way > -reach[0] - 1e-9 * length) & (way < np.hypot(*(end - start)) + reach[1] + 1e-9 * length)
        holds &= (off < HELD * length - 1e-9 * length) & (off > -BEYOND * length) & (count < MOST)
        found[holds, count[holds]] = normal
        count[holds] += 1
    return found


def _turns_in(before: np.ndarray, after: np.ndarray) -> bool:
    """Whether the tank's corner between two walls is one that points outwards."""
    return before[0] * after[1] - before[1] * after[0] > 0.0
