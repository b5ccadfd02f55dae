"""The per-world schedule: one fused kernel with a serial time loop per world, worlds in parallel on the cores."""

import taichi as ti

from solvers.machine.units import ITERATIONS_A_THREAD
from solvers.time.clock import Clock
from solvers.time.sequence import CHECK_EVERY, Sequence
from solvers.time.watch import NO_ROOM, OVER, RUNNING, TOO_FAST


@ti.data_oriented
class PerWorld:
    """Advances all worlds. A world's result depends on that world only: same bits on any number of threads."""

    def __init__(self, sequence: Sequence, clock: Clock, threads: int):
        self.sequence, self.carrier, self.clock = sequence, sequence.carrier, clock
        self.before, self.after = sequence.before, sequence.after
        self.real, self.worlds = clock.real, clock.worlds

    @ti.kernel
    def advance(self, target: ti.i32, origin: ti.f64, base: ti.f64):
        """Take every running world to base step `target`; step k is the time origin + k·base (s)."""
        for k in range(self.worlds * ITERATIONS_A_THREAD):
            if k % ITERATIONS_A_THREAD == 0:
                self.advance_world(k // ITERATIONS_A_THREAD, target, origin, base)

    @ti.func
    def advance_world(self, world, target, origin, base):
        """Rebuild the lists if they are stale, then take steps for as long as they are valid.

        The steps are an inner loop of their own, so that the compiler keeps their data in registers, not the lists'.
        """
        w, multiple = self.clock.world(world), 1
        while self.clock.step[w] < target and self.clock.status[w] == RUNNING:
            step = self.clock.step[w]
            t, fresh = origin + step * base, True
            may_be_invalid = self.sequence.may_be_invalid(w, t)
            invalid = self.sequence.invalid(w, t)
            if ti.static(self.sequence.has_multiples):
                left = target - step
                if self.sequence.may_lengthen(w, step, left, self.clock.multiple[w]):
                    invalid = True
                if may_be_invalid and self.sequence.must_shorten(w, self.clock.multiple[w]):
                    invalid = True
                if invalid or self.clock.multiple[w] > left:
                    invalid, self.clock.multiple[w] = True, self.sequence.multiple(w, step, left)
                multiple = self.clock.multiple[w]
            dt = ti.cast(multiple * base, self.real)
            if invalid or self.sequence.asked(w):
                if invalid:
                    self.sequence.sort(w)
                fresh = self.sequence.make_lists(w, t, dt, invalid)
                if not fresh:
                    self.clock.status[w] = NO_ROOM
            while fresh:
                t = origin + self.clock.step[w] * base
                kick = ti.cast(0.5 * (self.clock.before[w] + multiple) * base, self.real)
                sound = self.take_step(w, self.clock.step[w], t, kick, dt)
                self.clock.step[w], self.clock.before[w] = self.clock.step[w] + multiple, multiple
                fresh = self.clock.step[w] + multiple <= target
                now = origin + self.clock.step[w] * base
                fresh = fresh and not self.sequence.may_be_invalid(w, now) and not self.sequence.asked(w)
                if ti.static(self.sequence.has_multiples):
                    fresh = fresh and self.clock.step[w] % CHECK_EVERY != 0
                if not sound:
                    self.clock.status[w], fresh = TOO_FAST, False
                if fresh and not self.carrier.goes_on(w):
                    self.clock.status[w], fresh = OVER, False

    @ti.func
    def take_step(self, w, step, t, kick, dt):
        """Take the step that begins at base step `step` in a world, a single unit; returns whether it is sound."""
        for k in ti.static(range(len(self.before))):
            self.sequence.begin(k, w, step, t, kick, dt)
        frame, sound = self.carrier.frame(w, t), True
        for k in ti.static(range(len(self.after))):
            if not self.sequence.end(k, w, step, frame, kick, dt):
                sound = False
        return sound
