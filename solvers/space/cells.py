"""A grid of cells over the tank, and the grains sorted into it."""

from math import prod
from typing import Protocol

import numpy as np
import taichi as ti

from solvers.machine.runtime import Arrays

CHUNK = 256  # cells that one thread sums up


class Places(Protocol):
    """What is sorted: `count` places (m) in each of `worlds`, an array an axis.

    Some may have left (`present` 0) if `may_leave`.
    """

    axes: int
    worlds: int
    count: int
    may_leave: bool
    place: list[ti.Field]
    present: ti.Field


@ti.data_oriented
class Cells:
    """Cells no smaller than the reach of a contact, and no more of them than a few a grain.

    `shape` says how many there are along each axis. Cells are numbered in rows along the first axis.

    The grains of cell c are `sorted[w, first[w, c]]` to `sorted[w, first[w, c + 1] - 1]`, by their numbers; those that
    have left the scene are in a cell of their own beyond the last, which is nobody's neighbour.
    """

    def __init__(self, arrays: Arrays, grains: Places, lower: np.ndarray, upper: np.ndarray, reach: float):
        self.grains = grains
        extent, self.axes = upper - lower, grains.axes
        size = max(reach, float(np.prod(extent) / (4.0 * grains.count + 64.0)) ** (1.0 / self.axes))
        # In an array and not in the code, so that scenes that differ in lengths alone share a compiled kernel.
        self.lengths = arrays.holding(np.array([*lower, size]), arrays.place)  # the origin, and the size of a cell
        self.shape = tuple(int(length / size) + 1 for length in extent)
        self.strides = tuple(prod(self.shape[:a]) for a in range(self.axes))  # from a cell to the next along an axis
        self.cells = prod(self.shape)
        self.chunks = -(-(self.cells + 2) // CHUNK)
        (self.first,) = arrays.integers(1, (grains.worlds, self.chunks * CHUNK), kept=False)
        (self.chunk_first,) = arrays.integers(1, (grains.worlds, self.chunks), kept=False)
        self.cell_of, self.sorted = arrays.integers(2, (grains.worlds, grains.count), kept=False)

    @ti.func
    def find(self, w, i):
        """The cell a grain is in; beyond the grid, the nearest."""
        cell = 0
        for a in ti.static(range(self.axes)):
            along = ti.cast((self.grains.place[a][w, i] - self.lengths[a]) / self.lengths[self.axes], ti.i32)
            cell += self.strides[a] * ti.max(0, ti.min(self.shape[a] - 1, along))
        if ti.static(self.grains.may_leave):  # noqa: SIM102 (compiled only for open tanks)
            if self.grains.present[w, i] == 0.0:
                cell = self.cells
        return cell

    @ti.func
    def box(self, w, i):
        """The first and the last cells along each axis, of the cell that a grain is in and those around it."""
        at = [self.cell_of[w, i] // self.strides[a] for a in ti.static(range(self.axes))]
        for a in ti.static(range(self.axes - 1)):
            at[a] = at[a] % self.shape[a]
        lower = [ti.max(0, at[a] - 1) for a in ti.static(range(self.axes))]
        upper = [ti.min(self.shape[a] - 1, at[a] + 1) for a in ti.static(range(self.axes))]
        return lower, upper

    @ti.func
    def rows(self, lower: ti.template(), upper: ti.template()):
        """How many rows of cells there are in a box."""
        count = 1
        for a in ti.static(range(1, self.axes)):
            count *= upper[a] - lower[a] + 1
        return count

    @ti.func
    def row(self, lower: ti.template(), upper: ti.template(), n):
        """The cell with which the n-th row of a box begins at the edge of the grid."""
        cell, rest = 0, n
        for a in ti.static(range(1, self.axes)):
            along = rest
            if ti.static(a < self.axes - 1):
                span = upper[a] - lower[a] + 1
                along, rest = rest % span, rest // span
            cell += self.strides[a] * (lower[a] + along)
        return cell

    @ti.func
    def sort_world(self, w):
        """Sort the grains of one world by counting, on one thread."""
        for c in range(self.cells + 2):
            self.first[w, c] = 0
        for i in range(self.grains.count):
            self.cell_of[w, i] = self.find(w, i)
            self.count_up(w, self.cell_of[w, i], 1)
        total = 0
        for c in range(self.cells + 2):
            total += self.first[w, c]
            self.first[w, c] = total
        for k in range(self.grains.count):
            i = self.grains.count - 1 - k
            self.count_up(w, self.cell_of[w, i], -1)
            self.sorted[w, self.first[w, self.cell_of[w, i]]] = i

    @ti.func
    def count_up(self, w, cell, by):
        """Add to a cell's count, with no atomic: a world is one thread's."""
        self.first[w, cell] = self.first[w, cell] + by

    @ti.kernel
    def sort_all(self):
        """Sort the grains of all worlds on all threads; the result is that of `sort_world`."""
        for w, c in self.first:
            self.first[w, c] = 0
        for w, i in self.cell_of:
            self.cell_of[w, i] = self.find(w, i)
            ti.atomic_add(self.first[w, self.cell_of[w, i]], 1)
        for w, k in self.chunk_first:
            total = 0
            for c in range(k * CHUNK, (k + 1) * CHUNK):
                total += self.first[w, c]
                self.first[w, c] = total
            self.chunk_first[w, k] = total
        for w in range(self.grains.worlds):
            total = 0
            for k in range(self.chunks):
                here = self.chunk_first[w, k]
                self.chunk_first[w, k] = total
                total += here
        for w, c in self.first:
            self.first[w, c] = self.first[w, c] + self.chunk_first[w, c // CHUNK]
        for w, i in self.cell_of:
            place = ti.atomic_add(self.first[w, self.cell_of[w, i]], -1) - 1
            self.sorted[w, place] = i
        for w, c in self.first:
            # Threads came in any order; by number, the lists and so all sums have one order.
            if c < self.cells:
                for k in range(self.first[w, c] + 1, self.first[w, c + 1]):
                    i, hole = self.sorted[w, k], k
                    while hole > self.first[w, c] and self.sorted[w, hole - 1] > i:
                        self.sorted[w, hole] = self.sorted[w, hole - 1]
                        hole -= 1
                    self.sorted[w, hole] = i
