"""The per-grain schedule: all particles of all worlds in parallel, with kernel launches for every step."""

import numpy as np
import taichi as ti

from solvers.time.clock import Clock
from solvers.time.sequence import Sequence
from solvers.time.watch import NO_ROOM, RUNNING, TOO_FAST

# Assumed until the next check: speeds of at most HASTE times the highest now, growing with HASTE times the frame's
# acceleration plus RUSH (m/s²) for contacts.
HASTE, RUSH = 2.0, 50.0
ANY = 2**30  # steps, more than are ever taken at once
GLIMPSES = 4  # samples of the frame's acceleration from one check to the latest time of the next


@ti.data_oriented
class PerGrain:
    """Advances all worlds together. Each side of a contact computes its own force, so nothing is summed by atomics.

    Reading from a graphics processor takes as long as several steps. So speeds and displacements are checked only when
    the fastest particle (see HASTE, RUSH) could have used up half of the Verlet lists' skin.
    """

    def __init__(self, sequence: Sequence, clock: Clock, threads: int):
        self.sequence, self.carrier, self.clock = sequence, sequence.carrier, clock
        self.matters, self.before, self.after = sequence.matters, sequence.before, sequence.after
        self.real, self.worlds = clock.real, clock.worlds
        # Largest distance (m) from the origin, and what moving parts add to closing speeds (m/s)
        self.extent = max((matter.extent for matter in self.matters), default=0.0)
        self.nearing = max((matter.nearing for matter in self.matters), default=0.0)

    def advance(self, target: int, origin: float, base: float) -> None:
        """Take every running world to base step `target`; see PerWorld. All worlds have the same step length."""
        running = self.clock.running()
        if not running.any():
            return
        done = int(self.clock.step.to_numpy()[running].min())
        half_skin = 0.5 * min((matter.slack() for matter in self.matters), default=np.inf)
        before, multiple = (int(field.to_numpy()[running].min()) for field in (self.clock.before, self.clock.multiple))
        while done < target:
            safe = self.safe_steps(half_skin, origin + done * base, multiple * base)
            if (safe < 1 or multiple > target - done) and self.clock.running().any():
                for matter in self.matters:
                    matter.sort_all()
                multiple = self.choose_multiple(done, target - done)
                self.make_lists(origin + done * base, multiple * base)
                safe = max(1, self.safe_steps(half_skin, origin + done * base, multiple * base))
            if not self.clock.running().all() and not self.may_go_on():
                break
            for _ in range(min(safe, (target - done) // multiple)):
                self.take_step(done, origin + done * base, 0.5 * (before + multiple) * base, multiple * base)
                done, before = done + multiple, multiple
            self.reach(done, before)

    def choose_multiple(self, done: int, left: int) -> int:
        """How many base steps the next steps of all running worlds are long from `done` on, at most `left`."""
        if self.sequence.has_multiples:
            self.set_multiples(done, left)
        return int(self.clock.multiple.to_numpy()[self.clock.running()].min())

    @ti.kernel
    def set_multiples(self, done: ti.i32, left: ti.i32):
        """Set the multiple that each world allows, at most `left`."""
        for w in range(self.worlds):
            self.clock.multiple[w] = self.sequence.multiple(w, done, left)

    def may_go_on(self) -> bool:
        """Whether some worlds are running and no state check has stopped one."""
        status = self.clock.status.to_numpy()
        return bool(np.any(status == RUNNING)) and not np.any((status == NO_ROOM) | (status == TOO_FAST))

    def safe_steps(self, half_skin: float, time: float, step: float) -> int:
        """Number of steps in which no two unlisted particles can come within reach of each other."""
        if half_skin == np.inf:  # nothing has lists
            return ANY
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
        """Find each world's highest speed, largest displacement and, for `ahead` (s) to come, frame acceleration."""
        for w in range(self.worlds):
            self.clock.fastest[w], self.clock.farthest[w], self.clock.pushed[w] = 0.0, 0.0, 0.0
            for k in range(GLIMPSES):
                body = self.carrier.frame(w, time + ahead * k / (GLIMPSES - 1))
                self.clock.pushed[w] = ti.max(self.clock.pushed[w], self.push(body))
        for k in ti.static(range(len(self.matters))):
            for u in range(self.matters[k].units.count):
                w = self.matters[k].units.world(u)
                if self.clock.status[w] == RUNNING:
                    speed = self.matters[k].speed(u)
                    ti.atomic_max(self.clock.fastest[w], speed)
                    ti.atomic_max(self.clock.farthest[w], self.matters[k].way(u, time))
                    if not self.matters[k].is_sound(u, speed, step):
                        self.clock.status[w] = TOO_FAST

    @ti.func
    def push(self, body):
        """The largest acceleration (m/s²) of a frame: Coriolis' turns a velocity but does not change the speed."""
        push, turn = ti.sqrt(body[0] * body[0] + body[1] * body[1]), ti.abs(body[3]) + body[2] * body[2]
        if ti.static(self.carrier.spatial):
            square = [body[k] * body[k] for k in ti.static(range(9))]
            push = ti.sqrt(square[0] + square[1] + square[2])
            turn = ti.sqrt(square[6] + square[7] + square[8]) + square[3] + square[4] + square[5]
        return push + turn * self.extent

    @ti.kernel
    def make_lists(self, time: ti.f64, step: ti.f64):
        """Rebuild all lists."""
        for k in ti.static(range(len(self.matters))):
            for u in range(self.matters[k].units.count):
                w = self.matters[k].units.world(u)
                if self.clock.status[w] != TOO_FAST:  # noqa: SIM102 (Taichi evaluates both sides of `and`)
                    if not self.matters[k].make_lists(u, time, ti.cast(step, self.real), True):
                        self.clock.status[w] = NO_ROOM

    @ti.kernel
    def take_step(self, done: ti.i32, time: ti.f64, kick: ti.f64, step: ti.f64):
        """Take the step of `step` (s) that begins at base step `done`, in every running world."""
        for k in ti.static(range(len(self.before))):
            if ti.static(self.before[k].of_worlds):
                for w in range(self.worlds):
                    if self.clock.status[w] == RUNNING:
                        self.begin(k, w, done, time, kick, step)
            else:
                for u in range(self.before[k].units.count):
                    if self.clock.status[self.before[k].units.world(u)] == RUNNING:
                        self.begin(k, u, done, time, kick, step)
        for w in range(self.worlds):
            frame = self.carrier.frame(w, time)
            for k in ti.static(range(self.carrier.numbers)):
                self.clock.frame[k][w] = frame[k]
        for k in ti.static(range(len(self.after))):
            if ti.static(self.after[k].of_worlds):
                for w in range(self.worlds):
                    self.end(k, w, w, done, kick, step)
            else:
                for u in range(self.after[k].units.count):
                    self.end(k, u, self.after[k].units.world(u), done, kick, step)

    @ti.func
    def begin(self, k: ti.template(), u, done, time, kick, step):
        """Run phase k of `before` on unit or world u."""
        self.sequence.begin(k, u, done, time, ti.cast(kick, self.real), ti.cast(step, self.real))

    @ti.func
    def end(self, k: ti.template(), u, w, done, kick, step):
        """Run phase k of `after` on unit or world u of world w, if that is running."""
        if self.clock.status[w] == RUNNING:
            frame = ti.Vector([self.clock.frame[a][w] for a in ti.static(range(self.carrier.numbers))])
            self.sequence.end(k, u, done, frame, ti.cast(kick, self.real), ti.cast(step, self.real))

    @ti.kernel
    def reach(self, step: ti.i32, before: ti.i32):
        """Note that all running worlds have reached base step `step` with steps of `before` base steps."""
        for w in range(self.worlds):
            if self.clock.status[w] == RUNNING:
                self.clock.step[w], self.clock.before[w] = step, before
