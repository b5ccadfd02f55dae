"""The time step as one list: the phases of all matters and of the carrier, in their order."""

from collections.abc import Sequence as Several
from math import lcm

import taichi as ti

from solvers.machine.phase import Phase

CHECK_EVERY = 64  # base steps between two checks whether steps may be longer


@ti.data_oriented
class Sequence:
    """The step that every schedule runs, for worlds that hold `matters` and `pieces` and are moved by a `carrier`.

    A step of a world at time t (s) is: the `opening` of pieces that are free, in which they touch others; every
    phase of `before`, in which matters compute their forces and book those on the tank; the carrier's, which responds
    to that load; every phase of `between`, in which matters note how the tank will move; those of free pieces, which
    respond to their loads; the carrier's frame; every phase of `after`, in which matters move. A matter whose steps are
    longer (`Phase.every`) computes its forces in the first of a few steps and moves in the last one, once it is known
    how the tank has moved through all of them; its load stands in between (`Load`). A step is a `multiple` of the base
    step, which changes only when all lists are rebuilt, to the least that any matter or the carrier allows
    (`allowed_multiple`), and never overshoots the target. Since a quiet world seldom rebuilds its lists, it is checked
    every CHECK_EVERY base steps whether it may take longer ones. What a matter must offer is in `solvers.tank.matter`.

    An `exchange` between two matters acts before their forces, after them, and between the motions of the two.
    """

    def __init__(self, matters: Several, carrier, pieces, exchange=None):
        self.matters, self.carrier = tuple(matters), carrier
        pushing = (phase for matter in matters for phase in matter.before)
        self.before: tuple[Phase, ...] = (
            *pieces.opening,
            *(exchange.opening if exchange else ()),
            *pushing,
            *(exchange.phases if exchange else ()),
            *carrier.phases,
            *(p for m in matters for p in m.between),
            *pieces.phases,
        )
        closing = exchange.closing if exchange else ()
        moving = [phase for matter in matters[:1] for phase in matter.after]  # an exchange ends as the second one moves
        self.after: tuple[Phase, ...] = (*moving, *closing, *(p for matter in matters[1:] for p in matter.after))
        alike = all(phase.every == 1 for phase in (*self.before, *self.after))
        # Whether any step may be longer
        self.has_multiples = alike and all(one.has_multiples for one in (carrier, pieces, *matters))

    @property
    def exchange_interval(self) -> int:
        """Base steps after which all matters have acted and exchanged their loads with the carrier."""
        return lcm(*(phase.every for phase in (*self.before, *self.after)))

    @ti.func
    def begin(self, k: ti.template(), u, step, t, kick, dt):
        """Run phase k of `before` on unit or world u at base step `step`, if it is its turn."""
        if ti.static(self.before[k].every == 1):
            self.before[k].act(u, t, kick, dt)
        elif step % self.before[k].every == self.before[k].turn:
            self.before[k].act(u, t, self.before[k].every * kick, self.before[k].every * dt)

    @ti.func
    def end(self, k: ti.template(), u, step, frame: ti.template(), kick, dt):
        """Run phase k of `after` on unit or world u, if it is its turn; returns whether the state is sound."""
        sound = True
        if ti.static(self.after[k].every == 1):
            sound = self.after[k].act(u, frame, kick, dt)
        elif step % self.after[k].every == self.after[k].turn:
            sound = self.after[k].act(u, frame, self.after[k].every * kick, self.after[k].every * dt)
        return sound

    @ti.func
    def multiple(self, w, step, left):
        """How many base steps a world's next steps are long from base step `step` on, at most the `left` ones.

        A short one is a power of two that divides `step`, so that it does not depend on where a run is looked at.
        """
        multiple = ti.min(left, self.allowed_multiple(w))
        if multiple < CHECK_EVERY:
            longest, multiple = multiple, 1
            while 2 * multiple <= longest and step % (2 * multiple) == 0:
                multiple *= 2
        return multiple

    @ti.func
    def may_lengthen(self, w, step, left, multiple):
        """Whether a world takes shorter steps than it may; checked every CHECK_EVERY base steps."""
        found = False
        if ti.static(self.has_multiples):  # noqa: SIM102 (compiled only where steps may be longer)
            if step % CHECK_EVERY == 0 and left > 0:
                found = self.multiple(w, step, left) > multiple
        return found

    @ti.func
    def must_shorten(self, w, multiple):
        """Whether a world takes longer steps than it may now; checked when its lists are."""
        return multiple > self.allowed_multiple(w)

    @ti.func
    def allowed_multiple(self, w):
        """The largest multiple of a world: the least that any matter or the carrier allows."""
        allowed = self.carrier.allowed_multiple(w)
        for k in ti.static(range(len(self.matters))):
            allowed = ti.min(allowed, self.matters[k].allowed_multiple(w))
        return allowed

    @ti.func
    def invalid(self, u, t):
        """Whether a unit's lists, of any matter, must be rebuilt at time t (s)."""
        found = False
        for k in ti.static(range(len(self.matters))):
            if self.matters[k].invalid(u, t):
                found = True
        return found

    @ti.func
    def may_be_invalid(self, u, t):
        """Whether a unit's lists may be stale at time t (s), by cheap upper bounds on the displacements."""
        found = False
        for k in ti.static(range(len(self.matters))):
            if self.matters[k].may_be_invalid(u, t):
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
