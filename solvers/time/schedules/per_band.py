"""The per-band schedule: one thread per band of a world, synchronised by a barrier."""

import taichi as ti

from solvers.machine.runtime import available_cores, spread_threads
from solvers.machine.units import ITERATIONS_A_THREAD
from solvers.time.clock import Clock
from solvers.time.sequence import Sequence
from solvers.time.watch import NO_ROOM, OVER, RUNNING, TOO_FAST

FINE, ASKED, STALE, ENDED, FAST, FULL = range(6)  # status of a band, the most severe last


@ti.data_oriented
class PerBand:
    """Advances worlds of several bands; each band's whole time loop is one task of the thread pool.

    The bands meet at a barrier after each phase; after the last one they agree on whether to rebuild the lists. They
    wait by spinning, since waking a thread takes longer than a step. The first band alone runs the phases that act on
    whole worlds. With fewer threads than bands, one thread runs the bands in turn. The bits depend on the numbers of
    bands and threads, since the compiler then rounds differently in places.
    """

    def __init__(self, sequence: Sequence, clock: Clock, threads: int):
        self.sequence, self.carrier, self.clock = sequence, sequence.carrier, clock
        self.before, self.after = sequence.before, sequence.after
        self.real, self.worlds, self.bands = clock.real, clock.worlds, clock.units.a_world
        self.together = min(threads, available_cores()) >= clock.units.count
        if self.together:
            spread_threads()

    def advance(self, target: int, origin: float, base: float) -> None:
        """Take every running world to base step `target`; see PerWorld."""
        if self.together:
            self.clock.arrived.fill(0)
            self._advance_together(target, origin, base)
        else:
            self._advance_in_turn(target, origin, base)

    @ti.kernel
    def _advance_together(self, target: ti.i32, origin: ti.f64, base: ti.f64):
        for k in range(self.worlds * self.bands * ITERATIONS_A_THREAD):
            if k % ITERATIONS_A_THREAD == 0:
                self.advance_band(k // ITERATIONS_A_THREAD, target, origin, base)

    @ti.kernel
    def _advance_in_turn(self, target: ti.i32, origin: ti.f64, base: ti.f64):
        for k in range(self.worlds * ITERATIONS_A_THREAD):
            if k % ITERATIONS_A_THREAD == 0:
                self.advance_world(k // ITERATIONS_A_THREAD, target, origin, base)

    @ti.func
    def advance_band(self, u, target, origin, base):
        """The time loop of one band, as in PerWorld; all bands of a world pass the same barriers in the same order."""
        w = self.clock.world(u)
        done, running = self.clock.step[w], self.clock.status[w] == RUNNING
        before, multiple = self.clock.before[w], self.multiple_of(w)
        says = self.freshness(u, done, origin + done * base, multiple, target - done)
        self.clock.says[u] = says
        meetings = self.meet(w, 0)
        worst = self.worst(w)
        while running and worst <= STALE and done < target:
            if worst != FINE:
                if worst == STALE and u % self.bands == 0:
                    self.sequence.sort(w)
                if ti.static(self.sequence.has_multiples):  # noqa: SIM102 (compiled only where steps may be longer)
                    if worst == STALE:
                        multiple = self.sequence.multiple(w, done, target - done)
                meetings = self.meet(w, meetings)
                dt = ti.cast(multiple * base, self.real)
                says = FINE if self.sequence.make_lists(u, origin + done * base, dt, worst == STALE) else FULL
                self.clock.says[u] = says
                meetings = self.meet(w, meetings)
                worst = self.worst(w)
            while worst == FINE and done < target:
                t, dt = origin + done * base, ti.cast(multiple * base, self.real)
                kick = ti.cast(0.5 * (before + multiple) * base, self.real)
                for k in ti.static(range(len(self.before))):
                    self.begin(k, u, done, t, kick, dt)
                    meetings = self.meet(w, meetings)
                says = FINE
                for k in ti.static(range(len(self.after))):
                    if not self.end(k, u, done, t, kick, dt):
                        says = FAST
                    if ti.static(k < len(self.after) - 1):
                        meetings = self.meet(w, meetings)
                done, before = done + multiple, multiple
                if says == FINE:
                    says = self.freshness(u, done, origin + done * base, multiple, target - done)
                if says <= STALE and not self.carrier.goes_on(w):
                    says = ENDED
                self.clock.says[u] = says
                meetings = self.meet(w, meetings)
                worst = self.worst(w)
        if u % self.bands == 0:
            self.clock.step[w], self.clock.before[w], self.clock.multiple[w] = done, before, multiple
        self.report(w, says)

    @ti.func
    def advance_world(self, w, target, origin, base):
        """The time loop of a world on one thread, band after band."""
        start, multiple = w * self.bands, self.multiple_of(w)
        while self.clock.step[w] < target and self.clock.status[w] == RUNNING:
            done = self.clock.step[w]
            left = target - done
            t, worst = origin + done * base, FINE
            for u in range(start, start + self.bands):
                worst = ti.max(worst, self.freshness(u, done, t, multiple, left))
            if ti.static(self.sequence.has_multiples):  # noqa: SIM102
                if worst == STALE:
                    multiple = self.sequence.multiple(w, done, left)
                    self.clock.multiple[w] = multiple
            dt = ti.cast(multiple * base, self.real)
            if worst != FINE:
                whole, worst = worst == STALE, FINE
                if whole:
                    self.sequence.sort(w)
                for u in range(start, start + self.bands):
                    if not self.sequence.make_lists(u, t, dt, whole):
                        worst = FULL
            if worst == FINE:
                kick = ti.cast(0.5 * (self.clock.before[w] + multiple) * base, self.real)
                for k in ti.static(range(len(self.before))):
                    for u in range(start, start + self.bands):
                        self.begin(k, u, done, t, kick, dt)
                for k in ti.static(range(len(self.after))):
                    for u in range(start, start + self.bands):
                        if not self.end(k, u, done, t, kick, dt):
                            worst = FAST
                self.clock.step[w], self.clock.before[w] = self.clock.step[w] + multiple, multiple
                if worst == FINE and not self.carrier.goes_on(w):
                    worst = ENDED
            self.report(w, worst)

    @ti.func
    def begin(self, k: ti.template(), u, step, t, kick, dt):
        """A band's part of phase k of `before`."""
        if ti.static(self.before[k].of_worlds):
            if u % self.bands == 0:
                self.sequence.begin(k, u // self.bands, step, t, kick, dt)
        else:
            self.sequence.begin(k, u, step, t, kick, dt)

    @ti.func
    def end(self, k: ti.template(), u, step, t, kick, dt):
        """A band's part of phase k of `after`, in which the particles move; returns whether their state is sound."""
        sound = True
        if ti.static(self.after[k].of_worlds):
            if u % self.bands == 0:
                sound = self.act_on(k, u // self.bands, u // self.bands, step, t, kick, dt)
        else:
            sound = self.act_on(k, u, self.clock.world(u), step, t, kick, dt)
        return sound

    @ti.func
    def act_on(self, k: ti.template(), u, w, step, t, kick, dt):
        """Run phase k of `after` on unit or world u of world w; returns whether the state is sound."""
        return self.sequence.end(k, u, step, self.carrier.frame(w, t), kick, dt)

    @ti.func
    def multiple_of(self, w):
        """Present multiple of a world, in base steps."""
        multiple = 1
        if ti.static(self.sequence.has_multiples):
            multiple = self.clock.multiple[w]
        return multiple

    @ti.func
    def freshness(self, u, done, t, multiple, left):
        """State of a band's lists at base step `done`, time t (s): FINE, some entries to be sought (ASKED), or STALE.

        They also count as STALE if a step of `multiple` base steps would overshoot the `left` ones.
        """
        says = FINE
        if self.sequence.asked(u):
            says = ASKED
        may_be_invalid = self.sequence.may_be_invalid(u, t)
        if self.sequence.invalid(u, t):
            says = STALE
        if ti.static(self.sequence.has_multiples):
            w = self.clock.world(u)
            if 0 < left < multiple or self.sequence.may_lengthen(w, done, left, multiple):
                says = STALE
            if may_be_invalid:  # noqa: SIM102 (Taichi evaluates both sides of `and`)
                if self.sequence.must_shorten(w, multiple):
                    says = STALE
        return says

    @ti.func
    def worst(self, w):
        """The most severe status of a world's bands."""
        worst = FINE
        for u in range(w * self.bands, (w + 1) * self.bands):
            worst = ti.max(worst, self.clock.says[u])
        return worst

    @ti.func
    def meet(self, w, meetings):
        """Barrier: wait until all bands of the world are here; returns how often they have met."""
        ti.atomic_add(self.clock.arrived[w], 1)
        here = 0
        while here < (meetings + 1) * self.bands:
            here = ti.atomic_add(self.clock.arrived[w], 0)
        return meetings + 1

    @ti.func
    def report(self, w, says):
        if says == ENDED:
            self.clock.status[w] = OVER
        if says == FAST:
            self.clock.status[w] = TOO_FAST
        if says == FULL:
            self.clock.status[w] = NO_ROOM
