"""Contacts of two smooth outlines along their common normal, tracked from step to step by Newton's method."""

from math import pi

import taichi as ti

from solvers.grains.shapes.pose import turned, turned_back
from solvers.grains.shapes.tables import Tables, advanced, radius_of_curvature
from solvers.machine.state import Axis, State
from solvers.space.extremes import greater, lesser, within

TRIES = 40  # most Newton steps in seeking a contact
LONGEST = 0.1  # rad of polar angle: the longest Newton step along an outline
FLATTEST = 1e-5  # relative curvature, as a share of that of two discs, below which a Newton step is limited
CLOSE = 1e-3  # rad between the tangents, and offset over the lesser smallest radius, up to which a contact holds
STEEPEST = 4.0  # largest ratio of a distance by polar radius to the gap
DEEP = 0.5  # of the lesser smallest polar radius: a deeper overlap is not a contact
SETTLED, ALIKE = 1e-4, 0.05  # cells: last Newton step at convergence, and difference of two results that are the same
MINIMUM, SADDLE = 1.0, -1.0  # signs of the Newton step, for what is sought
NONE = -1.0  # no place
HALVINGS, NEARER = 6, 2  # bisections towards a saddle, and Newton steps to the place on j nearest to one on i

# Elements of the result of `contact`.
OVERLAP, NORMAL_Y, NORMAL_Z, POINT_Y, POINT_Z, PLACE_I, PLACE_J, HOLDS, CURVED_I, CURVED_J = range(10)


@ti.data_oriented
class Places:
    """Scratch arrays for the contacts of two outlines being sought: places on i and j, and of the saddles before them.

    Each is (rows, room), with a row for each unit that may seek at the same time.
    """

    def __init__(self, arrays: State, rows: Axis, room: int):
        names = "i", "j", "saddle_i", "saddle_j"
        axes = rows, Axis("contact", room)
        self.i, self.j, self.saddle_i, self.saddle_j = arrays.under("sought").reals(axes, *names, kept=False)


@ti.data_oriented
class Tracked:
    """The gap between two outlines at one of its local minima, where both have a common normal through both points.

    The overlap is −(p_i − p_j) · n with n the outward normal of j at p_j. It is stationary in both places, so the
    effect of errors in the places is of second order. Its gradient by the grains' positions and angles is −n and the
    torque of −n about each centre, so a force U'(ξ) n is conservative. A contact is stored as its two places. Newton's
    method solves t_i × t_j = 0 and t_j · (p_i − p_j) = 0, with the sign that leads to a MINIMUM, or to a SADDLE: a
    stationary point between two minima, at which the gap is largest along the outlines.

    With non-convex outlines minima and saddles appear and vanish in pairs, at equal gaps (Morse 1934). So the sum of
    U(ξ) over the minima less that over the saddles is continuous. This is the energy; a minimum in a dent that is only
    slightly deeper than the saddle next to it counts by the difference only.
    """

    def __init__(self, tables: Tables):
        self.tables, self.looks = tables, tables.looks
        self.flattest = FLATTEST * 2.0 * pi / tables.cells

    @ti.func
    def contact(self, moves: ti.template(), way, one: ti.template(), two: ti.template(), apart, place_i, place_j):
        """The contact or saddle at these places or, if it `moves`, one Newton step further.

        The step is short, so the outlines' points after it follow from their derivatives before it.

        `one` and `two` are the outlines of i and j, `apart` the centre of i less that of j (m). Returns overlap ξ (m,
        negative: a gap), normal towards i (y, z), contact point from i's centre (y, z) m, halfway between the two
        points, the new places, whether it holds (0 or 1), and the radii of curvature (m) of i and j. It holds if the
        normals are opposite, the gap is stationary of the kind sought, and Newton's method has come CLOSE.
        """
        between, centre = turned_back(two.turn, one.turn), turned_back(two.turn, apart)
        a, b, least = place_i, place_j, 1.0 + 0.0 * one.scale
        first, second = self.seen(one, between, a), two.scale * self.tables.trace(two.shape, b)
        if ti.static(moves):
            step = self.step(way, first, second, centre)
            a, b, least = a + step[0], b + step[1], step[2]
            first, second = advanced(first, step[0]), advanced(second, step[1])
        p, q = ti.Vector([first[0], first[1]]), ti.Vector([second[0], second[1]])
        along, tangent = ti.Vector([first[2], first[3]]), ti.Vector([second[2], second[3]])
        tangent *= 1.0 / ti.sqrt(tangent.norm_sqr())
        normal = ti.Vector([tangent[1], -tangent[0]])
        gap = centre + p - q
        facing = along.dot(tangent)
        smallest = lesser(one.scale * self.tables.smallest[one.shape], two.scale * self.tables.smallest[two.shape])
        close = ti.abs(gap.dot(tangent)) < CLOSE * smallest and ti.abs(along.cross(tangent)) < -CLOSE * facing
        # The far sides of two grains have opposite normals, too.
        near = -gap.dot(normal) < DEEP * smallest
        holds = ti.select(close and near and least > 0.0, 1.0, 0.0)
        n, point = turned(two.turn, normal), turned(two.turn, p - 0.5 * gap)
        a, b = self.tables.wrapped(a), self.tables.wrapped(b)
        one_curved, two_curved = curved(first, one.scale), curved(second, two.scale)
        return ti.Vector([-gap.dot(normal), n[0], n[1], point[0], point[1], a, b, holds, one_curved, two_curved])

    @ti.func
    def seen(self, one: ti.template(), between, place):
        """Point of the first outline from its centre, and its derivatives, in the second grain's frame."""
        own = one.scale * self.tables.trace(one.shape, place)
        p = turned(between, ti.Vector([own[0], own[1]]))
        d = turned(between, ti.Vector([own[2], own[3]]))
        e = turned(between, ti.Vector([own[4], own[5]]))
        return ti.Vector([p[0], p[1], d[0], d[1], e[0], e[1]])

    @ti.func
    def step(self, way, first, second, centre):
        """Newton step of both places, and a number that is positive if the curvature is that of the kind sought."""
        gap = centre + ti.Vector([first[0] - second[0], first[1] - second[1]])
        d, e = ti.Vector([first[2], first[3]]), ti.Vector([first[4], first[5]])
        g, h = ti.Vector([second[2], second[3]]), ti.Vector([second[4], second[5]])
        size_i, size_j = d.norm_sqr(), g.norm_sqr()
        # ∂/∂a and ∂/∂b of d × g and of gap · g.
        turn_a, turn_b = e.cross(g), d.cross(h)
        slide_a, slide_b = d.dot(g), gap.dot(h) - size_j
        # Negative if 1/R_i + 1/R_j − ξ/(R_i R_j) > 0, with R the radii of curvature: a minimum.
        bend = turn_a * slide_b - turn_b * slide_a
        along, turned_by = gap.dot(g), d.cross(g)
        longest = ti.static(LONGEST * self.tables.cells / (2.0 * pi))
        steep = greater(ti.abs(bend), self.flattest * size_i * size_j)
        change_a = within(way * (turned_by * slide_b - along * turn_b) / steep, longest)
        # The overlap may exceed the radius of curvature of j; then the other equation gives the step on j.
        shallow = slide_b < -0.1 * size_j
        over = ti.select(shallow, along + slide_a * change_a, turned_by + turn_a * change_a)
        under = ti.select(shallow, slide_b, turn_b)
        change_b = within(-over / ti.select(under == 0.0, 1.0, under), longest)
        return ti.Vector([change_a, change_b, -way * bend])

    @ti.func
    def fall(self, one: ti.template(), two: ti.template(), apart, place_i, place_j):
        """Decrease of the gap along i at a place, the place on j nearest to it, the gap (m), and the tangent's rate.

        The decrease is a sine, that between the tangents. The rate (1/m) is that at which the tangent at the nearest
        place turns as i moves along j, κ_j/(1 + κ_j gap).
        """
        between, centre = turned_back(two.turn, one.turn), turned_back(two.turn, apart)
        first, b = self.seen(one, between, place_i), place_j
        second = two.scale * self.tables.trace(two.shape, b)
        for _ in range(NEARER):
            b += self.nearer(first, second, centre)
            second = two.scale * self.tables.trace(two.shape, b)
        d, g = ti.Vector([first[2], first[3]]), ti.Vector([second[2], second[3]])
        gap = centre + ti.Vector([first[0] - second[0], first[1] - second[1]])
        size, bends = g.norm_sqr(), g.cross(ti.Vector([second[4], second[5]]))
        length = ti.sqrt(size)
        away = gap.cross(g) / length
        rate = ti.abs(bends) / greater(size * length + away * bends, 0.1 * size * length)
        return ti.Vector([-d.cross(g) / (length * d.norm()), b, away, rate])

    @ti.func
    def saddle(self, one: ti.template(), two: ti.template(), apart, low_i, low_j, high_i, high_j):
        """The saddle between two minima, of which the one at `high` comes after that at `low` along i.

        Bisection on the sign of the gap's slope gets near it for any outlines; Newton's method does the rest.
        """
        wide = self.tables.wrapped(high_i - low_i)
        a, b, bottom, top = low_i, low_j, 0.0 * wide, wide
        back = self.way_from(low_j, high_j)
        if wide < 0.5 * self.tables.cells:
            for _ in range(HALVINGS):
                middle = 0.5 * (bottom + top)
                c = self.fall(one, two, apart, low_i + middle, low_j + back * middle / wide)
                a, b = low_i + middle, c[1]
                if c[0] > 0.0:
                    top = middle
                else:
                    bottom = middle
        c = self.followed(SADDLE, one, two, apart, a, b)
        if wide >= 0.5 * self.tables.cells or self.tables.wrapped(c[PLACE_I] - low_i) > wide:
            c[HOLDS] = 0.0
        return c

    @ti.func
    def nearer(self, first, second, centre):
        """Newton step (cells) of a place on j towards the one nearest to the place on i."""
        gap = centre + ti.Vector([first[0] - second[0], first[1] - second[1]])
        g, h = ti.Vector([second[2], second[3]]), ti.Vector([second[4], second[5]])
        inverse = 1.0 / lesser(gap.dot(h) - g.norm_sqr(), -0.1 * g.norm_sqr())
        return within(-gap.dot(g) * inverse, ti.static(LONGEST * self.tables.cells / (2.0 * pi)))

    @ti.func
    def scan(self, one: ti.template(), two: ti.template(), apart, skin, places: ti.template(), row):
        """Find the contacts of a pair with a gap below `skin` (m), and write them to a row of `places`.

        Returns their number, at most the room there is. They are sought from those of LOOKS points on either outline at
        which the distance from the other, by polar radius, has a local minimum. They are stored in their order along i,
        each with the saddle between it and the previous one, or NONE.
        """
        found, points, stride = 0, ti.static(self.looks), ti.static(self.tables.cells // self.looks)
        convex = self.tables.convex[one.shape] * self.tables.convex[two.shape] > 0.0
        done = False
        # Two convex outlines have one contact, sought from the line of centres; else, or if that fails, all round both.
        for side in range(ti.select(convex, -1, 0), 2):
            swap = side == 1
            own, other = one, two
            if swap:
                own, other = two, one
            between = turned_back(other.turn, own.turn)
            centre = turned_back(other.turn, ti.select(swap, 0.0 - apart, apart))
            spacing = own.scale * self.tables.bounding[own.shape] * (2.0 * pi / points)
            far = other.scale * self.tables.bounding[other.shape] + skin + 2.0 * spacing
            near = STEEPEST * skin + 2.0 * spacing
            earlier, last, last_x, last_y = far, far, far, far
            toward = turned_back(one.turn, 0.0 - apart)
            for k in range(-2, ti.select(done, -2, ti.select(side < 0, -1, points))):
                at = (k & (points - 1)) * stride
                point = ti.Vector([self.tables.curve[own.shape, at, 0], self.tables.curve[own.shape, at, 4]])
                here = centre + turned(between, own.scale * point)
                away = here.norm()
                if away < far:
                    away -= other.scale * self.tables.radius(other.shape, here[0], here[1])
                if side < 0 or (k >= 0 and last <= earlier and last < away and last < near):
                    place, facing = 0.0 * own.scale + (k - 1) * stride, ti.atan2(last_y, last_x)
                    if side < 0:
                        place = ti.atan2(toward[1], toward[0]) * (self.tables.cells / (2.0 * pi))
                        facing = ti.atan2(centre[1], centre[0])
                    facing *= self.tables.cells / (2.0 * pi)
                    a, b = ti.select(swap, facing, place), ti.select(swap, place, facing)
                    c = self.followed(MINIMUM, one, two, apart, a, b)
                    done = done or (side < 0 and c[HOLDS] > 0.0)
                    if -c[OVERLAP] < skin and self.is_new(c, places, row, found):
                        places.i[row, found], places.j[row, found] = c[PLACE_I], c[PLACE_J]
                        found += 1
                earlier, last, last_x, last_y = last, away, here[0], here[1]
        self.put_in_order(places, row, found)
        for k in range(found):
            places.saddle_i[row, k], places.saddle_j[row, k] = NONE, NONE
            if found > 1:
                low = (k + found - 1) % found
                c = self.saddle(
                    one, two, apart, places.i[row, low], places.j[row, low], places.i[row, k], places.j[row, k]
                )
                if c[HOLDS] > 0.0 and -c[OVERLAP] < skin:
                    places.saddle_i[row, k], places.saddle_j[row, k] = c[PLACE_I], c[PLACE_J]
        return found

    @ti.func
    def put_in_order(self, places: ti.template(), row, count):
        """Sort contacts by their places on i."""
        for n in range(1, count):
            a, b, k = places.i[row, n], places.j[row, n], n
            while k > 0 and places.i[row, ti.max(k - 1, 0)] > a:
                places.i[row, k], places.j[row, k] = places.i[row, k - 1], places.j[row, k - 1]
                k -= 1
            places.i[row, k], places.j[row, k] = a, b

    @ti.func
    def is_new(self, c, places: ti.template(), row, found):
        """Whether c is a contact that has not been found yet, and there is room for it."""
        new, a, b = c[HOLDS] > 0.0 and found < places.i.shape[1], c[PLACE_I], c[PLACE_J]
        for k in range(found):
            if self.same(a, places.i[row, k], ALIKE) and self.same(b, places.j[row, k], ALIKE):
                new = False
        return new

    @ti.func
    def followed(self, way, one: ti.template(), two: ti.template(), apart, place_i, place_j):
        """The contact or saddle to which Newton's method converges from these places; HOLDS is 0 if it does not."""
        a, b, settled = place_i, place_j, False
        c = ti.Vector([0.0 * one.scale for _ in ti.static(range(CURVED_J + 1))])
        for _ in range(TRIES):
            c = self.contact(True, way, one, two, apart, a, b)
            settled = self.same(c[PLACE_I], a, SETTLED) and self.same(c[PLACE_J], b, SETTLED)
            a, b = c[PLACE_I], c[PLACE_J]
            if settled:
                break
        if not settled:
            c[HOLDS] = 0.0
        return c

    @ti.func
    def way_from(self, a, b):
        """Signed distance in cells from place a on an outline to b, the shorter way round."""
        return self.tables.wrapped(b - a + 0.5 * self.tables.cells) - 0.5 * self.tables.cells

    @ti.func
    def distance(self, a, b):
        """Distance in cells of two places on an outline."""
        return ti.abs(self.way_from(a, b))

    @ti.func
    def same(self, a, b, error):
        """Whether two places on an outline differ by less than `error` cells."""
        return self.distance(a, b) < error


@ti.func
def curved(own, scale):
    """Radius of curvature (m) of an outline from its derivatives at a point (`Tables.trace`)."""
    along = ti.Vector([own[2], own[3]]).norm()
    return radius_of_curvature(along * along * along, own[2] * own[5] - own[3] * own[4], scale)
