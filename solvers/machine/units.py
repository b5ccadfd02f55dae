"""Units of work: runs of grains that one thread moves. A unit is a whole world, a band of it, or a single grain."""

import taichi as ti

from solvers.machine.state import Axis

# Distance between the ghosts of different bands, so that no two threads write to one cache line.
APART = 16
# In a parallel loop Taichi's CPU backend gives each thread at least this many iterations.
ITERATIONS_A_THREAD = 512


@ti.data_oriented
class Units:
    """W worlds of `mobile` grains, each cut into `a_world` units of consecutive grain numbers.

    Unit u belongs to world u // a_world. With one unit per world each pair is listed once (half-list). With several
    units a pair across two of them is listed and evaluated in both, so that no unit writes to another's grains.
    """

    def __init__(self, worlds: int, mobile: int, a_world: int, ghost: int):
        self.worlds, self.mobile, self.a_world, self.first_ghost = worlds, mobile, a_world, ghost
        self.size = -(-mobile // a_world)
        self.count = worlds * a_world
        self.whole = a_world == 1
        self.single = self.size == 1 and a_world > 1

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
            i = (u % self.a_world) * self.size
        return i

    @ti.func
    def end(self, u):
        """One past the last grain of unit u; a unit may be empty."""
        return ti.max(self.first(u), ti.min(self.mobile, self.first(u) + self.size))

    @ti.func
    def ghost(self, u):
        """The ghost (far-off point) of unit u."""
        g = self.first_ghost
        if ti.static(not (self.whole or self.single)):
            g += APART * (u % self.a_world)
        return g
