"""Contact forces: overlaps and slips of listed contacts, and the laws of the scene on them."""

import numpy as np
import taichi as ti

from solvers.runtime import Arrays

PAIR, WALL = 0, 1


@ti.data_oriented
class Contacts:
    """One normal and one tangential law at work on the contacts of every world.

    The tangent is the normal turned counter-clockwise by 90°. Levers are the radii less half the overlap, which add
    up to the distance of the centres: angular momentum is exact. (Spandonidis 2016, eq. 4.7, takes whole radii.)
    """

    def __init__(self, arrays: Arrays, normal, tangential, interfaces):
        self.normal, self.tangential = normal, tangential
        self.normal_table = self._tabulate(arrays, normal, interfaces)
        self.tangential_table = self._tabulate(arrays, tangential, interfaces)

    @staticmethod
    def _tabulate(arrays: Arrays, law, interfaces) -> ti.Field:
        """Coefficients (W, 2, number) of a law on grain–grain and grain–wall contacts, `interfaces[w] = (pair, wall)`."""
        return arrays.holding(np.array([[law.coefficients(between) for between in world] for world in interfaces]))

    @ti.func
    def coefficients(self, table: ti.template(), w, kind: ti.template()):
        """The coefficients of one law in world w for grain–grain (PAIR) or grain–wall (WALL) contacts."""
        return ti.Vector([table[w, kind, k] for k in ti.static(range(table.shape[2]))])

    @ti.func
    def law(self, normal_c, tangential_c, contacts: ti.template(), w, p, overlap, rate, slip, dt):
        """Normal and tangential force (N) of contact p, whose history is brought up to date."""
        stiffness, root = contacts.stiffness[w, p], ti.sqrt(overlap)
        pressing = self.normal.force(normal_c, stiffness, overlap, root, rate)
        past = contacts.past[w, p]
        shearing, past = self.tangential.force(
            tangential_c, stiffness, contacts.mass[w, p], root, pressing, slip, dt, past
        )
        contacts.past[w, p] = past
        return pressing, shearing

    @ti.func
    def pair_forces(self, g: ti.template(), pairs: ti.template(), w, dt):
        """Forces between the grains g."""
        normal_c = self.coefficients(self.normal_table, w, PAIR)
        tangential_c = self.coefficients(self.tangential_table, w, PAIR)
        for p in range(pairs.length[w]):
            i, j = pairs.grain[w, p], pairs.mate[w, p]
            dy, dz = g.y[w, i] - g.y[w, j], g.z[w, i] - g.z[w, j]
            radius_i, radius_j = g.radius[w, i], g.radius[w, j]
            reach, square = radius_i + radius_j, dy * dy + dz * dz
            if square < reach * reach:
                inverse = 1.0 / ti.sqrt(square)
                ny, nz = dy * inverse, dz * inverse
                overlap = reach - square * inverse
                uy, uz = g.now_y[w, i] - g.now_y[w, j], g.now_z[w, i] - g.now_z[w, j]
                lever_i, lever_j = radius_i - 0.5 * overlap, radius_j - 0.5 * overlap
                rate = -(uy * ny + uz * nz)
                slip = uz * ny - uy * nz - lever_i * g.spin_now[w, i] - lever_j * g.spin_now[w, j]
                fn, ft = self.law(normal_c, tangential_c, pairs, w, p, overlap, rate, slip, dt)
                fy, fz = fn * ny - ft * nz, fn * nz + ft * ny
                g.push(w, i, fy, fz, -lever_i * ft)
                g.push(w, j, -fy, -fz, -lever_j * ft)
            else:
                pairs.past[w, p] *= 0.0

    @ti.func
    def wall_forces(self, g: ti.template(), walls: ti.template(), contacts: ti.template(), w, dt):
        """Forces of the walls on the grains g."""
        normal_c = self.coefficients(self.normal_table, w, WALL)
        tangential_c = self.coefficients(self.tangential_table, w, WALL)
        for p in range(contacts.length[w]):
            i = contacts.grain[w, p]
            gap = walls.gap(contacts.mate[w, p], g.y[w, i], g.z[w, i])
            distance, ny, nz = gap[0], gap[1], gap[2]
            radius = g.radius[w, i]
            if ti.abs(distance) < radius:
                overlap = radius - distance
                uy, uz = g.now_y[w, i], g.now_z[w, i]
                lever = radius - 0.5 * overlap
                rate = -(uy * ny + uz * nz)
                slip = uz * ny - uy * nz - lever * g.spin_now[w, i]
                fn, ft = self.law(normal_c, tangential_c, contacts, w, p, overlap, rate, slip, dt)
                g.push(w, i, fn * ny - ft * nz, fn * nz + ft * ny, -lever * ft)
            else:
                contacts.past[w, p] *= 0.0

    @ti.func
    def stored(self, contacts: ti.template(), kind: ti.template(), w, p, overlap):
        """Elastic energy (J) of contact p, 0 without overlap."""
        energy = 0.0
        if overlap > 0.0:
            stiffness, root = contacts.stiffness[w, p], ti.sqrt(overlap)
            tangential_c = self.coefficients(self.tangential_table, w, kind)
            energy = self.normal.energy(stiffness, overlap, root)
            energy += self.tangential.energy(tangential_c, stiffness, root, contacts.past[w, p])
        return energy

    @ti.func
    def census(self, g: ti.template(), walls: ti.template(), lists: ti.template(), w):
        """Number of touching contacts, largest overlap in radii of the smaller grain, elastic energy (J)."""
        touching, deepest, energy = 0.0, 0.0, 0.0
        for p in range(lists.pairs.length[w]):
            i, j = lists.pairs.grain[w, p], lists.pairs.mate[w, p]
            dy, dz = g.y[w, i] - g.y[w, j], g.z[w, i] - g.z[w, j]
            overlap = g.radius[w, i] + g.radius[w, j] - ti.sqrt(dy * dy + dz * dz)
            if overlap > 0.0:
                touching += 1.0
                deepest = ti.max(deepest, overlap / ti.min(g.radius[w, i], g.radius[w, j]))
                energy += self.stored(lists.pairs, PAIR, w, p, overlap)
        for p in range(lists.contacts.length[w]):
            i = lists.contacts.grain[w, p]
            gap = walls.gap(lists.contacts.mate[w, p], g.y[w, i], g.z[w, i])
            overlap = g.radius[w, i] - gap[0]
            if overlap > 0.0:
                touching += 1.0
                deepest = ti.max(deepest, overlap / g.radius[w, i])
                energy += self.stored(lists.contacts, WALL, w, p, overlap)
        return ti.Vector([touching, deepest, energy])
