"""The time step as one list: the phases of all matters and of the carrier, in their order."""

from collections.abc import Sequence as Several

import taichi as ti

from solvers.machine.phase import Phase


@ti.data_oriented
class Sequence:
    """The step that every schedule runs, for worlds that hold `matters` and are moved by a `carrier`.

    A step of a world at time t (s) is: every phase of `before`, in which matters compute their forces and book those on
    the tank, and the carrier then responds to that load; the carrier's frame; every phase of `after`, in which matters
    move. A step is `stride` base steps long. The stride changes only when all lists are rebuilt, to the least that any
    matter or the carrier allows (`pace`), and never overshoots the target. A matter has `before`, `after` and `units`,
    and says when its lists must be rebuilt (see `GrainMatter`).
    """

    def __init__(self, matters: Several, carrier):
        self.matters, self.carrier = tuple(matters), carrier
        self.before: tuple[Phase, ...] = (*(phase for matter in matters for phase in matter.before), *carrier.phases)
        self.after: tuple[Phase, ...] = tuple(phase for matter in matters for phase in matter.after)
        self.paced = carrier.paced and all(matter.paced for matter in matters)  # whether any step may be longer

    @ti.func
    def stride(self, w, due):
        """Stride of a world's next steps, in base steps, at most `due`."""
        stride = ti.min(due, self.carrier.pace(w))
        for k in ti.static(range(len(self.matters))):
            stride = ti.min(stride, self.matters[k].pace(w))
        return stride

    @ti.func
    def stale(self, u, t):
        """Whether a unit's lists, of any matter, must be rebuilt at time t (s)."""
        found = False
        for k in ti.static(range(len(self.matters))):
            if self.matters[k].stale(u, t):
                found = True
        return found

    @ti.func
    def worn(self, u):
        """Whether a unit's lists may be stale, by a cheap upper bound on the displacements."""
        found = False
        for k in ti.static(range(len(self.matters))):
            if self.matters[k].worn(u):
                found = True
        return found

    @ti.func
    def asked(self, u):
        """Whether some entries of a unit's lists must be searched for again although the lists are valid."""
        found = False
        for k in ti.static(range(len(self.matters))):
            if self.matters[k].asked(u):
                found = True
        return found

    @ti.func
    def sort(self, w):
        """Sort a world's particles into cells before the lists are rebuilt."""
        for k in ti.static(range(len(self.matters))):
            self.matters[k].sort(w)

    @ti.func
    def make_lists(self, u, t, dt, whole):
        """Rebuild a unit's lists, or with `whole` false only the entries asked for; returns whether they fit."""
        fits = True
        for k in ti.static(range(len(self.matters))):
            if not self.matters[k].make_lists(u, t, dt, whole):
                fits = False
        return fits
