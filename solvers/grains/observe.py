"""What is measured of a world as it runs: sums over its grains, taken in one order on any number of threads."""

from types import SimpleNamespace

import taichi as ti

from solvers.grains import quantities
from solvers.grains.contacts import Contacts
from solvers.grains.mover import Mover
from solvers.grains.neighbours import Neighbours
from solvers.grains.state import Grains
from solvers.machine.quantity import places
from solvers.machine.runtime import Arrays
from solvers.machine.units import Units
from solvers.motion.frame import Frame
from solvers.tank import quantities as tank
from solvers.tank.walls import Walls

CHUNK = 1024  # grains whose sum one thread takes
NEVER = -1.0

MASS, MOMENT_Y, MOMENT_Z, KINETIC, ROTATIONAL, SPILLED, ESCAPED = range(7)
TOUCHING, DEEPEST, ELASTIC = range(3)


@ti.data_oriented
class Observer:
    """One row of numbers a world: of the grains in the tank, whose spilled ones are only counted.

    `quantities` says which, and `at` where in the row each begins. The force on the tank is also that on its fixed
    grains and parts; its moment is about the tank's origin.
    """

    def __init__(
        self,
        arrays: Arrays,
        units: Units,
        grains: Grains,
        walls: Walls,
        neighbours: Neighbours,
        contacts: Contacts,
        frame: Frame,
        mover: Mover,
    ):
        self.units, self.grains, self.walls, self.neighbours = units, grains, walls, neighbours
        self.contacts, self.frame, self.mover = contacts, frame, mover
        self.exact, self.may_leave = arrays.exact, grains.may_leave
        self.chunks = -(-grains.mobile // CHUNK)
        self.quantities = (*tank.SERIES, *quantities.SERIES, quantities.ESCAPED)
        self.at = SimpleNamespace(**places(self.quantities))
        columns = sum(quantity.width for quantity in self.quantities)
        (self.rows,) = arrays.reals(1, (grains.worlds, columns), arrays.exact, kept=False)
        self.sums = arrays.reals(7, (grains.worlds, self.chunks), arrays.exact, kept=False)
        self.counted = arrays.reals(3, (units.count,), arrays.exact, kept=False)

    @ti.kernel
    def observe(self, time: ti.f64, since: ti.f64):
        """Fill the rows with the state at `time` (s), the grains' own, `since` (s) after the last look."""
        for u in range(self.units.count):
            census = self.contacts.census(self.grains, self.neighbours.pairs, self.neighbours.contacts, u, time)
            for k in ti.static(range(3)):
                self.counted[k][u] = census[k]
        for w, chunk in self.sums[0]:
            self.sum_chunk(self.grains, w, chunk)
        for w in range(self.units.worlds):
            self.sum_world(w, time, since)
            if w == 0:
                self.walls.note_places(time)

    @ti.func
    def sum_chunk(self, g: ti.template(), w, chunk):
        """Sums over one chunk of grains; an open tank's that are out of it are spilled, and let go of far away."""
        zero = ti.cast(0.0, self.exact)
        mass, moment_y, moment_z, kinetic, rotational, spilled = zero, zero, zero, zero, zero, zero
        escaped = ti.cast(NEVER, self.exact)
        for i in range(chunk * CHUNK, ti.min(g.mobile, (chunk + 1) * CHUNK)):
            inside = self.walls.holds(g.y[w, i], g.z[w, i])
            if ti.static(self.may_leave):
                if not inside:
                    g.spilled[w, i] = 1.0
                inside = g.spilled[w, i] == 0.0
                spilled += g.spilled[w, i]
                if not inside and g.present[w, i] == 1.0 and not self.walls.follows(g.y[w, i], g.z[w, i]):
                    g.remove(w, i)
            elif not inside:
                escaped = i
            if inside:
                m, j = 1.0 / g.inverse_mass[w, i], 1.0 / g.inverse_inertia[w, i]
                mass += m
                moment_y += m * g.y[w, i]
                moment_z += m * g.z[w, i]
                kinetic += 0.5 * m * (g.now_y[w, i] * g.now_y[w, i] + g.now_z[w, i] * g.now_z[w, i])
                rotational += 0.5 * j * g.spin_now[w, i] * g.spin_now[w, i]
        row = ti.Vector([mass, moment_y, moment_z, kinetic, rotational, spilled, escaped])
        for k in ti.static(range(7)):
            self.sums[k][w, chunk] = row[k]

    @ti.func
    def sum_world(self, w, time, since):
        sums = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(7))])
        sums[ESCAPED] = NEVER
        for chunk in range(self.chunks):
            for k in ti.static(range(ESCAPED)):
                sums[k] += self.sums[k][w, chunk]
            sums[ESCAPED] = ti.max(sums[ESCAPED], self.sums[ESCAPED][w, chunk])
        contacts = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        load = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
            contacts[TOUCHING] += self.counted[TOUCHING][u]
            contacts[DEEPEST] = ti.max(contacts[DEEPEST], self.counted[DEEPEST][u])
            contacts[ELASTIC] += self.counted[ELASTIC][u]
            load += ti.Vector([self.mover.load_y[u], self.mover.load_z[u], self.mover.load_moment[u]])
            self.mover.load_y[u], self.mover.load_z[u], self.mover.load_moment[u] = 0.0, 0.0, 0.0
        self.write_row(w, time, since, sums, contacts, load)

    @ti.func
    def write_row(self, w, time, since, sums, contacts, load):
        mass = ti.max(sums[MASS], 1e-30)
        centre_y, centre_z = sums[MOMENT_Y] / mass, sums[MOMENT_Z] / mass
        pose = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(9))])
        if ti.static(self.frame.moving):
            pose = self.frame.kinematics(w, time)
        height = pose[1] + ti.sin(pose[2]) * centre_y + ti.cos(pose[2]) * centre_z
        for k in ti.static(range(3)):
            self.rows[w, self.at.pose + k] = pose[k]
            self.rows[w, self.at.pose_rate + k] = pose[3 + k]
            self.rows[w, self.at.wall_force + k] = load[k] / ti.cast(since, self.exact)
        self.rows[w, self.at.centre_of_mass], self.rows[w, self.at.centre_of_mass + 1] = centre_y, centre_z
        self.rows[w, self.at.kinetic] = sums[KINETIC]
        self.rows[w, self.at.rotational] = sums[ROTATIONAL]
        self.rows[w, self.at.potential] = sums[MASS] * self.frame.gravity[0] * height
        self.rows[w, self.at.elastic] = contacts[ELASTIC]
        self.rows[w, self.at.contacts] = contacts[TOUCHING]
        self.rows[w, self.at.overlap] = contacts[DEEPEST]
        self.rows[w, self.at.spilled] = sums[SPILLED]
        self.rows[w, self.at.escaped] = sums[ESCAPED]
