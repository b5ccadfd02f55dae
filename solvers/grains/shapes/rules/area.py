"""The shared-area rule: the contact force is the gradient of an energy of the area that two outlines share."""

from math import sqrt

import taichi as ti

from solvers.grains.shapes.given import Shapes
from solvers.grains.shapes.grains import with_disc
from solvers.grains.shapes.pose import turned, turned_back
from solvers.grains.shapes.rules.polygons import AREA, PUSH_X, PUSH_Y, XX, XY, YX, YY, Polygons
from solvers.grains.shapes.rules.rest import Rest
from solvers.grains.shapes.rules.single import Single
from solvers.grains.shapes.rules.wall import FAR, SeenWalls
from solvers.grains.shapes.tables import TINY, Tables
from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.space.extremes import greater, lesser
from solvers.tank.walls import Walls

WINDOW = 1.0 / 32.0  # of the smaller grain's radius: distance within which edges are evaluated


@ti.data_oriented
class Area(Single):
    """One contact of two grains, or of a grain and a wall, by the area A that they share (Feng and Owen 2004).

    Its overlap is that of discs with the same shared area, ξ = (3 A/(4 √(2 R)))^⅔ with R = R_i R_j/(R_i + R_j), so that
    the laws' elastic energy depends on A only. The normal is −∂ξ/∂x: of length 1 between discs, longer between flat
    sides and shorter at tips. Forces, rates and slip all have that factor, so that the power of each is right. If
    outlines overlap in several places, there is one resultant force, and friction acts at a point on its line.

    Only edges within a `window` (m) of the other body are evaluated. They are chosen anew when the two have moved
    relative to each other by that much.
    """

    wall_memory = ("window", "edge_first", "edges", "from_y", "from_z", "from_far")
    pair_memory = ("window", "edge_first", "edges", "from_y", "from_z", "from_first", "from_second")

    def __init__(self, arrays: State, units: Units, walls: Walls, shapes: Shapes, wide: int = 0):
        outlines = with_disc(shapes)
        self.tables, self.walls = Tables(arrays, outlines), SeenWalls(arrays, walls)
        self.rest = Rest(arrays, units, bent=False)
        self.polygons = Polygons(arrays, outlines, shapes.nodes)

    @ti.func
    def pair(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moves: ti.template()):
        """The contact of grains i and j: overlap (m), normal towards i, point from i's centre (m), 1 (it holds).

        If they share no area, the overlap is zero or negative: minus a lower bound of the gap.
        """
        one, two, apart = g.outline(w, i), g.outline(w, j), g.apart(w, i, j)
        between, centre = turned_back(two.turn, one.turn), turned_back(two.turn, apart)
        way = ti.abs(apart[0] - pairs.from_y[u, p][0]) + ti.abs(apart[1] - pairs.from_z[u, p][0])
        way += g.reach[w, i] * ti.abs(g.angle[0][w, i] - pairs.from_first[u, p][0])
        way += g.reach[w, j] * ti.abs(g.angle[0][w, j] - pairs.from_second[u, p][0])
        window = pairs.window[u, p][0]
        first, edges = ti.cast(pairs.edge_first[u, p][0], ti.i32), ti.cast(pairs.edges[u, p][0], ti.i32)
        anew = way >= window
        if anew:
            window, way = WINDOW * lesser(one.scale, two.scale), 0.0 * way
            reach = two.scale * self.polygons.bounding[two.shape] + window
            first, edges = self.polygons.facing(one, between, centre, reach)
        total, gap, first, edges = self.polygons.shared(one, between, centre, two, first, edges, window)
        if ti.static(moves):  # noqa: SIM102 (compiled only there)
            if anew:
                pairs.window[u, p][0], pairs.edge_first[u, p][0], pairs.edges[u, p][0] = window, first, edges
                pairs.from_y[u, p][0], pairs.from_z[u, p][0] = apart[0], apart[1]
                pairs.from_first[u, p][0], pairs.from_second[u, p][0] = g.angle[0][w, i], g.angle[0][w, j]
        contact = contact_of(total, one.scale * two.scale / (one.scale + two.scale), two.turn)
        if contact[0] == 0.0:
            contact[0] = -greater(lesser(gap, window - way), 0.0)
        return contact

    @ti.func
    def wall(
        self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p, moves: ti.template()
    ):
        """The contact of a grain with a wall, in the form of `pair`; no overlap if it belongs to another feature."""
        contact = ti.Vector([0.0 * g.radius[w, i], 0.0, 0.0, 0.0, 0.0, 1.0])
        if feature < self.walls.walls.segments:
            face = self.walls.facing(feature, shift, g.y[w, i], g.z[w, i])
            normal = ti.Vector([ti.cast(face[0], g.real), ti.cast(face[1], g.real)])
            one, far = g.outline(w, i), ti.cast(face[2], g.real)
            own = turned_back(one.turn, normal)
            way = ti.abs(own[0] - contacts.from_y[u, p][0]) + ti.abs(own[1] - contacts.from_z[u, p][0])
            way = g.reach[w, i] * way + ti.abs(far - contacts.from_far[u, p][0])
            window = contacts.window[u, p][0]
            first, edges = ti.cast(contacts.edge_first[u, p][0], ti.i32), ti.cast(contacts.edges[u, p][0], ti.i32)
            anew = way >= window
            if anew:
                window = WINDOW * one.scale
                first, edges = self.polygons.below(one.shape, own, (window - far) / one.scale)
            total, first, edges = self.polygons.behind(one, own, far, first, edges, window)
            if ti.static(moves):  # noqa: SIM102 (compiled only there)
                if anew:
                    contacts.window[u, p][0], contacts.edge_first[u, p][0] = window, first
                    contacts.edges[u, p][0], contacts.from_far[u, p][0] = edges, far
                    contacts.from_y[u, p][0], contacts.from_z[u, p][0] = own[0], own[1]
            contact = contact_of(total, one.scale, one.turn)
            if not self.walls.counts_on_segment(feature, shift, g.y[w, i] + contact[3], g.z[w, i] + contact[4]):
                contact[0] = -FAR
        else:
            contact = self.walls.corner_contact(g, self.tables, w, i, feature, shift)
        return contact


@ti.func
def contact_of(total, radius, turn):
    """The contact from a shared area `total`, in a frame rotated by `turn`, with an effective radius (m)."""
    contact = ti.Vector([0.0 * radius, 0.0, 0.0, 0.0, 0.0, 1.0])
    push, area = ti.Vector([total[PUSH_X], total[PUSH_Y]]), total[AREA]
    width = push.norm()
    if area > 0.0 and width > TINY:
        overlap = (area / (ti.static(4.0 * sqrt(2.0) / 3.0) * ti.sqrt(radius))) ** ti.static(2.0 / 3.0)
        normal, along = (-2.0 / 3.0) * overlap / area * push, push / width
        # A point on the line of the force with this moment, in the middle of the shared area along the force.
        across = (total[XY] - total[YX]) / width
        depth = along[0] * along[0] * total[XX] + along[1] * along[1] * total[YY]
        depth += along[0] * along[1] * (total[XY] + total[YX])
        point = across * ti.Vector([along[1], -along[0]]) + (depth - 0.5 * area) / width * along
        normal, point = turned(turn, normal), turned(turn, point)
        contact = ti.Vector([overlap, normal[0], normal[1], point[0], point[1], 1.0])
    return contact
