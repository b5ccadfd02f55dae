"""From points to nodes: mass and momentum, with what stresses add to it through a step."""

import numpy as np
import taichi as ti

from solvers.bulk.given import Bulk
from solvers.bulk.order import Order
from solvers.bulk.state import ALONG_Y, ALONG_Z, SHEAR, Points
from solvers.bulk.weights import weights
from solvers.machine.state import Axis, State
from solvers.machine.units import Units

MASS, ALONG, UP, PUSHED_ALONG, PUSHED_UP = range(5)  # of a node: mass, momentum, impulse of stresses
WIDE = 3  # columns of nodes that a column of points spreads to
SLOTS = 5  # numbers of a node


@ti.data_oriented
class Spread:
    """Each column of points spreads to a strip of its own, three columns of nodes wide, so that no two threads meet.

    The momentum of a point is affine about it (Jiang et al. 2015, APIC), and its stress acts through the same weights
    (Hu et al. 2018, MLS-MPM). With the length Δt of the kick, and nodes h apart, node i receives the momentum

        p_i = Σ w_i (m v + (m C − Δt V σ 4/h²) (x_i − x))
    """

    def __init__(self, arrays: State, units: Units, points: Points, order: Order, bulk: Bulk):
        self.units, self.points, self.order, self.rows = units, points, order, bulk.grid.rows
        own = arrays.under("bulk.spread")
        self.modulus = own.holding("modulus", np.array([bulk.material.bulk_modulus]), "one")
        length = bulk.grid.columns * WIDE * self.rows * SLOTS
        (self.strips,) = own.reals((Axis("world", points.worlds), Axis("slot", length)), "strips", kept=False)

    @ti.func
    def pressure(self, w, i):
        """The pressure (Pa) of a point, K (V_0/V − 1); none where it is looser than at rest."""
        p = self.points
        return ti.max(0.0, self.modulus[0] * (p.free[w, i] / p.volume[w, i] - 1.0))

    @ti.func
    def spread(self, u, t, kick, dt):
        """Spread the points of a unit's columns to their strips."""
        w = self.units.world(u)
        for c in range(self.units.first(u), self.units.end(u)):
            begin = c * (WIDE * self.rows * SLOTS)
            for k in range(WIDE * self.rows * SLOTS):
                self.strips[w, begin + k] = 0.0
            for k in range(self.order.first[w, c], self.order.first[w, c + 1]):
                self.spread_point(w, self.order.listed[w, k], begin, kick)

    @ti.func
    def spread_point(self, w, i, begin, kick):
        """Spread one point to the strip that begins at a slot."""
        p, tank = self.points, self.order.of(i)
        _, far_y = self.order.cells(w, i, 0)
        row, far_z = self.order.cells(w, i, 1)
        along, up = weights(far_y), weights(far_z)
        finer = [ti.cast(self.order.table[tank, 2 + a], p.real) for a in ti.static(range(2))]
        mass, pressure = p.mass[w, i], self.pressure(w, i)
        pushed = 4.0 * kick * p.volume[w, i]
        shear = pushed * p.deviator[SHEAR][w, i]
        # Per cell instead of per metre: 4/h of what acts over 4/h², and C h
        push_yy = pushed * (p.deviator[ALONG_Y][w, i] - pressure) * finer[0]
        push_zz = pushed * (p.deviator[ALONG_Z][w, i] - pressure) * finer[1]
        push_yz, push_zy = shear * finer[1], shear * finer[0]
        yy, yz = mass * p.gradient[0][w, i] / finer[0], mass * p.gradient[1][w, i] / finer[1]
        zy, zz = mass * p.gradient[2][w, i] / finer[0], mass * p.gradient[3][w, i] / finer[1]
        v_y, v_z = mass * p.velocity[0][w, i], mass * p.velocity[1][w, i]
        for a in ti.static(range(WIDE)):
            off_y = a - far_y
            first_y, first_z = v_y + yy * off_y, v_z + zy * off_y
            for b in ti.static(range(WIDE)):
                off_z = b - far_z
                weight = along[a] * up[b]
                slot = begin + (a * self.rows + row + b) * SLOTS
                self.add(w, slot + MASS, weight * mass)
                self.add(w, slot + ALONG, weight * (first_y + yz * off_z))
                self.add(w, slot + UP, weight * (first_z + zz * off_z))
                self.add(w, slot + PUSHED_ALONG, -weight * (push_yy * off_y + push_yz * off_z))
                self.add(w, slot + PUSHED_UP, -weight * (push_zy * off_y + push_zz * off_z))

    @ti.func
    def add(self, w, slot, value):
        """Add to a slot; no atomic is needed, since one thread has the whole strip."""
        self.strips[w, slot] = self.strips[w, slot] + value
