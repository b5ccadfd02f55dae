"""The search for contacts of bodies: corners of one solid that are in another, by the nearest edge that they face."""

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, Scope
from solvers.motion.contact_pairs import OF_TANK, Shape
from solvers.tank.pieces import COSINE, SINE, Pieces, Y, Z

FAR = 1e30  # m or m²
# Columns of `corners`: place (m), direction into the solid, and the row of the pair; and of `edges`, those of a `Shape`
C_Y, C_Z, INWARD_Y, INWARD_Z, PAIR = range(5)
A_Y, A_Z, T_Y, T_Z, LENGTH, AT_START, AT_END = range(7)
# Columns of `places`: the numbers of the parts whose corners and whose edges touch, and where the edges begin and end
OWNER, OTHER, FIRST, END = range(4)
# Columns of `bounds`: the box (m) of the edges, and how deep (m) a corner may be in their solid
LEAST_Y, LEAST_Z, MOST_Y, MOST_Z, DEEPEST = range(5)
# Columns of `found`: the overlap (m), the normal away from the edge, and the corner's place (m)
OVERLAP, N_Y, N_Z, P_Y, P_Z = range(5)


@ti.data_oriented
class ContactSearch:
    """Where the corners of solids touch other solids, for all `pairs` (whose corners, whose edges) of `shapes`.

    A corner that stands out of its solid touches another solid at the nearest point of those edges that it faces, whose
    normal points into the corner's own solid: so a row of short edges is one smooth surface, and of two corners that
    meet head-on neither is pushed aside. Where the other solid has a re-entrant corner, as a tank has seen from
    outside, the nearest point may be that corner. So each corner has one contact at most with each solid.

    A corner is no more in a solid, but beyond it, where it is deeper than the thickness of its own body's parts.
    """

    def __init__(self, own: Scope, pieces: Pieces, worlds: int, shapes: list[Shape], pairs: list):
        self.pieces, self.exact = pieces, own.exact
        self.count = sum(len(one.nodes) for one, _ in pairs)
        ends = np.cumsum([0, *(len(shape.edges) for shape in shapes)])
        begins = {id(shape): int(first) for shape, first in zip(shapes, ends[:-1], strict=True)}
        corners = [[*node, k] for k, (one, _) in enumerate(pairs) for node in one.nodes]
        edges = [(begins[id(other)], begins[id(other)] + len(other.edges)) for _, other in pairs]
        places = [[one.part, other.part, *of] for (one, other), of in zip(pairs, edges, strict=True)]
        deepest = [(other if one.part == OF_TANK else one).thickness for one, other in pairs]
        bounds = [[*_box(other, deep), deep] for (_, other), deep in zip(pairs, deepest, strict=True)]
        self.edges = own.holding("edges", np.concatenate([shape.edges for shape in shapes]), "edge number", own.exact)
        self.corners = own.holding("corners", np.array(corners), "contact number", own.exact)
        self.places = own.holding("places", np.array(places), "pair number", ti.i32)
        self.bounds = own.holding("bounds", np.array(bounds), "pair number", own.exact)
        each = Axis("world", worlds), Axis("contact", self.count), Axis("number", 5)
        (self.found,) = own.reals(each, "found", kind=own.exact, kept=False)

    @ti.func
    def pair(self, c):
        """The pair that a contact belongs to."""
        return ti.cast(self.corners[c, PAIR], ti.i32)

    @ti.func
    def pose(self, w, part):
        """The pose of a part in the tank as the step begins; that of the tank if it is none."""
        found = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(7))])
        found[COSINE] = 1.0
        if part >= 0:
            for k in ti.static(range(7)):
                found[k] = self.pieces.poses[w, part, k]
        return found

    @ti.func
    def find(self, w, c):
        """Find where the corner of a contact is, and its overlap with the other solid; zero if there is none."""
        pair = self.pair(c)
        own, other = self.pose(w, self.places[pair, OWNER]), self.pose(w, self.places[pair, OTHER])
        drawn = ti.Vector([self.corners[c, C_Y], self.corners[c, C_Z]])
        place = _turned(own, drawn, 1.0) + ti.Vector([own[Y], own[Z]])
        far = _turned(other, place - ti.Vector([other[Y], other[Z]]), -1.0)
        self.found[w, c, OVERLAP], self.found[w, c, P_Y], self.found[w, c, P_Z] = 0.0, place[0], place[1]
        if self.in_box(pair, far[0], far[1]):
            inward = _turned(own, ti.Vector([self.corners[c, INWARD_Y], self.corners[c, INWARD_Z]]), 1.0)
            into = _turned(other, inward, -1.0)
            nearest = self.nearest(pair, far[0], far[1], into[0], into[1])
            normal = _turned(other, ti.Vector([nearest[1], nearest[2]]), 1.0)
            self.found[w, c, OVERLAP], self.found[w, c, N_Y], self.found[w, c, N_Z] = nearest[0], normal[0], normal[1]

    @ti.func
    def in_box(self, pair, y, z):
        """Whether a place in the other's axes is in the box around its edges."""
        along = self.bounds[pair, LEAST_Y] <= y <= self.bounds[pair, MOST_Y]
        return along and self.bounds[pair, LEAST_Z] <= z <= self.bounds[pair, MOST_Z]

    @ti.func
    def nearest(self, pair, y, z, inward_y, inward_z):
        """Overlap and normal of a corner at a place in the other's axes, with that direction into its solid."""
        overlap, n_y, n_z = ti.cast(0.0, self.exact), ti.cast(0.0, self.exact), ti.cast(0.0, self.exact)
        nearest = ti.cast(FAR, self.exact)
        for e in range(self.places[pair, FIRST], self.places[pair, END]):
            t_y, t_z = self.edges[e, T_Y], self.edges[e, T_Z]
            if t_z * inward_y - t_y * inward_z > 0.0:
                off_y, off_z = y - self.edges[e, A_Y], z - self.edges[e, A_Z]
                along, deep = off_y * t_y + off_z * t_z, t_y * off_z - t_z * off_y
                past = along - ti.min(ti.max(along, 0.0), self.edges[e, LENGTH])
                square = deep * deep + past * past
                if square < nearest:
                    nearest, overlap, n_y, n_z = square, ti.max(deep, 0.0), t_z, -t_y
                    if past != 0.0:
                        wedged = self.edges[e, AT_START] if past < 0.0 else self.edges[e, AT_END]
                        overlap *= wedged  # 0 past an end beside which there is no more solid
                        if overlap > 0.0:
                            overlap = ti.sqrt(square)
                            n_y, n_z = (deep * t_z - past * t_y) / overlap, (0.0 - deep * t_y - past * t_z) / overlap
        if overlap > self.bounds[pair, DEEPEST]:
            overlap = 0.0
        return ti.Vector([overlap, n_y, n_z])


@ti.func
def _turned(pose: ti.template(), vector: ti.template(), sign: ti.template()):
    """A vector turned as a pose says, or with the sign −1 back."""
    cos, sin = pose[COSINE], sign * pose[SINE]
    return ti.Vector([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]])


def _box(shape: Shape, deepest: float) -> list[float]:
    """The box (m) in which a corner may touch a solid, up to `deepest` beyond it; everywhere for a tank."""
    if shape.part == OF_TANK:
        return [-FAR, -FAR, FAR, FAR]
    starts = shape.edges[:, [A_Y, A_Z]]
    return [*(starts.min(axis=0) - deepest), *(starts.max(axis=0) + deepest)]
