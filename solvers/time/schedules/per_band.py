"""The per-band schedule: the bands of a world on threads of their own, kept in step by a barrier."""

import taichi as ti

from solvers.machine.runtime import available_cores, spread_threads
from solvers.time.schedules.engine import ITERATIONS_A_THREAD, Engine
from solvers.time.watch import CAPSIZED, NO_ROOM, RUNNING, TOO_FAST

FINE, ASKED, STALE, OVER, FAST, FULL = range(6)  # what a band says of itself, the worst last


@ti.data_oriented
class PerBand:
    """Advances worlds of several bands; each band's whole time loop is one task of the thread pool.

    Bands meet twice a step: after the forces, which read what all grains do, and after the move, where they agree on
    building the lists anew; in a ship once more in between, after the first one has steered her. They wait by spinning,
    since a wake-up takes longer than a step. With fewer threads than bands one thread does them in turn. The bits
    depend on the numbers of bands and of threads, for which the compiler rounds differently here and there.
    """

    def __init__(self, engine: Engine, threads: int):
        self.units, self.neighbours, self.contacts = engine.units, engine.neighbours, engine.contacts
        self.grains, self.mover, self.frame, self.clock = engine.grains, engine.mover, engine.frame, engine.clock
        self.unseen, self.real, self.bands = engine.unseen, engine.grains.real, engine.units.a_world
        self.together = min(threads, available_cores()) >= engine.units.count
        if self.together:
            spread_threads()

    def advance(self, target: int, origin: float, unkicked: int, step: float, fastest: float) -> None:
        """Take every running world to step `target`; see PerWorld."""
        if self.together:
            self.clock.arrived.fill(0)
            self._advance_together(target, origin, unkicked, step, fastest)
        else:
            self._advance_in_turn(target, origin, unkicked, step, fastest)

    @ti.kernel
    def _advance_together(self, target: ti.i32, origin: ti.f64, unkicked: ti.i32, step: ti.f64, fastest: ti.f64):
        for k in range(self.units.count * ITERATIONS_A_THREAD):
            if k % ITERATIONS_A_THREAD == 0:
                self.advance_band(k // ITERATIONS_A_THREAD, target, origin, unkicked, step, fastest)

    @ti.kernel
    def _advance_in_turn(self, target: ti.i32, origin: ti.f64, unkicked: ti.i32, step: ti.f64, fastest: ti.f64):
        for k in range(self.grains.worlds * ITERATIONS_A_THREAD):
            if k % ITERATIONS_A_THREAD == 0:
                self.advance_world(k // ITERATIONS_A_THREAD, target, origin, unkicked, step, fastest)

    @ti.func
    def advance_band(self, u, target, origin, unkicked, step, fastest):
        """As PerWorld does it; the bands of a world are at the same line wherever they meet."""
        w, dt = self.units.world(u), ti.cast(step, self.real)
        done, running = self.clock.step[w], self.clock.status[w] == RUNNING
        says = self.freshness(u, origin + done * step)
        self.clock.says[u] = says
        meetings = self.meet(w, 0)
        worst = self.worst(w)
        while running and worst <= STALE and done < target:
            if worst != FINE:
                if worst == STALE and u % self.bands == 0:
                    self.neighbours.cells.sort_world(w)
                meetings = self.meet(w, meetings)
                says = FINE if self.neighbours.rebuild(u, origin + done * step, dt, worst == STALE) else FULL
                self.clock.says[u] = says
                meetings = self.meet(w, meetings)
                worst = self.worst(w)
            while worst == FINE and done < target:
                t = origin + done * step
                self.contacts.forces(u, t, dt)
                if ti.static(self.frame.afloat):
                    self.mover.weigh(self.grains, u, dt)
                meetings = self.meet(w, meetings)
                if ti.static(self.frame.afloat):
                    if u % self.bands == 0:
                        self.steer(w, t, done == unkicked, dt)
                    meetings = self.meet(w, meetings)
                says = self.move(u, t, done == unkicked, dt, fastest)
                done += 1
                if says == FINE:
                    says = self.freshness(u, t + step)
                if ti.static(self.frame.afloat):  # noqa: SIM102 (compiled only for ships)
                    if says <= STALE and not self.frame.goes_on(w):
                        says = OVER
                self.clock.says[u] = says
                meetings = self.meet(w, meetings)
                worst = self.worst(w)
        if u % self.bands == 0:
            self.clock.step[w] = done
        self.report(w, says)

    @ti.func
    def advance_world(self, w, target, origin, unkicked, step, fastest):
        """The same on one thread, band after band."""
        dt, first = ti.cast(step, self.real), w * self.bands
        while self.clock.step[w] < target and self.clock.status[w] == RUNNING:
            t, worst = origin + self.clock.step[w] * step, FINE
            for u in range(first, first + self.bands):
                worst = ti.max(worst, self.freshness(u, t))
            if worst != FINE:
                whole, worst = worst == STALE, FINE
                if whole:
                    self.neighbours.cells.sort_world(w)
                for u in range(first, first + self.bands):
                    if not self.neighbours.rebuild(u, t, dt, whole):
                        worst = FULL
            if worst == FINE:
                for u in range(first, first + self.bands):
                    self.contacts.forces(u, t, dt)
                    if ti.static(self.frame.afloat):
                        self.mover.weigh(self.grains, u, dt)
                if ti.static(self.frame.afloat):
                    self.steer(w, t, self.clock.step[w] == unkicked, dt)
                for u in range(first, first + self.bands):
                    worst = ti.max(worst, self.move(u, t, self.clock.step[w] == unkicked, dt, fastest))
                self.clock.step[w] = self.clock.step[w] + 1
                if ti.static(self.frame.afloat):  # noqa: SIM102
                    if worst == FINE and not self.frame.goes_on(w):
                        worst = OVER
            self.report(w, worst)

    @ti.func
    def freshness(self, u, t):
        """Whether a band's lists are FINE, or some or all contacts are to be sought anew."""
        says = FINE
        if self.neighbours.asked(u):
            says = ASKED
        if self.neighbours.stale(u, t):
            says = STALE
        return says

    @ti.func
    def move(self, u, t, first, dt, fastest):
        """Move the grains of a band; says whether they have become too fast."""
        body = self.frame.body_force(self.units.world(u), t)
        speed = self.mover.move(self.grains, u, body, first, dt)
        self.neighbours.travel[u] = self.neighbours.travel[u] + (speed + self.unseen) * dt
        return FINE if speed < fastest else FAST

    @ti.func
    def steer(self, w, t, first, dt):
        """Take a world's ship through the step with the load of all its bands."""
        load = self.mover.weight(w * self.bands)
        for u in range(w * self.bands + 1, (w + 1) * self.bands):
            load += self.mover.weight(u)
        self.frame.follow(w, t, dt, ti.select(first, 0.5 * dt, dt), load)

    @ti.func
    def worst(self, w):
        """The worst that a band of this world says."""
        worst = FINE
        for u in range(w * self.bands, (w + 1) * self.bands):
            worst = ti.max(worst, self.clock.says[u])
        return worst

    @ti.func
    def meet(self, w, meetings):
        """Wait until all bands of the world are here; returns how often they have met."""
        ti.atomic_add(self.clock.arrived[w], 1)
        here = 0
        while here < (meetings + 1) * self.bands:
            here = ti.atomic_add(self.clock.arrived[w], 0)
        return meetings + 1

    @ti.func
    def report(self, w, says):
        if says == OVER:
            self.clock.status[w] = CAPSIZED
        if says == FAST:
            self.clock.status[w] = TOO_FAST
        if says == FULL:
            self.clock.status[w] = NO_ROOM
