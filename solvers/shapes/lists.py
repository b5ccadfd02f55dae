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
        count = self.rule.seek_pair(g, w, ti.min(i, j), ti.max(i, j), self.margin(), u)
        for k in range(count):
            if total < self.pairs.capacity:
                self.write_pair(g, u, total, i, j, target, False, dt)
                self.recall(self.pairs, u, total, i, j, k, count)
            total += 1
        return total

    @ti.func
    def list_contact(self, g: ti.template(), u, found, i, feature, shift: ti.template(), dt):
        """List the contacts of a grain with a wall that is near; returns how many there are then."""
        total, w = found, self.units.world(u)
        count = self.rule.seek_wall(g, w, i, feature, shift, self.margin(), u)
        for k in range(count):
            if total < self.contacts.capacity:
                self.write_contact(g, u, total, i, feature, False, dt)
                self.recall(self.contacts, u, total, i, feature, k, count)
            total += 1
        return total

    @ti.func
    def recall(self, contacts: ti.template(), u, p, i, mate, k, count):
        """Contact p, the k-th of `count` that the rule has found of these two, remembers what it did in the old list.

        That is what the nearest of the old contacts did, if none of the others found is nearer to that one.
        """
        row, place = i - self.units.first(u), self.units.world(u) * contacts.stride + mate
        best, nearest = -1, ti.cast(self.rule.farthest, self.grains.real)
        for q in range(contacts.old_first[u, row], contacts.old_first[u, row + 1]):
            if contacts.old_mate[u, q] == place:
                away, taken = self.rule.away(contacts, u, q, k), False
                for other in range(count):
                    if other != k and self.rule.away(contacts, u, q, other) < away:
                        taken = True
                if away < nearest and not taken:
                    best, nearest = q, away
        if best >= 0:
            contacts.recall(u, p, best)
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
    def lose(self, contacts: ti.template(), u, p):
        """Contact p has been lost sight of: have the lists built anew before the next step."""
        if not self.rule.is_lost(contacts, u, p):
            self.rule.lose(contacts, u, p)
            self.want(u)

    @ti.func
    def want(self, u):
        """Have the lists of a unit built anew before the next step."""
        self.travel[u] = NEVER
