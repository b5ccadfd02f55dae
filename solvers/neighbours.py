"""Who may touch whom: a cell grid, and Verlet half lists with a skin that carry the contacts' history.

Each pair stands once, i < j, in the order of i, so a world's forces are summed in one order on any number of threads.
"""

import numpy as np
import taichi as ti

from solvers.grains import Grains
from solvers.runtime import Arrays
from solvers.walls import Walls


@ti.data_oriented
class ContactList:
    """Candidate contacts of one kind (grain–grain or grain–wall) in each world, sorted by their first grain.

    `mate` is the other grain or the wall feature; `stiffness` k (N/m^1.5) and `mass` m_eff (kg) do not change while a
    contact is listed. `past` is the tangential law's history, zero while the two do not touch.
    """

    def __init__(self, arrays: Arrays, worlds: int, grains: int, capacity: int, history: int):
        self.capacity, self.history = capacity, history
        (self.length,) = arrays.integers(1, (worlds,))
        self.grain, self.mate, self.old_mate = arrays.integers(3, (worlds, capacity))
        self.stiffness, self.mass = arrays.reals(2, (worlds, capacity))
        self.past, self.old_past = arrays.vectors(2, history, (worlds, capacity))
        self.first, self.old_first = arrays.integers(2, (worlds, grains + 1))

    @ti.func
    def set_aside(self, w, grains):
        """Keep the present list as the old one, for `add` to find history in."""
        for i in range(grains + 1):
            self.old_first[w, i] = self.first[w, i]
        for p in range(self.length[w]):
            self.old_mate[w, p] = self.mate[w, p]
            self.old_past[w, p] = self.past[w, p]

    @ti.func
    def put_back(self, w, grains):
        """Undo a rebuild that ran out of room."""
        for i in range(grains + 1):
            self.first[w, i] = self.old_first[w, i]
        self.length[w] = self.old_first[w, grains]
        for i in range(grains):
            for p in range(self.old_first[w, i], self.old_first[w, i + 1]):
                self.grain[w, p] = i
                self.mate[w, p] = self.old_mate[w, p]
                self.past[w, p] = self.old_past[w, p]

    @ti.func
    def add(self, w, p, i, mate, stiffness, mass):
        """Write candidate p with the history it had, if any."""
        self.grain[w, p] = i
        self.mate[w, p] = mate
        self.stiffness[w, p] = stiffness
        self.mass[w, p] = mass
        past = ti.Vector([0.0 for _ in ti.static(range(self.history))])
        for q in range(self.old_first[w, i], self.old_first[w, i + 1]):
            if self.old_mate[w, q] == mate:
                past = self.old_past[w, q]
        self.past[w, p] = past


@ti.data_oriented
class Neighbours:
    """The two contact lists of every world and when to build them anew."""

    def __init__(
        self,
        arrays: Arrays,
        grains: Grains,
        walls: Walls,
        skin: float,
        history: int,
        modulus: np.ndarray,
        room: int,
    ):
        self.grains, self.walls, self.skin = grains, walls, skin
        worlds, count = grains.worlds, grains.count
        self.pairs = ContactList(arrays, worlds, count, room * (4 * count + 16), history)
        self.contacts = ContactList(arrays, worlds, count, room * (2 * count + 16), history)
        # k = (4/3) E* √R_eff of grain–grain and grain–wall contacts in each world
        self.modulus = arrays.holding(4.0 / 3.0 * modulus)
        self.make_grid(arrays, 2.0 * grains.largest + skin)
        self.built_y, self.built_z = arrays.reals(2, (worlds, count))
        self.travel = arrays.holding(np.full(worlds, np.inf))  # no grain has moved farther than this since

    def make_grid(self, arrays: Arrays, reach: float) -> None:
        """Cells no smaller than the reach of a contact, and no more of them than a few a grain."""
        lower, upper = self.walls.outline.min(axis=0), self.walls.outline.max(axis=0)
        extent = upper - lower
        size = max(reach, float(np.sqrt(extent[0] * extent[1] / (4.0 * self.grains.count + 64.0))))
        self.origin_y, self.origin_z, self.cell = float(lower[0]), float(lower[1]), size
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
        old = False
        if self.travel[w] > 0.5 * self.skin:
            old = True
            if self.travel[w] < 1e30:
                # The running sum of speeds overestimates what shaking grains travel; look at where they are.
                moved = 0.0
                for i in range(self.grains.count):
                    dy = self.grains.y[w, i] - self.built_y[w, i]
                    dz = self.grains.z[w, i] - self.built_z[w, i]
                    moved = ti.max(moved, dy * dy + dz * dz)
                moved = ti.sqrt(moved)
                if moved < 0.3 * self.skin:
                    old = False
                    self.travel[w] = moved
        return old

    @ti.func
    def bin_grains(self, w):
        """Sort the grains of a world into cells by counting."""
        for c in range(self.columns * self.rows + 1):
            self.cell_first[w, c] = 0
        for i in range(self.grains.count):
            column = ti.cast((self.grains.y[w, i] - self.origin_y) / self.cell, ti.i32)
            row = ti.cast((self.grains.z[w, i] - self.origin_z) / self.cell, ti.i32)
            column = ti.max(0, ti.min(self.columns - 1, column))
            row = ti.max(0, ti.min(self.rows - 1, row))
            self.cell_of[w, i] = row * self.columns + column
            self.cell_first[w, self.cell_of[w, i]] += 1
        total = 0
        for c in range(self.columns * self.rows + 1):
            total += self.cell_first[w, c]
            self.cell_first[w, c] = total
        for k in range(self.grains.count):
            i = self.grains.count - 1 - k
            self.cell_first[w, self.cell_of[w, i]] -= 1
            self.sorted[w, self.cell_first[w, self.cell_of[w, i]]] = i

    @ti.func
    def list_pairs(self, w) -> ti.i32:
        """List the pairs of one world; returns their number, also where it exceeds the room there is."""
        found = 0
        for i in range(self.grains.count):
            self.pairs.first[w, i] = found
            y, z, radius = self.grains.y[w, i], self.grains.z[w, i], self.grains.radius[w, i]
            mass = 1.0 / self.grains.inverse_mass[w, i]
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
                        reach = radius + other + self.skin
                        if dy * dy + dz * dz < reach * reach:
                            if found < self.pairs.capacity:
                                other_mass = 1.0 / self.grains.inverse_mass[w, j]
                                effective = ti.sqrt(radius * other / (radius + other))
                                self.pairs.add(
                                    w,
                                    found,
                                    i,
                                    j,
                                    self.modulus[w, 0] * effective,
                                    mass * other_mass / (mass + other_mass),
                                )
                            found += 1
        self.pairs.first[w, self.grains.count] = found
        return found

    @ti.func
    def list_contacts(self, w) -> ti.i32:
        """List the grains near walls; returns their number, also where it exceeds the room there is."""
        found = 0
        for i in range(self.grains.count):
            self.contacts.first[w, i] = found
            radius = self.grains.radius[w, i]
            for feature in range(self.walls.features):
                # A wall contact may begin as the grain slides past a segment's end, so ask with a margin.
                if self.walls.near(feature, self.grains.y[w, i], self.grains.z[w, i], radius + self.skin):
                    if found < self.contacts.capacity:
                        stiffness = self.modulus[w, 1] * ti.sqrt(radius)
                        mass = 1.0 / self.grains.inverse_mass[w, i]
                        self.contacts.add(w, found, i, feature, stiffness, mass)
                    found += 1
        self.contacts.first[w, self.grains.count] = found
        return found

    @ti.func
    def rebuild(self, w):
        """List all contacts of a world anew; returns False, with the old lists in place, where they do not fit."""
        self.bin_grains(w)
        self.pairs.set_aside(w, self.grains.count)
        self.contacts.set_aside(w, self.grains.count)
        pairs, contacts = self.list_pairs(w), self.list_contacts(w)
        fits = pairs <= self.pairs.capacity and contacts <= self.contacts.capacity
        if fits:
            self.pairs.length[w], self.contacts.length[w] = pairs, contacts
            for i in range(self.grains.count):
                self.built_y[w, i], self.built_z[w, i] = self.grains.y[w, i], self.grains.z[w, i]
            self.travel[w] = 0.0
        else:
            self.pairs.put_back(w, self.grains.count)
            self.contacts.put_back(w, self.grains.count)
        return fits
