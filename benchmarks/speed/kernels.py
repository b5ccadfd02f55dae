"""Parts of a step, and of its force loop, repeated many times on one state, so that each can be timed alone.

They call the engine's own functions. With a step of zero these leave places and velocities as they are, and from the
second time on the history, too.
"""

import numpy as np
import taichi as ti

from solvers.grains.contacts import gathered
from solvers.grains.laws.chosen import PAIR
from solvers.machine.state import State
from solvers.machine.wide import real_vectors
from solvers.simulation import Simulation
from solvers.space.axes import dot

OVERLAP = 1e-6  # m, of the contacts that the laws are tried on alone
MULTIPLY_ADDS = 16


@ti.data_oriented
class Parts:
    """The parts of a step of a simulation of one world, schedule per-world; each method does its part `times` times."""

    def __init__(self, simulation: Simulation):
        matter = simulation.grains
        self.real, self.grains, self.neighbours = matter.grains.real, matter.grains, matter.lists
        self.carrier, self.contacts, self.mover = simulation.carrier, matter.contacts, matter.mover
        self.lanes = self.neighbours.pairs.lanes
        self.sink = ti.field(self.real, shape=self.lanes)
        with real_vectors(simulation.wide):  # they are compiled at their first call
            for part in (
                self.pair_forces,
                self.wall_forces,
                self.move,
                self.build,
                self.gather,
                self.laws,
                self.scatter,
            ):
                part(0, 0.0)

    @ti.kernel
    def pair_forces(self, times: ti.i32, step: ti.f64):
        """The forces between grains."""
        ti.loop_config(serialize=True)
        for _ in range(times):
            self.contacts.pair_forces(self.grains, self.neighbours.pairs, 0, ti.cast(step, self.real))

    @ti.kernel
    def wall_forces(self, times: ti.i32, step: ti.f64):
        """The forces of the walls."""
        ti.loop_config(serialize=True)
        for _ in range(times):
            self.contacts.wall_forces(self.grains, self.neighbours.contacts, 0, 0.0, ti.cast(step, self.real))

    @ti.kernel
    def move(self, times: ti.i32, step: ti.f64):
        """The frame's force and the motion of the grains; their forces are cleared."""
        ti.loop_config(serialize=True)
        for _ in range(times):
            body = self.carrier.frame(0, 0.0)
            self.sink[0] = self.mover.move(self.grains, 0, body, False, ti.cast(step, self.real))

    @ti.kernel
    def build(self, times: ti.i32, step: ti.f64):
        """Listing all contacts of the candidates, with the laws' constants for `step`."""
        ti.loop_config(serialize=True)
        for _ in range(times):
            self.neighbours.sort(0)
            self.neighbours.rebuild(0, 0.0, ti.cast(step, self.real), True)

    @ti.kernel
    def gather(self, times: ti.i32, step: ti.f64):
        """Of the pair forces: reading the grains and the geometry."""
        ti.loop_config(serialize=True)
        for _ in range(times):
            self.gather_once(self.grains, self.neighbours.pairs)

    @ti.func
    def gather_once(self, g: ti.template(), pairs: ti.template()):
        total = self.nothing()
        for block in range(pairs.blocks(0)):
            i, j = pairs.grain[0, block], pairs.mate[0, block]
            normal, distance, approach = self.contacts.geometry(g, i, j, pairs.reach[0, block], pairs.lanes)
            velocity = self.contacts.differences(g.now, i, j, pairs.lanes)
            spin = gathered(g.spin_now[0], i, pairs.lanes) + gathered(g.spin_now[0], j, pairs.lanes)
            total += distance + ti.max(approach, 0.0) + dot(velocity, normal) + spin
        self.keep(total)

    @ti.kernel
    def laws(self, times: ti.i32, step: ti.f64):
        """Of the pair forces: the laws, on made-up overlaps and velocities; spoils the history."""
        ti.loop_config(serialize=True)
        for _ in range(times):
            self.laws_once(self.neighbours.pairs, ti.cast(step, self.real))

    @ti.func
    def laws_once(self, pairs: ti.template(), dt):
        total = self.nothing()
        for block in range(pairs.blocks(0)):
            # Slower than they press, as grains that have nearly come to rest.
            overlap = OVERLAP * pairs.share[0, block]
            turns = [overlap]
            fn, ft, roll = self.contacts.laws.forces(PAIR, pairs, 0, block, overlap, overlap, turns, turns, None, dt)
            total += fn + ft[0] + roll[0]
        self.keep(total)

    @ti.kernel
    def scatter(self, times: ti.i32, step: ti.f64):
        """Of the pair forces: adding a force and a torque, here of nothing, to both grains of every pair."""
        ti.loop_config(serialize=True)
        for _ in range(times):
            self.scatter_once(self.grains, self.neighbours.pairs, ti.cast(step, self.real))

    @ti.func
    def scatter_once(self, g: ti.template(), pairs: ti.template(), dt):
        for block in range(pairs.blocks(0)):
            i, target = pairs.grain[0, block], pairs.target[0, block]
            f = dt * pairs.share[0, block]
            for k in ti.static(range(pairs.lanes)):
                g.push(0, i[k], [f[k] for _ in range(g.axes)], [f[k] for _ in range(g.turns)])
            for k in ti.static(range(pairs.lanes)):
                g.push(0, target[k], [-f[k] for _ in range(g.axes)], [-f[k] for _ in range(g.turns)])

    @ti.func
    def nothing(self):
        return ti.Vector([ti.cast(0.0, self.real) for _ in ti.static(range(self.lanes))])

    @ti.func
    def keep(self, total):
        """Write a result, without which the compiler would leave out what led to it."""
        for k in ti.static(range(self.lanes)):
            self.sink[k] = total[k]


@ti.data_oriented
class Limits:
    """What one core can do at most: kernels on arrays of `size` reals, each done `times` times.

    The factor s comes from a field, since Taichi leaves the reading of the fields' address in the innermost loop where
    nothing outside reads a field, and the loop is no SIMD code then.
    """

    def __init__(self, precision: str, size: int):
        arrays = State(precision)
        self.size = size
        self.a, self.b, self.c = (
            arrays.holding(name, np.full(size, value), "element")
            for name, value in (("a", 0.0), ("b", 1.0), ("c", 0.5))
        )
        self.s = arrays.holding("s", np.array([0.5]), "one")
        arrays.finish()
        self.close = arrays.release

    @ti.kernel
    def triad(self, times: ti.i32):
        """a = b + s c: two reals read and one written an element (McCalpin 1995)."""
        ti.loop_config(serialize=True)
        for n in range(times):
            s = self.s[0] * n
            for k in range(self.size):
                self.a[k] = self.b[k] + s * self.c[k]

    @ti.kernel
    def multiply_add(self, times: ti.i32):
        """MULTIPLY_ADDS multiplications, each with an addition, an element; two chains, so that one need not wait."""
        ti.loop_config(serialize=True)
        for _ in range(times):
            s = self.s[0]
            for k in range(self.size):
                x, y = self.b[k], self.c[k]
                for _link in ti.static(range(MULTIPLY_ADDS // 2)):
                    x = x * s + 0.25
                    y = y * s + 0.25
                self.a[k] = x + y

    @ti.kernel
    def root_and_divide(self, times: ti.i32):
        """One square root and one division an element."""
        ti.loop_config(serialize=True)
        for n in range(times):
            s = self.s[0] * n
            for k in range(self.size):
                self.a[k] = ti.sqrt(self.b[k] + s) + self.c[k] / (self.b[k] + s)
