"""Who may touch whom: a cell grid, and Verlet half lists with a skin that carry the contacts' history.

Each pair stands once, i < j, in the order of i, so a world's forces are summed in one order on any number of threads.
"""

import numpy as np
import taichi as ti

from solvers.grains import Grains
from solvers.laws.chosen import PAIR, WALL, ChosenLaws
from solvers.runtime import Arrays
from solvers.walls import Walls

# Pairs that one pass of the force loop takes: two AVX2 registers of 64-bit numbers, a fifth faster than one.
LANES = 8

SKIN, ORIGIN_Y, ORIGIN_Z, CELL = range(4)


@ti.data_oriented
class ContactList:
    """Candidate contacts of one kind (grain–grain or grain–wall) in each world, sorted by their first grain.

    Contact p stands in lane p % lanes of block p // lanes. `mate` is the other grain or the wall feature. What does
    not change while a contact is listed: `stiffness` k (N/m^1.5), `reach` (m), the distance at which the two touch,
    `share`, the first grain's part of it, and the laws' constants. The laws' memory does change, and is zero while the
    two do not touch. What the laws keep are fields by the names they give.
    """

    def __init__(self, arrays: Arrays, worlds: int, grains: int, room: int, lanes: int, laws: ChosenLaws):
        self.lanes = lanes
        blocks = -(-room // lanes)
        self.capacity = blocks * lanes
        shape = (worlds, blocks)
        (self.length,) = arrays.integers(1, (worlds,))
        self.grain, self.mate = arrays.integer_vectors(2, lanes, shape)
        self.stiffness, self.reach, self.share = arrays.vectors(3, lanes, shape)
        self.constants = arrays.vectors(len(laws.constants), lanes, shape)
        self.memory = arrays.vectors(len(laws.memory), lanes, shape)
        for name, field in zip((*laws.constants, *laws.memory), (*self.constants, *self.memory), strict=True):
            setattr(self, name, field)
        self.memories = len(self.memory)
        self.first, self.old_first = arrays.integers(2, (worlds, grains + 1))
        (self.old_mate,) = arrays.integers(1, (worlds, self.capacity))
        self.old_memory = arrays.reals(self.memories, (worlds, self.capacity))

    @ti.func
    def blocks(self, w):
        """Blocks in use, the last maybe padded."""
        return (self.length[w] + self.lanes - 1) // self.lanes

    @ti.func
    def first_of(self, w, p):
        """The first grain of contact p."""
        return self.grain[w, p // self.lanes][p % self.lanes]

    @ti.func
    def second_of(self, w, p):
        """The other grain, or the wall feature, of contact p."""
        return self.mate[w, p // self.lanes][p % self.lanes]

    @ti.func
    def set_aside(self, w, grains):
        """Keep the present list as the old one, for `add` to find memory in."""
        for i in range(grains + 1):
            self.old_first[w, i] = self.first[w, i]
        for p in range(self.length[w]):
            block, lane = p // self.lanes, p % self.lanes
            self.old_mate[w, p] = self.mate[w, block][lane]
            for k in ti.static(range(self.memories)):
                self.old_memory[k][w, p] = self.memory[k][w, block][lane]

    @ti.func
    def put_back(self, w, grains):
        """Undo a rebuild that ran out of room."""
        for i in range(grains + 1):
            self.first[w, i] = self.old_first[w, i]
        for i in range(grains):
            for p in range(self.old_first[w, i], self.old_first[w, i + 1]):
                block, lane = p // self.lanes, p % self.lanes
                self.grain[w, block][lane] = i
                self.mate[w, block][lane] = self.old_mate[w, p]
                for k in ti.static(range(self.memories)):
                    self.memory[k][w, block][lane] = self.old_memory[k][w, p]

    @ti.func
    def write(self, w, p, i, mate):
        """Contact p is between grain i and its mate, and remembers nothing."""
        block, lane = p // self.lanes, p % self.lanes
        self.grain[w, block][lane] = i
        self.mate[w, block][lane] = mate
        for k in ti.static(range(self.memories)):
            self.memory[k][w, block][lane] = 0.0

    @ti.func
    def add(self, w, p, i, mate, stiffness, reach, share):
        """Write contact p with the memory it had, if any."""
        self.write(w, p, i, mate)
        block, lane = p // self.lanes, p % self.lanes
        self.stiffness[w, block][lane] = stiffness
        self.reach[w, block][lane] = reach
        self.share[w, block][lane] = share
        for q in range(self.old_first[w, i], self.old_first[w, i + 1]):
            if self.old_mate[w, q] == mate:
                for k in ti.static(range(self.memories)):
                    self.memory[k][w, block][lane] = self.old_memory[k][w, q]

    @ti.func
    def pad(self, w, ghost):
        """Fill the last block with pairs that never touch: of grain 0 and the far-off ghost."""
        for p in range(self.length[w], self.blocks(w) * self.lanes):
            self.write(w, p, 0, ghost)
            self.reach[w, p // self.lanes][p % self.lanes] = 0.0


@ti.data_oriented
class Neighbours:
    """The two contact lists of every world and when to build them anew."""

    def __init__(
        self,
        arrays: Arrays,
        grains: Grains,
        walls: Walls,
        skin: float,
        reach: float,
        laws: ChosenLaws,
        modulus: np.ndarray,
        room: int,
    ):
        self.grains, self.walls, self.laws = grains, walls, laws
        worlds, count = grains.worlds, grains.count
        self.pairs = ContactList(arrays, worlds, count, room * (4 * count + 16), LANES, laws)
        self.contacts = ContactList(arrays, worlds, count, room * (2 * count + 16), 1, laws)
        # k = (4/3) E* √R_eff of grain–grain and grain–wall contacts in each world
        self.modulus = arrays.holding(4.0 / 3.0 * modulus)
        self.make_grid(arrays, skin, reach)
        self.built_y, self.built_z = arrays.reals(2, (worlds, count))
        self.travel = arrays.holding(np.full(worlds, np.inf))  # no grain has moved farther than this since

    def make_grid(self, arrays: Arrays, skin: float, reach: float) -> None:
        """Cells no smaller than the reach of a contact, and no more of them than a few a grain."""
        lower, upper = self.walls.outline.min(axis=0), self.walls.outline.max(axis=0)
        extent = upper - lower
        size = max(reach, float(np.sqrt(extent[0] * extent[1] / (4.0 * self.grains.count + 64.0))))
        # In an array and not in the code, so that scenes that differ in lengths alone share a compiled kernel.
        self.lengths = arrays.holding(np.array([skin, lower[0], lower[1], size]))
        self.columns = int(extent[0] / size) + 1
        self.rows = int(extent[1] / size) + 1
        worlds, cells = self.grains.worlds, self.columns * self.rows
        (self.cell_first,) = arrays.integers(1, (worlds, cells + 1))
        self.cell_of, self.sorted = arrays.integers(2, (worlds, self.grains.count))

    def forget(self) -> None:
        """Drop all history, for grains that were put somewhere else."""
        for contacts in (self.pairs, self.contacts):
            contacts.length.fill(0)
            contacts.first.fill(0)
        self.travel.fill(np.inf)

    @ti.func
    def stale(self, w):
        """Whether two grains may have moved into reach unlisted: one of them farther than half the skin."""
        old, skin = False, self.lengths[SKIN]
        if self.travel[w] > 0.5 * skin:
            old = True
            if self.travel[w] < 1e30:
                # The running sum of speeds overestimates what shaking grains travel; look at where they are.
                moved = 0.0
                for i in range(self.grains.count):
                    dy = self.grains.y[w, i] - self.built_y[w, i]
                    dz = self.grains.z[w, i] - self.built_z[w, i]
                    moved = ti.max(moved, dy * dy + dz * dz)
                moved = ti.sqrt(moved)
                if moved < 0.3 * skin:
                    old = False
                    self.travel[w] = moved
        return old

    @ti.func
    def bin_grains(self, w):
        """Sort the grains of a world into cells by counting."""
        for c in range(self.columns * self.rows + 1):
            self.cell_first[w, c] = 0
        origin_y, origin_z, cell = self.lengths[ORIGIN_Y], self.lengths[ORIGIN_Z], self.lengths[CELL]
        for i in range(self.grains.count):
            column = ti.cast((self.grains.y[w, i] - origin_y) / cell, ti.i32)
            row = ti.cast((self.grains.z[w, i] - origin_z) / cell, ti.i32)
            column = ti.max(0, ti.min(self.columns - 1, column))
            row = ti.max(0, ti.min(self.rows - 1, row))
            self.cell_of[w, i] = row * self.columns + column
            self.count_up(w, self.cell_of[w, i], 1)
        total = 0
        for c in range(self.columns * self.rows + 1):
            total += self.cell_first[w, c]
            self.cell_first[w, c] = total
        for k in range(self.grains.count):
            i = self.grains.count - 1 - k
            self.count_up(w, self.cell_of[w, i], -1)
            self.sorted[w, self.cell_first[w, self.cell_of[w, i]]] = i

    @ti.func
    def count_up(self, w, cell, by):
        """Add to a cell's count, with no atomic: a world is one thread's."""
        self.cell_first[w, cell] = self.cell_first[w, cell] + by

    @ti.func
    def list_pairs(self, w, dt) -> ti.i32:
        """List the pairs of one world; returns their number, also where it exceeds the room there is."""
        found = 0
        for i in range(self.grains.count):
            self.pairs.first[w, i] = found
            y, z, radius = self.grains.y[w, i], self.grains.z[w, i], self.grains.radius[w, i]
            inverse_mass = self.grains.inverse_mass[w, i]
            row, column = self.cell_of[w, i] // self.columns, self.cell_of[w, i] % self.columns
            for r in range(ti.max(0, row - 1), ti.min(self.rows, row + 2)):
                # Three neighbouring cells of a row are one run of the sorted grains.
                left = r * self.columns + ti.max(0, column - 1)
                right = r * self.columns + ti.min(self.columns - 1, column + 1)
                for k in range(self.cell_first[w, left], self.cell_first[w, right + 1]):
                    j = self.sorted[w, k]
                    if j > i:
                        dy, dz = y - self.grains.y[w, j], z - self.grains.z[w, j]
                        other = self.grains.radius[w, j]
                        reach = radius + other + self.lengths[SKIN]
                        if dy * dy + dz * dz < reach * reach:
                            if found < self.pairs.capacity:
                                mass = 1.0 / (inverse_mass + self.grains.inverse_mass[w, j])
                                effective = ti.sqrt(radius * other / (radius + other))
                                touch = radius + other
                                self.pairs.add(w, found, i, j, self.modulus[w, PAIR] * effective, touch, radius / touch)
                                block, lane = found // self.pairs.lanes, found % self.pairs.lanes
                                self.laws.prepare(PAIR, self.pairs, w, block, lane, mass, dt)
                            found += 1
        self.pairs.first[w, self.grains.count] = found
        return found

    @ti.func
    def list_contacts(self, w, dt) -> ti.i32:
        """List the grains near walls; returns their number, also where it exceeds the room there is."""
        found = 0
        for i in range(self.grains.count):
            self.contacts.first[w, i] = found
            radius = self.grains.radius[w, i]
            for feature in range(self.walls.features):
                # A wall contact may begin as the grain slides past a segment's end, so ask with a margin.
                if self.walls.near(feature, self.grains.y[w, i], self.grains.z[w, i], radius + self.lengths[SKIN]):
                    if found < self.contacts.capacity:
                        mass = 1.0 / self.grains.inverse_mass[w, i]
                        self.contacts.add(w, found, i, feature, self.modulus[w, WALL] * ti.sqrt(radius), radius, 1.0)
                        self.laws.prepare(WALL, self.contacts, w, found, 0, mass, dt)
                    found += 1
        self.contacts.first[w, self.grains.count] = found
        return found

    @ti.func
    def rebuild(self, w, dt):
        """List all contacts of a world anew; returns False, with the old lists in place, where they do not fit."""
        self.bin_grains(w)
        self.pairs.set_aside(w, self.grains.count)
        self.contacts.set_aside(w, self.grains.count)
        pairs, contacts = self.list_pairs(w, dt), self.list_contacts(w, dt)
        fits = pairs <= self.pairs.capacity and contacts <= self.contacts.capacity
        if fits:
            self.pairs.length[w], self.contacts.length[w] = pairs, contacts
            self.pairs.pad(w, self.grains.ghost)
            for i in range(self.grains.count):
                self.built_y[w, i], self.built_z[w, i] = self.grains.y[w, i], self.grains.z[w, i]
            self.travel[w] = 0.0
        else:
            # The laws' constants are lost, but no force is worked out before the lists have been built with more room.
            self.pairs.put_back(w, self.grains.count)
            self.contacts.put_back(w, self.grains.count)
        return fits
