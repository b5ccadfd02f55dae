"""Diagnostics of the grains: sums over those of a world, taken in one order on any number of threads."""

from types import SimpleNamespace

import numpy as np
import taichi as ti

from solvers.grains import quantities
from solvers.grains.contacts import Contacts
from solvers.grains.lists.neighbours import Neighbours
from solvers.grains.state import GrainState
from solvers.machine.quantity import parted, places
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.space.axes import dot, named
from solvers.tank.walls import Walls

CHUNK = 1024  # grains whose sum one thread takes
NEVER = -1.0

ESCAPED, MASS, KINETIC, ROTATIONAL, SPILLED, MOMENT = range(6)  # of mass, about each axis' origin
TOUCHING, DEEPEST, ELASTIC = range(3)


@ti.data_oriented
class Diagnostics:
    """One row of numbers per world, of the grains in the tank; spilled grains are only counted.

    `quantities` are the numbers' declarations, and `at` has the column in which each begins.
    """

    def __init__(
        self,
        arrays: State,
        units: Units,
        grains: GrainState,
        walls: Walls,
        lists: Neighbours,
        contacts: Contacts,
        carrier,
    ):
        self.units, self.grains, self.walls, self.lists = units, grains, walls, lists
        self.contacts, self.carrier = contacts, carrier
        self.exact, self.may_leave = arrays.exact, grains.may_leave
        self.chunks = -(-grains.room // CHUNK)
        self.quantities = tuple(one.within(grains.axes) for one in (*quantities.SERIES, quantities.ESCAPED))
        self.at = SimpleNamespace(**places(self.quantities))
        columns = sum(quantity.width for quantity in self.quantities)
        own, scratch = arrays.under("diagnostics"), {"kind": arrays.exact, "kept": False}
        world, chunk = Axis("world", grains.worlds), Axis("chunk", self.chunks)
        (self.rows,) = own.reals((world, Axis("quantity", columns)), "rows", **scratch)
        self.numbers = MOMENT + grains.axes
        sums = "escaped", "mass", "kinetic", "rotational", "spilled", *named("moment", grains.axes)
        self.sums = own.reals((world, chunk), *sums, **scratch)
        self.counted = own.reals((units.axis,), "touching", "deepest", "elastic", **scratch)

    def sums_at(self, time: float) -> dict[str, np.ndarray]:
        """The quantities of every world at `time` (s), which must be the grains' own: (W, *shape) of each by name."""
        self.count(time)
        return parted(self.rows.to_numpy().astype(float), self.quantities)

    @ti.kernel
    def count(self, time: ti.f64):
        """Fill the rows."""
        for u in range(self.units.count):
            found = self.contacts.diagnostics(self.grains, self.lists.pairs, self.lists.contacts, u, time)
            for k in ti.static(range(3)):
                self.counted[k][u] = found[k]
        for w, chunk in self.sums[0]:
            self.sum_chunk(self.grains, w, chunk)
        for w in range(self.units.worlds):
            self.sum_world(w, time)

    @ti.func
    def sum_chunk(self, g: ti.template(), w, chunk):
        """Sums over one chunk of grains; an open tank's that are out of it are spilled, and let go of far away."""
        sums = [ti.cast(0.0, self.exact) for _ in range(self.numbers)]
        sums[ESCAPED] = NEVER
        for i in range(chunk * CHUNK, ti.min(self.units.moving(), (chunk + 1) * CHUNK)):
            inside = self.walls.holds(*g.at(w, i))
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
                for k in ti.static(range(g.turns)):
                    sums[ROTATIONAL] += 0.5 * j * g.spin_now[k][w, i] * g.spin_now[k][w, i]
        for k in ti.static(range(self.numbers)):
            self.sums[k][w, chunk] = sums[k]

    @ti.func
    def follows(self, g: ti.template(), w, i):
        """Whether a grain is so near the tank that it is followed though it has left."""
        return self.walls.follows(*g.at(w, i))

    @ti.func
    def sum_world(self, w, time):
        sums = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(self.numbers))])
        sums[ESCAPED] = NEVER
        for chunk in range(self.chunks):
            for k in ti.static(range(MASS, self.numbers)):
                sums[k] += self.sums[k][w, chunk]
            sums[ESCAPED] = ti.max(sums[ESCAPED], self.sums[ESCAPED][w, chunk])
        contacts = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
            contacts[TOUCHING] += self.counted[TOUCHING][u]
            contacts[DEEPEST] = ti.max(contacts[DEEPEST], self.counted[DEEPEST][u])
            contacts[ELASTIC] += self.counted[ELASTIC][u]
        self.write_row(w, time, sums, contacts)

    @ti.func
    def height(self, w, time, centre: ti.template()):
        """Height (m) over the earth of a point of the tank."""
        found = ti.cast(0.0, self.exact)
        if ti.static(self.carrier.spatial):
            found = self.carrier.height(w, time, centre)
        else:
            pose = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(9))])
            if ti.static(self.carrier.moving):
                pose = self.carrier.kinematics(w, time)
            found = pose[1] + ti.sin(pose[2]) * centre[0] + ti.cos(pose[2]) * centre[1]
        return found

    @ti.func
    def write_row(self, w, time, sums, contacts):
        mass = ti.max(sums[MASS], 1e-30)
        centre = [sums[MOMENT + a] / mass for a in ti.static(range(self.grains.axes))]
        height = self.height(w, time, centre)
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
