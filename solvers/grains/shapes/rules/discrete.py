"""The source's contact rule: the node of either outline that lies deepest in the other."""

from math import pi

import taichi as ti

from solvers.grains.shapes.given import Shapes
from solvers.grains.shapes.grains import with_disc
from solvers.grains.shapes.pose import turned, turned_back
from solvers.grains.shapes.rules.nodes import Nodes
from solvers.grains.shapes.rules.osculating import Osculating
from solvers.grains.shapes.rules.rest import SURE, Rest
from solvers.grains.shapes.rules.single import Single
from solvers.grains.shapes.rules.wall import FAR, SeenWalls
from solvers.grains.shapes.tables import Tables
from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.machine.wide import enter
from solvers.space.extremes import lesser
from solvers.tank.walls import Walls

NEAR = 0.01  # of the distance between nodes: slide of a contact after which neighbouring nodes are checked
FOLLOWED = 0.5  # of that distance: how far two grains move past each other until all nodes are searched again


@ti.data_oriented
class Discrete(Single):
    """One contact of two grains, or of a grain and a wall, at the deepest node (Spandonidis 2016, table 8.1).

    All nodes are searched until the two touch, and then whenever they have moved past each other by half the distance
    between two nodes; in between the deepest node of either grain is followed from node to node. A node elsewhere that
    has become the deepest meanwhile is found too deep by less than that distance. `sure` is how far (m) they may still
    move; that of convex grains falls by the slide of the contact alone.
    """

    wall_memory = (SURE, "node_first")
    pair_memory = (*wall_memory, "node_second")

    def __init__(self, arrays: State, units: Units, walls: Walls, shapes: Shapes, wide: int = 0):
        outlines = with_disc(shapes)
        self.tables = Tables(arrays, outlines)
        # With non-convex outlines a node elsewhere may become the deepest as the two are pressed together.
        near = NEAR * 2.0 * pi / shapes.nodes
        self.followed = FOLLOWED * 2.0 * pi / shapes.nodes
        carried = Osculating(arrays, units, outlines, near, wide) if shapes.convex else Rest(arrays, units, bent=False)
        self.rest = carried
        self.nodes, self.walls = Nodes(arrays, self.tables, outlines, shapes.nodes), SeenWalls(arrays, walls)

    @ti.func
    def note(self, contacts: ti.template(), u, p, k):
        """Have all nodes of contact p searched at its next evaluation."""
        enter(contacts.sure, u, p, 0, 0.0)

    @ti.func
    def is_due(self, contacts: ti.template(), u, p, radius):
        """Whether all nodes must be searched for contact p; if so, the next search is put off. `radius` in m."""
        due = contacts.sure[u, p][0] <= 0.0
        enter(contacts.sure, u, p, 0, ti.select(due, self.followed * radius, contacts.sure[u, p][0]))
        return due

    @ti.func
    def pair(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moves: ti.template()):
        """The contact of grains i and j: overlap (m), normal towards i, point from i's centre (m), 1 (it holds).

        Then come the radii of curvature (m) of i and j, see `Nodes.contact`.
        """
        anew, first, second = True, 0, 0
        if ti.static(moves):
            anew = self.is_due(pairs, u, p, lesser(g.radius[w, i], g.radius[w, j]))
            first, second = ti.cast(pairs.node_first[u, p][0], ti.i32), ti.cast(pairs.node_second[u, p][0], ti.i32)
        one, two = g.outline(w, i), g.outline(w, j)
        c, first, second = self.nodes.contact(one, two, g.apart(w, i, j), first, second, anew)
        if ti.static(moves):
            enter(pairs.node_first, u, p, 0, first)
            enter(pairs.node_second, u, p, 0, second)
            if c[0] <= 0.0:
                enter(pairs.sure, u, p, 0, 0.0)
        return ti.Vector([c[0], c[1], c[2], c[3], c[4], 1.0 + 0.0 * c[0], c[5], c[6]])

    @ti.func
    def wall(
        self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p, moves: ti.template()
    ):
        """The contact of a grain with a wall, in the form of `pair`; no overlap if it belongs to another feature."""
        contact = ti.Vector([0.0 * g.radius[w, i], 0.0, 0.0, 0.0, 0.0, 1.0])
        if feature < self.walls.walls.segments:
            face = self.walls.facing(feature, shift, g.y[w, i], g.z[w, i])
            normal = ti.Vector([ti.cast(face[0], g.real), ti.cast(face[1], g.real)])
            own, anew, lowest = turned_back(g.turn(w, i), normal), True, 0
            if ti.static(moves):
                anew, lowest = (
                    self.is_due(contacts, u, p, g.radius[w, i]),
                    ti.cast(contacts.node_first[u, p][0], ti.i32),
                )
            if anew:
                lowest = self.lowest(g.shape[w, i], own)
            else:
                known = lowest
                for side in ti.static((-1, 1)):
                    beside = self.nodes.beside(known, side)
                    if self.height(g.shape[w, i], beside, own) < self.height(g.shape[w, i], lowest, own):
                        lowest = beside
            if ti.static(moves):
                enter(contacts.node_first, u, p, 0, lowest)
            node = g.radius[w, i] * turned(g.turn(w, i), self.nodes.place(g.shape[w, i], lowest))
            overlap = -ti.cast(face[2], g.real) - node.dot(normal)
            if not self.walls.counts_on_segment(feature, shift, g.y[w, i] + node[0], g.z[w, i] + node[1]):
                overlap = -FAR
            contact = ti.Vector([overlap, normal[0], normal[1], node[0], node[1], 1.0])
        else:
            contact = self.walls.corner_contact(g, self.tables, w, i, feature, shift)
        return contact

    @ti.func
    def height(self, shape, node, normal):
        """Height of a node of an outline along a unit vector."""
        return self.nodes.place(shape, node).dot(normal)

    @ti.func
    def lowest(self, shape, normal):
        """The lowest node of an outline along a unit vector."""
        best, found, k = FAR, 0, 0
        while k < self.nodes.length:
            after = self.nodes.after[k]
            height = ti.Vector([self.nodes.circle[shape, k, 0], self.nodes.circle[shape, k, 1]]).dot(normal)
            width = self.nodes.circle[shape, k, 2]
            if height - width < best:
                if width == 0.0:
                    best, found = height, self.nodes.start[k]
                else:
                    after = k + 1
            k = after
        return found
