"""By how much neighbouring grains may have neared each other: a bound from boxes round the displacements in each cell.

Grains that flow together hardly near each other, however far they go.
"""

import taichi as ti

from solvers.grains.state import GrainState
from solvers.machine.state import Axis, State
from solvers.space.axes import dot, named
from solvers.space.cells import Cells

EMPTY = 1e30  # m, the bounds of a box with nothing in it, the wrong way round


@ti.data_oriented
class Boxes:
    """The `low` and `high` bounds (m) of the displacements in each cell of a world, the last that were taken.

    Cells are those of the time when candidates were sought. Fixed grains have gone nowhere.
    """

    def __init__(self, arrays: State, grains: GrainState, cells: Cells):
        self.grains, self.cells = grains, cells
        own, axes = arrays.under("lists"), (Axis("world", grains.worlds), Axis("cell", cells.room))
        self.low = own.reals(axes, *named("low", grains.axes), kept=False)
        self.high = own.reals(axes, *named("high", grains.axes), kept=False)

    @ti.func
    def moves(self, w, since: ti.template(), rings: ti.template()):
        """How far (m) a world's grains are at most from where they were, the fields `since` (m), and by how much any
        two may have neared whose cells are at most so many `rings` apart."""
        moved = self.take(w, since)
        return moved, self.nearing(w, rings)

    @ti.func
    def take(self, w, since: ti.template()):
        """Box the displacements of a world's grains; returns the largest one (m)."""
        g, c, farthest = self.grains, self.cells, ti.cast(0.0, self.grains.real)
        for cell in range(c.number()):
            low = [ti.cast(EMPTY, g.real) for _ in ti.static(range(g.axes))]
            high = [-low[a] for a in ti.static(range(g.axes))]
            for k in range(c.first[w, cell], c.first[w, cell + 1]):
                i = c.sorted[w, k]
                gone = [ti.cast(0.0, g.real) for _ in ti.static(range(g.axes))]
                if i < g.units.moving():
                    for a in ti.static(range(g.axes)):
                        gone[a] = ti.cast(g.place[a][w, i] - since[a][w, i], g.real)
                farthest = ti.max(farthest, dot(gone, gone))
                for a in ti.static(range(g.axes)):
                    low[a], high[a] = ti.min(low[a], gone[a]), ti.max(high[a], gone[a])
            for a in ti.static(range(g.axes)):
                self.low[a][w, cell], self.high[a][w, cell] = low[a], high[a]
        return ti.sqrt(farthest)

    @ti.func
    def nearing(self, w, rings: ti.template()):
        """By how much (m) two grains in one cell, or in two at most so many `rings` apart, have neared at most."""
        c, farthest = self.cells, ti.cast(0.0, self.grains.real)
        for cell in range(c.number()):
            if self.low[0][w, cell] < EMPTY:
                lower, upper = c.around(cell, rings)
                for n in range(c.rows(lower, upper)):
                    row = c.row(lower, upper, n)
                    for other in range(ti.max(cell, row + lower[0]), row + upper[0] + 1):
                        square = 0.0 * farthest
                        for a in ti.static(range(self.grains.axes)):
                            ahead = self.high[a][w, cell] - self.low[a][w, other]
                            apart = ti.max(0.0, ahead, self.high[a][w, other] - self.low[a][w, cell])
                            square += apart * apart
                        farthest = ti.max(farthest, square)
        return ti.sqrt(farthest)
