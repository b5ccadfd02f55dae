"""The per-world schedule: one fused kernel, a serial time loop in each world, worlds in parallel on the cores."""

import taichi as ti

from solvers.time.schedules.engine import ITERATIONS_A_THREAD, Engine
from solvers.time.watch import CAPSIZED, NO_ROOM, RUNNING, TOO_FAST


@ti.data_oriented
class PerWorld:
    """Advances all worlds. What a world does depends on nothing but itself: the same bits on any number of threads."""

    def __init__(self, engine: Engine, threads: int):
        self.units, self.grains = engine.units, engine.grains
        self.neighbours, self.contacts = engine.neighbours, engine.contacts
        self.mover, self.frame, self.clock = engine.mover, engine.frame, engine.clock
        self.unseen, self.real = engine.unseen, engine.grains.real

    @ti.kernel
    def advance(self, target: ti.i32, origin: ti.f64, unkicked: ti.i32, step: ti.f64, fastest: ti.f64):
        """Take every running world to step `target`; step k is the time origin + k·step (s).

        The step `unkicked` is the grains' first; faster than `fastest` m/s is bad.
        """
        for k in range(self.grains.worlds * ITERATIONS_A_THREAD):
            if k % ITERATIONS_A_THREAD == 0:
                self.advance_world(k // ITERATIONS_A_THREAD, target, origin, unkicked, step, fastest)

    @ti.func
    def advance_world(self, unit, target, origin, unkicked, step, fastest):
        """Build the lists where they are stale, then take steps for as long as they last.

        The steps are a loop of their own: the compiler keeps at hand what they work with, and not what the lists need.
        """
        w, dt = self.units.world(unit), ti.cast(step, self.real)
        while self.clock.step[w] < target and self.clock.status[w] == RUNNING:
            t, fresh = origin + self.clock.step[w] * step, True
            stale = self.neighbours.stale(w, t)
            if stale or self.neighbours.asked(w):
                if stale:
                    self.neighbours.cells.sort_world(w)
                fresh = self.neighbours.rebuild(w, t, dt, stale)
                if not fresh:
                    self.clock.status[w] = NO_ROOM
            while fresh:
                t = origin + self.clock.step[w] * step
                self.contacts.forces(w, t, dt)
                first = self.clock.step[w] == unkicked
                if ti.static(self.frame.afloat):
                    kick = ti.select(first, 0.5 * dt, dt)
                    self.mover.weigh(self.grains, w, dt)
                    self.frame.follow(w, t, dt, kick, self.mover.weight(w))
                body = self.frame.body_force(w, t)
                speed = self.mover.move(self.grains, w, body, first, dt)
                self.neighbours.travel[w] = self.neighbours.travel[w] + (speed + self.unseen) * dt
                self.clock.step[w] = self.clock.step[w] + 1
                fresh = self.clock.step[w] < target and not self.neighbours.worn(w) and not self.neighbours.asked(w)
                if not speed < fastest:
                    self.clock.status[w], fresh = TOO_FAST, False
                if ti.static(self.frame.afloat):  # noqa: SIM102 (compiled only for ships)
                    if fresh and not self.frame.goes_on(w):
                        self.clock.status[w], fresh = CAPSIZED, False
