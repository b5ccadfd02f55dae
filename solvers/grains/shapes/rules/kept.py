"""The memory of contacts of smooth outlines, and how contacts end in saddles."""

import taichi as ti

from solvers.grains.shapes.rules.rest import STILL, SURE
from solvers.grains.shapes.rules.tracked import NONE, Tracked
from solvers.machine.wide import enter
from solvers.space.extremes import greater, lesser

# Memory of a contact with a wall, and what a contact of two grains has in addition; *_BENT for non-convex outlines.
WALL, WALL_BENT = ("place_first",), ("saddle_first", SURE)
PAIR, PAIR_BENT = ("place_second",), ("saddle_second",)
MET = 1.0 / 64.0  # of an outline: a contact that is no longer found has ended in a saddle nearer than this


@ti.data_oriented
class Kept:
    """Places of contacts and of saddles, as stored in `ContactList`.

    `place_first` and `place_second` are the places of a contact on both outlines, `saddle_first` and `saddle_second`
    those of the saddle before it in the order along the first outline, or NONE. Contacts of a pair are adjacent
    entries. An ended or lost contact has its last place less one whole turn. `sure` is how far (m) the two may still
    move past each other until new contacts beside this one are looked for.
    """

    def __init__(self, tracked: Tracked, bent: bool):
        self.tracked, self.tables = tracked, tracked.tables
        self.met = MET * self.tables.cells
        self.wall_memory = WALL + (WALL_BENT if bent else ())
        self.pair_memory = self.wall_memory + PAIR + (PAIR_BENT if bent else ())

    @ti.func
    def is_lost(self, contacts: ti.template(), u, p):
        """Whether contact p has ended or is lost."""
        return contacts.place_first[u, p][0] < 0.0

    @ti.func
    def lose(self, contacts: ti.template(), u, p):
        """Mark contact p as ended or lost."""
        enter(contacts.place_first, u, p, 0, self.tables.wrapped(contacts.place_first[u, p][0]) - self.tables.cells)

    @ti.func
    def free(self, contacts: ti.template(), u, p):
        """Mark entry p as free: neither contact nor saddle."""
        enter(contacts.place_first, u, p, 0, -self.tables.cells)
        if ti.static(hasattr(contacts, "saddle_first")):
            enter(contacts.saddle_first, u, p, 0, NONE)

    @ti.func
    def beside(self, contacts: ti.template(), u, p, side):
        """The pair's next contact on a side (1 or −1) of p along the first outline; p if there is none."""
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
        """Whether another contact of p's pair is near this place already."""
        row, mate, found = self.row(contacts, u, p), contacts.mate[u, p][0], False
        for q in range(contacts.first[u, row], contacts.first[u, row + 1]):
            other = contacts.place_first[u, q][0]
            if contacts.mate[u, q][0] == mate and q != p and other >= 0.0:
                found = found or self.tracked.same(place, other, self.met)
        return found

    @ti.func
    def row(self, contacts: ti.template(), u, p):
        """Number of a contact's first grain within its unit, by which the list is sorted."""
        return contacts.first_of(u, p) - contacts.units.first(u)

    @ti.func
    def to_saddle(self, contacts: ti.template(), u, p, q):
        """Distance (cells) from contact p to the saddle before q; a whole turn if there is none."""
        saddle, place = contacts.saddle_first[u, q][0], contacts.place_first[u, p][0]
        return ti.select(saddle >= 0.0, self.tracked.distance(place, saddle), 1.0 * self.tables.cells)

    @ti.func
    def end(self, contacts: ti.template(), u, p, surely):
        """End contact p, which is no longer found, in the saddle before or after it, if one is near or `surely`."""
        after = self.beside(contacts, u, p, 1.0)
        own, following = self.to_saddle(contacts, u, p, p), self.to_saddle(contacts, u, p, after)
        if ti.min(own, following) < self.met or surely:
            if own <= following:
                self.end_with_own(contacts, u, p)
            else:
                self.end_before(contacts, u, p, after)

    @ti.func
    def end_saddle(self, contacts: ti.template(), u, p):
        """Remove the saddle before contact p, which is no longer found; a neighbouring contact near it ends with it."""
        before = self.beside(contacts, u, p, -1.0)
        own, other = self.to_saddle(contacts, u, p, p), self.to_saddle(contacts, u, before, p)
        if own < self.met and own <= other:
            self.end_with_own(contacts, u, p)
        elif other < self.met:
            self.end_before(contacts, u, before, p)
        else:
            enter(contacts.saddle_first, u, p, 0, NONE)

    @ti.func
    def end_with_own(self, contacts: ti.template(), u, p):
        """End contact p together with the saddle before it."""
        for side in ti.static((-1.0, 1.0)):
            enter(contacts.sure, u, self.beside(contacts, u, p, side), 0, 0.0)  # it has not looked beyond p
        if not self.is_lost(contacts, u, p):
            self.lose(contacts, u, p)
        enter(contacts.saddle_first, u, p, 0, NONE)

    @ti.func
    def end_before(self, contacts: ti.template(), u, p, after):
        """End contact p in the saddle before contact `after`, which takes over the saddle before p."""
        self.take_over_saddle(contacts, u, after, p)
        self.end_with_own(contacts, u, p)

    @ti.func
    def take_over_saddle(self, contacts: ti.template(), u, p, q):
        """Set the saddle before contact p to the one before q."""
        enter(contacts.saddle_first, u, p, 0, contacts.saddle_first[u, q][0])
        if ti.static(hasattr(contacts, "saddle_second")):
            enter(contacts.saddle_second, u, p, 0, contacts.saddle_second[u, q][0])
        if ti.static(hasattr(contacts, STILL)):
            enter(contacts.still, u, p, 0, 0.0)  # the stored saddle is no longer valid

    @ti.func
    def way_back(self, contacts: ti.template(), u, p, q):
        """Distance (cells) along the first outline from contact q onwards to p."""
        return self.tables.wrapped(contacts.place_first[u, p][0] - contacts.place_first[u, q][0])

    @ti.func
    def free_way(self, contacts: ti.template(), u, p, side):
        """Distance (cells) from contact p to the next known saddle or contact of its pair on a side; huge: none."""
        other = self.beside(contacts, u, p, side)
        between = ti.select(side > 0.0, other, p)
        place, saddle = contacts.place_first[u, p][0], contacts.saddle_first[u, between][0]
        way = self.tables.wrapped(side * (contacts.place_first[u, other][0] - place))
        way = ti.select(saddle >= 0.0, lesser(way, self.tables.wrapped(side * (saddle - place))), way)
        return ti.select(other == p, 2.0 * self.tables.cells, way)

    @ti.func
    def is_due(self, contacts: ti.template(), u, p):
        """Whether the grains have moved so far that new contacts beside contact p must be looked for."""
        return contacts.sure[u, p][0] <= 0.0

    @ti.func
    def look_again(self, contacts: ti.template(), u, p, sure, least):
        """Have the next look beside contact p be due when the grains have moved by `sure` (m), but at the `least` m."""
        enter(contacts.sure, u, p, 0, greater(sure, least))
