"""Which features of a mesh are near a point, and which triangles are above or below it: cells that are sorted once."""

import numpy as np
import taichi as ti

from solvers.machine.state import State
from solvers.tank.solids import features as of
from solvers.tank.solids.mesh import ACROSS, Mesh, distance

MOST_CELLS = 200_000
MOST_COLUMNS = 64  # along each axis


@ti.data_oriented
class Nearby:
    """Features by cells over the tank: `listed[first[c]]` and on are those that a grain in cell c may be near.

    They are within `reach` (m) of the cell, however large the triangles are.
    """

    def __init__(
        self, arrays: State, mesh: Mesh, found: of.Features, bounds: tuple[np.ndarray, np.ndarray], reach: float
    ):
        lower, upper = bounds
        extent = upper - lower
        size = max(reach, float(np.prod(extent) / MOST_CELLS) ** (1.0 / 3.0))
        self.shape = tuple(int(length / size) + 1 for length in extent)
        own = arrays.under("nearby")
        self.lengths = own.holding("lengths", np.array([*lower, size]), "number", own.place)
        first, listed = _sorted(_shapes(mesh, found), lower, size, np.array(self.shape), reach)
        self.first = own.holding("first", first, "cell", ti.i32)
        self.listed = own.holding("listed", listed, "place", ti.i32)

    @ti.func
    def cell(self, y, z, x):
        """The cell of a point; of one outside, the nearest."""
        place, found = ti.Vector([y, z, x]), 0
        for a in ti.static((2, 1, 0)):
            along = ti.cast((place[a] - self.lengths[a]) / self.lengths[3], ti.i32)
            found = found * ti.static(self.shape[a]) + ti.max(0, ti.min(ti.static(self.shape[a] - 1), along))
        return found


def _shapes(mesh: Mesh, found: of.Features) -> list[np.ndarray]:
    """The corners (1 to 3, 3) m of every feature."""
    edges = found.edges[:, [*range(3), *range(of.END, of.END + 3)]].reshape(-1, 2, 3)
    return [*mesh.points, *edges, *found.corners[:, None, :3]]


def _sorted(
    shapes: list[np.ndarray], lower: np.ndarray, size: float, shape: np.ndarray, reach: float
) -> tuple[np.ndarray, np.ndarray]:
    """Where each cell's features begin, and the features, cell by cell."""
    cells, features = [], []
    beyond = reach + 0.5 * np.sqrt(3.0) * size  # from the middle of a cell to what may be near any point of it
    strides = np.array([1, shape[0], shape[0] * shape[1]])
    for number, corners in enumerate(shapes):
        low = np.clip(((corners.min(axis=0) - reach - lower) / size).astype(int), 0, shape - 1)
        high = np.clip(((corners.max(axis=0) + reach - lower) / size).astype(int), 0, shape - 1)
        some = np.stack(np.meshgrid(*map(np.arange, low, high + 1), indexing="ij"), axis=-1).reshape(-1, 3)
        middles = lower + size * (some + 0.5)
        three = corners[np.minimum(np.arange(3), len(corners) - 1)]
        if len(corners) == 3:
            some = some[distance(middles, three) <= beyond]
        cells.append(some @ strides)
        features.append(np.full(len(some), number))
    cells, features = np.concatenate(cells), np.concatenate(features)
    order = np.argsort(cells, kind="stable")
    first = np.searchsorted(cells[order], np.arange(int(np.prod(shape)) + 1))
    return first, features[order] if len(order) else np.zeros(1, dtype=int)


@ti.data_oriented
class Columns:
    """Triangles by upright columns, and their corners `seen` from above (m, 6), y and x each, by rising numbers."""

    def __init__(self, arrays: State, mesh: Mesh):
        self.shape = tuple(min(MOST_COLUMNS, 1 + int(np.sqrt(len(mesh.triangles)))) for _ in range(2))
        lower, upper = (corner[ACROSS] for corner in mesh.box)
        size = (upper - lower) / np.array(self.shape)
        seen = mesh.corners[np.sort(mesh.triangles, axis=1)][..., ACROSS]
        low, high = (
            np.clip(((end - lower) / size).astype(int) + more, 0, np.array(self.shape) - 1)
            for end, more in ((seen.min(axis=1), 0), (seen.max(axis=1), 0))
        )
        lists: list[list[int]] = [[] for _ in range(self.shape[0] * self.shape[1])]
        for k, ((y0, x0), (y1, x1)) in enumerate(zip(low, high, strict=True)):
            for x in range(x0, x1 + 1):
                for y in range(y0, y1 + 1):
                    lists[y + self.shape[0] * x].append(k)
        own = arrays.under("columns")
        self.lengths = own.holding("lengths", np.array([*lower, *size]), "number", own.place)
        self.first = own.holding("first", np.cumsum([0, *map(len, lists)]), "column", ti.i32)
        self.listed = own.holding("listed", np.concatenate(lists).astype(int), "place", ti.i32)
        self.seen = own.holding("seen", seen.reshape(-1, 6), "triangle number", own.place)

    @ti.func
    def column(self, y, x):
        """The column of a point; of one outside, the nearest."""
        along = ti.cast((y - self.lengths[0]) / self.lengths[2], ti.i32)
        across = ti.cast((x - self.lengths[1]) / self.lengths[3], ti.i32)
        along = ti.max(0, ti.min(ti.static(self.shape[0] - 1), along))
        across = ti.max(0, ti.min(ti.static(self.shape[1] - 1), across))
        return along + ti.static(self.shape[0]) * across
