"""Diagnostics of the bulk: sums over the points of a world, in the order of their numbers."""

from types import SimpleNamespace

import numpy as np
import taichi as ti

from solvers.bulk import quantities
from solvers.bulk.gather import Gather
from solvers.bulk.nodes import HAS, MAY, NODE
from solvers.bulk.state import ALONG_Y, ALONG_Z, SHEAR
from solvers.bulk.weights import weights
from solvers.machine.quantity import parted, places
from solvers.machine.state import Axis, State

FULL = 0.999  # of its friction that a point calls on when it slides


@ti.data_oriented
class Diagnostics:
    """One row of numbers per world. `quantities` declares them, and `at` has the column in which each begins.

    They are sums over the slab of each tank, but for the centre of mass and what slides: these weigh each tank by its
    length `along` (W, tanks) a ship, over that of the first.
    """

    def __init__(self, arrays: State, gather: Gather, carrier, modulus: float, along: np.ndarray):
        self.gather, self.points, self.nodes, self.order = gather, gather.points, gather.nodes, gather.order
        self.units, self.carrier, self.exact, self.modulus = gather.units, carrier, arrays.exact, modulus
        self.quantities = (*quantities.SERIES, *quantities.CHECKED)
        self.at = SimpleNamespace(**places(self.quantities))
        columns = sum(quantity.width for quantity in self.quantities)
        own, row = arrays.under("bulk.diagnostics"), (Axis("world", self.points.worlds), Axis("quantity", columns))
        (self.rows,) = own.reals(row, "rows", kind=arrays.exact, kept=False)
        self.along = own.holding("along", along, "world tank", arrays.exact)

    def sums_at(self, time: float) -> dict[str, np.ndarray]:
        """The quantities of every world at `time` (s), which must be the points' own: (W, *shape) of each by name."""
        self.count(time)
        return parted(self.rows.to_numpy().astype(float), self.quantities)

    @ti.kernel
    def count(self, time: ti.f64):
        """Fill the rows."""
        for w in range(self.points.worlds):
            self.sum_world(w, time)

    @ti.func
    def sum_world(self, w, time):
        p = self.points
        zero, shear_modulus = ti.cast(0.0, self.exact), ti.cast(self.gather.numbers[0], self.exact)
        mass, slab_y, slab_z, kinetic, elastic, crowding = zero, zero, zero, zero, zero, zero
        aboard, of_y, of_z, sliding = zero, zero, zero, zero
        escaped, densest = ti.cast(-1.0, self.exact), zero
        for i in range(p.count):
            m = ti.cast(p.mass[w, i], self.exact)
            y, z = ti.cast(p.place[0][w, i], self.exact), ti.cast(p.place[1][w, i], self.exact)
            whole = m * self.along[w, self.order.of(i)]
            mass, slab_y, slab_z = mass + m, slab_y + m * y, slab_z + m * z
            aboard, of_y, of_z = aboard + whole, of_y + whole * y, of_z + whole * z
            kinetic += ti.cast(self.order.kinetic(w, i), self.exact)
            volume, free = ti.cast(p.volume[w, i], self.exact), ti.cast(p.free[w, i], self.exact)
            if free > volume:
                elastic += self.modulus * (free * ti.log(free / volume) - (free - volume))
            s_yy, s_zz = ti.cast(p.deviator[ALONG_Y][w, i], self.exact), ti.cast(p.deviator[ALONG_Z][w, i], self.exact)
            s_yz, s_xx = ti.cast(p.deviator[SHEAR][w, i], self.exact), s_yy + s_zz
            square = 0.5 * (s_yy * s_yy + s_zz * s_zz + s_xx * s_xx) + s_yz * s_yz
            elastic += volume * square / (2.0 * shear_modulus)
            if p.use[w, i] > FULL:
                sliding += whole
            crowding += m * self.crowd(w, i)
            densest = ti.max(densest, free / volume - 1.0)
            if not self.is_within(i, y, z):
                escaped = i
        thickness = ti.cast(self.gather.numbers[5], self.exact)
        self.rows[w, self.at.centre_of_mass] = of_y / aboard
        self.rows[w, self.at.centre_of_mass + 1] = of_z / aboard
        self.rows[w, self.at.kinetic] = thickness * kinetic
        self.rows[w, self.at.potential] = (
            thickness * mass * self.carrier.gravity[0] * self.height(w, time, slab_y / mass, slab_z / mass)
        )
        self.rows[w, self.at.elastic] = thickness * elastic
        losses = ti.Vector([zero, zero, zero, zero, -thickness * kinetic])  # what nodes gained and points have not
        for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
            losses[0] += self.nodes.lost[u]
            losses[4] += thickness * self.nodes.gained[u]
            for way in ti.static(range(3)):
                losses[1 + way] += self.gather.lost[u, way]
        for way in ti.static(range(5)):
            self.rows[w, self.at.bulk_losses + way] = losses[way]
        self.rows[w, self.at.bulk_sliding] = sliding / aboard
        self.rows[w, self.at.bulk_crowding] = crowding / mass
        self.rows[w, self.at.bulk_escaped], self.rows[w, self.at.bulk_densest] = escaped, densest

    @ti.func
    def crowd(self, w, i):
        """How much denser (share) the nodes know a point to be; they have the places of the step before."""
        p, o = self.points, self.order
        node, far_y = o.cells(w, i, 0)
        row, far_z = o.cells(w, i, 1)
        column = node + ti.cast(o.table[o.of(i), 4], ti.i32)
        along, up = weights(far_y), weights(far_z)
        has, may, over = ti.cast(0.0, p.real), ti.cast(0.0, p.real), ti.cast(0.0, p.real)
        for a in ti.static(range(3)):
            for b in ti.static(range(3)):
                slot = NODE * ((column + a) * o.rows + row + b)
                has += along[a] * up[b] * self.nodes.node[w, slot + HAS]
                may += along[a] * up[b] * self.nodes.node[w, slot + MAY]
        if may > 0.0 and has > 0.0:
            over = has * p.volume[w, i] / (p.mass[w, i] * may) - 1.0
        return ti.cast(over, self.exact)

    @ti.func
    def is_within(self, i, y, z):
        """Whether a point is within the grid, a cell from its edges at least."""
        o, tank = self.order, self.order.of(i)
        across, up = (y - o.table[tank, 0]) * o.table[tank, 2], (z - o.table[tank, 1]) * o.table[tank, 3]
        return 0.5 < across < o.table[tank, 5] - 1.5 and 0.5 < up < o.rows - 1.5

    @ti.func
    def height(self, w, time, y, z):
        """Height (m) over the earth of a point of the tank."""
        pose = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(9))])
        if ti.static(self.carrier.moving):
            pose = self.carrier.kinematics(w, time)
        return pose[1] + ti.sin(pose[2]) * y + ti.cos(pose[2]) * z
