"""The rule of smooth outlines: contacts along common normals, each followed from step to step."""

from math import pi

import taichi as ti

from solvers.laws.extremes import greater, within
from solvers.runtime import Arrays
from solvers.shapes.given import Shapes
from solvers.shapes.grains import with_disc
from solvers.shapes.pose import turned, turned_back
from solvers.shapes.tables import TINY, Tables
from solvers.shapes.tracked import (
    ALIKE,
    CLOSE,
    DEEP,
    HOLDS,
    LONGEST,
    NORMAL_Y,
    NORMAL_Z,
    OVERLAP,
    PLACE_I,
    PLACE_J,
    POINT_Y,
    POINT_Z,
    SETTLED,
    TRIES,
    Tracked,
    advanced,
)
from solvers.shapes.wall import SeenWalls
from solvers.units import Units
from solvers.walls import Walls

ROOM = 8  # contacts of a grain with another, or with one wall, at most
FIRST, BORN, SECOND = range(3)  # what is remembered of a contact: see Continuous.pair_memory
LOOSE = 1.0 / 8.0  # what counts of the way that a contact has gone since it was lost sight of
UNKNOWN = -1.0  # where it has yet to be seen how deep a contact is
NEAR = 1.0 / 16.0  # of the outlines, together: how far a contact may go between lists and be known again


@ti.data_oriented
class Continuous:
    """Every local minimum of the gap between two outlines, or between one and a wall, is a contact of its own.

    A contact is remembered by the places on the outlines where it is (`Tracked`); one step of Newton's method a time
    step keeps it there. They are sought where lists are made.
    """

    pair_memory, wall_memory = ("place_first", "born", "place_second"), ("place_first", "born")

    def __init__(self, arrays: Arrays, units: Units, walls: Walls, shapes: Shapes):
        self.units = units
        self.tables = Tables(arrays, with_disc(shapes))
        self.tracked, self.walls = Tracked(self.tables), SeenWalls(arrays, walls)
        self.farthest = NEAR * self.tables.cells
        self.places_first, self.places_second = arrays.reals(2, (units.count, ROOM), kept=False)

    @ti.func
    def seek_pair(self, g: ti.template(), w, i, j, margin, u):
        """Find the contacts of two grains with gaps below a margin (m); returns how many there are."""
        return self.tracked.scan(
            g.shape[w, i],
            g.radius[w, i],
            g.turn(w, i),
            g.shape[w, j],
            g.radius[w, j],
            g.turn(w, j),
            g.apart(w, i, j),
            margin,
            self.places_first,
            self.places_second,
            u,
        )

    @ti.func
    def away(self, contacts: ti.template(), u, q, k):
        """How far (cells) contact q of an old list is from the k-th that has been found of the same two."""
        far = self.tracked.distance(contacts.old_more[FIRST][u, q][0], self.places_first[u, k])
        if ti.static(len(contacts.more) > SECOND):
            far += self.tracked.distance(contacts.old_more[SECOND][u, q][0], self.places_second[u, k])
        if contacts.old_more[FIRST][u, q][0] < 0.0:
            far *= LOOSE
        return far

    @ti.func
    def note(self, contacts: ti.template(), u, p, k, late):
        """Contact p is where the k-th has been found; it comes `late` where the two were in the old list without it."""
        contacts.more[FIRST][u, p][0] = self.places_first[u, k]
        if ti.static(len(contacts.more) > SECOND):
            contacts.more[SECOND][u, p][0] = self.places_second[u, k]
            if late:  # of two grains alone: what rolls on a wall would sink into it
                contacts.more[BORN][u, p][0] = UNKNOWN

    @ti.func
    def is_lost(self, contacts: ti.template(), u, p):
        """Whether contact p has been lost sight of."""
        return contacts.more[FIRST][u, p][0] < 0.0

    @ti.func
    def lose(self, contacts: ti.template(), u, p):
        """Remember that it has: its place, where it was last seen, is said a whole turn too low."""
        contacts.more[FIRST][u, p][0] = self.tables.wrapped(contacts.more[FIRST][u, p][0]) - self.tables.cells

    @ti.func
    def counted(self, contacts: ti.template(), u, p, c: ti.template(), moves: ti.template()):
        """The part of the overlap of contact p that counts.

        Where two outlines overlap already, a bend of them can make a second contact of what was one. Counted from
        nothing it would come with energy, so it counts from what it was at first, or has been at least since then.
        """
        born, whole = contacts.more[BORN][u, p][0], greater(c[OVERLAP], 0.0)
        if born == UNKNOWN or born > whole:
            born = whole
        if ti.static(moves):  # noqa: SIM102 (compiled only there)
            if c[HOLDS] > 0.0:
                contacts.more[BORN][u, p][0] = born
        return c[OVERLAP] - born

    @ti.func
    def pair(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moves: ti.template()):
        """Contact p of grains i and j: overlap (m), normal towards i, point from i's centre (m), whether it holds.

        Unless it `moves`, it is looked at where it was found last.
        """
        contact = ti.Vector([-g.reach[w, i], 0.0, 0.0, 0.0, 0.0, 0.0])
        if not self.is_lost(pairs, u, p):
            c = self.tracked.contact(
                moves,
                g.shape[w, i],
                g.radius[w, i],
                g.turn(w, i),
                g.shape[w, j],
                g.radius[w, j],
                g.turn(w, j),
                g.apart(w, i, j),
                pairs.more[FIRST][u, p][0],
                pairs.more[SECOND][u, p][0],
            )
            if ti.static(moves):  # noqa: SIM102 (compiled only there)
                if c[HOLDS] > 0.0:
                    pairs.more[FIRST][u, p][0], pairs.more[SECOND][u, p][0] = c[PLACE_I], c[PLACE_J]
            overlap = self.counted(pairs, u, p, c, moves)
            contact = ti.Vector([overlap, c[NORMAL_Y], c[NORMAL_Z], c[POINT_Y], c[POINT_Z], c[HOLDS]])
        return contact

    @ti.func
    def seek_wall(self, g: ti.template(), w, i, feature, shift: ti.template(), margin, u):
        """Find the contacts of a grain with a wall at gaps below a margin (m); returns how many there are."""
        found, looks = 0, ti.static(self.tracked.looks)
        stride = ti.static(self.tables.cells // self.tracked.looks)
        target = self.target(g, w, i, feature, shift)
        earlier = self.rough_gap(g, w, i, feature, target, -2 * stride)
        last = self.rough_gap(g, w, i, feature, target, -stride)
        for k in range(looks):
            gap = self.rough_gap(g, w, i, feature, target, k * stride)
            if last <= earlier and last < gap:
                found = self.settle(g, w, i, feature, target, 0.0 * margin + (k - 1) * stride, margin, u, found)
            earlier, last = last, gap
        return found

    @ti.func
    def settle(self, g: ti.template(), w, i, feature, target, start, margin, u, before):
        """Follow a place to the contact near by, write it down if it is new; returns how many there are."""
        found, fresh, place = before, False, start
        for _ in range(TRIES):
            c = self.against(g, w, i, feature, target, place, True)
            settled = self.tracked.same(c[PLACE_I], place, SETTLED)
            place = c[PLACE_I]
            if settled:
                fresh = c[HOLDS] > 0.0 and -c[OVERLAP] < margin and before < ROOM
                break
        for k in range(before):
            if self.tracked.same(place, self.places_first[u, k], ALIKE):
                fresh = False
        if fresh:
            self.places_first[u, before] = place
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
    def rough_gap(self, g: ti.template(), w, i, feature, target, cell):
        """What has a local minimum where a contact is, at the start of a cell of the outline."""
        at, scale = cell & (self.tables.cells - 1), g.radius[w, i]
        x, y = scale * self.tables.curve[g.shape[w, i], at, 0], scale * self.tables.curve[g.shape[w, i], at, 4]
        gap = target[2] + x * target[0] + y * target[1]
        if feature >= self.walls.walls.segments:
            gap = (x - target[0]) ** 2 + (y - target[1]) ** 2
        return gap

    @ti.func
    def wall(
        self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p, moves: ti.template()
    ):
        """Contact p of grain i with a wall, as `pair`; it does not count where it is another feature's."""
        contact = ti.Vector([-g.reach[w, i], 0.0, 0.0, 0.0, 0.0, 0.0])
        if not self.is_lost(contacts, u, p):
            target = self.target(g, w, i, feature, shift)
            c = self.against(g, w, i, feature, target, contacts.more[FIRST][u, p][0], moves)
            if ti.static(moves):  # noqa: SIM102 (compiled only there)
                if c[HOLDS] > 0.0:
                    contacts.more[FIRST][u, p][0] = c[PLACE_I]
            normal = turned(g.turn(w, i), ti.Vector([c[NORMAL_Y], c[NORMAL_Z]]))
            point = turned(g.turn(w, i), ti.Vector([c[POINT_Y], c[POINT_Z]]))
            counts = self.walls.counts_on_corner(feature, normal[0], normal[1])
            if feature < self.walls.walls.segments:
                counts = self.walls.counts_on_segment(feature, shift, g.y[w, i] + point[0], g.z[w, i] + point[1])
            overlap = self.counted(contacts, u, p, c, moves)
            if not counts:
                overlap = -g.reach[w, i]
            contact = ti.Vector([overlap, normal[0], normal[1], point[0], point[1], c[HOLDS]])
        return contact

    @ti.func
    def against(self, g: ti.template(), w, i, feature, target, place, moves: ti.template()):
        """The contact of an outline with a wall near a place, all in the grain's frame; see `Tracked.contact`.

        The gap to a segment of normal m is least where p' · m = 0, that to a corner q where p' · (p − q) = 0.
        """
        shape, scale, corner = g.shape[w, i], g.radius[w, i], feature >= self.walls.walls.segments
        a, own = place, scale * self.tables.trace(shape, place)
        s = self.slopes(own, target, corner)
        if ti.static(moves):
            step = -within(s[0] / (ti.abs(s[1]) + TINY), ti.static(LONGEST * self.tables.cells / (2.0 * pi)))
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
        holds = ti.select(near and s[1] > 0.0 and ti.abs(miss) < CLOSE and facing < 0.0, 1.0, 0.0)
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
