"""Candidates: pairs, and grains beside walls, that may come near each other before long.

The lists of contacts are filtered from them, some times over, before the cells are searched again: an outer and an
inner Verlet list, as in GROMACS (Páll et al. 2020, J. Chem. Phys. 153, 134110). Cells hold four times as many pairs.
"""

from collections.abc import Iterable

import numpy as np
import taichi as ti

from solvers.grains.lists.boxes import Boxes
from solvers.grains.state import GrainState
from solvers.machine.quantity import PLANE, SPACE
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.space.axes import dot, named
from solvers.tank.walls import Walls

# Of pairs and wall features: per grain, in the plane and in space, and more (all pairs of 40 grains)
ROOM, MORE = {PLANE: (8, 3), SPACE: (16, 3)}, (512, 16)
BESIDE = 1.5  # times as far for grains beside walls as for pairs: neighbours go on together, but past walls


@ti.data_oriented
class Candidates:
    """For each grain i of a unit the grains j > i of the unit, and all others, that may come as near as is listed.

    They are all that had gaps up to `farthest` (m), to walls BESIDE times that, when they were `seen`, and are `known`,
    by world. In the step in which they are renewed `renewed` is 1. Walls are left out where they move. Of a mesh's
    features only those `nearby` are looked at, which are sorted into cells (`solvers.tank.solids.nearby`).
    """

    def __init__(
        self,
        arrays: State,
        units: Units,
        grains: GrainState,
        walls: Walls,
        farthest: float,
        room: int,
        across: int,
        boxes: Boxes | None,
        reach: float,
        nearby=None,
    ):
        self.units, self.grains, self.walls, self.walled = units, grains, walls, not walls.moving
        self.boxes, self.boxed = boxes, boxes is not None
        self.nearby, self.sorted = nearby, nearby is not None
        own, world = arrays.under("candidates"), Axis("world", grains.worlds)
        capacity, walled = (
            room * (each * units.size + more) for each, more in zip(ROOM[grains.axes], MORE, strict=True)
        )
        self.capacity, self.wall_capacity = capacity + 2 * room * across, walled if self.walled else 1
        starts = units.axis, Axis("start", units.size + 1)
        self.first, self.wall_first = own.integers(starts, "first", "wall_first")
        (self.mate,) = own.integers((units.axis, Axis("candidate", self.capacity)), "mate")
        (self.feature,) = own.integers((units.axis, Axis("beside", self.wall_capacity)), "feature")
        self.seen = own.reals((world, Axis("grain", grains.room)), *named("seen", grains.axes), kind=own.place)
        (self.known,) = own.integers((world,), "known")
        (self.renewed,) = own.integers((world,), "renewed", kept=False)
        # Gaps (m) up to which pairs and grains beside walls are among them, and of grains more than two cells apart
        gaps = np.array([farthest, BESIDE * farthest, 2.0 * (reach + farthest)])
        self.farthest = own.holding("farthest", gaps, "number")

    def forget(self, worlds: Iterable[int]) -> None:
        """Have those of some worlds sought anew before their next lists."""
        for w in worlds:
            self.known[w] = 0

    @ti.func
    def outdated(self, w, margin):
        """Whether a pair or a grain beside a wall, with a gap below `margin` (m), may be none of them.

        Grains that were more than two cells apart had gaps of a cell and `farthest` at least.
        """
        old = self.known[w] == 0
        if not old:
            moved, nearing = ti.cast(0.0, self.grains.real), ti.cast(0.0, self.grains.real)
            if ti.static(self.boxed):
                moved, nearing = self.boxes.moves(w, self.seen, 2)
            else:
                for i in range(self.units.moving()):
                    gone = [
                        ti.cast(self.grains.place[a][w, i] - self.seen[a][w, i], self.grains.real)
                        for a in ti.static(range(self.grains.axes))
                    ]
                    moved = ti.max(moved, dot(gone, gone))
                moved = ti.sqrt(moved)
                nearing = 2.0 * moved
            old = nearing + margin > self.farthest[0] or 2.0 * moved + margin > self.farthest[2]
            if ti.static(self.walled):
                old = old or moved + margin > self.farthest[1]
        return old

    @ti.func
    def renew(self, w, margin):
        """Have the units of a world seek them anew if they are outdated for a margin (m); returns whether they are."""
        self.renewed[w] = ti.cast(self.outdated(w, margin), ti.i32)
        if self.renewed[w] == 1:
            self.known[w] = 1
            for i in range(self.units.moving()):
                self.grains.fold(w, i)
                for a in ti.static(range(self.grains.axes)):
                    self.seen[a][w, i] = self.grains.place[a][w, i]
        return self.renewed[w] == 1

    @ti.func
    def found(self, g: ti.template(), c: ti.template(), u, t):
        """Seek those of a unit if they are to be renewed; False if there is no room for them."""
        fits, w = True, self.units.world(u)
        if self.renewed[w] == 1:
            fits = self.seek(g, c, u, t)
            if not fits:
                self.known[w] = 0
        return fits

    @ti.func
    def seek(self, g: ti.template(), c: ti.template(), u, t):
        """Seek those of a unit among sorted grains; False without room.

        What a grain has near it comes at random: without branches the processor guesses nothing wrong. So the last
        place is for what is looked at after all are found.
        """
        w, found = self.units.world(u), 0
        start, end, last = self.units.first(u), self.units.end(u), self.capacity - 1
        for i in range(start, end):
            self.first[u, i - start] = found
            place = [g.place[a][w, i] for a in ti.static(range(g.axes))]
            reach = g.reach[w, i] + self.farthest[0]
            lower, upper = c.box(w, i)
            for n in range(c.rows(lower, upper)):
                # Three adjacent cells of a row are one contiguous range of the sorted grains.
                row = c.row(lower, upper, n)
                for k in range(c.first[w, row + lower[0]], c.first[w, row + upper[0] + 1]):
                    j = c.sorted[w, k]
                    apart = g.nearest([place[a] - g.place[a][w, j] for a in ti.static(range(g.axes))])
                    far = reach + g.reach[w, j]
                    self.mate[u, ti.min(found, last)] = j
                    found += self.mine(i, j, start, end) & ti.cast(dot(apart, apart) < far * far, ti.i32)
        for k in range(end - start, self.units.size + 1):
            self.first[u, k] = found
        return found <= last and self.seek_walls(g, u, t)

    @ti.func
    def mine(self, i, j, start, end):
        """Whether a unit lists the pair of its grain i and grain j, 1 or 0."""
        found = ti.cast(j > i, ti.i32)
        if ti.static(not self.units.whole):
            found = found | (ti.cast(j < i, ti.i32) & (ti.cast(j < start, ti.i32) | ti.cast(j >= end, ti.i32)))
        return found

    @ti.func
    def seek_walls(self, g: ti.template(), u, t):
        """Seek the walls that grains of a unit are beside; returns whether there is room."""
        w, start, end, found = self.units.world(u), self.units.first(u), self.units.end(u), 0
        if ti.static(self.walled):
            shift = self.walls.shift(w, t)
            for i in range(start, end):
                self.wall_first[u, i - start] = found
                reach = g.reach[w, i] + self.farthest[1]
                begin, last = 0, self.walls.features
                if ti.static(self.sorted):
                    cell = self.nearby.cell(*g.at(w, i))
                    begin, last = self.nearby.first[cell], self.nearby.first[cell + 1]
                for k in range(begin, last):
                    feature = k
                    if ti.static(self.sorted):
                        feature = self.nearby.listed[k]
                    if self.walls.near(feature, shift, reach, *g.at(w, i)):
                        self.feature[u, ti.min(found, self.wall_capacity - 1)] = feature
                        found += 1
            for k in range(end - start, self.units.size + 1):
                self.wall_first[u, k] = found
        return found <= self.wall_capacity
