"""The step, written once: the phases of all matters and of the carrier, in the order in which they act."""

from collections.abc import Sequence as Several

import taichi as ti

from solvers.machine.phase import Phase


@ti.data_oriented
class Sequence:
    """What every schedule runs, for worlds that hold `matters` and are moved by a `carrier`.

    A step is a whole number of base steps, its stride, which changes only where all lists are made anew: the least that
    any matter or the carrier allows then (`pace`), without overshooting what is asked for. At time t (s) it is, in a
    world: every phase of `before`, in which matters find their forces and book those on
    the tank, and the carrier then answers to that load; the carrier's frame; every phase of `after`, in which matters
    move. A matter has `before`, `after` and `units`, and says when its lists are worn (see `GrainMatter`).
    """

    def __init__(self, matters: Several, carrier):
        self.matters, self.carrier = tuple(matters), carrier
        self.before: tuple[Phase, ...] = (*(phase for matter in matters for phase in matter.before), *carrier.phases)
        self.after: tuple[Phase, ...] = tuple(phase for matter in matters for phase in matter.after)
        self.paced = carrier.paced and all(matter.paced for matter in matters)  # whether any step may be longer

    @ti.func
    def stride(self, w, due):
        """Base steps that the steps to come may take in a world, `due` at most."""
        stride = ti.min(due, self.carrier.pace(w))
        for k in ti.static(range(len(self.matters))):
            stride = ti.min(stride, self.matters[k].pace(w))
        return stride

    @ti.func
    def stale(self, u, t):
        """Whether the lists of a unit, of any matter, are no good any more at time t (s)."""
        found = False
        for k in ti.static(range(len(self.matters))):
            if self.matters[k].stale(u, t):
                found = True
        return found

    @ti.func
    def worn(self, u):
        """Whether they may be: a bound that costs nothing."""
        found = False
        for k in ti.static(range(len(self.matters))):
            if self.matters[k].worn(u):
                found = True
        return found

    @ti.func
    def asked(self, u):
        """Whether some entries are to be sought anew though the lists are good."""
        found = False
        for k in ti.static(range(len(self.matters))):
            if self.matters[k].asked(u):
                found = True
        return found

    @ti.func
    def sort(self, w):
        """Sort a world's particles into cells, before lists are made."""
        for k in ti.static(range(len(self.matters))):
            self.matters[k].sort(w)

    @ti.func
    def make_lists(self, u, t, dt, whole):
        """Make the lists of a unit anew, or with `whole` false only what is asked for; False where they do not fit."""
        fits = True
        for k in ti.static(range(len(self.matters))):
            if not self.matters[k].make_lists(u, t, dt, whole):
                fits = False
        return fits
