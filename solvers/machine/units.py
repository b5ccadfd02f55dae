"""Units of work: runs of grains that one thread moves. A unit is a whole world, a band of it, or a single grain."""

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, Scope, roomy

# Distance between the ghosts of different bands, so that no two threads write to one cache line.
APART = 16
# In a parallel loop Taichi's CPU backend gives each thread at least this many iterations.
ITERATIONS_A_THREAD = 512
FEW, OF_ALL = 1024, 8192  # grains for which a world, and all worlds together, have room at least
LONG = 8192  # from how many on there is little room to spare
MOBILE, SHARE, COUNT = range(3)


def spacious(count: int, worlds: int) -> int:
    """Room for so many grains: scenes of nearly as many have the same, and so share compiled kernels."""
    return roomy(count, roomy(1, min(FEW, OF_ALL // worlds))) if count <= LONG else -(-count // LONG) * LONG


@ti.data_oriented
class Units:
    """W worlds of `mobile` grains, each cut into `a_world` units of consecutive grain numbers, `share` in each.

    `size` is for how many a unit has room. With arrays of their `own` the numbers of grains are in these; else they are
    compiled in, as the room is. The ghosts of a world come after the `room` of its grains.

    Unit u belongs to world u // a_world. With one unit per world each pair is listed once (half-list). With several
    units a pair across two of them is listed and evaluated in both, so that no unit writes to another's grains.
    """

    def __init__(self, worlds: int, mobile: int, a_world: int, more: int = 0, own: Scope | None = None):
        self.worlds, self.mobile, self.a_world = worlds, mobile, a_world
        self.share = -(-mobile // a_world)
        self.count = worlds * a_world
        self.whole = a_world == 1
        self.single = self.share == 1 and a_world > 1
        self.told = own is not None and not self.single
        self.size, self.room, self.more = self.share, mobile + more, more
        if self.told:
            self.size, self.room = (spacious(count, worlds) for count in (self.share, mobile + more))
            self.numbers = own.holding("numbers", np.array([mobile, self.share, mobile + more]), "number", ti.i32)

    @property
    def ghosts(self) -> int:
        """Number of ghosts of a world: far-off points for padding pairs, which also keep worlds on own cache lines."""
        return 1 if self.single else APART * self.a_world

    @property
    def axis(self) -> Axis:
        """The axis of arrays with one entry per unit."""
        return Axis("unit", self.count)

    @ti.func
    def world(self, u):
        """The world of unit u."""
        w = u
        if ti.static(self.worlds == 1):
            w = 0  # a constant, which the compiler builds into every address
        elif ti.static(not self.whole):
            w = u // self.a_world
        return w

    @ti.func
    def first(self, u):
        """The first grain of unit u."""
        i = 0
        if ti.static(not self.whole):
            i = (u % self.a_world) * self.told_of(SHARE, self.share)
        return i

    @ti.func
    def end(self, u):
        """One past the last grain of unit u; a unit may be empty."""
        return ti.max(self.first(u), ti.min(self.moving(), self.first(u) + self.told_of(SHARE, self.share)))

    @ti.func
    def moving(self):
        """How many grains of a world move."""
        return self.told_of(MOBILE, self.mobile)

    @ti.func
    def all(self):
        """How many grains a world has, fixed ones included."""
        return self.told_of(COUNT, self.mobile + self.more)

    @ti.func
    def told_of(self, which: ti.template(), number: ti.template()):
        """One of the `numbers`; where there are none, the `number` itself, as a constant."""
        if ti.static(self.told):
            return self.numbers[which]
        else:
            return number

    @ti.func
    def ghost(self, u):
        """The ghost (far-off point) of unit u."""
        g = self.room
        if ti.static(not (self.whole or self.single)):
            g += APART * (u % self.a_world)
        return g
