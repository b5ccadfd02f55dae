"""The points of each column of cells, in the order of their numbers."""

import numpy as np
import taichi as ti

from solvers.bulk.given import Bulk
from solvers.bulk.grid import Grid
from solvers.bulk.state import Points
from solvers.machine.state import Axis, State


@ti.data_oriented
class Order:
    """Lists of points by the first of the three columns of nodes that carry each.

    The points of column c of world w are `listed[w, first[w, c]]` to `listed[w, first[w, c + 1] - 1]`.
    """

    def __init__(self, arrays: State, points: Points, bulk: Bulk):
        grid: Grid = bulk.grid
        self.points, self.columns, self.rows, self.tanks = points, grid.columns, grid.rows, len(bulk.fill)
        own, world = arrays.under("bulk.order"), Axis("world", points.worlds)
        table = np.column_stack([grid.origin, 1.0 / grid.spacing, grid.first[:-1], np.diff(grid.first)])
        self.table = own.holding("grid", table, "tank number", own.place)
        tank = np.repeat(np.arange(self.tanks), bulk.fill)
        self.tank = own.holding("tank", tank, "point", ti.i32) if self.tanks > 1 else None
        (self.column,) = own.integers(points.each, "column", kept=False)
        (self.first,) = own.integers((world, Axis("column", self.columns + 1)), "first", kept=False)
        (self.listed,) = own.integers((world, Axis("place", points.count)), "listed", kept=False)

    @ti.func
    def of(self, i):
        """The tank of a point."""
        tank = 0
        if ti.static(self.tanks > 1):
            tank = self.tank[i]
        return tank

    @ti.func
    def cells(self, w, i, axis: ti.template()):
        """Where a point is along an axis: the first node that carries it, and how far (cells) it is from there."""
        tank = self.of(i)
        along = (self.points.place[axis][w, i] - self.table[tank, axis]) * self.table[tank, 2 + axis]
        node = ti.cast(ti.floor(along - 0.5), ti.i32)
        last = self.rows - 3
        if ti.static(axis == 0):
            last = ti.cast(self.table[tank, 5], ti.i32) - 3
        node = ti.max(0, ti.min(last, node))
        return node, ti.cast(along - node, self.points.real)

    @ti.func
    def kinetic(self, w, i):
        """Kinetic energy (J/m) of a point and of the velocity about it."""
        tank = self.of(i)
        finer_y, finer_z = self.table[tank, 2], self.table[tank, 3]
        quarter_y = ti.cast(0.25 / (finer_y * finer_y), self.points.real)
        quarter_z = ti.cast(0.25 / (finer_z * finer_z), self.points.real)
        return self.points.kinetic(w, i, quarter_y, quarter_z)

    @ti.func
    def sort(self, w, t, kick, dt):
        """List a world's points by columns: a counting sort on one thread."""
        for c in range(self.columns + 1):
            self.first[w, c] = 0
        for i in range(self.points.count):
            node, _ = self.cells(w, i, 0)
            column = node + ti.cast(self.table[self.of(i), 4], ti.i32)
            self.column[w, i] = column
            self.first[w, column] = self.first[w, column] + 1
        total = 0
        for c in range(self.columns + 1):
            here = self.first[w, c]
            self.first[w, c] = total
            total += here
        for i in range(self.points.count):
            column = self.column[w, i]
            place = self.first[w, column]
            self.listed[w, place] = i
            self.first[w, column] = place + 1
        for k in range(self.columns):  # the ends have become the beginnings of the next ones
            c = self.columns - k
            self.first[w, c] = self.first[w, c - 1]
        self.first[w, 0] = 0
