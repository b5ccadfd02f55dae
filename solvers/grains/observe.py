"""What is measured of a world as it runs: sums over its grains, taken in one order on any number of threads."""

from types import SimpleNamespace

import taichi as ti

from solvers.grains import quantities
from solvers.grains.contacts import Contacts
from solvers.grains.neighbours import Neighbours
from solvers.grains.state import Grains
from solvers.machine.quantity import places
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.space.axes import dot, named
from solvers.tank import quantities as tank
from solvers.tank.load import Load
from solvers.tank.walls import Walls

CHUNK = 1024  # grains whose sum one thread takes
NEVER = -1.0

ESCAPED, MASS, KINETIC, ROTATIONAL, SPILLED, MOMENT = range(6)  # of mass, about each axis' origin
TOUCHING, DEEPEST, ELASTIC = range(3)


@ti.data_oriented
class Observer:
    """One row of numbers a world: of the grains in the tank, whose spilled ones are only counted.

    `quantities` says which, and `at` where in the row each begins. The force on the tank is also that on its fixed
    grains and parts; its moment is about the tank's origin.
    """

    def __init__(
        self,
        arrays: State,
        units: Units,
        grains: Grains,
        walls: Walls,
        neighbours: Neighbours,
        contacts: Contacts,
        carrier,
        load: Load,
    ):
        self.units, self.grains, self.walls, self.neighbours = units, grains, walls, neighbours
        self.contacts, self.carrier, self.load = contacts, carrier, load
        self.exact, self.may_leave = arrays.exact, grains.may_leave
        self.chunks = -(-grains.mobile // CHUNK)
        self.quantities = (*tank.SERIES, *quantities.SERIES, quantities.ESCAPED)
        self.at = SimpleNamespace(**places(self.quantities))
        columns = sum(quantity.width for quantity in self.quantities)
        own, scratch = arrays.under("observed"), {"kind": arrays.exact, "kept": False}
        world, chunk = Axis("world", grains.worlds), Axis("chunk", self.chunks)
        (self.rows,) = own.reals((world, Axis("quantity", columns)), "rows", **scratch)
        pieces = world, Axis("piece", load.pieces), Axis("component", 3)
        (self.loads,) = own.reals(pieces, "loads", **scratch)
        self.numbers = MOMENT + grains.axes
        sums = "escaped", "mass", "kinetic", "rotational", "spilled", *named("moment", grains.axes)
        self.sums = own.reals((world, chunk), *sums, **scratch)
        self.counted = own.reals((units.axis,), "touching", "deepest", "elastic", **scratch)

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
        sums = [ti.cast(0.0, self.exact) for _ in range(self.numbers)]
        sums[ESCAPED] = NEVER
        for i in range(chunk * CHUNK, ti.min(g.mobile, (chunk + 1) * CHUNK)):
            inside = self.walls.holds(g.place[0][w, i], g.place[1][w, i])
            if ti.static(self.may_leave):
                if not inside:
                    g.spilled[w, i] = 1.0
                inside = g.spilled[w, i] == 0.0
                sums[SPILLED] += g.spilled[w, i]
                if not inside and g.present[w, i] == 1.0 and not self.follows(g, w, i):
                    g.remove(w, i)
            elif not inside:
                sums[ESCAPED] = i
            if inside:
                m, j = 1.0 / g.inverse_mass[w, i], 1.0 / g.inverse_inertia[w, i]
                sums[MASS] += m
                for a in ti.static(range(g.axes)):
                    sums[MOMENT + a] += m * g.place[a][w, i]
                velocity = [g.now[a][w, i] for a in ti.static(range(g.axes))]
                sums[KINETIC] += 0.5 * m * dot(velocity, velocity)
                sums[ROTATIONAL] += 0.5 * j * g.spin_now[w, i] * g.spin_now[w, i]
        for k in ti.static(range(self.numbers)):
            self.sums[k][w, chunk] = sums[k]

    @ti.func
    def follows(self, g: ti.template(), w, i):
        """Whether a grain is so near the tank that it is followed though it has left."""
        return self.walls.follows(g.place[0][w, i], g.place[1][w, i])

    @ti.func
    def sum_world(self, w, time, since):
        sums = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(self.numbers))])
        sums[ESCAPED] = NEVER
        for chunk in range(self.chunks):
            for k in ti.static(range(MASS, self.numbers)):
                sums[k] += self.sums[k][w, chunk]
            sums[ESCAPED] = ti.max(sums[ESCAPED], self.sums[ESCAPED][w, chunk])
        for piece in range(self.load.pieces):
            for k in ti.static(range(3)):
                self.loads[w, piece, k] = 0.0
        contacts = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        load = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
            contacts[TOUCHING] += self.counted[TOUCHING][u]
            contacts[DEEPEST] = ti.max(contacts[DEEPEST], self.counted[DEEPEST][u])
            contacts[ELASTIC] += self.counted[ELASTIC][u]
            for piece in range(self.load.pieces):
                impulse = self.load.take(u, piece)
                for k in ti.static(range(3)):
                    self.loads[w, piece, k] = self.loads[w, piece, k] + impulse[k] / ti.cast(since, self.exact)
                load += impulse
        self.write_row(w, time, since, sums, contacts, load)

    @ti.func
    def write_row(self, w, time, since, sums, contacts, load):
        mass = ti.max(sums[MASS], 1e-30)
        centre = [sums[MOMENT + a] / mass for a in ti.static(range(self.grains.axes))]
        pose = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(9))])
        if ti.static(self.carrier.moving):
            pose = self.carrier.kinematics(w, time)
        height = pose[1] + ti.sin(pose[2]) * centre[0] + ti.cos(pose[2]) * centre[1]
        for k in ti.static(range(3)):
            self.rows[w, self.at.pose + k] = pose[k]
            self.rows[w, self.at.pose_rate + k] = pose[3 + k]
            self.rows[w, self.at.wall_force + k] = load[k] / ti.cast(since, self.exact)
        for a in ti.static(range(self.grains.axes)):
            self.rows[w, self.at.centre_of_mass + a] = centre[a]
        self.rows[w, self.at.kinetic] = sums[KINETIC]
        self.rows[w, self.at.rotational] = sums[ROTATIONAL]
        self.rows[w, self.at.potential] = sums[MASS] * self.carrier.gravity[0] * height
        self.rows[w, self.at.elastic] = contacts[ELASTIC]
        self.rows[w, self.at.contacts] = contacts[TOUCHING]
        self.rows[w, self.at.overlap] = contacts[DEEPEST]
        self.rows[w, self.at.spilled] = sums[SPILLED]
        self.rows[w, self.at.escaped] = sums[ESCAPED]
