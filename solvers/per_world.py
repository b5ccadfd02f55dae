"""The per-world schedule: one fused kernel, a serial time loop in each world, worlds in parallel on the cores."""

import taichi as ti

from solvers.contacts import Contacts
from solvers.frame import Frame
from solvers.grains import Grains
from solvers.neighbours import Neighbours
from solvers.walls import Walls
from solvers.watch import NO_ROOM, RUNNING, TOO_FAST

# A parallel loop of Taichi's CPU backend gives each thread at least this many iterations.
ITERATIONS_A_THREAD = 512


@ti.data_oriented
class PerWorld:
    """Advances all worlds. What a world does depends on nothing but itself: the same bits on any number of threads."""

    def __init__(self, grains: Grains, walls: Walls, neighbours: Neighbours, contacts: Contacts, frame: Frame):
        self.grains, self.walls, self.neighbours = grains, walls, neighbours
        self.contacts, self.frame = contacts, frame

    @ti.kernel
    def advance(
        self,
        clock: ti.template(),
        target: ti.i32,
        origin: ti.f64,
        dt: ti.f64,
        fastest: ti.f64,
    ):
        """Take every world to step `target`; step k is the time origin + k dt (s). Faster than `fastest` m/s is bad."""
        for k in range(self.grains.worlds * ITERATIONS_A_THREAD):
            if k % ITERATIONS_A_THREAD == 0:
                self.advance_world(clock, k // ITERATIONS_A_THREAD, target, origin, dt, fastest)

    @ti.func
    def advance_world(self, clock: ti.template(), w, target, origin, dt, fastest):
        while clock.step[w] < target and clock.status[w] == RUNNING:
            fits = True
            if self.neighbours.stale(w):
                fits = self.neighbours.rebuild(w, dt)
            if fits:
                self.contacts.pair_forces(self.grains, self.neighbours.pairs, w, dt)
                self.contacts.wall_forces(self.grains, self.walls, self.neighbours.contacts, w, dt)
                body = self.frame.body_force(w, origin + clock.step[w] * dt)
                kick = dt if clock.kicked[w] == 1 else 0.5 * dt
                clock.kicked[w] = 1
                speed = self.grains.kick_and_drift(w, body, self.frame.rotating, kick, dt)
                self.neighbours.travel[w] = self.neighbours.travel[w] + speed * dt
                clock.step[w] = clock.step[w] + 1
                if not speed < fastest:
                    clock.status[w] = TOO_FAST
            else:
                clock.status[w] = NO_ROOM
