"""Substeps: steps of a matter that are several base steps long, as those of water beside grains in a ship."""

from collections.abc import Iterable
from dataclasses import replace

import taichi as ti

from solvers.machine.phase import Phase
from solvers.machine.state import Axis, Scope


@ti.data_oriented
class Substeps:
    """A step of a matter is `every` base steps: forces are computed in the first, and particles move in the last.

    Then it is known how the tank has moved through all of them. With 1 nothing is done here. Other matters may rebuild
    their lists far more often: the matter's own `lists` are rebuilt only if they are stale themselves, which they can
    become only as its particles move, so never between forces and motion.
    """

    def __init__(self, own: Scope, lists, every: int):
        self.every, self.long, self.lists, self.units = every, every > 1, lists, lists.units
        if self.long:
            world = (Axis("world", self.units.worlds),)
            (self.during,) = own.reals(world, "during", kept=False)  # s, the kick that belongs to the forces
            (self.rebuilding,) = own.integers(world, "rebuilding", kept=False)  # whether lists are rebuilt

    def first(self, phases: Iterable[Phase]) -> tuple[Phase, ...]:
        """Phases as they are called in the first base step."""
        return tuple(replace(phase, every=self.every) for phase in phases)

    def last(self, phases: Iterable[Phase]) -> tuple[Phase, ...]:
        """Phases as they are called in the last base step."""
        return tuple(replace(phase, every=self.every, last=True) for phase in phases)

    @ti.func
    def note(self, w, kick):
        """Note the kick (s) for the forces of a world that are computed now."""
        if ti.static(self.long):
            self.during[w] = kick

    @ti.func
    def kick(self, w, kick):
        """The kick (s) that belongs to the present forces."""
        during = kick
        if ti.static(self.long):
            during = self.during[w]
        return during

    @ti.func
    def sort(self, w):
        """Sort the particles of a world, if its lists are to be rebuilt."""
        rebuilds = 1
        if ti.static(self.long):
            rebuilds = 0
            for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
                if self.lists.invalid(u):
                    rebuilds = 1
            self.rebuilding[w] = rebuilds
        if rebuilds > 0:
            self.lists.order.sort_world(w)

    @ti.func
    def rebuilds(self, u):
        """Whether the lists of a unit are rebuilt with those of the other matters."""
        rebuilds = True
        if ti.static(self.long):
            rebuilds = self.rebuilding[self.units.world(u)] > 0
        return rebuilds
