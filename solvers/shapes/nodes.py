"""The source's discrete rule for two grains: the deepest node of either inside the other's outline."""

from itertools import pairwise

import numpy as np
import taichi as ti

from solvers.runtime import Arrays
from solvers.shapes import series
from solvers.shapes.contour import Contour
from solvers.shapes.pose import turned, turned_back
from solvers.shapes.tables import TINY, Tables

PARTS = 4  # into which a run of nodes is cut
ARCS = 8  # at the top
SLACK = 1.0 + 1e-6  # on bounds, for the tables' errors and rounding


@ti.data_oriented
class Nodes:
    """`count` nodes on each outline, evenly by polar angle, in runs within runs with a circle about each.

    A run is passed over if no point of its circle can lie deeper in the other grain than what has been found. So few
    nodes are looked at, but the result is that of Spandonidis (2016), table 8.1, over all of them. The exception is
    step 6, for which the tangent is the other outline's at the node's polar angle, not a chord of two nodes.
    """

    def __init__(self, arrays: Arrays, tables: Tables, outlines: list[Contour], count: int):
        self.tables = tables
        runs = _runs(count)
        self.length = len(runs)
        self.after = arrays.holding(np.array([after for _, _, after in runs]), ti.i32)
        self.circle = arrays.holding(np.array([_circles(outline, count, runs) for outline in outlines]))
        self.steepest = arrays.holding(SLACK * np.array([_steepest(outline) for outline in outlines]))

    @ti.func
    def contact(self, shape_i, scale_i, turn_i, shape_j, scale_j, turn_j, apart):
        """Overlap ξ (m; 0 if none), normal towards i (y, z) and contact point from i's centre (y, z) m.

        `turn` is (cos, sin) of a grain's angle, `apart` the centre of i less that of j (m). The contact point is the
        deepest node.
        """
        contact = ti.Vector([0.0 * scale_i, 0.0, 0.0, 0.0, 0.0])
        reach_i, reach_j = scale_i * self.tables.bounding[shape_i], scale_j * self.tables.bounding[shape_j]
        if apart.norm_sqr() < (reach_i + reach_j) ** 2:
            there = self.deepest(shape_i, scale_i, turn_i, shape_j, scale_j, turn_j, apart)
            back = self.deepest(shape_j, scale_j, turn_j, shape_i, scale_i, turn_i, -apart)
            if there[0] > 0.0 and there[0] >= back[0]:
                contact = ti.Vector([there[0], there[1], there[2], there[3] - apart[0], there[4] - apart[1]])
            elif back[0] > 0.0:
                contact = ti.Vector([back[0], -back[1], -back[2], back[3], back[4]])
        return contact

    @ti.func
    def deepest(self, shape, scale, turn, other, other_scale, other_turn, apart):
        """Overlap, the other outline's normal and the node from the other's centre, for the nodes of one grain."""
        k = self.search(shape, scale, turn, other, other_scale, other_turn, apart)
        found = ti.Vector([0.0 * scale, 0.0, 0.0, 0.0, 0.0])
        if k >= 0:
            own = self.seen(shape, scale, turn, other_turn, apart, k)
            distance = own.norm()
            radius = other_scale * self.tables.radius_and_slope(other, own[0], own[1])
            # The normal R e_r − R' e_θ.
            ny, nz = radius[0] * own[0] + radius[1] * own[1], radius[0] * own[1] - radius[1] * own[0]
            tilt = radius[0] / ti.sqrt(radius[0] ** 2 + radius[1] ** 2)
            size = tilt / (radius[0] * ti.max(distance, TINY))
            normal, point = turned(other_turn, ti.Vector([ny, nz]) * size), turned(other_turn, own)
            found = ti.Vector([(radius[0] - distance) * tilt, normal[0], normal[1], point[0], point[1]])
        return found

    @ti.func
    def search(self, shape, scale, turn, other, other_scale, other_turn, apart):
        """Place in `circle` of the node that lies deepest by polar radius; −1 if none lies inside."""
        between = turned_back(other_turn, turn)
        centre = turned_back(other_turn, apart)
        reach, steepest = other_scale * self.tables.bounding[other], other_scale * self.steepest[other]
        best, which, k = 0.0 * scale, -1, 0
        while k < self.length:
            after = self.after[k]
            place = ti.Vector([self.circle[shape, k, 0], self.circle[shape, k, 1]]) * scale
            width = self.circle[shape, k, 2] * scale
            own = centre + turned(between, place)
            distance = own.norm()
            if reach - distance + width > best:
                depth = other_scale * self.tables.radius(other, own[0], own[1]) - distance
                if width == 0.0:
                    if depth > best:
                        best, which = depth, k
                else:
                    # From the circle's middle R changes by R' times the angle asin(s), which is less than this.
                    s = width / ti.max(distance, TINY)
                    if s > 1.0 or depth + width + steepest * s * (1.0 + 0.5708 * s * s) > best:
                        after = k + 1
            k = after
        return which

    @ti.func
    def seen(self, shape, scale, turn, other_turn, apart, k):
        """A node from the centre of another grain, in that grain's frame."""
        place = ti.Vector([self.circle[shape, k, 0], self.circle[shape, k, 1]]) * scale
        return turned_back(other_turn, apart) + turned(turned_back(other_turn, turn), place)


def _runs(count: int) -> list[tuple[int, int, int]]:
    """Runs of nodes, each before its parts: first node, one past the last, and the next run that is not within."""
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
    """Middle (x, y) and radius (m) of a circle about each run, (n, 3); a node's radius is 0."""
    points = outline.points(2.0 * np.pi / count * np.arange(count))
    circles = []
    for first, end, _ in runs:
        part = points[first:end]
        middle = 0.5 * (part.min(axis=0) + part.max(axis=0))
        circles.append((*middle, SLACK * np.linalg.norm(part - middle, axis=1).max()))
    return np.array(circles)


def _steepest(outline: Contour) -> float:
    """Largest |R'| (m)."""
    n = np.arange(1, len(outline.descriptors) + 1)
    amplitudes, phases = n * np.array(outline.descriptors), np.array(outline.phases) + 0.5 * np.pi
    return max(series.largest(amplitudes, phases), series.largest(-amplitudes, phases))
