"""Contact forces of grains with outlines: the laws of the scene on what a rule of contact says."""

import taichi as ti

from solvers.contacts import Contacts
from solvers.laws.chosen import PAIR, WALL
from solvers.laws.extremes import greater

OVERLAP, NORMAL_Y, NORMAL_Z, POINT_Y, POINT_Z, HOLDS = range(6)


@ti.data_oriented
class ShapedContacts(Contacts):
    """What the listed contacts do to grains with outlines.

    The force acts at one point on both grains, so angular momentum is exact: between their outlines, where it is for
    discs, too (see `Contacts`). Slip and rate are of that point. The laws' effective radius is that of the discs of
    equal area, so that the elastic energy depends on the overlap alone.
    """

    def __init__(self, arrays, units, grains, walls, lists, laws, rule):
        super().__init__(arrays, units, grains, walls, lists, laws)
        self.rule = rule

    @ti.func
    def pair_forces(self, g: ti.template(), pairs: ti.template(), u, dt):
        """Forces between the grains g, a contact at a time; one across two units is worked out in both."""
        w, start, end = self.units.world(u), self.units.first(u), self.units.end(u)
        for p in range(pairs.length[u]):
            listed, mate = pairs.first_of(u, p), pairs.second_of(u, p)
            i, j = ti.min(listed, mate), ti.max(listed, mate)
            c = self.rule.pair(g, pairs, w, i, j, u, p, True)
            if c[HOLDS] == 0.0:
                self.lists.lose(pairs, u, p)
                c[OVERLAP] = -g.reach[w, i]
            ny, nz, overlap = c[NORMAL_Y], c[NORMAL_Z], greater(c[OVERLAP], 0.0)
            # From the middle of the overlap to where the outlines of discs would cross.
            back = (0.5 - pairs.share[u, p][0] if listed == i else pairs.share[u, p][0] - 0.5) * overlap
            lever_y, lever_z = c[POINT_Y] + back * ny, c[POINT_Z] + back * nz
            apart = g.apart(w, i, j)
            far_y, far_z = lever_y + apart[0], lever_z + apart[1]
            spin_i, spin_j = g.spin_now[w, i], g.spin_now[w, j]
            uy = g.now_y[w, i] - g.now_y[w, j] - spin_i * lever_z + spin_j * far_z
            uz = g.now_z[w, i] - g.now_z[w, j] + spin_i * lever_y - spin_j * far_y
            fn, ft, roll = self.laws.forces(
                PAIR,
                pairs,
                u,
                p,
                ti.Vector([overlap]),
                ti.Vector([-(uy * ny + uz * nz)]),
                ti.Vector([uz * ny - uy * nz]),
                ti.Vector([spin_i - spin_j]),
                dt,
            )
            fy, fz = fn[0] * ny - ft[0] * nz, fn[0] * nz + ft[0] * ny
            if start <= i < end:
                g.push(w, i, fy, fz, lever_y * fz - lever_z * fy + roll[0])
            if start <= j < end:
                g.push(w, j, -fy, -fz, far_z * fy - far_y * fz - roll[0])

    @ti.func
    def wall_forces(self, g: ti.template(), contacts: ti.template(), u, t, dt):
        """Forces of the walls on the grains g."""
        w = self.units.world(u)
        shift = self.walls.shift(w, t)
        for p in range(contacts.length[u]):
            i, feature = contacts.first_of(u, p), contacts.second_of(u, p)
            c = self.rule.wall(g, contacts, w, i, feature, shift, u, p, True)
            if c[HOLDS] == 0.0:
                self.lists.lose(contacts, u, p)
                c[OVERLAP] = -g.reach[w, i]
            ny, nz, overlap = c[NORMAL_Y], c[NORMAL_Z], greater(c[OVERLAP], 0.0)
            lever_y, lever_z = c[POINT_Y] + 0.5 * overlap * ny, c[POINT_Z] + 0.5 * overlap * nz
            velocity, spin = self.walls.velocity(feature, shift), g.spin_now[w, i]
            uy = g.now_y[w, i] - velocity[0] - spin * lever_z
            uz = g.now_z[w, i] - velocity[1] + spin * lever_y
            fn, ft, roll = self.laws.forces(
                WALL,
                contacts,
                u,
                p,
                ti.Vector([overlap]),
                ti.Vector([-(uy * ny + uz * nz)]),
                ti.Vector([uz * ny - uy * nz]),
                ti.Vector([spin]),
                dt,
            )
            fy, fz = fn[0] * ny - ft[0] * nz, fn[0] * nz + ft[0] * ny
            g.push(w, i, fy, fz, lever_y * fz - lever_z * fy + roll[0])

    @ti.func
    def census(self, g: ti.template(), pairs: ti.template(), contacts: ti.template(), u, t):
        """Number of touching contacts, largest overlap in radii of the smaller grain, their energy (J), of a unit."""
        w, start, end = self.units.world(u), self.units.first(u), self.units.end(u)
        zero = ti.cast(0.0, g.exact)
        touching, deepest, energy = zero, zero, zero
        for p in range(pairs.length[u]):
            i, j = pairs.first_of(u, p), pairs.second_of(u, p)
            overlap = self.rule.pair(g, pairs, w, ti.min(i, j), ti.max(i, j), u, p, False)[OVERLAP]
            if overlap > 0.0:
                part = ti.select(start <= j < end or j >= g.mobile, 1.0, 0.5)
                touching += part
                deepest = ti.max(deepest, overlap / ti.min(g.radius[w, i], g.radius[w, j]))
                energy += part * self.laws.energy(PAIR, pairs, u, p, overlap)
        shift = self.walls.shift(w, t)
        for p in range(contacts.length[u]):
            i, feature = contacts.first_of(u, p), contacts.second_of(u, p)
            overlap = self.rule.wall(g, contacts, w, i, feature, shift, u, p, False)[OVERLAP]
            if overlap > 0.0:
                touching += 1.0
                deepest = ti.max(deepest, overlap / g.radius[w, i])
                energy += self.laws.energy(WALL, contacts, u, p, overlap)
        return ti.Vector([touching, deepest, energy])
