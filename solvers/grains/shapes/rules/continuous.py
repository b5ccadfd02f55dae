"""The rule for smooth outlines: contacts along common normals, each tracked from step to step."""

from math import pi

import taichi as ti

from solvers.grains.shapes.given import Shapes
from solvers.grains.shapes.grains import with_disc
from solvers.grains.shapes.pose import turned
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
)
from solvers.grains.shapes.rules.wall import SeenWalls, slopes
from solvers.grains.shapes.tables import TINY, Tables, advanced
from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.machine.wide import enter
from solvers.space.extremes import greater, lesser, within
from solvers.tank.walls import Walls

ROOM = 32  # most contacts of a grain with another grain or with one wall
NEAR = 1.0 / 16.0  # of both outlines' cells together: how far a contact may move between rebuilds and be identified
WIDE = 1.0 / 8.0  # of an outline: range on either side of a contact that is looked at for new ones
FORESIGHT = 0.5  # of the way after which the gap may get a new minimum at a place: it may be sooner between places
AGAIN = 1e-3  # of a grain's reach: the least way from one look to the next
# Elements of `Tracked.contact` that are passed on: for any contact, and for one between grains.
SAID = OVERLAP, NORMAL_Y, NORMAL_Z, POINT_Y, POINT_Z, HOLDS
SAID_OF_PAIR = *SAID, CURVED_I, CURVED_J
ATTEMPTS = 8  # Newton steps to find a contact again before it counts as ended or lost
GROWN = 2.0  # value of HOLDS for a contact that exists while its pair must be searched again


@ti.data_oriented
class Continuous:
    """Every local minimum of the gap between two outlines, or between one and a wall, is a contact of its own.

    A contact is stored by its places on the outlines and those of the saddle before it (`Tracked`), which are updated
    by one Newton step per time step. Contacts are sought when lists are rebuilt. If some outlines are non-convex
    (`bent`), there are saddles, and new ones are also looked for next to known contacts that overlap. A minimum and a
    saddle appear where the slope of the gap, which rises away from a contact, comes back to zero. It is found at places
    as far apart as those from which contacts are sought. As the grains move past each other by m, no slope there
    changes by more than m (κ_j/(1 + κ_j gap) + 1/R), with κ_j the curvature of the other outline and R the grains'
    reach, nor a gap by more than m. So the next look is due when the grains have moved by half of what the least slope
    or gap allows, however many steps that takes.
    """

    def __init__(self, arrays: State, units: Units, walls: Walls, shapes: Shapes, wide: int = 0):
        self.units = units
        self.outlines = outlines = with_disc(shapes)
        self.tables = Tables(arrays, outlines)
        self.tracked, self.walls = Tracked(self.tables), SeenWalls(arrays, walls)
        self.bent = not all(outline.convex for outline in shapes.outlines)
        self.rest = Rest(arrays, units, True) if self.bent else Osculating(arrays, units, outlines, wide=wide)
        self.kept = Kept(self.tracked, self.bent)
        self.pair_memory, self.wall_memory = self.kept.pair_memory, self.kept.wall_memory
        self.farthest, self.most = NEAR * self.tables.cells, ROOM
        self.places = Places(arrays, units.axis, ROOM)
        self.spacing = self.tables.cells // self.tracked.looks
        self.places_aside = int(WIDE * self.tracked.looks)

    @ti.func
    def seek_pair(self, g: ti.template(), w, i, j, margin, u):
        """Find the contacts of two grains with gaps below a margin (m); returns their number."""
        one, two = g.outline(w, i), g.outline(w, j)
        return self.tracked.scan(one, two, g.apart(w, i, j), margin, self.places, u)

    @ti.func
    def away(self, contacts: ti.template(), u, q, k):
        """Distance (cells) from contact q of the old list to the k-th contact found for the same pair."""
        place = contacts.old_place_first[u, q][0]
        far = self.tracked.distance(place, self.places.i[u, k])
        if ti.static(hasattr(contacts, "place_second")):
            far += self.tracked.distance(contacts.old_place_second[u, q][0], self.places.j[u, k])
        # The memory of a lost contact is not used.
        return ti.select(place < 0.0, self.farthest, far)

    @ti.func
    def was_known(self, contacts: ti.template(), u, q):
        """Whether contact q of the old list was not lost."""
        return contacts.old_place_first[u, q][0] >= 0.0

    @ti.func
    def note(self, contacts: ti.template(), u, p, k):
        """Set contact p to the places of the k-th contact found."""
        enter(contacts.place_first, u, p, 0, self.places.i[u, k])
        if ti.static(hasattr(contacts, "place_second")):
            enter(contacts.place_second, u, p, 0, self.places.j[u, k])
        if ti.static(self.bent):
            enter(contacts.saddle_first, u, p, 0, self.places.saddle_i[u, k])
            if ti.static(hasattr(contacts, "saddle_second")):
                enter(contacts.saddle_second, u, p, 0, self.places.saddle_j[u, k])

    @ti.func
    def places_for_pair(self, g: ti.template(), w, i, j, most):
        """Number of entries for the contacts of two grains: one if both are convex, else `most`."""
        return ti.select(self.tables.convex[g.shape[w, i]] * self.tables.convex[g.shape[w, j]] > 0.0, 1, most)

    @ti.func
    def places_for_wall(self, g: ti.template(), w, i, most):
        """Number of entries for the contacts of a grain with a wall: one if it is convex, else `most`."""
        return ti.select(self.tables.convex[g.shape[w, i]] > 0.0, 1, most)

    @ti.func
    def free(self, contacts: ti.template(), u, p):
        """Mark entry p as free."""
        self.kept.free(contacts, u, p)

    @ti.func
    def is_lost(self, contacts: ti.template(), u, p):
        """Whether contact p has ended or is lost."""
        return self.kept.is_lost(contacts, u, p)

    @ti.func
    def lose(self, contacts: ti.template(), u, p):
        """Mark contact p as ended or lost."""
        self.kept.lose(contacts, u, p)

    @ti.func
    def pair(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moves: ti.template()):
        """Contact p of grains i and j: overlap (m), normal towards i, point from i's centre (m), whether it holds.

        The last is 0 if the contact no longer exists, 1 if it does, and GROWN if there are also unlisted contacts next
        to it. Unless it `moves`, the contact is evaluated at its stored places.
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
                    enter(pairs.place_second, u, p, 0, b)
                    if ti.static(self.bent):  # noqa: SIM102 (compiled only there)
                        if c[OVERLAP] > 0.0:
                            c[HOLDS] = ti.select(self.grown(g, pairs, w, i, j, u, p), GROWN, 1.0)
            else:
                c = self.between(g, MINIMUM, False, w, i, j, a, b)
            contact = ti.Vector([c[n] for n in ti.static(SAID_OF_PAIR)])
        return contact

    @ti.func
    def keep(self, contacts: ti.template(), u, p, c, tries):
        """Store the place of contact p after `tries` Newton steps, or that it has ended; returns whether it exists.

        A contact that has moved far may have converged to another one of its pair: then it has ended.
        """
        holds = c[HOLDS]
        if ti.static(self.bent):
            far = tries > 1 or not self.tracked.same(c[PLACE_I], contacts.place_first[u, p][0], ALIKE)
            if holds > 0.0 and far and self.kept.has_twin(contacts, u, p, c[PLACE_I]):
                holds = 0.0
            if holds == 0.0:
                self.kept.end(contacts, u, p, c[HOLDS] > 0.0)
        if holds > 0.0:
            enter(contacts.place_first, u, p, 0, c[PLACE_I])
        return holds

    @ti.func
    def pair_saddle(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moves: ti.template()):
        """The saddle before contact p of grains i and j, in the form of `pair`."""
        contact, a = self.nothing(g, w, i, rest.HOLDS + 1), pairs.saddle_first[u, p][0]
        if a >= 0.0:
            # In the step in which it ends it still counts, like the contact that ends with it.
            c = self.between(g, SADDLE, moves, w, i, j, a, pairs.saddle_second[u, p][0])
            contact = ti.Vector([c[n] for n in ti.static(SAID)])
            if ti.static(moves):
                if c[HOLDS] > 0.0:
                    enter(pairs.saddle_first, u, p, 0, c[PLACE_I])
                    enter(pairs.saddle_second, u, p, 0, c[PLACE_J])
                else:
                    self.kept.end_saddle(pairs, u, p)
        return contact

    @ti.func
    def grown(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p):
        """Whether a new contact and saddle have appeared next to an overlapping contact, or a saddle is missing."""
        new = False
        if (
            self.kept.is_due(pairs, u, p)
            and self.tables.convex[g.shape[w, i]] * self.tables.convex[g.shape[w, j]] == 0.0
        ):
            one, two, apart = g.outline(w, i), g.outline(w, j), g.apart(w, i, j)
            a, sure, turns = pairs.place_first[u, p][0], pairs.reach[u, p][0], 1.0 / pairs.reach[u, p][0]
            along = ti.static(self.spacing) * g.radius[w, i] / g.radius[w, j]
            for turn in range(2):
                side, b, k = 1.0 - 2.0 * turn, pairs.place_second[u, p][0], 1
                way = self.kept.free_way(pairs, u, p, side)
                known = way < self.tables.cells
                while k <= self.places_aside and k * self.spacing < way and not new:
                    c = self.tracked.fall(one, two, apart, a + side * k * self.spacing, b - side * along)
                    b, new = c[1], c[2] < 0.0 and side * c[0] > 0.0
                    sure = lesser(sure, greater(c[2], -FORESIGHT * side * c[0] / (c[3] + turns)))
                    # A known contact beyond a gap overlaps on its own.
                    k = ti.select(known and c[2] > 0.0, self.places_aside + 1, k + 1)
            before = self.kept.beside(pairs, u, p, -1.0)
            back = ti.select(before == p, 0.0, self.kept.way_back(pairs, u, p, before))
            if not new and back > 0.0 and back < 0.5 * self.tables.cells and pairs.saddle_first[u, p][0] < 0.0:
                b = pairs.place_second[u, p][0] + 0.5 * back * g.radius[w, i] / g.radius[w, j]
                new = self.tracked.fall(one, two, apart, a - 0.5 * back, b)[2] < 0.0
            self.kept.look_again(pairs, u, p, ti.select(new, 0.0 * sure, sure), AGAIN * pairs.reach[u, p][0])
        return new

    @ti.func
    def nothing(self, g: ti.template(), w, i, elements: ti.template()):
        """A vector for no contact, with a given number of elements."""
        return ti.Vector([-g.reach[w, i] if n == 0 else 0.0 * g.reach[w, i] for n in ti.static(range(elements))])

    @ti.func
    def between(self, g: ti.template(), way: ti.template(), moves: ti.template(), w, i, j, a, b):
        """The contact or saddle of two grains at these places; see `Tracked.contact`."""
        one, two = g.outline(w, i), g.outline(w, j)
        return self.tracked.contact(moves, way, one, two, g.apart(w, i, j), a, b)

    @ti.func
    def seek_wall(self, g: ti.template(), w, i, feature, shift: ti.template(), margin, u):
        """Find the contacts of a grain with a wall with gaps below a margin (m); returns their number."""
        found, looks = 0, ti.static(self.tracked.looks)
        stride = ti.static(self.tables.cells // self.tracked.looks)
        target = self.walls.target(g, w, i, feature, shift)
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
        """The contact or saddle to which Newton's method converges from a place; HOLDS is 0 if it does not."""
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
        """Find the contact near a place and store it if it is new; returns the new number of contacts."""
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
    def rough_gap(self, outline: ti.template(), feature, target, cell):
        """Gap to a segment, or squared distance to a corner, at the start of a cell; it is least near a contact."""
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
        """Contact p of grain i with a wall, in the form of `pair`; no overlap if it belongs to another feature."""
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
        """The saddle before contact p of grain i with a wall, in the form of `wall`."""
        contact, place = self.nothing(g, w, i, rest.HOLDS + 1), contacts.saddle_first[u, p][0]
        if place >= 0.0:
            c = self.at_wall(g, SADDLE, moves, w, i, feature, shift, place)
            contact = ti.Vector([c[n] for n in ti.static(SAID)])
            if ti.static(moves):
                if c[HOLDS] > 0.0:
                    enter(contacts.saddle_first, u, p, 0, c[PLACE_I])
                else:
                    self.kept.end_saddle(contacts, u, p)
        return contact

    @ti.func
    def grown_on_wall(self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p):
        """As `grown`, for a grain on a segment, along which its slopes change as it turns alone."""
        new = False
        if self.kept.is_due(contacts, u, p) and self.tables.convex[g.shape[w, i]] == 0.0:
            target, a, sure = self.walls.target(g, w, i, feature, shift), contacts.place_first[u, p][0], g.reach[w, i]
            for turn in range(2):
                side, k = 1.0 - 2.0 * turn, 1
                way = self.kept.free_way(contacts, u, p, side)
                known = way < self.tables.cells
                while k <= self.places_aside and k * self.spacing < way and not new:
                    own = g.radius[w, i] * self.tables.trace(g.shape[w, i], a + side * k * self.spacing)
                    gap = target[2] + own[0] * target[0] + own[1] * target[1]
                    rise = side * (own[2] * target[0] + own[3] * target[1])
                    new = gap < 0.0 and rise < 0.0
                    rise *= FORESIGHT * g.reach[w, i] / ti.sqrt(own[2] * own[2] + own[3] * own[3])
                    sure = lesser(sure, greater(gap, rise))
                    k = ti.select(known and gap > 0.0, self.places_aside + 1, k + 1)
            self.kept.look_again(contacts, u, p, ti.select(new, 0.0 * sure, sure), AGAIN * g.reach[w, i])
        return new

    @ti.func
    def at_wall(
        self, g: ti.template(), way: ti.template(), moves: ti.template(), w, i, feature, shift: ti.template(), place
    ):
        """The contact or saddle of a grain with a wall near a place, in the tank's frame; see `against`."""
        outline = g.outline(w, i)
        c = self.against(outline, feature, self.walls.target(g, w, i, feature, shift), way, place, moves)
        normal = turned(g.turn(w, i), ti.Vector([c[NORMAL_Y], c[NORMAL_Z]]))
        point = turned(g.turn(w, i), ti.Vector([c[POINT_Y], c[POINT_Z]]))
        counts = self.walls.counts_on_corner(feature, shift, normal[0], normal[1])
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
        s = slopes(own, target, corner)
        if ti.static(moves):
            step = -way * within(s[0] / (ti.abs(s[1]) + TINY), ti.static(LONGEST * self.tables.cells / (2.0 * pi)))
            a, own = place + step, advanced(own, step)
            s = slopes(own, target, corner)
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
