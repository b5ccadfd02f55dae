"""Who may touch whom where grains have outlines: one entry a contact, of which two grains may have several."""

import taichi as ti

from solvers.neighbours import NEVER, Neighbours


@ti.data_oriented
class ShapedNeighbours(Neighbours):
    """Neighbour lists of grains whose bounding circles are near each other; a rule says how many contacts they have.

    The two grains of a pair are put to the rule in the order of their numbers, so that units that share a pair work
    out the same numbers.
    """

    lanes = 1  # an outline's tables are read contact by contact

    def __init__(self, arrays, units, grains, walls, skin, bridges, reach, laws, modulus, room, rule):
        super().__init__(arrays, units, grains, walls, skin, bridges, reach, laws, modulus, room, rule)
        self.rule = rule
        (self.built_angle,) = arrays.reals(1, (grains.worlds, grains.count))

    @ti.func
    def list_pair(self, g: ti.template(), u, found, i, j, target, dt):
        """List the contacts of two grains that are near each other; returns how many there are then."""
        total, w = found, self.units.world(u)
        for k in range(self.rule.seek_pair(g, w, ti.min(i, j), ti.max(i, j), self.margin(), u)):
            if total < self.pairs.capacity:
                self.write_pair(g, u, total, i, j, target, False, dt)
                self.recall(self.pairs, u, total, i, j, k)
            total += 1
        return total

    @ti.func
    def list_contact(self, g: ti.template(), u, found, i, feature, shift: ti.template(), dt):
        """List the contacts of a grain with a wall that is near; returns how many there are then."""
        total, w = found, self.units.world(u)
        for k in range(self.rule.seek_wall(g, w, i, feature, shift, self.margin(), u)):
            if total < self.contacts.capacity:
                self.write_contact(g, u, total, i, feature, False, dt)
                self.recall(self.contacts, u, total, i, feature, k)
            total += 1
        return total

    @ti.func
    def recall(self, contacts: ti.template(), u, p, i, mate, k):
        """Contact p, the k-th that the rule has found, remembers what it did in the old list."""
        row, place = i - self.units.first(u), self.units.world(u) * contacts.stride + mate
        for q in range(contacts.old_first[u, row], contacts.old_first[u, row + 1]):
            if contacts.old_mate[u, q] == place and self.rule.is_same(contacts, u, q, k):
                contacts.recall(u, p, q)
        self.rule.note(contacts, u, p, k)

    @ti.func
    def note_built(self, w, i):
        """Remember where a grain is as the lists are built."""
        self.built_y[w, i], self.built_z[w, i] = self.grains.y[w, i], self.grains.z[w, i]
        self.built_angle[w, i] = self.grains.angle[w, i]

    @ti.func
    def way(self, w, i):
        """How far (m) any point of a grain can have gone since then."""
        dy = ti.cast(self.grains.y[w, i] - self.built_y[w, i], self.grains.real)
        dz = ti.cast(self.grains.z[w, i] - self.built_z[w, i], self.grains.real)
        turned = ti.abs(self.grains.angle[w, i] - self.built_angle[w, i])
        return ti.sqrt(dy * dy + dz * dz) + turned * self.grains.reach[w, i]

    @ti.func
    def renew(self, u):
        """Have a unit's lists built anew before its next step: a contact has been lost sight of."""
        self.travel[u] = NEVER
