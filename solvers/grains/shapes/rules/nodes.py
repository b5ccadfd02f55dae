"""The source's discrete rule for two grains: the deepest node of either grain inside the other's outline."""

from itertools import pairwise

import numpy as np
import taichi as ti

from solvers.grains.shapes import series
from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.pose import turned, turned_back
from solvers.grains.shapes.tables import TINY, Tables
from solvers.machine.state import State

PARTS = 4  # number of parts into which a run of nodes is cut
ARCS = 8  # number of runs at the top level
SLACK = 1.0 + 1e-6  # on bounds, for the tables' errors and rounding
NEARBY = 0.1  # of the other grain's bounding radius: nodes farther outside than this are not searched
DEPTH = 0  # element of the result of `Nodes.seen`


@ti.data_oriented
class Nodes:
    """`count` nodes on each outline, equally spaced by polar angle, in a tree of runs with a bounding circle for each.

    The result is that of Spandonidis (2016), table 8.1, over all nodes, except for step 6: the tangent is the other
    outline's at the node's polar angle, not a chord of two nodes. A search of all nodes skips a run if no point of its
    circle can lie deeper in the other grain than the deepest node found. Between searches the deepest node of either
    grain is followed: each time its two neighbours are checked.

    A disc of n nodes then rolls like a polygon with n corners, at any stiffness: only on slopes steeper than π/n.
    """

    def __init__(self, arrays: State, tables: Tables, outlines: list[Contour], count: int):
        self.tables, self.count = tables, count
        runs = _runs(count)
        self.length = len(runs)
        own = arrays.under("nodes")
        self.after = own.holding("after", np.array([after for _, _, after in runs]), "run", ti.i32)
        self.start = own.holding("start", np.array([first for first, _, _ in runs]), "run", ti.i32)
        self.circle = own.holding(
            "circle", np.array([_circles(outline, count, runs) for outline in outlines]), "outline run number"
        )
        self.point = own.holding(
            "point", np.array([_points(outline, count) for outline in outlines]), "outline node number"
        )
        self.steepest = own.holding(
            "steepest", SLACK * np.array([_steepest(outline) for outline in outlines]), "outline"
        )
        self.least = own.holding("least", np.array([_least(outline) for outline in outlines]), "outline")

    @ti.func
    def contact(self, one: ti.template(), two: ti.template(), apart, node_i, node_j, all_nodes):
        """The contact of grains i and j, with the deepest nodes of i and of j.

        The contact is: overlap ξ (m; negative: minus a lower bound of the gap; 0: no contact, gap unknown), normal
        towards i, contact point from i's centre (m), and the radii of curvature (m) of i and j there, 0 for the grain
        whose node it is. `one` and `two` are the outlines of i and j, `apart` the centre of i less that of j (m). The
        contact point is the deepest node: of all nodes if `all_nodes`, else of `node_i`, `node_j` and their neighbours.
        """
        between, back = turned_back(two.turn, one.turn), turned_back(one.turn, two.turn)
        centre, centre_back = turned_back(two.turn, apart), turned_back(one.turn, 0.0 - apart)
        a, b = node_i, node_j
        first = self.seen(one, between, two, centre, a)
        second = self.seen(two, back, one, centre_back, b)
        if all_nodes:
            a = self.search(one, between, two, centre, a, first[DEPTH])
            b = self.search(two, back, one, centre_back, b, second[DEPTH])
        else:
            a = self.deeper(one, between, two, centre, a, first[DEPTH])
            b = self.deeper(two, back, one, centre_back, b, second[DEPTH])
        if a != node_i:
            first = self.seen(one, between, two, centre, a)
        if b != node_j:
            second = self.seen(two, back, one, centre_back, b)
        contact = ti.Vector([0.0 * one.scale, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        there, here = overlap_of(first), overlap_of(second)
        if there > 0.0 and there >= here:
            own = own_of(first)
            normal, point, curved = normal_of(first, two.turn), turned(two.turn, own), self.curved(two, own)
            contact = ti.Vector([there, normal[0], normal[1], point[0] - apart[0], point[1] - apart[1], 0.0, curved])
        elif here > 0.0:
            own = own_of(second)
            normal, point, curved = 0.0 - normal_of(second, one.turn), turned(one.turn, own), self.curved(one, own)
            contact = ti.Vector([here, normal[0], normal[1], point[0], point[1], curved, 0.0])
        elif all_nodes:
            far_i, far_j = self.nearby(one), self.nearby(two)
            gap_i = ti.min(-first[DEPTH], far_j) * self.least[two.shape]
            contact[0] = -ti.min(gap_i, ti.min(-second[DEPTH], far_i) * self.least[one.shape])
        return contact, a, b

    @ti.func
    def curved(self, outline: ti.template(), own):
        """Radius of curvature (m) of an outline in the direction of a point."""
        return outline.scale * self.tables.curved(outline.shape, own[0], own[1])

    @ti.func
    def deeper(self, one: ti.template(), between, other: ti.template(), centre, known, depth_known):
        """The deepest of a node with a known depth and its two neighbours."""
        best, which = depth_known, known
        for side in ti.static((-1, 1)):
            node = self.beside(known, side)
            depth = self.depth(one, between, other, centre, node)
            if depth > best:
                best, which = depth, node
        return which

    @ti.func
    def place(self, shape, n):
        """Position of node n of an outline."""
        return ti.Vector([self.point[shape, n, 0], self.point[shape, n, 1]])

    @ti.func
    def nearby(self, outline: ti.template()):
        """Largest distance (m) outside a grain at which nodes are searched."""
        return NEARBY * outline.scale * self.tables.bounding[outline.shape]

    @ti.func
    def beside(self, node, side):
        """The next node on a side, 1 or −1."""
        n = node + side
        return ti.select(n < 0, self.count - 1, ti.select(n == self.count, 0, n))

    @ti.func
    def depth(self, one: ti.template(), between, other: ti.template(), centre, n):
        """Depth by polar radius (m) of a node in the other grain."""
        own = centre + one.scale * turned(between, self.place(one.shape, n))
        return other.scale * self.tables.radius(other.shape, own[0], own[1]) - own.norm()

    @ti.func
    def seen(self, one: ti.template(), between, other: ti.template(), centre, n):
        """Depth by polar radius (m) of a node in the other grain, R and R' there (m), the node in its frame (m)."""
        own = centre + one.scale * turned(between, self.place(one.shape, n))
        radius = other.scale * self.tables.radius_and_slope(other.shape, own[0], own[1])
        return ti.Vector([radius[0] - own.norm(), radius[0], radius[1], own[0], own[1]])

    @ti.func
    def search(self, one: ti.template(), between, other: ti.template(), centre, known, depth_known):
        """The node that is deepest by polar radius, even if outside; `known` if no node is NEARBY.

        The deeper the `known` node, the fewer others are checked.
        """
        reach, steepest = other.scale * self.tables.bounding[other.shape], other.scale * self.steepest[other.shape]
        best, which, k = ti.max(depth_known, -self.nearby(other)), known, 0
        while k < self.length:
            after = self.after[k]
            place = ti.Vector([self.circle[one.shape, k, 0], self.circle[one.shape, k, 1]]) * one.scale
            width = self.circle[one.shape, k, 2] * one.scale
            own = centre + turned(between, place)
            distance = own.norm()
            if reach - distance + width > best:
                depth = other.scale * self.tables.radius(other.shape, own[0], own[1]) - distance
                if width == 0.0:
                    if depth > best:
                        best, which = depth, self.start[k]
                else:
                    # Within the circle R changes by less than R' times asin(s), which is bounded by this polynomial.
                    s = width / ti.max(distance, TINY)
                    if s > 1.0 or depth + width + steepest * s * (1.0 + 0.5708 * s * s) > best:
                        after = k + 1
            k = after
        return which


@ti.func
def own_of(node):
    """A node's position in the other grain's frame."""
    return ti.Vector([node[3], node[4]])


@ti.func
def overlap_of(node):
    """Distance (m) of a node from the other outline's tangent at its polar angle."""
    return node[DEPTH] * node[1] / ti.sqrt(node[1] * node[1] + node[2] * node[2])


@ti.func
def normal_of(node, turn):
    """The other outline's unit normal along R e_r − R' e_θ at a node, with that grain rotated by `turn`."""
    own = own_of(node)
    size = 1.0 / (ti.sqrt(node[1] * node[1] + node[2] * node[2]) * ti.max(own.norm(), TINY))
    return turned(turn, ti.Vector([node[1] * own[0] + node[2] * own[1], node[1] * own[1] - node[2] * own[0]]) * size)


def _runs(count: int) -> list[tuple[int, int, int]]:
    """Runs of nodes in depth-first order: first node, one past the last, and the next run that is not a part of it."""
    runs = []

    def cut(first: int, end: int, parts: int) -> None:
        place = len(runs)
        if parts == PARTS:
            runs.append((first, end, 0))
        if end - first > 1:
            marks = [first + (end - first) * k // parts for k in range(parts + 1)]
            for a, b in pairwise(marks):
                if b > a:
                    cut(a, b, PARTS)
        if parts == PARTS:
            runs[place] = (first, end, len(runs))

    cut(0, count, ARCS)
    return runs


def _circles(outline: Contour, count: int, runs: list[tuple[int, int, int]]) -> np.ndarray:
    """Centre (x, y) and radius (m) of each run's bounding circle, (n, 3); a single node has radius 0."""
    points, circles = _points(outline, count), []
    for first, end, _ in runs:
        part = points[first:end]
        middle = 0.5 * (part.min(axis=0) + part.max(axis=0))
        circles.append((*middle, SLACK * np.linalg.norm(part - middle, axis=1).max()))
    return np.array(circles)


def _points(outline: Contour, count: int) -> np.ndarray:
    """The nodes (count, 2), m."""
    return outline.points(2.0 * np.pi / count * np.arange(count))


def _least(outline: Contour) -> float:
    """Lower bound of the distance of an outside point from an outline, relative to its distance by polar radius.

    The gradient of |p| − R(θ) is (1, −R'/|p|) along and across the radius, and |p| exceeds the smallest R outside.
    """
    return 1.0 / (SLACK * np.hypot(1.0, _steepest(outline) / outline.smallest_radius))


def _steepest(outline: Contour) -> float:
    """Largest |R'| (m)."""
    n = np.arange(1, len(outline.descriptors) + 1)
    amplitudes, phases = n * np.array(outline.descriptors), np.array(outline.phases) + 0.5 * np.pi
    return max(series.largest(amplitudes, phases), series.largest(-amplitudes, phases))
