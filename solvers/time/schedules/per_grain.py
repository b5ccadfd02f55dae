"""The per-grain schedule: all particles of all worlds in parallel, a launch a step."""

import numpy as np
import taichi as ti

from solvers.time.clock import Clock
from solvers.time.sequence import Sequence
from solvers.time.watch import NO_ROOM, RUNNING, TOO_FAST

# Until the next look no particle is expected to be faster than this times the fastest now, and than what this many
# times the frame's acceleration, and this one of the contacts' own (m/s²), add.
HASTE, RUSH = 2.0, 50.0
GLIMPSES = 4  # of the frame's acceleration, between one look and the last time the next can be


@ti.data_oriented
class PerGrain:
    """Advances all worlds together. Each side of a contact works out its own force, so nothing is summed by atomics.

    Reading from a graphics processor takes as long as several steps. So particles are looked at only as often as the
    fastest of them (see HASTE, RUSH) could have used up half the lists' skin.
    """

    def __init__(self, sequence: Sequence, clock: Clock, threads: int):
        self.sequence, self.carrier, self.clock = sequence, sequence.carrier, clock
        self.matters, self.before, self.after = sequence.matters, sequence.before, sequence.after
        self.real, self.worlds = clock.real, clock.worlds
        self.extent = max(matter.extent for matter in self.matters)  # m, from the origin
        self.nearing = max(matter.nearing for matter in self.matters)  # m/s, of parts

    def advance(self, target: int, origin: float, base: float) -> None:
        """Take every running world to base step `target`; see PerWorld. All take steps of one length."""
        running = self.clock.running()
        if not running.any():
            return
        done = int(self.clock.step.to_numpy()[running].min())
        half_skin = 0.5 * min(matter.slack() for matter in self.matters)
        before, stride = (int(field.to_numpy()[running].min()) for field in (self.clock.before, self.clock.stride))
        while done < target:
            safe = self.safe_steps(half_skin, origin + done * base, stride * base)
            if (safe < 1 or stride > target - done) and self.clock.running().any():
                for matter in self.matters:
                    matter.sort_all()
                stride = self.choose_stride(target - done)
                self.make_lists(origin + done * base, stride * base)
                safe = max(1, self.safe_steps(half_skin, origin + done * base, stride * base))
            if not self.clock.running().all() and not self.may_go_on():
                break
            for _ in range(min(safe, (target - done) // stride)):
                self.take_step(origin + done * base, 0.5 * (before + stride) * base, stride * base)
                done, before = done + stride, stride
            self.reach(done, before)

    def choose_stride(self, due: int) -> int:
        """Base steps of the steps to come, `due` at most."""
        if self.sequence.paced:
            self.set_strides(due)
        return int(self.clock.stride.to_numpy()[self.clock.running()].min())

    @ti.kernel
    def set_strides(self, due: ti.i32):
        """How many base steps each world may take at a time."""
        for w in range(self.worlds):
            self.clock.stride[w] = self.sequence.stride(w, due)

    def may_go_on(self) -> bool:
        """Whether some worlds run and none has been stopped by the watch."""
        status = self.clock.status.to_numpy()
        return bool(np.any(status == RUNNING)) and not np.any((status == NO_ROOM) | (status == TOO_FAST))

    def safe_steps(self, half_skin: float, time: float, step: float) -> int:
        """Steps in which no particle can come into reach of another unlisted."""
        self.look(time, np.sqrt(2.0 * half_skin / RUSH), step)
        running = self.clock.running()
        if not running.any():
            return 1
        left = np.maximum(half_skin - self.clock.farthest.to_numpy()[running], 0.0)
        speed = HASTE * self.clock.fastest.to_numpy()[running] + self.nearing
        rush = RUSH + HASTE * self.clock.pushed.to_numpy()[running]
        # left = v T + a T²/2
        time_left = (np.sqrt(speed**2 + 2.0 * rush * left) - speed) / rush
        return int((time_left / step).min())

    @ti.kernel
    def look(self, time: ti.f64, ahead: ti.f64, step: ti.f64):
        """Find the highest speed and the longest way in every world, and how the frame will push until `ahead` (s)."""
        for w in range(self.worlds):
            self.clock.fastest[w], self.clock.farthest[w], self.clock.pushed[w] = 0.0, 0.0, 0.0
            for k in range(GLIMPSES):
                body = self.carrier.frame(w, time + ahead * k / (GLIMPSES - 1))
                push = ti.sqrt(body[0] * body[0] + body[1] * body[1])
                # What turns a particle's way only (Coriolis) makes it no faster.
                push += (ti.abs(body[3]) + body[2] * body[2]) * self.extent
                self.clock.pushed[w] = ti.max(self.clock.pushed[w], push)
        for k in ti.static(range(len(self.matters))):
            for u in range(self.matters[k].units.count):
                w = self.matters[k].units.world(u)
                if self.clock.status[w] == RUNNING:
                    speed = self.matters[k].speed(u)
                    ti.atomic_max(self.clock.fastest[w], speed)
                    ti.atomic_max(self.clock.farthest[w], self.matters[k].way(u, time))
                    if not self.matters[k].is_sound(speed, step):
                        self.clock.status[w] = TOO_FAST

    @ti.kernel
    def make_lists(self, time: ti.f64, step: ti.f64):
        """Make all lists anew."""
        for k in ti.static(range(len(self.matters))):
            for u in range(self.matters[k].units.count):
                w = self.matters[k].units.world(u)
                if self.clock.status[w] != TOO_FAST:  # noqa: SIM102 (Taichi evaluates both sides of `and`)
                    if not self.matters[k].make_lists(u, time, ti.cast(step, self.real), True):
                        self.clock.status[w] = NO_ROOM

    @ti.kernel
    def take_step(self, time: ti.f64, kick: ti.f64, step: ti.f64):
        """One step of every running world."""
        for k in ti.static(range(len(self.before))):
            if ti.static(self.before[k].of_worlds):
                for w in range(self.worlds):
                    if self.clock.status[w] == RUNNING:
                        self.before[k].act(w, time, ti.cast(kick, self.real), ti.cast(step, self.real))
            else:
                for u in range(self.before[k].units.count):
                    if self.clock.status[self.before[k].units.world(u)] == RUNNING:
                        self.before[k].act(u, time, ti.cast(kick, self.real), ti.cast(step, self.real))
        for w in range(self.worlds):
            frame = self.carrier.frame(w, time)
            for k in ti.static(range(4)):
                self.clock.frame[k][w] = frame[k]
        for k in ti.static(range(len(self.after))):
            for u in range(self.after[k].units.count):
                w = self.after[k].units.world(u)
                if self.clock.status[w] == RUNNING:
                    frame = ti.Vector([self.clock.frame[k][w] for k in ti.static(range(4))])
                    self.after[k].act(u, frame, ti.cast(kick, self.real), ti.cast(step, self.real))

    @ti.kernel
    def reach(self, step: ti.i32, before: ti.i32):
        """All running worlds have come to this base step, by steps of `before` of them."""
        for w in range(self.worlds):
            if self.clock.status[w] == RUNNING:
                self.clock.step[w], self.clock.before[w] = step, before
