"""The laws a scene has chosen, with their coefficients in every world."""

import numpy as np
import taichi as ti

from solvers.runtime import Arrays
from solvers.units import Units

PAIR, WALL = 0, 1


@ti.data_oriented
class ChosenLaws:
    """A normal, a tangential and a rolling law for grain–grain (PAIR) and grain–wall (WALL) contacts.

    `interfaces[w]` = (pair, wall) in world w. Contacts come in blocks of lanes (`ContactList`); what a law returns for
    a block is a vector of lanes.
    """

    def __init__(self, arrays: Arrays, units: Units, normal, tangential, rolling, interfaces):
        self.units = units
        self.normal, self.tangential, self.rolling = laws = normal, tangential, rolling
        self.tables = [arrays.holding(self.tabulate(law, interfaces)) for law in laws]
        self.constants = tuple(name for law in laws for name in law.constants)
        self.memory = tuple(name for law in laws for name in law.memory)
        self.counts = tuple(len(law.constants) for law in laws)
        # A torque turns its sign where the first and the second grain change places; forces along n and t do not.
        self.odd = [law is rolling for law in laws for _ in law.memory]

    @staticmethod
    def tabulate(law, interfaces) -> np.ndarray:
        """Coefficients (W, 2, number) of a law; one zero for a law that has none."""
        return np.array([[law.coefficients(between) or [0.0] for between in world] for world in interfaces])

    @ti.func
    def coefficients(self, which: ti.template(), u, kind: ti.template()):
        """The coefficients of one law in the world of unit u."""
        table = ti.static(self.tables[which])
        w = self.units.world(u)
        return ti.Vector([table[w, kind, k] for k in ti.static(range(table.shape[2]))])

    @ti.func
    def prepare(self, kind: ti.template(), contacts: ti.template(), u, block, lane, mass, radius, dt):
        """Work out the laws' constants of a newly listed contact, m_eff in kg, R_eff in m, Δt in s."""
        self.prepare_law(self.normal, 0, 0, kind, contacts, u, block, lane, mass, radius, dt)
        first = ti.static(self.counts[0])
        self.prepare_law(self.tangential, 1, first, kind, contacts, u, block, lane, mass, radius, dt)
        first_rolling = ti.static(self.counts[0] + self.counts[1])
        self.prepare_law(self.rolling, 2, first_rolling, kind, contacts, u, block, lane, mass, radius, dt)

    @ti.func
    def prepare_law(
        self,
        law: ti.template(),
        which: ti.template(),
        first: ti.template(),
        kind: ti.template(),
        contacts: ti.template(),
        u,
        block,
        lane,
        mass,
        radius,
        dt,
    ):
        """Work out one law's constants, which stand from `first` on."""
        if ti.static(self.counts[which] > 0):
            c = self.coefficients(which, u, kind)
            values = law.prepare(c, contacts.stiffness[u, block][lane], mass, radius, dt)
            for k in ti.static(range(self.counts[which])):
                contacts.constants[first + k][u, block][lane] = values[k]

    @ti.func
    def forces(self, kind: ti.template(), contacts: ti.template(), u, block, overlap, rate, slip, turning, dt):
        """Normal and tangential forces (N) and rolling torques (N m) of a block of contacts; memory is updated.

        `overlap` in m, its `rate` and the `slip` in m/s, `turning` ω_i − ω_j (ω_i at a wall) in rad/s. The torque acts
        on the first grain, and its opposite on the second.
        """
        root = ti.sqrt(overlap)
        normal_c, tangential_c = self.coefficients(0, u, kind), self.coefficients(1, u, kind)
        rolling_c = self.coefficients(2, u, kind)
        pressing = self.normal.force(normal_c, contacts, u, block, overlap, root, rate, dt)
        shearing = self.tangential.force(tangential_c, contacts, u, block, root, pressing, slip, dt)
        torque = self.rolling.torque(rolling_c, contacts, u, block, pressing, turning, dt)
        return pressing, shearing, torque

    @ti.func
    def energy(self, kind: ti.template(), contacts: ti.template(), u, p, overlap):
        """Elastic energy (J) of contact p, which overlaps."""
        block, lane, root = p // contacts.lanes, p % contacts.lanes, ti.sqrt(overlap)
        pressed = self.normal.energy(contacts, u, block, lane, overlap, root)
        sheared = self.tangential.energy(self.coefficients(1, u, kind), contacts, u, block, lane, root)
        return pressed + sheared + self.rolling.energy(contacts, u, block, lane)
