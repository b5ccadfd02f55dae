"""Neighbour lists of grains with outlines: one entry per contact, of which two grains may have several."""

from math import ceil

import numpy as np
import taichi as ti

from solvers.grains.lists.neighbours import Neighbours
from solvers.grains.lists.validity import NEVER
from solvers.grains.shapes.rules.rest import STILL
from solvers.grains.shapes.support import Support
from solvers.machine.wide import enter
from solvers.space.extremes import greater

BENT_PLACES = 4  # initial entries per pair if an outline is non-convex


@ti.data_oriented
class ShapedNeighbours(Neighbours):
    """Neighbour lists of grains whose bounding circles are near each other; a rule says how many contacts they have.

    Each listed pair gets a block of adjacent entries, as many as it may need, and its contacts are sought: with all
    others when the lists are rebuilt, or separately when one of them is lost or new ones appear. Pairs of which none is
    found within the margin are left out until the next rebuild: bounding circles of long grains overlap where the
    grains are far apart. The rule gets the two grains of a pair in the order of their numbers, so that units that share
    a pair compute identical results.
    """

    def __init__(self, arrays, units, grains, walls, reach, skin, laws, modulus, room, rule):
        self.lanes, self.pair_fleeting = rule.rest.lanes, rule.rest.memory
        self.places = min(rule.most, BENT_PLACES * room)
        room *= (BENT_PLACES if rule.bent else 1) * ceil(grains.crowding - 0.01)
        super().__init__(arrays, units, grains, walls, reach, skin, laws, modulus, room, rule)
        self.rule = rule
        if rule.most > 1:
            self.support = Support(arrays, rule.outlines)
        for contacts in (self.pairs, self.contacts):
            # In a pair's first entry: whether its contacts must be searched for again.
            (contacts.wanted,) = contacts.arrays.vectors(
                contacts.each, "wanted", across=units.single, wide=contacts.wide
            )
        self.asking = arrays.under("lists").holding("asking", np.zeros(units.count), "unit", ti.i32, kept=True)

    @ti.func
    def list_pair(self, g: ti.template(), u, found, i, j, target, dt):
        """Reserve entries for the contacts of two neighbouring grains; returns the new number of entries."""
        places = self.rule.places_for_pair(g, self.units.world(u), i, j, self.places)
        for p in range(found, ti.min(found + places, self.pairs.capacity)):
            self.write_pair(g, u, p, i, j, target, False, dt)
            farther = greater(g.reach[self.units.world(u), i], g.reach[self.units.world(u), j])
            enter(self.pairs.reach, u, p // self.pairs.lanes, p % self.pairs.lanes, farther)
            self.rule.free(self.pairs, u, p)
            enter(self.pairs.wanted, u, p, 0, ti.select(p == found, 1.0, 0.0))
        return found + places

    @ti.func
    def list_contact(self, g: ti.template(), u, found, i, feature, shift: ti.template(), dt):
        """Reserve entries for the contacts of a grain with a nearby wall; returns the new number of entries."""
        places = self.rule.places_for_wall(g, self.units.world(u), i, self.places)
        for p in range(found, ti.min(found + places, self.contacts.capacity)):
            self.write_contact(g, u, p, i, feature, False, dt)
            self.rule.free(self.contacts, u, p)
            enter(self.contacts.wanted, u, p, 0, ti.select(p == found, 1.0, 0.0))
        return found + places

    @ti.func
    def asked(self, u):
        """Whether some contacts of a unit must be searched for again although its lists are valid."""
        return self.asking[u] != 0

    @ti.func
    def seek(self, u, t, whole):
        """Seek the contacts of all pairs marked `wanted`; returns False if a pair has more contacts than entries."""
        g, w, fits = self.grains, self.units.world(u), True
        shift = self.walls.shift(w, t)
        for p in range(self.pairs.length[u]):
            if self.pairs.wanted[u, p][0] > 0.0:
                i, j = self.pairs.first_of(u, p), self.pairs.second_of(u, p)
                if not (whole and self.goes_on(u, p, i)):
                    count = self.seek_pair(g, w, ti.min(i, j), ti.max(i, j), u)
                    fits = self.replace(self.pairs, u, p, i, j, count, whole) and fits
        for p in range(self.contacts.length[u]):
            if self.contacts.wanted[u, p][0] > 0.0:
                i, feature = self.contacts.first_of(u, p), self.contacts.second_of(u, p)
                count = self.rule.seek_wall(g, w, i, feature, shift, self.skin.beside(w), u)
                fits = self.replace(self.contacts, u, p, i, feature, count, whole) and fits
        self.asking[u] = 0
        if not fits:
            self.validity.displacement[u] = NEVER
            if whole:
                self.put_back(u)
        elif whole and ti.static(self.rule.most > 1):
            self.leave_out(self.pairs, u)
        for p in range(self.pairs.length[u], self.pairs.blocks(u) * self.pairs.lanes):
            self.rule.rest.forget(self.pairs, u, p, False)
        return fits

    @ti.func
    def seek_pair(self, g: ti.template(), w, i, j, u):
        """Have the rule find the contacts of two grains; returns their number."""
        count, near = 0, True
        if ti.static(self.rule.most > 1):
            near = self.support.gap(g, w, i, j) < self.skin.margin(w)
        if near:
            count = self.rule.seek_pair(g, w, i, j, self.skin.margin(w), u)
        return count

    @ti.func
    def leave_out(self, pairs: ti.template(), u):
        """Close the gaps of pairs without a contact in the list of a unit that has just been built and sought."""
        p, kept = 0, 0
        for k in range(self.units.size):
            end = pairs.first[u, k + 1]
            pairs.first[u, k] = kept
            while p < end:
                after, mate, found = p, pairs.second_of(u, p), False
                while after < end and pairs.second_of(u, ti.min(after, end - 1)) == mate:
                    found = found or not self.rule.is_lost(pairs, u, after)
                    after += 1
                if found:
                    for q in range(p, after):
                        pairs.move(u, q, kept)
                        kept += 1
                p = after
        pairs.first[u, self.units.size], pairs.length[u] = kept, kept
        pairs.pad(u)

    @ti.func
    def goes_on(self, u, p, i):
        """Whether contact p is its pair's only one and known from the old list, so that it need not be sought."""
        known = False
        if ti.static(not self.rule.bent):
            row, mate = i - self.units.first(u), self.pairs.second_of(u, p)
            place = self.units.world(u) * self.pairs.stride + mate
            for q in range(self.pairs.old_first[u, row], self.pairs.old_first[u, row + 1]):
                if self.pairs.old_mate[u, q] == place and self.rule.was_known(self.pairs, u, q):
                    self.pairs.recall(u, p, q)
                    known = True
            if known:
                enter(self.pairs.wanted, u, p, 0, 0.0)
                self.rule.rest.forget(self.pairs, u, p, True)
        return known

    @ti.func
    def replace(self, contacts: ti.template(), u, head, i, mate, count, whole):
        """Replace a pair's contacts, in entries from `head` on, by the `count` found by the rule; returns if they fit.

        Their memory comes from the old list, or from the present entries if not the `whole` list was rebuilt.
        """
        row, end = i - self.units.first(u), head
        while end < contacts.first[u, row + 1] and contacts.second_of(u, end) == mate:
            end += 1
        if not whole:
            contacts.set_aside_some(u, row, head, end)
        enter(contacts.wanted, u, head, 0, 0.0)
        for p in range(head, end):
            contacts.clear(u, p)
            if p - head < count:
                self.recall(contacts, u, p, i, mate, p - head, count)
            else:
                self.rule.free(contacts, u, p)
            if ti.static(hasattr(contacts, STILL)):
                self.rule.rest.forget(contacts, u, p, p - head < count)
        return count <= end - head

    @ti.func
    def recall(self, contacts: ti.template(), u, p, i, mate, k, count):
        """Restore the memory of contact p, the k-th of `count` that the rule has found for a pair, from the old list.

        It is that of the nearest old contact, unless another contact found is nearer to that one.
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
    def lose(self, contacts: ti.template(), u, p):
        """Mark contact p as lost; its pair's contacts are searched for again before the next step."""
        if not self.rule.is_lost(contacts, u, p):
            self.rule.lose(contacts, u, p)
            self.want(contacts, u, p)

    @ti.func
    def want(self, contacts: ti.template(), u, p):
        """Have the contacts of p's pair searched for again before the next step."""
        enter(contacts.wanted, u, self.head(contacts, u, p), 0, 1.0)
        if ti.static(self.units.single):
            self.validity.displacement[u] = NEVER
        else:
            self.asking[u] = 1

    @ti.func
    def head(self, contacts: ti.template(), u, p):
        """The first entry of p's pair."""
        first, start = p, contacts.first[u, contacts.first_of(u, p) - self.units.first(u)]
        while first > start and contacts.second_of(u, ti.max(first - 1, 0)) == contacts.second_of(u, p):
            first -= 1
        return first
