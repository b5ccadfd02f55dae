"""The rule of smooth outlines: contacts along common normals, each followed from step to step."""

import taichi as ti

from solvers.laws.extremes import within
from solvers.runtime import Arrays
from solvers.shapes.given import Shapes
from solvers.shapes.grains import with_disc
from solvers.shapes.pose import turned, turned_back
from solvers.shapes.tables import Tables
from solvers.shapes.tracked import (
    ALIKE,
    CLOSE,
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
)
from solvers.shapes.wall import SeenWalls
from solvers.units import Units
from solvers.walls import Walls

ROOM = 8  # contacts of a grain with another, or with one wall, at most


@ti.data_oriented
class Continuous:
    """Every local minimum of the gap between two outlines, or between one and a wall, is a contact of its own.

    A contact is remembered by the places on the outlines where it is (`Tracked`); one step of Newton's method a time
    step keeps it there. They are sought where lists are made.
    """

    pair_memory, wall_memory = ("place_first", "place_second"), ("place_first",)

    def __init__(self, arrays: Arrays, units: Units, walls: Walls, shapes: Shapes):
        self.units = units
        self.tables = Tables(arrays, with_disc(shapes))
        self.tracked, self.walls = Tracked(self.tables), SeenWalls(arrays, walls)
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
    def is_same(self, contacts: ti.template(), u, q, k):
        """Whether contact q of an old list is the k-th that has been found."""
        return self.tracked.same(contacts.old_more[0][u, q][0], self.places_first[u, k], ALIKE)

    @ti.func
    def note(self, contacts: ti.template(), u, p, k):
        """Contact p is where the k-th has been found."""
        contacts.more[0][u, p][0] = self.places_first[u, k]
        if ti.static(len(contacts.more) > 1):
            contacts.more[1][u, p][0] = self.places_second[u, k]

    @ti.func
    def pair(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moves: ti.template()):
        """Contact p of grains i and j: overlap (m), normal towards i, point from i's centre (m), whether it holds.

        Unless it `moves`, it is looked at where it was found last.
        """
        c = self.tracked.contact(
            ti.static(1 if moves else 0),
            g.shape[w, i],
            g.radius[w, i],
            g.turn(w, i),
            g.shape[w, j],
            g.radius[w, j],
            g.turn(w, j),
            g.apart(w, i, j),
            pairs.more[0][u, p][0],
            pairs.more[1][u, p][0],
        )
        if ti.static(moves):
            pairs.more[0][u, p][0], pairs.more[1][u, p][0] = c[PLACE_I], c[PLACE_J]
        return ti.Vector([c[OVERLAP], c[NORMAL_Y], c[NORMAL_Z], c[POINT_Y], c[POINT_Z], c[HOLDS]])

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
        target = self.target(g, w, i, feature, shift)
        c = self.against(g, w, i, feature, target, contacts.more[0][u, p][0], moves)
        if ti.static(moves):
            contacts.more[0][u, p][0] = c[PLACE_I]
        normal = turned(g.turn(w, i), ti.Vector([c[NORMAL_Y], c[NORMAL_Z]]))
        point = turned(g.turn(w, i), ti.Vector([c[POINT_Y], c[POINT_Z]]))
        counts = self.walls.counts_on_corner(feature, normal[0], normal[1])
        if feature < self.walls.walls.segments:
            counts = self.walls.counts_on_segment(feature, shift, g.y[w, i] + point[0], g.z[w, i] + point[1])
        overlap = ti.select(counts, c[OVERLAP], -1.0)
        return ti.Vector([overlap, normal[0], normal[1], point[0], point[1], c[HOLDS]])

    @ti.func
    def against(self, g: ti.template(), w, i, feature, target, place, moves: ti.template()):
        """The contact of an outline with a wall near a place, all in the grain's frame; see `Tracked.contact`.

        The gap to a segment of normal m is least where p' · m = 0, that to a corner q where p' · (p − q) = 0.
        """
        shape, scale = g.shape[w, i], g.radius[w, i]
        corner, longest = feature >= self.walls.walls.segments, LONGEST * g.reach[w, i]
        a = place
        if ti.static(moves):
            s = self.slopes(scale * self.tables.trace(shape, place), target, corner)
            stiff = ti.abs(s[1]) + 1e-6 * s[2]
            a = place - within(s[0] / stiff, longest / ti.sqrt(s[2]))
        own = scale * self.tables.trace(shape, a)
        s = self.slopes(own, target, corner)
        size = ti.sqrt(s[2])
        outward = ti.Vector([own[3], -own[2]]) / size
        gap = target[2] + own[0] * target[0] + own[1] * target[1]
        ny, nz, miss = target[0], target[1], s[0] / size
        if corner:
            gap = (target[0] - own[0]) * outward[0] + (target[1] - own[1]) * outward[1]
            ny, nz, miss = -outward[0], -outward[1], s[0] / size / (LONGEST * longest)
        facing = outward[0] * ny + outward[1] * nz
        holds = ti.select(s[1] > 0.0 and ti.abs(miss) < CLOSE and facing < 0.0, 1.0, 0.0)
        a = self.tables.wrapped(a)
        return ti.Vector([-gap, ny, nz, own[0], own[1], a, 0.0 * a, miss, holds])

    @ti.func
    def slopes(self, own, target, corner):
        """First and second derivative of the gap (its half square, for a corner) by the place, and |p'|²."""
        x, y = target[0], target[1]
        size = own[2] * own[2] + own[3] * own[3]
        more = 0.0 * x
        if corner:
            x, y, more = own[0] - target[0], own[1] - target[1], size
        return ti.Vector([own[2] * x + own[3] * y, own[4] * x + own[5] * y + more, size])
