"""Contacts of two smooth outlines along their common normal, followed from step to step by Newton's method."""

from math import pi

import taichi as ti

from solvers.laws.extremes import greater, lesser, within
from solvers.shapes.pose import turned, turned_back
from solvers.shapes.tables import Tables

LOOKS = 128  # points of an outline from which contacts are sought
TRIES = 40  # steps to a contact from where it is sought
LONGEST = 0.1  # rad by polar angle: the longest step along an outline
FLATTEST = 1e-5  # of what two discs have: relative curvature, below which a step is not stretched further
CLOSE = 1e-3  # rad between the tangents, and m of offset to m of the lesser smallest radius, of a contact in hand
STEEPEST = 4.0  # by how much a distance by polar radius may exceed a gap
DEEP = 0.5  # of the lesser smallest polar radius: an overlap that is none
SETTLED, ALIKE = 1e-4, 0.05  # cells: the last step to a contact, and by what two ways to the same one may differ

# Elements of what `contact` gives.
OVERLAP, NORMAL_Y, NORMAL_Z, POINT_Y, POINT_Z, PLACE_I, PLACE_J, HOLDS = range(8)


@ti.data_oriented
class Tracked:
    """The gap between two outlines at one of its local minima, where both have one normal through both points.

    The overlap is −(p_i − p_j) · n with n the outward normal of j at p_j. It is stationary in both places, so errors of
    the places count squared, and its gradient by the grains' positions and angles is −n and the torque of −n about each
    centre: a force U'(ξ) n is conservative. The places are two numbers for each contact to remember. Newton's method
    solves t_i × t_j = 0 and t_j · (p_i − p_j) = 0, the second of which is first solved for the place on j, and what is
    left is turned downhill where it leads to a maximum.
    """

    def __init__(self, tables: Tables):
        self.tables, self.looks = tables, min(LOOKS, tables.cells)
        self.flattest = FLATTEST * 2.0 * pi / tables.cells

    @ti.func
    def contact(
        self, moves: ti.template(), shape_i, scale_i, turn_i, shape_j, scale_j, turn_j, apart, place_i, place_j
    ):
        """The contact that was at these places; if it `moves`, one step of Newton's method further.

        That step is short, so the outlines' points there follow from their derivatives here.

        `turn` is (cos, sin) of a grain's angle, `apart` the centre of i less that of j (m). Gives overlap ξ (m,
        negative: a gap), normal towards i (y, z), contact point from i's centre (y, z) m, halfway between the two
        points, the new places, and 1 if this is a contact: the normals face each other, the gap is at a local minimum,
        and Newton's method has come CLOSE. Where it is 0 the pair has to be scanned anew.
        """
        between, centre = turned_back(turn_j, turn_i), turned_back(turn_j, apart)
        a, b, least = place_i, place_j, 1.0 + 0.0 * scale_i
        first, second = self.seen(shape_i, scale_i, between, a), scale_j * self.tables.trace(shape_j, b)
        if ti.static(moves):
            step = self.step(first, second, centre)
            a, b, least = a + step[0], b + step[1], step[2]
            first, second = advanced(first, step[0]), advanced(second, step[1])
        p, q = ti.Vector([first[0], first[1]]), ti.Vector([second[0], second[1]])
        along, tangent = ti.Vector([first[2], first[3]]), ti.Vector([second[2], second[3]])
        tangent *= 1.0 / ti.sqrt(tangent.norm_sqr())
        normal = ti.Vector([tangent[1], -tangent[0]])
        gap = centre + p - q
        facing = along.dot(tangent)
        smallest = lesser(scale_i * self.tables.smallest[shape_i], scale_j * self.tables.smallest[shape_j])
        close = ti.abs(gap.dot(tangent)) < CLOSE * smallest and ti.abs(along.cross(tangent)) < -CLOSE * facing
        # The far sides of two grains have facing normals, too.
        near = -gap.dot(normal) < DEEP * smallest
        holds = ti.select(close and near and least > 0.0, 1.0, 0.0)
        n, point = turned(turn_j, normal), turned(turn_j, p - 0.5 * gap)
        a, b = self.tables.wrapped(a), self.tables.wrapped(b)
        return ti.Vector([-gap.dot(normal), n[0], n[1], point[0], point[1], a, b, holds])

    @ti.func
    def seen(self, shape, scale, between, place):
        """Point of the first outline, from its centre, and derivatives, in the second grain's frame."""
        own = scale * self.tables.trace(shape, place)
        p = turned(between, ti.Vector([own[0], own[1]]))
        d = turned(between, ti.Vector([own[2], own[3]]))
        e = turned(between, ti.Vector([own[4], own[5]]))
        return ti.Vector([p[0], p[1], d[0], d[1], e[0], e[1]])

    @ti.func
    def step(self, first, second, centre):
        """Changes of both places, and a number that is positive where the gap has a minimum near by."""
        gap = centre + ti.Vector([first[0] - second[0], first[1] - second[1]])
        d, e = ti.Vector([first[2], first[3]]), ti.Vector([first[4], first[5]])
        g, h = ti.Vector([second[2], second[3]]), ti.Vector([second[4], second[5]])
        size_j = g.norm_sqr()
        # ∂/∂a and ∂/∂b of d × g and of gap · g.
        turn_a, turn_b = e.cross(g), d.cross(h)
        slide_a, slide_b = d.dot(g), gap.dot(h) - size_j
        curved = slide_b < -0.1 * size_j  # the overlap is less than the radius of curvature of j
        inverse = 1.0 / lesser(slide_b, -0.1 * size_j)
        along = gap.dot(g)
        slope = turn_a - turn_b * slide_a * inverse
        rest = -d.cross(g) + turn_b * along * inverse
        longest = ti.static(LONGEST * self.tables.cells / (2.0 * pi))
        change_a = within(rest / greater(ti.abs(slope), self.flattest * d.norm_sqr()), longest)
        change_b = within(-(along + slide_a * change_a) * inverse, longest)
        return ti.Vector([change_a, change_b, ti.select(curved, slope, -1.0)])

    @ti.func
    def scan(
        self,
        shape_i,
        scale_i,
        turn_i,
        shape_j,
        scale_j,
        turn_j,
        apart,
        skin,
        places_i: ti.template(),
        places_j: ti.template(),
        row,
    ):
        """Find the contacts of a pair with a gap below `skin` (m); writes their places to `places_i[row, k]` and _j.

        Gives their number, at most as many as there is room for. They are sought from those of LOOKS points of either
        outline at which the distance from the other, by polar radius, has a local minimum.
        """
        found, sides, points, stride = 0, 2, ti.static(self.looks), ti.static(self.tables.cells // self.looks)
        if self.tables.convex[shape_i] * self.tables.convex[shape_j] > 0.0:
            # They have but one contact, which is found from the line of their centres.
            toward, back = turned_back(turn_i, -apart), turned_back(turn_j, apart)
            c = self.followed(
                shape_i,
                scale_i,
                turn_i,
                shape_j,
                scale_j,
                turn_j,
                apart,
                ti.atan2(toward[1], toward[0]) * (self.tables.cells / (2.0 * pi)),
                ti.atan2(back[1], back[0]) * (self.tables.cells / (2.0 * pi)),
            )
            if c[HOLDS] > 0.0:
                sides = 0
                if -c[OVERLAP] < skin:
                    places_i[row, 0], places_j[row, 0] = c[PLACE_I], c[PLACE_J]
                    found = 1
        for side in range(sides):
            swap = side == 1
            shape, other = ti.select(swap, shape_j, shape_i), ti.select(swap, shape_i, shape_j)
            scale, other_scale = ti.select(swap, scale_j, scale_i), ti.select(swap, scale_i, scale_j)
            turn, other_turn = ti.select(swap, turn_j, turn_i), ti.select(swap, turn_i, turn_j)
            between = turned_back(other_turn, turn)
            centre = turned_back(other_turn, ti.select(swap, -apart, apart))
            spacing = scale * self.tables.bounding[shape] * (2.0 * pi / points)
            far = other_scale * self.tables.bounding[other] + skin + 2.0 * spacing
            near = STEEPEST * skin + 2.0 * spacing
            earlier, last, last_x, last_y = far, far, far, far
            for k in range(-2, points):
                at = (k & (points - 1)) * stride
                point = ti.Vector([self.tables.curve[shape, at, 0], self.tables.curve[shape, at, 4]])
                here = centre + turned(between, scale * point)
                away = here.norm()
                if away < far:
                    away -= other_scale * self.tables.radius(other, here[0], here[1])
                if k >= 0 and last <= earlier and last < away and last < near:
                    own = 0.0 * scale + (k - 1) * stride
                    facing = ti.atan2(last_y, last_x) * (self.tables.cells / (2.0 * pi))
                    found = self.settle(
                        shape_i,
                        scale_i,
                        turn_i,
                        shape_j,
                        scale_j,
                        turn_j,
                        apart,
                        skin,
                        ti.select(swap, facing, own),
                        ti.select(swap, own, facing),
                        places_i,
                        places_j,
                        row,
                        found,
                    )
                earlier, last, last_x, last_y = last, away, here[0], here[1]
        return found

    @ti.func
    def settle(
        self,
        shape_i,
        scale_i,
        turn_i,
        shape_j,
        scale_j,
        turn_j,
        apart,
        skin,
        place_i,
        place_j,
        places_i: ti.template(),
        places_j: ti.template(),
        row,
        before,
    ):
        """Follow a pair of places to the contact near by, and write it down if it is new; gives how many there are."""
        found = before
        c = self.followed(shape_i, scale_i, turn_i, shape_j, scale_j, turn_j, apart, place_i, place_j)
        a, b = c[PLACE_I], c[PLACE_J]
        fresh = c[HOLDS] > 0.0 and -c[OVERLAP] < skin and before < places_i.shape[1]
        for k in range(before):
            if self.same(a, places_i[row, k], ALIKE) and self.same(b, places_j[row, k], ALIKE):
                fresh = False
        if fresh:
            places_i[row, before], places_j[row, before] = a, b
            found += 1
        return found

    @ti.func
    def followed(self, shape_i, scale_i, turn_i, shape_j, scale_j, turn_j, apart, place_i, place_j):
        """The contact to which Newton's method leads from these places; it does not hold where it leads to none."""
        c = self.contact(False, shape_i, scale_i, turn_i, shape_j, scale_j, turn_j, apart, place_i, place_j)
        settled = False
        for _ in range(TRIES):
            a, b = c[PLACE_I], c[PLACE_J]
            c = self.contact(True, shape_i, scale_i, turn_i, shape_j, scale_j, turn_j, apart, a, b)
            settled = self.same(c[PLACE_I], a, SETTLED) and self.same(c[PLACE_J], b, SETTLED)
            if settled:
                break
        if not settled:
            c[HOLDS] = 0.0
        return c

    @ti.func
    def distance(self, a, b):
        """How many cells two places on an outline are apart."""
        return ti.abs(self.tables.wrapped(a - b + 0.5 * self.tables.cells) - 0.5 * self.tables.cells)

    @ti.func
    def same(self, a, b, error):
        """Whether two places on an outline differ by less than so many cells."""
        return self.distance(a, b) < error


@ti.func
def advanced(own, step):
    """Point of an outline and derivatives (`Tables.trace`) a short step onwards, to the second order."""
    return ti.Vector(
        [
            own[0] + step * (own[2] + 0.5 * step * own[4]),
            own[1] + step * (own[3] + 0.5 * step * own[5]),
            own[2] + step * own[4],
            own[3] + step * own[5],
            own[4],
            own[5],
        ]
    )
