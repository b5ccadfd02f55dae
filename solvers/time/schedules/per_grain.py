"""The per-grain schedule: all grains of all worlds in parallel, a launch a step."""

import numpy as np
import taichi as ti

from solvers.time.schedules.engine import Engine
from solvers.time.watch import NO_ROOM, RUNNING, TOO_FAST

# Until the next look no grain is expected to be faster than this times the fastest now, and than what this many times
# the frame's acceleration, and this one of the contacts' own (m/s²), add.
HASTE, RUSH = 2.0, 50.0
GLIMPSES = 4  # of the frame's acceleration, between one look and the last time the next can be


@ti.data_oriented
class PerGrain:
    """Advances all worlds together. Each side of a contact works out its own force, so nothing is summed by atomics.

    Reading from a graphics processor takes as long as several steps. So grains are looked at only as often as the
    fastest of them (see HASTE, RUSH) could have used up half the lists' skin.
    """

    def __init__(self, engine: Engine, threads: int):
        self.units, self.grains, self.walls = engine.units, engine.grains, engine.walls
        self.neighbours, self.contacts = engine.neighbours, engine.contacts
        self.mover, self.frame, self.clock = engine.mover, engine.frame, engine.clock
        self.real = engine.grains.real
        self.extent = float(np.hypot(*np.abs(self.walls.bounds).max(axis=0)))  # m, from the origin

    def advance(self, target: int, origin: float, unkicked: int, step: float, fastest: ti.f64) -> None:
        """Take every running world to step `target`; see PerWorld."""
        running = self.clock.running()
        if not running.any():
            return
        done = int(self.clock.step.to_numpy()[running].min())
        half_skin = 0.5 * float(self.neighbours.skin.to_numpy()[0])
        while done < target:
            safe = self.safe_steps(half_skin, origin + done * step, step, fastest)
            if safe < 1 and self.clock.running().any():
                self.neighbours.cells.sort_all()
                self.rebuild(origin + done * step, step)
                safe = max(1, self.safe_steps(half_skin, origin + done * step, step, fastest))
            if not self.clock.running().all() and not self.may_go_on():
                break
            for k in range(done, min(target, done + safe)):
                self.take_step(origin + k * step, k == unkicked, step)
            done = min(target, done + safe)
            self.reach(done)

    def may_go_on(self) -> bool:
        """Whether some worlds run and none has been stopped by the watch."""
        status = self.clock.status.to_numpy()
        return bool(np.any(status == RUNNING)) and not np.any((status == NO_ROOM) | (status == TOO_FAST))

    def safe_steps(self, half_skin: float, time: float, step: float, fastest: float) -> int:
        """Steps in which no grain can come into reach of another unlisted."""
        self.look(time, np.sqrt(2.0 * half_skin / RUSH), fastest)
        running = self.clock.running()
        if not running.any():
            return 1
        left = np.maximum(half_skin - self.clock.farthest.to_numpy()[running], 0.0)
        speed = HASTE * self.clock.fastest.to_numpy()[running] + self.walls.fastest
        rush = RUSH + HASTE * self.clock.pushed.to_numpy()[running]
        # left = v T + a T²/2
        time_left = (np.sqrt(speed**2 + 2.0 * rush * left) - speed) / rush
        return int((time_left / step).min())

    @ti.kernel
    def look(self, time: ti.f64, ahead: ti.f64, fastest: ti.f64):
        """Find the highest speed and the longest way in every world, and how the frame will push until `ahead` (s)."""
        for w in range(self.units.worlds):
            self.clock.fastest[w], self.clock.farthest[w], self.clock.pushed[w] = 0.0, 0.0, 0.0
            for k in range(GLIMPSES):
                body = self.frame.body_force(w, time + ahead * k / (GLIMPSES - 1))
                push = ti.sqrt(body[0] * body[0] + body[1] * body[1])
                # What turns a grain's way only (Coriolis) makes it no faster.
                push += (ti.abs(body[3]) + body[2] * body[2]) * self.extent
                self.clock.pushed[w] = ti.max(self.clock.pushed[w], push)
        for u in range(self.units.count):
            w = self.units.world(u)
            if self.clock.status[w] == RUNNING:
                i = self.units.first(u)
                vy, vz = self.grains.velocity_y[w, i], self.grains.velocity_z[w, i]
                speed = ti.sqrt(vy * vy + vz * vz)
                ti.atomic_max(self.clock.fastest[w], speed)
                moved = self.neighbours.travel[u]
                if moved == 0.0:  # there are lists; without, it says NEVER
                    moved = self.neighbours.moved(u, time)
                ti.atomic_max(self.clock.farthest[w], moved)
                if not speed < fastest:
                    self.clock.status[w] = TOO_FAST

    @ti.kernel
    def rebuild(self, time: ti.f64, step: ti.f64):
        """List all contacts anew."""
        for u in range(self.units.count):
            w = self.units.world(u)
            if self.clock.status[w] != TOO_FAST:  # noqa: SIM102 (Taichi evaluates both sides of `and`)
                if not self.neighbours.rebuild(u, time, ti.cast(step, self.real), True):
                    self.clock.status[w] = NO_ROOM

    @ti.kernel
    def take_step(self, time: ti.f64, first: ti.i32, step: ti.f64):
        """One step of every running world."""
        for w in range(self.units.worlds):
            body = self.frame.body_force(w, time)
            for k in ti.static(range(4)):
                self.clock.body[k][w] = body[k]
        for u in range(self.units.count):
            if self.clock.status[self.units.world(u)] == RUNNING:
                self.contacts.forces(u, time, ti.cast(step, self.real))
        for u in range(self.units.count):
            w = self.units.world(u)
            if self.clock.status[w] == RUNNING:
                body = ti.Vector([self.clock.body[k][w] for k in ti.static(range(4))])
                self.mover.move(self.grains, u, body, first == 1, ti.cast(step, self.real))

    @ti.kernel
    def reach(self, step: ti.i32):
        """All running worlds have come to this step."""
        for w in range(self.units.worlds):
            if self.clock.status[w] == RUNNING:
                self.clock.step[w] = step
