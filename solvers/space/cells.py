"""A cell grid over the tank, with the grains sorted into it."""

from math import prod
from typing import Protocol

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, State, roomy
from solvers.machine.units import Units

CHUNK = 256  # cells that one thread sums up
FEW = 8  # chunks for which there is room at least


class Places(Protocol):
    """What is sorted: `count` points (m) in each of `worlds`, in one array per axis, with `room` for more.

    The `units` tell kernels how many there are. With `may_leave` some may be gone (`present` 0).
    """

    axes: int
    worlds: int
    count: int
    room: int
    units: Units
    may_leave: bool
    place: list[ti.Field]
    present: ti.Field


@ti.data_oriented
class Cells:
    """Square cells no smaller than the reach of a contact, and not more than a few per grain.

    `shape` is the number of cells along each axis; kernels read it from an array, and there is `room` for more cells,
    so that tanks of nearly the same size share them. Cells are numbered in rows along the first axis. With `wraps`
    those at both ends of the last axis are neighbours.

    The grains of cell c are `sorted[w, first[w, c]]` to `sorted[w, first[w, c + 1] - 1]`, in the order of their
    numbers. Grains that have left the scene are in an extra cell after the last, which is no cell's neighbour.
    """

    def __init__(
        self, arrays: State, grains: Places, lower: np.ndarray, upper: np.ndarray, reach: float, wraps: bool = False
    ):
        self.grains, self.wraps = grains, wraps
        extent, self.axes = upper - lower, grains.axes
        size = max(reach, float(np.prod(extent) / (4.0 * grains.count + 64.0)) ** (1.0 / self.axes))
        # In an array, not compiled in, so that scenes that differ in lengths only share a compiled kernel.
        own, world = arrays.under("cells"), Axis("world", grains.worlds)
        # A whole number of cells goes round where space repeats itself
        last = extent[-1] / max(1, int(extent[-1] / size)) if wraps else size
        lengths = np.array([*lower, size, last])  # the origin, the size of a cell, and that along the last axis
        self.lengths = own.holding("lengths", lengths, "number", own.place)
        shape = tuple(int(length / size) + 1 for length in extent)
        if wraps:
            shape = (*shape[:-1], max(1, int(extent[-1] / size)))
        strides = [prod(shape[:a]) for a in range(self.axes + 1)]  # from a cell to the next along an axis; all cells
        self.sizes = own.holding("sizes", np.array([*shape, *strides]), "number", ti.i32)
        self.chunks = roomy(-(-(strides[-1] + 2) // CHUNK), FEW)
        self.room = self.chunks * CHUNK
        (self.first,) = own.integers((world, Axis("cell", self.room)), "first")
        (self.chunk_first,) = own.integers((world, Axis("chunk", self.chunks)), "chunk_first", kept=False)
        (self.cell_of,) = own.integers((world, Axis("grain", grains.room)), "cell_of", kept=False)
        (self.sorted,) = own.integers((world, Axis("place", grains.room)), "sorted")

    @ti.func
    def shape_along(self, axis: ti.template()):
        """Number of cells along an axis."""
        return self.sizes[axis]

    @ti.func
    def stride(self, axis: ti.template()):
        """From a cell to the next along an axis."""
        return self.sizes[self.axes + axis]

    @ti.func
    def number(self):
        """Number of cells."""
        return self.sizes[2 * self.axes]

    @ti.func
    def find(self, w, i):
        """The cell of a grain; outside the grid, the nearest cell."""
        cell = 0
        for a in ti.static(range(self.axes)):
            size = self.lengths[self.axes + (1 if ti.static(self.wraps and a == self.axes - 1) else 0)]
            along = ti.cast((self.grains.place[a][w, i] - self.lengths[a]) / size, ti.i32)
            cell += self.stride(a) * ti.max(0, ti.min(self.shape_along(a) - 1, along))
        if ti.static(self.grains.may_leave):  # noqa: SIM102 (compiled only for open tanks)
            if self.grains.present[w, i] == 0.0:
                cell = self.number()
        return cell

    @ti.func
    def box(self, w, i):
        """First and last cells along each axis of the box of a grain's cell and its neighbours."""
        lower, upper = self.around(self.cell_of[w, i], 1)
        return lower, upper

    @ti.func
    def around(self, cell, rings: ti.template()):
        """First and last cells along each axis of the box of a cell and so many `rings` of neighbours."""
        at = [cell // self.stride(a) for a in ti.static(range(self.axes))]
        for a in ti.static(range(self.axes - 1)):
            at[a] = at[a] % self.shape_along(a)
        lower = [ti.max(0, at[a] - rings) for a in ti.static(range(self.axes))]
        upper = [ti.min(self.shape_along(a) - 1, at[a] + rings) for a in ti.static(range(self.axes))]
        if ti.static(self.wraps):
            last = ti.static(self.axes - 1)
            lower[last] = at[last] - rings
            upper[last] = lower[last] + ti.min(2 * rings, self.shape_along(last) - 1)
        return lower, upper

    @ti.func
    def rows(self, lower: ti.template(), upper: ti.template()):
        """Number of rows of cells in a box."""
        count = 1
        for a in ti.static(range(1, self.axes)):
            count *= upper[a] - lower[a] + 1
        return count

    @ti.func
    def row(self, lower: ti.template(), upper: ti.template(), n):
        """The first cell, at the edge of the grid, of the n-th row of a box."""
        cell, rest = 0, n
        for a in ti.static(range(1, self.axes)):
            along = rest
            if ti.static(a < self.axes - 1):
                span = upper[a] - lower[a] + 1
                along, rest = rest % span, rest // span
            at = lower[a] + along
            if ti.static(self.wraps and a == self.axes - 1):
                at = (at + 2 * self.shape_along(a)) % self.shape_along(a)
            cell += self.stride(a) * at
        return cell

    @ti.func
    def sort_world(self, w):
        """Sort the grains of one world by a counting sort, on one thread."""
        for c in range(self.number() + 2):
            self.first[w, c] = 0
        for i in range(self.grains.units.all()):
            self.cell_of[w, i] = self.find(w, i)
            self.count_up(w, self.cell_of[w, i], 1)
        total = 0
        for c in range(self.number() + 2):
            total += self.first[w, c]
            self.first[w, c] = total
        for k in range(self.grains.units.all()):
            i = self.grains.units.all() - 1 - k
            self.count_up(w, self.cell_of[w, i], -1)
            self.sorted[w, self.first[w, self.cell_of[w, i]]] = i

    @ti.func
    def count_up(self, w, cell, by):
        """Add to a cell's count; no atomic is needed, since one thread has the whole world."""
        self.first[w, cell] = self.first[w, cell] + by

    @ti.kernel
    def sort_all(self):
        """Sort the grains of all worlds on all threads; the result is that of `sort_world`."""
        for w, c in self.first:
            self.first[w, c] = 0
        for w, i in self.cell_of:
            if i < self.grains.units.all():
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
            if i < self.grains.units.all():
                place = ti.atomic_add(self.first[w, self.cell_of[w, i]], -1) - 1
                self.sorted[w, place] = i
        for w, c in self.first:
            # The threads' order is arbitrary; sorted by number, the lists and so all sums have one order.
            if c < self.number():
                for k in range(self.first[w, c] + 1, self.first[w, c + 1]):
                    i, hole = self.sorted[w, k], k
                    while hole > self.first[w, c] and self.sorted[w, hole - 1] > i:
                        self.sorted[w, hole] = self.sorted[w, hole - 1]
                        hole -= 1
                    self.sorted[w, hole] = i
