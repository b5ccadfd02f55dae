"""The per-world schedule: one fused kernel, a serial time loop in each world, worlds in parallel on the cores."""

import taichi as ti

from solvers.machine.units import ITERATIONS_A_THREAD
from solvers.time.clock import Clock
from solvers.time.sequence import Sequence
from solvers.time.watch import NO_ROOM, OVER, RUNNING, TOO_FAST


@ti.data_oriented
class PerWorld:
    """Advances all worlds. What a world does depends on nothing but itself: the same bits on any number of threads."""

    def __init__(self, sequence: Sequence, clock: Clock, threads: int):
        self.sequence, self.carrier, self.clock = sequence, sequence.carrier, clock
        self.before, self.after = sequence.before, sequence.after
        self.real, self.worlds = clock.real, clock.worlds

    @ti.kernel
    def advance(self, target: ti.i32, origin: ti.f64, unkicked: ti.i32, step: ti.f64):
        """Take every running world to step `target`; step k is the time origin + k·step (s).

        The step `unkicked` is the particles' first.
        """
        for k in range(self.worlds * ITERATIONS_A_THREAD):
            if k % ITERATIONS_A_THREAD == 0:
                self.advance_world(k // ITERATIONS_A_THREAD, target, origin, unkicked, step)

    @ti.func
    def advance_world(self, world, target, origin, unkicked, step):
        """Make the lists where they are stale, then take steps for as long as they last.

        The steps are a loop of their own: the compiler keeps at hand what they work with, and not what the lists need.
        """
        w, dt = self.clock.world(world), ti.cast(step, self.real)
        while self.clock.step[w] < target and self.clock.status[w] == RUNNING:
            t, fresh = origin + self.clock.step[w] * step, True
            stale = self.sequence.stale(w, t)
            if stale or self.sequence.asked(w):
                if stale:
                    self.sequence.sort(w)
                fresh = self.sequence.make_lists(w, t, dt, stale)
                if not fresh:
                    self.clock.status[w] = NO_ROOM
            while fresh:
                t = origin + self.clock.step[w] * step
                sound = self.take_step(w, t, self.clock.step[w] == unkicked, dt)
                self.clock.step[w] = self.clock.step[w] + 1
                fresh = self.clock.step[w] < target and not self.sequence.worn(w) and not self.sequence.asked(w)
                if not sound:
                    self.clock.status[w], fresh = TOO_FAST, False
                if fresh and not self.carrier.goes_on(w):
                    self.clock.status[w], fresh = OVER, False

    @ti.func
    def take_step(self, w, t, first, dt):
        """One step of a world, which is its only unit; returns whether all is sound."""
        for k in ti.static(range(len(self.before))):
            self.before[k].act(w, t, first, dt)
        frame, sound = self.carrier.frame(w, t), True
        for k in ti.static(range(len(self.after))):
            if not self.after[k].act(w, frame, first, dt):
                sound = False
        return sound
