"""The laws a scene has chosen, with their coefficients in every world."""

import numpy as np
import taichi as ti

from solvers.runtime import Arrays
from solvers.units import Units

PAIR, WALL = 0, 1


@ti.data_oriented
class ChosenLaws:
    """A normal and a tangential law for grain–grain (PAIR) and grain–wall (WALL) contacts.

    `interfaces[w]` = (pair, wall) in world w. Contacts come in blocks of lanes (`ContactList`); what a law returns for
    a block is a vector of lanes.
    """

    def __init__(self, arrays: Arrays, units: Units, normal, tangential, interfaces):
        self.units = units
        self.normal, self.tangential = normal, tangential
        self.normal_table = self._tabulate(arrays, normal, interfaces)
        self.tangential_table = self._tabulate(arrays, tangential, interfaces)
        self.normal_constants, self.tangential_constants = len(normal.constants), len(tangential.constants)
        self.constants = (*normal.constants, *tangential.constants)
        self.memory = (*normal.memory, *tangential.memory)

    @staticmethod
    def _tabulate(arrays: Arrays, law, interfaces) -> ti.Field:
        """Coefficients (W, 2, number) of a law."""
        return arrays.holding(np.array([[law.coefficients(between) for between in world] for world in interfaces]))

    @ti.func
    def coefficients(self, table: ti.template(), u, kind: ti.template()):
        """The coefficients of one law in the world of unit u."""
        w = self.units.world(u)
        return ti.Vector([table[w, kind, k] for k in ti.static(range(table.shape[2]))])

    @ti.func
    def prepare(self, kind: ti.template(), contacts: ti.template(), w, block, lane, mass, radius, dt):
        """Work out the laws' constants of a newly listed contact, m_eff in kg, Δt in s."""
        stiffness = contacts.stiffness[w, block][lane]
        if ti.static(self.normal_constants > 0):
            c = self.coefficients(self.normal_table, w, kind)
            values = self.normal.prepare(c, stiffness, mass, dt)
            for k in ti.static(range(self.normal_constants)):
                contacts.constants[k][w, block][lane] = values[k]
        if ti.static(self.tangential_constants > 0):
            c = self.coefficients(self.tangential_table, w, kind)
            values = self.tangential.prepare(c, stiffness, mass, dt)
            for k in ti.static(range(self.tangential_constants)):
                contacts.constants[self.normal_constants + k][w, block][lane] = values[k]

    @ti.func
    def forces(self, kind: ti.template(), contacts: ti.template(), w, block, overlap, rate, slip, turning, dt):
        """Normal and tangential forces (N) of a block of contacts, whose memory is brought up to date."""
        root = ti.sqrt(overlap)
        normal_c = self.coefficients(self.normal_table, w, kind)
        tangential_c = self.coefficients(self.tangential_table, w, kind)
        pressing = self.normal.force(normal_c, contacts, w, block, overlap, root, rate)
        shearing = self.tangential.force(tangential_c, contacts, w, block, root, pressing, slip, dt)
        return pressing, shearing, 0.0 * shearing

    @ti.func
    def energy(self, kind: ti.template(), contacts: ti.template(), w, p, overlap):
        """Elastic energy (J) of contact p, which overlaps."""
        block, lane, root = p // contacts.lanes, p % contacts.lanes, ti.sqrt(overlap)
        pressed = self.normal.energy(contacts, w, block, lane, overlap, root)
        tangential_c = self.coefficients(self.tangential_table, w, kind)
        return pressed + self.tangential.energy(tangential_c, contacts, w, block, lane, root)
