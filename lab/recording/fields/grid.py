"""A grid of points, and the sums of what is spread over them with Lucy's function."""

from dataclasses import dataclass

import numpy as np

MOST_NODES = 4_000_000
AT_ONCE = 2_000_000  # pairs of points and nodes in memory


def lucy(distance: np.ndarray, reach: float, axes: int) -> np.ndarray:
    """Lucy's function (1977), φ(r) = a (1 + 3 r/c) (1 − r/c)³ below its reach c, whose integral over space is 1.

    a = 5/(π c²) in the plane, 105/(16 π c³) in space; distance r and reach c in m, φ in 1/m² or 1/m³.
    """
    scale = 5.0 / (np.pi * reach**2) if axes == 2 else 105.0 / (16.0 * np.pi * reach**3)
    q = np.minimum(distance / reach, 1.0)
    return scale * (1.0 + 3.0 * q) * (1.0 - q) ** 3


@dataclass(frozen=True)
class Grid:
    """Nodes `spacing` (m) apart along each axis, from `first` (axes,) m, `shape` of them."""

    first: np.ndarray
    spacing: float
    shape: tuple[int, ...]

    @property
    def axes(self) -> int:
        """Number of axes."""
        return len(self.shape)

    def along(self, axis: int) -> np.ndarray:
        """The nodes' places (m) along an axis."""
        return self.first[axis] + self.spacing * np.arange(self.shape[axis])

    def spread(self, place: np.ndarray, amount: np.ndarray, reach: float) -> np.ndarray:
        """Σ_i a_i φ(r − r_i) at the nodes, (*shape, k): amounts (n, k) at places (n, axes) m, over a `reach` (m)."""
        found = np.zeros((int(np.prod(self.shape)), amount.shape[1]))
        whole = np.floor((place - self.first) / self.spacing).astype(int)
        half = int(np.ceil(reach / self.spacing))
        offsets = np.stack(np.meshgrid(*[np.arange(-half, half + 2)] * self.axes, indexing="ij"), -1)
        offsets = offsets.reshape(-1, self.axes)
        strides = np.cumprod([1, *self.shape[:0:-1]])[::-1]
        a_piece = max(1, AT_ONCE // len(offsets))
        for begin in range(0, len(place), a_piece):
            some = slice(begin, begin + a_piece)
            node = whole[some, None] + offsets
            apart = np.sqrt(((self.first + self.spacing * node - place[some, None]) ** 2).sum(axis=-1))
            near = (apart < reach) & ((node >= 0) & (node < self.shape)).all(axis=-1)
            point, _ = np.nonzero(near)
            flat, weight = (node[near] * strides).sum(axis=-1), lucy(apart[near], reach, self.axes)
            for k in range(amount.shape[1]):
                found[:, k] += np.bincount(flat, weight * amount[some][point, k], len(found))
        return found.reshape(*self.shape, -1)


def grid_over(low: np.ndarray, high: np.ndarray, spacing: float) -> Grid:
    """The grid that covers a box (m). Raises ValueError for too many nodes."""
    counts = np.ceil((np.asarray(high) - low) / spacing - 1e-9).astype(int) + 1
    if np.prod(counts.astype(float)) > MOST_NODES:
        raise ValueError(f"{np.prod(counts.astype(float)):.3g} nodes are more than {MOST_NODES}")
    first = 0.5 * (np.asarray(low) + high) - 0.5 * spacing * (counts - 1)
    return Grid(first, spacing, tuple(int(count) for count in counts))
