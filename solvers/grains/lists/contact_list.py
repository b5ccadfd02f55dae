"""The list of candidate contacts of each unit of work, with their contact history."""

import numpy as np
import taichi as ti

from solvers.grains.laws.chosen import ChosenLaws
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.machine.wide import enter, entry


@ti.data_oriented
class ContactList:
    """Candidate contacts of one kind (grain–grain or grain–wall) of each unit u, sorted by their first grain.

    Contact p is in lane p % lanes of block p // lanes. `mate` is the other grain or the wall feature; `target` the
    grain that takes the reaction, which is a ghost if the mate belongs to another unit. Grains are stored as indices
    into the arrays of all worlds, with `stride` entries per world, which saves the force loop an addition per read;
    with a stride of 0 they are numbers within their world. `places` are the numbers of valid indices of grains and of
    mates. Constant while a contact is listed are `stiffness` k (N/m^1.5), `reach` (m), the centre distance at which the
    two touch, `share`, the first grain's part of it, and the laws' constants. The laws' memory changes, and is zero
    while the two do not touch. Constants, memory and `more` memories of other owners are fields under the names given,
    or the list of them where a law remembers a vector; `fleeting` ones are not carried over to the next list.
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
        self.units, self.lanes, self.stride, self.wide = units, lanes, stride, bool(laws.wide)
        ways = {"across": units.single, "wide": self.wide}
        blocks, across = -(-room // lanes), units.single
        self.capacity = blocks * lanes
        self.arrays, self.lane = arrays, Axis("lane", lanes)
        axes, contacts = (units.axis, Axis("block", blocks), self.lane), Axis("contact", self.capacity)
        self.each = (units.axis, contacts, Axis("one", 1))
        (self.length,) = arrays.integers((units.axis,), "length", below=self.capacity + 1)
        base = stride * (np.arange(units.count) // units.a_world)
        (self.grain,) = arrays.integer_vectors(axes, "grain", base=base, below=places[0], **ways)
        (self.mate,) = arrays.integer_vectors(axes, "mate", base=base, below=places[1], **ways)
        self.has_targets = not (units.whole or units.single)
        self.target = self.mate
        if self.has_targets:
            (self.target,) = arrays.integer_vectors(axes, "target", base=base, below=places[1], wide=self.wide)
        constants = "stiffness", "reach", "share"
        self.stiffness, self.reach, self.share = arrays.vectors(axes, *constants, **ways)
        if laws.kinds > 1:
            rows = laws.kinds * (laws.kinds + 1)
            (self.row,) = arrays.integer_vectors(axes, "row", below=rows, **ways)  # row of the interface
        self.kinds = laws.kinds
        self.constants = arrays.under("constant").vectors(axes, *laws.constants, **ways)
        memory, remembered = (*laws.memory, *more), arrays.under("memory")
        self.memory = remembered.vectors(axes, *laws.memory, **ways)
        self.memory += remembered.vectors(self.each, *more, **ways)
        of_laws, others = self.memory[: len(laws.memory)], self.memory[len(laws.memory) :]
        for name, field in zip((*laws.constants, *more), (*self.constants, *others), strict=True):
            setattr(self, name, field)
        for name, fields in laws.by_name(of_laws).items():
            setattr(self, name, fields)
        self.memories, others = len(self.memory), arrays.under("fleeting").vectors(axes, *fleeting, **ways)
        for name, field in zip(fleeting, others, strict=True):
            setattr(self, name, field)
        self.whole = [self.grain, self.mate, self.stiffness, self.reach, self.share]  # all that is known of a contact
        self.whole += [self.target] * self.has_targets + ([self.row] if laws.kinds > 1 else [])
        self.whole += [*self.constants, *self.memory, *others]
        old, starts = arrays.under("old"), (units.axis, Axis("start", units.size + 1))
        (self.first,) = arrays.integers(starts, "first", across=across, below=self.capacity + 1)
        (self.old_first,) = old.integers(starts, "first", across=across, kept=False)
        (self.old_mate,) = old.integers((units.axis, contacts), "mate", across=across, kept=False)
        self.old_memory = old.under("memory").vectors(self.each, *memory, kept=False, **ways)
        for name, field in zip(memory, self.old_memory, strict=True):
            setattr(self, f"old_{name}", field)

    def forget(self) -> None:
        """Empty the list and its contact history."""
        self.length.fill(0)
        self.first.fill(0)

    @ti.func
    def blocks(self, u):
        """Number of blocks in use; the last may be padded."""
        return (self.length[u] + self.lanes - 1) // self.lanes

    @ti.func
    def first_of(self, u, p):
        """The first grain of contact p, by its number within its world."""
        return entry(self.grain, u, p // self.lanes, p % self.lanes) - self.units.world(u) * self.stride

    @ti.func
    def second_of(self, u, p):
        """The other grain (by its number within its world), or the wall feature, of contact p."""
        return entry(self.mate, u, p // self.lanes, p % self.lanes) - self.units.world(u) * self.stride

    @ti.func
    def remembered(self, which: ti.template(), u, p):
        """The memory of contact p with number `which`."""
        lanes = ti.static(self.memory[which].n)
        return entry(self.memory[which], u, p // lanes, p % lanes)

    @ti.func
    def remember(self, which: ti.template(), u, p, value):
        """Set the memory of contact p with number `which`."""
        lanes = ti.static(self.memory[which].n)
        enter(self.memory[which], u, p // lanes, p % lanes, value)

    @ti.func
    def remembers(self, u, p):
        """Whether contact p remembers anything."""
        found = False
        for k in ti.static(range(self.memories)):
            found = found or self.remembered(k, u, p) != 0.0
        return found

    @ti.func
    def hand_on(self, u, p, q):
        """Let what contact p remembers be contact q's."""
        for k in ti.static(range(self.memories)):
            self.remember(k, u, q, self.remembered(k, u, p))
            self.remember(k, u, p, 0.0)

    @ti.func
    def set_aside(self, u):
        """Copy the present list to the old one, in which `add` finds the contact history."""
        for k in range(self.units.size + 1):
            self.old_first[u, k] = self.first[u, k]
        for p in range(self.length[u]):
            self.keep_old(u, p)

    @ti.func
    def set_aside_some(self, u, row, start, end):
        """Copy only these contacts of a grain to the old list."""
        self.old_first[u, row], self.old_first[u, row + 1] = start, end
        for p in range(start, end):
            self.keep_old(u, p)

    @ti.func
    def keep_old(self, u, p):
        """Copy contact p to its place in the old list."""
        block, lane = p // self.lanes, p % self.lanes
        self.old_mate[u, p] = entry(self.mate, u, block, lane)
        for k in ti.static(range(self.memories)):
            enter(self.old_memory[k], u, p, 0, self.remembered(k, u, p))

    @ti.func
    def put_back(self, u):
        """Undo a rebuild that exceeded the capacity."""
        start = self.units.world(u) * self.stride + self.units.first(u)
        self.length[u] = self.old_first[u, self.units.size]
        for k in range(self.units.size + 1):
            self.first[u, k] = self.old_first[u, k]
        for k in range(self.units.size):
            for p in range(self.old_first[u, k], self.old_first[u, k + 1]):
                block, lane = p // self.lanes, p % self.lanes
                enter(self.grain, u, block, lane, start + k)
                enter(self.mate, u, block, lane, self.old_mate[u, p])
                for m in ti.static(range(self.memories)):
                    self.remember(m, u, p, entry(self.old_memory[m], u, p, 0))

    @ti.func
    def write(self, u, p, i, mate, target):
        """Write contact p between grain i and its mate, without memory."""
        block, lane, before = p // self.lanes, p % self.lanes, self.units.world(u) * self.stride
        enter(self.grain, u, block, lane, before + i)
        enter(self.mate, u, block, lane, before + mate)
        if ti.static(self.has_targets):
            enter(self.target, u, block, lane, before + target)
        self.clear(u, p)

    @ti.func
    def move(self, u, p, to):
        """Write contact p over the contact `to`."""
        for field in ti.static(self.whole):
            enter(field, u, to // field.n, to % field.n, entry(field, u, p // field.n, p % field.n))

    @ti.func
    def clear(self, u, p):
        """Clear the memory of contact p."""
        for k in ti.static(range(self.memories)):
            self.remember(k, u, p, 0.0)

    @ti.func
    def add(self, u, p, i, mate, target, row, stiffness, reach, share):
        """Write contact p with its memory from the old list, if it was listed there."""
        self.add_new(u, p, i, mate, target, row, stiffness, reach, share)
        k, place = i - self.units.first(u), self.units.world(u) * self.stride + mate
        for q in range(self.old_first[u, k], self.old_first[u, k + 1]):
            if self.old_mate[u, q] == place:
                self.recall(u, p, q)

    @ti.func
    def recall(self, u, p, q):
        """Copy the memory of contact q of the old list to contact p."""
        for m in ti.static(range(self.memories)):
            self.remember(m, u, p, entry(self.old_memory[m], u, q, 0))

    @ti.func
    def add_new(self, u, p, i, mate, target, row, stiffness, reach, share):
        """Write contact p and its constant properties, without memory."""
        self.write(u, p, i, mate, target)
        block, lane = p // self.lanes, p % self.lanes
        if ti.static(self.kinds > 1):
            enter(self.row, u, block, lane, row)
        enter(self.stiffness, u, block, lane, stiffness)
        enter(self.reach, u, block, lane, reach)
        enter(self.share, u, block, lane, share)

    @ti.func
    def pad(self, u):
        """Pad the last block with pairs that never touch: the unit's first grain and a far-off ghost."""
        i, ghost = self.units.first(u), self.units.ghost(u)
        for p in range(self.length[u], self.blocks(u) * self.lanes):
            self.write(u, p, i, ghost, ghost)
            if ti.static(self.kinds > 1):
                enter(self.row, u, p // self.lanes, p % self.lanes, 0)
            enter(self.reach, u, p // self.lanes, p % self.lanes, 0.0)
