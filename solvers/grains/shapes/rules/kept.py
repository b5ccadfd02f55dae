"""What is remembered of the contacts of smooth outlines, and how they end in saddles."""

import taichi as ti

from solvers.grains.shapes.rules.rest import STILL
from solvers.grains.shapes.rules.tracked import NONE, Tracked

# Of a contact with a wall, and more of one between two grains; the second pair of each for outlines that bend.
WALL, WALL_BENT = ("place_first",), ("saddle_first", "looked")
PAIR, PAIR_BENT = ("place_second",), ("saddle_second",)
MET = 1.0 / 64.0  # of an outline: nearer a saddle than this, a contact that is not found any more has ended in it


@ti.data_oriented
class Kept:
    """Places of contacts and of saddles, as `ContactList` keeps them.

    `place_first` and `place_second` are where a contact is on both outlines, `saddle_first` and `saddle_second` where
    the saddle before it is, by places on the first, or NONE. Contacts of the same two stand side by side. One that has
    ended or been lost sight of has its last place a whole turn too low. `looked` counts steps.
    """

    def __init__(self, tracked: Tracked, bent: bool):
        self.tracked, self.tables = tracked, tracked.tables
        self.met = MET * self.tables.cells
        self.wall_memory = WALL + (WALL_BENT if bent else ())
        self.pair_memory = self.wall_memory + PAIR + (PAIR_BENT if bent else ())

    @ti.func
    def is_lost(self, contacts: ti.template(), u, p):
        """Whether contact p has ended or been lost sight of."""
        return contacts.place_first[u, p][0] < 0.0

    @ti.func
    def lose(self, contacts: ti.template(), u, p):
        """Remember that it has."""
        contacts.place_first[u, p][0] = self.tables.wrapped(contacts.place_first[u, p][0]) - self.tables.cells

    @ti.func
    def beside(self, contacts: ti.template(), u, p, side):
        """The next contact of the same two on one side of p along the first outline, 1 or −1; p if there is none."""
        row, mate, here = self.row(contacts, u, p), contacts.mate[u, p][0], contacts.place_first[u, p][0]
        found, least = p, 2.0 * self.tables.cells
        for q in range(contacts.first[u, row], contacts.first[u, row + 1]):
            place = contacts.place_first[u, q][0]
            way = self.tables.wrapped(side * (place - here))
            if contacts.mate[u, q][0] == mate and q != p and place >= 0.0 and way < least:
                found, least = q, way
        return found

    @ti.func
    def has_twin(self, contacts: ti.template(), u, p, place):
        """Whether another contact of the same two as p is near this place already."""
        row, mate, found = self.row(contacts, u, p), contacts.mate[u, p][0], False
        for q in range(contacts.first[u, row], contacts.first[u, row + 1]):
            other = contacts.place_first[u, q][0]
            if contacts.mate[u, q][0] == mate and q != p and other >= 0.0:
                found = found or self.tracked.same(place, other, self.met)
        return found

    @ti.func
    def row(self, contacts: ti.template(), u, p):
        """The place of a contact's first grain in its unit, by which the list is sorted."""
        return contacts.first_of(u, p) - contacts.units.first(u)

    @ti.func
    def to_saddle(self, contacts: ti.template(), u, p, q):
        """How many cells contact p is from the saddle before q, all round where there is none."""
        saddle, place = contacts.saddle_first[u, q][0], contacts.place_first[u, p][0]
        return ti.select(saddle >= 0.0, self.tracked.distance(place, saddle), 1.0 * self.tables.cells)

    @ti.func
    def end(self, contacts: ti.template(), u, p, surely):
        """Contact p is not found any more: note if it has ended in the saddle before it, or in the one after it."""
        after = self.beside(contacts, u, p, 1.0)
        own, following = self.to_saddle(contacts, u, p, p), self.to_saddle(contacts, u, p, after)
        if ti.min(own, following) < self.met or surely:
            if own <= following:
                self.end_with_own(contacts, u, p)
            else:
                self.end_before(contacts, u, p, after)

    @ti.func
    def end_saddle(self, contacts: ti.template(), u, p):
        """The saddle before contact p is not found any more: one of the contacts beside it may have ended in it."""
        before = self.beside(contacts, u, p, -1.0)
        own, other = self.to_saddle(contacts, u, p, p), self.to_saddle(contacts, u, before, p)
        if own < self.met and own <= other:
            self.end_with_own(contacts, u, p)
        elif other < self.met:
            self.end_before(contacts, u, before, p)
        else:
            contacts.saddle_first[u, p][0] = NONE

    @ti.func
    def end_with_own(self, contacts: ti.template(), u, p):
        """Contact p has ended in the saddle before it."""
        if not self.is_lost(contacts, u, p):
            self.lose(contacts, u, p)
        contacts.saddle_first[u, p][0] = NONE

    @ti.func
    def end_before(self, contacts: ti.template(), u, p, after):
        """Contact p has ended in the saddle before the one after it, which takes over the saddle before p."""
        self.take_over_saddle(contacts, u, after, p)
        self.end_with_own(contacts, u, p)

    @ti.func
    def take_over_saddle(self, contacts: ti.template(), u, p, q):
        """The saddle before contact p is now the one that was before q."""
        contacts.saddle_first[u, p][0] = contacts.saddle_first[u, q][0]
        if ti.static(hasattr(contacts, "saddle_second")):
            contacts.saddle_second[u, p][0] = contacts.saddle_second[u, q][0]
        if ti.static(hasattr(contacts, STILL)):
            contacts.still[u, p][0] = 0.0  # what was seen of it was another

    @ti.func
    def way_back(self, contacts: ti.template(), u, p, q):
        """How many cells it is along the first outline from contact q to p."""
        return self.tables.wrapped(contacts.place_first[u, p][0] - contacts.place_first[u, q][0])

    @ti.func
    def beyond(self, contacts: ti.template(), u, p, away):
        """Whether what is so many cells from contact p lies beyond a saddle that is known, or another contact."""
        side = ti.select(away > 0.0, 1.0, -1.0)
        other = self.beside(contacts, u, p, side)
        far, between = ti.abs(away), ti.select(side > 0.0, other, p)
        saddle = self.tables.wrapped(side * (contacts.saddle_first[u, between][0] - contacts.place_first[u, p][0]))
        contact = self.tables.wrapped(side * (contacts.place_first[u, other][0] - contacts.place_first[u, p][0]))
        return other != p and (far > contact or (contacts.saddle_first[u, between][0] >= 0.0 and far > saddle))
