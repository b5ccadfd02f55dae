"""The list of candidate contacts of each unit of work, with what the laws remember of each."""

import numpy as np
import taichi as ti

from solvers.grains.laws.chosen import ChosenLaws
from solvers.machine.state import Axis, State
from solvers.machine.units import Units


@ti.data_oriented
class ContactList:
    """Candidate contacts of one kind (grain–grain or grain–wall) of each unit u, sorted by their first grain.

    Contact p stands in lane p % lanes of block p // lanes. `mate` is the other grain or the wall feature; `target` the
    grain that takes the reaction, which is a ghost where the mate belongs to another unit. Grains go by their places in
    the arrays of all worlds, `stride` numbers a world, which saves the forces an addition a number they read; with a
    stride of 0 by their numbers in their world. What does not change while a
    contact is listed: `stiffness` k (N/m^1.5), `reach` (m), the distance at which the two touch, `share`, the
    first grain's part of it, and the laws' constants. The laws' memory does change, and is zero while the two do not
    touch. `places` are how many there are for grains and for mates. What the laws keep, and `more` memories that
    others do, contact by contact, are fields by the names they give; `fleeting` ones are not handed on to the next
    list.
    """

    def __init__(
        self,
        arrays: State,
        units: Units,
        room: int,
        lanes: int,
        stride: int,
        laws: ChosenLaws,
        places: tuple[int, int],
        more: tuple[str, ...] = (),
        fleeting: tuple[str, ...] = (),
    ):
        self.units, self.lanes, self.stride = units, lanes, stride
        blocks, across = -(-room // lanes), units.single
        self.capacity = blocks * lanes
        self.arrays, self.lane = arrays, Axis("lane", lanes)
        axes, contacts = (units.axis, Axis("block", blocks), self.lane), Axis("contact", self.capacity)
        self.each = (units.axis, contacts, Axis("one", 1))
        (self.length,) = arrays.integers((units.axis,), "length", below=self.capacity + 1)
        base = stride * (np.arange(units.count) // units.a_world)
        (self.grain,) = arrays.integer_vectors(axes, "grain", across=across, base=base, below=places[0])
        (self.mate,) = arrays.integer_vectors(axes, "mate", across=across, base=base, below=places[1])
        self.has_targets = not (units.whole or units.single)
        self.target = self.mate
        if self.has_targets:
            (self.target,) = arrays.integer_vectors(axes, "target", base=base, below=places[1])
        constants = "stiffness", "reach", "share"
        self.stiffness, self.reach, self.share = arrays.vectors(axes, *constants, across=across)
        if laws.kinds > 1:
            rows = laws.kinds * (laws.kinds + 1)
            (self.row,) = arrays.integer_vectors(axes, "row", across=across, below=rows)  # of the interface
        self.kinds = laws.kinds
        self.constants = arrays.under("constant").vectors(axes, *laws.constants, across=across)
        memory, remembered = (*laws.memory, *more), arrays.under("memory")
        self.memory = remembered.vectors(axes, *laws.memory, across=across)
        self.memory += remembered.vectors(self.each, *more, across=across)
        for name, field in zip((*laws.constants, *memory), (*self.constants, *self.memory), strict=True):
            setattr(self, name, field)
        self.memories = len(self.memory)
        for name, field in zip(fleeting, arrays.under("fleeting").vectors(axes, *fleeting, across=across), strict=True):
            setattr(self, name, field)
        old, starts = arrays.under("old"), (units.axis, Axis("start", units.size + 1))
        (self.first,) = arrays.integers(starts, "first", across=across, below=self.capacity + 1)
        (self.old_first,) = old.integers(starts, "first", across=across, kept=False)
        (self.old_mate,) = old.integers((units.axis, contacts), "mate", across=across, kept=False)
        self.old_memory = old.under("memory").vectors(self.each, *memory, across=across, kept=False)
        for name, field in zip(memory, self.old_memory, strict=True):
            setattr(self, f"old_{name}", field)

    def forget(self) -> None:
        """Empty the list, history and all."""
        self.length.fill(0)
        self.first.fill(0)

    @ti.func
    def blocks(self, u):
        """Blocks in use, the last maybe padded."""
        return (self.length[u] + self.lanes - 1) // self.lanes

    @ti.func
    def first_of(self, u, p):
        """The first grain of contact p, in its world."""
        return self.grain[u, p // self.lanes][p % self.lanes] - self.units.world(u) * self.stride

    @ti.func
    def second_of(self, u, p):
        """The other grain, or the wall feature, of contact p, in its world."""
        return self.mate[u, p // self.lanes][p % self.lanes] - self.units.world(u) * self.stride

    @ti.func
    def remembered(self, which: ti.template(), u, p):
        """One of the things that contact p remembers."""
        field = ti.static(self.memory[which])
        return field[u, p // field.n][p % field.n]

    @ti.func
    def remember(self, which: ti.template(), u, p, value):
        """Have contact p remember another value of it."""
        field = ti.static(self.memory[which])
        field[u, p // field.n][p % field.n] = value

    @ti.func
    def set_aside(self, u):
        """Keep the present list as the old one, for `add` to find memory in."""
        for k in range(self.units.size + 1):
            self.old_first[u, k] = self.first[u, k]
        for p in range(self.length[u]):
            self.keep_old(u, p)

    @ti.func
    def set_aside_some(self, u, row, start, end):
        """Keep only these contacts of a grain as the old list."""
        self.old_first[u, row], self.old_first[u, row + 1] = start, end
        for p in range(start, end):
            self.keep_old(u, p)

    @ti.func
    def keep_old(self, u, p):
        """Copy contact p to its place in the old list."""
        block, lane = p // self.lanes, p % self.lanes
        self.old_mate[u, p] = self.mate[u, block][lane]
        for k in ti.static(range(self.memories)):
            self.old_memory[k][u, p][0] = self.remembered(k, u, p)

    @ti.func
    def put_back(self, u):
        """Undo a rebuild that ran out of room."""
        start = self.units.world(u) * self.stride + self.units.first(u)
        self.length[u] = self.old_first[u, self.units.size]
        for k in range(self.units.size + 1):
            self.first[u, k] = self.old_first[u, k]
        for k in range(self.units.size):
            for p in range(self.old_first[u, k], self.old_first[u, k + 1]):
                block, lane = p // self.lanes, p % self.lanes
                self.grain[u, block][lane] = start + k
                self.mate[u, block][lane] = self.old_mate[u, p]
                for m in ti.static(range(self.memories)):
                    self.remember(m, u, p, self.old_memory[m][u, p][0])

    @ti.func
    def write(self, u, p, i, mate, target):
        """Contact p is between grain i and its mate, and remembers nothing."""
        block, lane, before = p // self.lanes, p % self.lanes, self.units.world(u) * self.stride
        self.grain[u, block][lane] = before + i
        self.mate[u, block][lane] = before + mate
        if ti.static(self.has_targets):
            self.target[u, block][lane] = before + target
        self.clear(u, p)

    @ti.func
    def clear(self, u, p):
        """Contact p remembers nothing."""
        for k in ti.static(range(self.memories)):
            self.remember(k, u, p, 0.0)

    @ti.func
    def add(self, u, p, i, mate, target, row, stiffness, reach, share):
        """Write contact p with the memory it had, if any."""
        self.add_new(u, p, i, mate, target, row, stiffness, reach, share)
        k, place = i - self.units.first(u), self.units.world(u) * self.stride + mate
        for q in range(self.old_first[u, k], self.old_first[u, k + 1]):
            if self.old_mate[u, q] == place:
                self.recall(u, p, q)

    @ti.func
    def recall(self, u, p, q):
        """Contact p remembers what contact q of the old list did."""
        for m in ti.static(range(self.memories)):
            self.remember(m, u, p, self.old_memory[m][u, q][0])

    @ti.func
    def add_new(self, u, p, i, mate, target, row, stiffness, reach, share):
        """Write contact p, which remembers nothing."""
        self.write(u, p, i, mate, target)
        block, lane = p // self.lanes, p % self.lanes
        if ti.static(self.kinds > 1):
            self.row[u, block][lane] = row
        self.stiffness[u, block][lane] = stiffness
        self.reach[u, block][lane] = reach
        self.share[u, block][lane] = share

    @ti.func
    def pad(self, u):
        """Fill the last block with pairs that never touch: of the unit's first grain and a far-off ghost."""
        i, ghost = self.units.first(u), self.units.ghost(u)
        for p in range(self.length[u], self.blocks(u) * self.lanes):
            self.write(u, p, i, ghost, ghost)
            if ti.static(self.kinds > 1):
                self.row[u, p // self.lanes][p % self.lanes] = 0
            self.reach[u, p // self.lanes][p % self.lanes] = 0.0
