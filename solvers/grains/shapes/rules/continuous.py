"""The rule of smooth outlines: contacts along common normals, each followed from step to step."""

from math import pi

import taichi as ti

from solvers.grains.laws.extremes import within
from solvers.grains.shapes.given import Shapes
from solvers.grains.shapes.grains import with_disc
from solvers.grains.shapes.pose import turned, turned_back
from solvers.grains.shapes.rules import osculating, rest
from solvers.grains.shapes.rules.kept import Kept
from solvers.grains.shapes.rules.osculating import Osculating
from solvers.grains.shapes.rules.rest import Rest
from solvers.grains.shapes.rules.tracked import (
    ALIKE,
    CLOSE,
    CURVED_I,
    CURVED_J,
    DEEP,
    HOLDS,
    LONGEST,
    MINIMUM,
    NONE,
    NORMAL_Y,
    NORMAL_Z,
    OVERLAP,
    PLACE_I,
    PLACE_J,
    POINT_Y,
    POINT_Z,
    SADDLE,
    SETTLED,
    TRIES,
    Places,
    Tracked,
    advanced,
)
from solvers.grains.shapes.rules.wall import SeenWalls
from solvers.grains.shapes.tables import TINY, Tables
from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.tank.walls import Walls

ROOM = 32  # contacts of a grain with another, or with one wall, at most
NEAR = 1.0 / 16.0  # of the outlines, together: how far a contact may go between lists and be known again
PLACES = 8  # on either side of a contact, where others may come up
# Elements of `Tracked.contact` that are passed on: of any contact, and of one between grains.
SAID = OVERLAP, NORMAL_Y, NORMAL_Z, POINT_Y, POINT_Z, HOLDS
SAID_OF_PAIR = *SAID, CURVED_I, CURVED_J
WIDE = 1.0 / 8.0  # of an outline: what they span
ATTEMPTS = 8  # of Newton's method to find a contact again before it has ended or been lost
GROWN = 2.0  # a contact that holds and wants new lists
SELDOM = 4  # steps from one look at such a place to the next


@ti.data_oriented
class Continuous:
    """Every local minimum of the gap between two outlines, or between one and a wall, is a contact of its own.

    A contact is remembered by the places on the outlines where it is, and where the saddle before it is (`Tracked`);
    one step of Newton's method a time step keeps it there. They are sought where lists are made, and where outlines
    are `bent` also beside those that are known, a place at a time. Only these have saddles.
    """

    def __init__(self, arrays: State, units: Units, walls: Walls, shapes: Shapes):
        self.units = units
        outlines = with_disc(shapes)
        self.tables = Tables(arrays, outlines)
        self.tracked, self.walls = Tracked(self.tables), SeenWalls(arrays, walls)
        self.bent = not all(outline.convex for outline in shapes.outlines)
        self.rest = Rest(arrays, units, True) if self.bent else Osculating(arrays, units, outlines)
        self.kept = Kept(self.tracked, self.bent)
        self.pair_memory, self.wall_memory = self.kept.pair_memory, self.kept.wall_memory
        self.farthest, self.most = NEAR * self.tables.cells, ROOM
        self.places = Places(arrays, units.axis, ROOM)

    @ti.func
    def seek_pair(self, g: ti.template(), w, i, j, margin, u):
        """Find the contacts of two grains with gaps below a margin (m); returns how many there are."""
        one, two = g.outline(w, i), g.outline(w, j)
        return self.tracked.scan(one, two, g.apart(w, i, j), margin, self.places, u)

    @ti.func
    def away(self, contacts: ti.template(), u, q, k):
        """How far (cells) contact q of an old list is from the k-th that has been found of the same two."""
        place = contacts.old_place_first[u, q][0]
        far = self.tracked.distance(place, self.places.i[u, k])
        if ti.static(hasattr(contacts, "place_second")):
            far += self.tracked.distance(contacts.old_place_second[u, q][0], self.places.j[u, k])
        # One that has been lost has nothing to hand on.
        return ti.select(place < 0.0, self.farthest, far)

    @ti.func
    def was_known(self, contacts: ti.template(), u, q):
        """Whether contact q of an old list had not been lost sight of."""
        return contacts.old_place_first[u, q][0] >= 0.0

    @ti.func
    def note(self, contacts: ti.template(), u, p, k):
        """Contact p is where the k-th has been found; it is free where there are not so many."""
        contacts.place_first[u, p][0] = self.places.i[u, k]
        if ti.static(hasattr(contacts, "place_second")):
            contacts.place_second[u, p][0] = self.places.j[u, k]
        if ti.static(self.bent):
            contacts.saddle_first[u, p][0] = self.places.saddle_i[u, k]
            if ti.static(hasattr(contacts, "saddle_second")):
                contacts.saddle_second[u, p][0] = self.places.saddle_j[u, k]

    @ti.func
    def places_for_pair(self, g: ti.template(), w, i, j, most):
        """Room to leave for contacts of two grains: convex ones have but one, for others there is room for `most`."""
        return ti.select(self.tables.convex[g.shape[w, i]] * self.tables.convex[g.shape[w, j]] > 0.0, 1, most)

    @ti.func
    def places_for_wall(self, g: ti.template(), w, i, most):
        """The same for a grain and a wall."""
        return ti.select(self.tables.convex[g.shape[w, i]] > 0.0, 1, most)

    @ti.func
    def free(self, contacts: ti.template(), u, p):
        """Contact p is none."""
        contacts.place_first[u, p][0] = -self.tables.cells
        if ti.static(self.bent):
            contacts.saddle_first[u, p][0] = NONE

    @ti.func
    def is_lost(self, contacts: ti.template(), u, p):
        """Whether contact p has ended or been lost sight of."""
        return self.kept.is_lost(contacts, u, p)

    @ti.func
    def lose(self, contacts: ti.template(), u, p):
        """Remember that it has."""
        self.kept.lose(contacts, u, p)

    @ti.func
    def pair(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moves: ti.template()):
        """Contact p of grains i and j: overlap (m), normal towards i, point from i's centre (m), whether it holds.

        This is 0 if not, 1 if so, and GROWN if there are others beside it that are not listed. Unless it `moves`, it
        is looked at where it was found last.
        """
        contact = self.nothing(g, w, i, osculating.CURVED_J + 1)
        if not self.is_lost(pairs, u, p):
            c, a, b = self.nothing(g, w, i, CURVED_J + 1), pairs.place_first[u, p][0], pairs.place_second[u, p][0]
            if ti.static(moves):
                tries = 0
                while c[HOLDS] == 0.0 and tries < ATTEMPTS:
                    c = self.between(g, MINIMUM, True, w, i, j, a, b)
                    a, b, tries = c[PLACE_I], c[PLACE_J], tries + 1
                c[HOLDS] = self.keep(pairs, u, p, c, tries)
                if c[HOLDS] > 0.0:
                    pairs.place_second[u, p][0] = b
                    if ti.static(self.bent):  # noqa: SIM102 (compiled only there)
                        if c[OVERLAP] > 0.0:
                            c[HOLDS] = ti.select(self.grown(g, pairs, w, i, j, u, p), GROWN, 1.0)
            else:
                c = self.between(g, MINIMUM, False, w, i, j, a, b)
            contact = ti.Vector([c[n] for n in ti.static(SAID_OF_PAIR)])
        return contact

    @ti.func
    def keep(self, contacts: ti.template(), u, p, c, tries):
        """Note where contact p has gone in so many steps of Newton's method, or that it has ended; returns if it holds.

        One that has come far may have come to another: it is then the same.
        """
        holds = c[HOLDS]
        if ti.static(self.bent):
            far = tries > 1 or not self.tracked.same(c[PLACE_I], contacts.place_first[u, p][0], ALIKE)
            if holds > 0.0 and far and self.kept.has_twin(contacts, u, p, c[PLACE_I]):
                holds = 0.0
            if holds == 0.0:
                self.kept.end(contacts, u, p, c[HOLDS] > 0.0)
        if holds > 0.0:
            contacts.place_first[u, p][0] = c[PLACE_I]
        return holds

    @ti.func
    def pair_saddle(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moves: ti.template()):
        """The saddle before contact p of grains i and j, as `pair`."""
        contact, a = self.nothing(g, w, i, rest.HOLDS + 1), pairs.saddle_first[u, p][0]
        if a >= 0.0:
            # It counts a last time where it ends, as the contact does that ends with it.
            c = self.between(g, SADDLE, moves, w, i, j, a, pairs.saddle_second[u, p][0])
            contact = ti.Vector([c[n] for n in ti.static(SAID)])
            if ti.static(moves):
                if c[HOLDS] > 0.0:
                    pairs.saddle_first[u, p][0], pairs.saddle_second[u, p][0] = c[PLACE_I], c[PLACE_J]
                else:
                    self.kept.end_saddle(pairs, u, p)
        return contact

    @ti.func
    def next_look(self, contacts: ti.template(), u, p):
        """Where to look beside contact p now: so many cells from it, to either side by turns; mostly 0: nowhere."""
        k = contacts.looked[u, p][0] + 1.0
        k = ti.select(k < SELDOM * 2.0 * PLACES, k, 0.0)
        contacts.looked[u, p][0] = k
        turn = ti.cast(k, ti.i32)
        look = turn // SELDOM
        away = (1.0 + look // 2) * ti.static(WIDE * self.tables.cells / PLACES)
        return ti.select(turn % SELDOM == 0, ti.select(look % 2 == 0, away, -away), 0.0 * away)

    @ti.func
    def grown(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p):
        """Whether beside a contact that overlaps another has come up with a saddle, or a saddle is missing."""
        away, new = self.next_look(pairs, u, p), False
        if away != 0.0 and self.tables.convex[g.shape[w, i]] * self.tables.convex[g.shape[w, j]] == 0.0:
            side, before = ti.select(away > 0.0, 1.0, -1.0), self.kept.beside(pairs, u, p, -1.0)
            back = ti.select(before == p, 0.0, self.kept.way_back(pairs, u, p, before))
            missing = side < 0.0 and back > 0.0 and back < 0.5 * self.tables.cells and pairs.saddle_first[u, p][0] < 0.0
            away = ti.select(missing, -0.5 * back, away)
            a = pairs.place_first[u, p][0] + away
            b = pairs.place_second[u, p][0] - away * g.radius[w, i] / g.radius[w, j]
            one, two = g.outline(w, i), g.outline(w, j)
            c = self.tracked.fall(one, two, g.apart(w, i, j), a, b)
            new = c[2] < 0.0 and (missing or (side * c[0] > 0.0 and not self.kept.beyond(pairs, u, p, away)))
        return new

    @ti.func
    def nothing(self, g: ti.template(), w, i, elements: ti.template()):
        """No contact, with so many elements."""
        return ti.Vector([-g.reach[w, i] if n == 0 else 0.0 * g.reach[w, i] for n in ti.static(range(elements))])

    @ti.func
    def between(self, g: ti.template(), way: ti.template(), moves: ti.template(), w, i, j, a, b):
        """What there is between two grains at these places; see `Tracked.contact`."""
        one, two = g.outline(w, i), g.outline(w, j)
        return self.tracked.contact(moves, way, one, two, g.apart(w, i, j), a, b)

    @ti.func
    def seek_wall(self, g: ti.template(), w, i, feature, shift: ti.template(), margin, u):
        """Find the contacts of a grain with a wall at gaps below a margin (m); returns how many there are."""
        found, looks = 0, ti.static(self.tracked.looks)
        stride = ti.static(self.tables.cells // self.tracked.looks)
        target = self.target(g, w, i, feature, shift)
        outline = g.outline(w, i)
        earlier = self.rough_gap(outline, feature, target, -2 * stride)
        last = self.rough_gap(outline, feature, target, -stride)
        for k in range(looks):
            gap = self.rough_gap(outline, feature, target, k * stride)
            if last <= earlier and last < gap:
                found = self.settle(outline, feature, target, 0.0 * margin + (k - 1) * stride, margin, u, found)
            earlier, last = last, gap
        if ti.static(self.bent):
            self.tracked.put_in_order(self.places, u, found)
            for k in range(found):
                self.places.saddle_i[u, k] = NONE
                if found > 1 and feature < self.walls.walls.segments:
                    along = self.tables.wrapped(self.places.i[u, k] - self.places.i[u, (k + found - 1) % found])
                    c = self.followed(outline, feature, target, SADDLE, self.places.i[u, k] - 0.5 * along)
                    between = self.tables.wrapped(self.places.i[u, k] - c[PLACE_I]) < along
                    if c[HOLDS] > 0.0 and between and -c[OVERLAP] < margin:
                        self.places.saddle_i[u, k] = c[PLACE_I]
        return found

    @ti.func
    def followed(self, outline: ti.template(), feature, target, way: ti.template(), start):
        """What Newton's method leads to from a place; it does not hold where it leads to nothing."""
        c, place, settled = ti.Vector([0.0 * start for _ in ti.static(range(HOLDS + 1))]), start, False
        for _ in range(TRIES):
            c = self.against(outline, feature, target, way, place, True)
            settled = self.tracked.same(c[PLACE_I], place, SETTLED)
            place = c[PLACE_I]
            if settled:
                break
        if not settled:
            c[HOLDS] = 0.0
        return c

    @ti.func
    def settle(self, outline: ti.template(), feature, target, start, margin, u, before):
        """Follow a place to the contact near by, write it down if it is new; returns how many there are."""
        found, c = before, self.followed(outline, feature, target, MINIMUM, start)
        place, fresh = c[PLACE_I], c[HOLDS] > 0.0 and -c[OVERLAP] < margin and before < ROOM
        for k in range(before):
            if self.tracked.same(place, self.places.i[u, k], ALIKE):
                fresh = False
        if fresh:
            self.places.i[u, before] = place
            found += 1
        return found

    @ti.func
    def target(self, g: ti.template(), w, i, feature, shift: ti.template()):
        """A wall in a grain's frame: a segment's normal and its distance (m) from the centre, or where a corner is."""
        seen = ti.Vector([ti.cast(0.0, g.real), ti.cast(0.0, g.real), ti.cast(0.0, g.real)])
        if feature < self.walls.walls.segments:
            face = self.walls.facing(feature, shift, g.y[w, i], g.z[w, i])
            normal = turned_back(g.turn(w, i), ti.Vector([ti.cast(face[0], g.real), ti.cast(face[1], g.real)]))
            seen = ti.Vector([normal[0], normal[1], ti.cast(face[2], g.real)])
        else:
            point = self.walls.walls.from_start(feature, shift, g.y[w, i], g.z[w, i])
            corner = turned_back(g.turn(w, i), -ti.Vector([ti.cast(point[0], g.real), ti.cast(point[1], g.real)]))
            seen = ti.Vector([corner[0], corner[1], ti.cast(0.0, g.real)])
        return seen

    @ti.func
    def rough_gap(self, outline: ti.template(), feature, target, cell):
        """What has a local minimum where a contact is, at the start of a cell of the outline."""
        at, shape = cell & (self.tables.cells - 1), outline.shape
        x, y = outline.scale * self.tables.curve[shape, at, 0], outline.scale * self.tables.curve[shape, at, 4]
        gap = target[2] + x * target[0] + y * target[1]
        if feature >= self.walls.walls.segments:
            gap = (x - target[0]) ** 2 + (y - target[1]) ** 2
        return gap

    @ti.func
    def wall(
        self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p, moves: ti.template()
    ):
        """Contact p of grain i with a wall, as `pair`; it does not count where it is another feature's."""
        contact = self.nothing(g, w, i, rest.HOLDS + 1)
        if not self.is_lost(contacts, u, p):
            c, place = self.nothing(g, w, i, HOLDS + 1), contacts.place_first[u, p][0]
            if ti.static(moves):
                tries = 0
                while c[HOLDS] == 0.0 and tries < ATTEMPTS:
                    c = self.at_wall(g, MINIMUM, True, w, i, feature, shift, place)
                    place, tries = c[PLACE_I], tries + 1
                c[HOLDS] = self.keep(contacts, u, p, c, tries)
                if ti.static(self.bent):  # noqa: SIM102 (compiled only there)
                    if c[HOLDS] > 0.0 and c[OVERLAP] > 0.0 and feature < self.walls.walls.segments:
                        c[HOLDS] = ti.select(self.grown_on_wall(g, contacts, w, i, feature, shift, u, p), GROWN, 1.0)
            else:
                c = self.at_wall(g, MINIMUM, False, w, i, feature, shift, place)
            contact = ti.Vector([c[n] for n in ti.static(SAID)])
        return contact

    @ti.func
    def wall_saddle(
        self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p, moves: ti.template()
    ):
        """The saddle before contact p of grain i with a wall, as `wall`."""
        contact, place = self.nothing(g, w, i, rest.HOLDS + 1), contacts.saddle_first[u, p][0]
        if place >= 0.0:
            c = self.at_wall(g, SADDLE, moves, w, i, feature, shift, place)
            contact = ti.Vector([c[n] for n in ti.static(SAID)])
            if ti.static(moves):
                if c[HOLDS] > 0.0:
                    contacts.saddle_first[u, p][0] = c[PLACE_I]
                else:
                    self.kept.end_saddle(contacts, u, p)
        return contact

    @ti.func
    def grown_on_wall(self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p):
        """As `grown`, of a grain on a segment."""
        away, new = self.next_look(contacts, u, p), False
        if away != 0.0 and self.tables.convex[g.shape[w, i]] == 0.0:
            target, a = self.target(g, w, i, feature, shift), contacts.place_first[u, p][0] + away
            own = g.radius[w, i] * self.tables.trace(g.shape[w, i], a)
            inside = target[2] + own[0] * target[0] + own[1] * target[1] < 0.0
            falls = away * (own[2] * target[0] + own[3] * target[1]) < 0.0
            new = inside and falls and not self.kept.beyond(contacts, u, p, away)
        return new

    @ti.func
    def at_wall(
        self, g: ti.template(), way: ti.template(), moves: ti.template(), w, i, feature, shift: ti.template(), place
    ):
        """What there is between a grain and a wall near a place, in the tank's frame; see `against`."""
        outline = g.outline(w, i)
        c = self.against(outline, feature, self.target(g, w, i, feature, shift), way, place, moves)
        normal = turned(g.turn(w, i), ti.Vector([c[NORMAL_Y], c[NORMAL_Z]]))
        point = turned(g.turn(w, i), ti.Vector([c[POINT_Y], c[POINT_Z]]))
        counts = self.walls.counts_on_corner(feature, normal[0], normal[1])
        if feature < self.walls.walls.segments:
            counts = self.walls.counts_on_segment(feature, shift, g.y[w, i] + point[0], g.z[w, i] + point[1])
        overlap = ti.select(counts, c[OVERLAP], -g.reach[w, i])
        return ti.Vector([overlap, normal[0], normal[1], point[0], point[1], c[PLACE_I], c[PLACE_J], c[HOLDS]])

    @ti.func
    def against(self, outline: ti.template(), feature, target, way: ti.template(), place, moves: ti.template()):
        """The contact of an outline with a wall near a place, all in the grain's frame; see `Tracked.contact`.

        The gap to a segment of normal m is least where p' · m = 0, that to a corner q where p' · (p − q) = 0.
        """
        shape, scale, corner = outline.shape, outline.scale, feature >= self.walls.walls.segments
        a, own = place, scale * self.tables.trace(shape, place)
        s = self.slopes(own, target, corner)
        if ti.static(moves):
            step = -way * within(s[0] / (ti.abs(s[1]) + TINY), ti.static(LONGEST * self.tables.cells / (2.0 * pi)))
            a, own = place + step, advanced(own, step)
            s = self.slopes(own, target, corner)
        inverse = 1.0 / ti.sqrt(s[2])
        outward = ti.Vector([own[3], -own[2]]) * inverse
        gap = target[2] + own[0] * target[0] + own[1] * target[1]
        ny, nz, miss = target[0], target[1], s[0] * inverse
        if corner:
            gap = (target[0] - own[0]) * outward[0] + (target[1] - own[1]) * outward[1]
            ny, nz, miss = -outward[0], -outward[1], miss / (scale * self.tables.smallest[shape])
        facing = outward[0] * ny + outward[1] * nz
        near = -gap < DEEP * scale * self.tables.smallest[shape]
        holds = ti.select(near and way * s[1] > 0.0 and ti.abs(miss) < CLOSE and facing < 0.0, 1.0, 0.0)
        return ti.Vector([-gap, ny, nz, own[0], own[1], self.tables.wrapped(a), 0.0 * a, holds])

    @ti.func
    def slopes(self, own, target, corner):
        """First and second derivative of the gap (its half square, for a corner) by the place, and |p'|²."""
        x, y = target[0], target[1]
        size = own[2] * own[2] + own[3] * own[3]
        more = 0.0 * x
        if corner:
            x, y, more = own[0] - target[0], own[1] - target[1], size
        return ti.Vector([own[2] * x + own[3] * y, own[4] * x + own[5] * y + more, size])
