"""Walls of a tank that is a mesh of triangles."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.state import State
from solvers.tank.pieces import Pieces
from solvers.tank.solids import features as of
from solvers.tank.solids.mesh import STEEP, UP, Mesh
from solvers.tank.solids.nearby import Columns, Nearby
from solvers.tank.tank import Tank
from solvers.tank.walls import BEYOND, NOWHERE


@ti.data_oriented
class FaceWalls:
    """The walls of a mesh, with the grains inside, as `Walls` has them in the plane: features, and their gaps.

    In the order of their numbers these are its faces, edges and corners (`solvers.tank.solids.features`). Edges between
    faces in one plane are none, and a point above such an edge is over one of the faces. What a contact remembers goes
    on from one feature to the next of a smooth surface, one whose faces meet at less than 30 deg. Walls of a closed
    mesh act on the inside only, those of an open one on both sides.
    """

    smooth = True

    def __init__(self, arrays: State, tanks: Sequence[Tank], pieces: Pieces, solid: Mesh):
        self.tanks, self.pieces, self.parts = len(tanks), len(tanks) + len(pieces.parts), len(pieces.parts)
        self.moved, self.moving, self.fastest = pieces, pieces.moving, pieces.fastest
        self.mesh, self.open, self.real = solid, solid.open, arrays.real
        found = of.features_of(solid)
        self.faces, self.edges, self.corners = len(found.faces), len(found.edges), len(found.corners)
        self.features, self.found = self.faces + self.edges + self.corners, found
        own = arrays.under("faces")
        self.face = own.holding("face", found.faces, "face column", own.place)
        self.edge = own.holding("edge", _some(found.edges, of.AN_EDGE), "edge column", own.place)
        self.corner = own.holding("corner", _some(found.corners, of.A_CORNER), "corner column", own.place)
        self.spoke = own.holding("spoke", _some(found.spokes, 3), "spoke column", own.place)
        self.group = own.holding("group", found.group, "feature", ti.i32)
        self.box = own.holding("box", np.concatenate(self.bounds), "number", own.place)
        self.columns = Columns(own, solid)

    @property
    def said(self) -> str:
        """Its features in words."""
        return f"{self.faces} triangles, {self.edges} edges, {self.corners} corners"

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the box round the tank, with a margin round an open one."""
        lower, upper = self.mesh.box
        margin = BEYOND * (upper - lower) if self.open else 0.0
        return lower - margin, upper + margin

    bounds_of_grains = bounds

    def nearby(self, arrays: State, reach: float) -> Nearby:
        """The features that are near a point, for a reach of up to so much (m)."""
        return Nearby(arrays, self.mesh, self.found, self.bounds, reach)

    @ti.func
    def shift(self, w, t):
        """The poses of all pieces at time t (s)."""
        return self.moved.at(w, t)

    @ti.func
    def piece(self, feature):
        """Number of the piece of a feature: there is only the tank."""
        return 0

    @ti.func
    def velocity(self, feature, shift: ti.template(), y, z, x):
        """Velocity (m/s) of the point (y, z, x) of a feature in the tank's frame: it stands still."""
        none = ti.cast(0.0, self.real)
        return ti.Vector([none, none, none])

    @ti.func
    def rate(self, feature, shift: ti.template()):
        """Rate (rad/s) at which a feature turns in the tank's frame: none does."""
        none = ti.cast(0.0, self.real)
        return [none, none, none]

    @ti.func
    def gap(self, feature, shift: ti.template(), y, z, x):
        """Signed distance (m) of a point from a wall feature and the unit normal towards the point, as of `Walls`."""
        found = ti.Vector([NOWHERE + 0.0 * y, 0.0 * y, 0.0 * y, 0.0 * y])
        if feature < self.faces:
            found = self.gap_of_face(feature, y, z, x)
        elif feature < self.faces + self.edges:
            found = self.gap_of_edge(feature - self.faces, y, z, x)
        else:
            found = self.gap_of_corner(feature - self.faces - self.edges, y, z, x)
        return found

    @ti.func
    def gap_of_face(self, k, y, z, x):
        """The gap of a face."""
        inside = NOWHERE + 0.0 * y
        for side in ti.static(range(3)):
            inside = ti.min(inside, self.beyond(k, ti.static(of.SIDE + side * of.A_SIDE), y, z, x))
        distance = component(self.face, k, of.NORMAL, offset(self.face, k, of.SIDE, y, z, x))
        side = 1.0 + 0.0 * y
        if ti.static(self.open):  # noqa: SIM102 (only where grains may be on either side)
            if distance < 0.0:
                side -= 2.0
        normal = [side * self.face[k, of.NORMAL + a] for a in ti.static(range(3))]
        distance *= side
        if inside < 0.0:
            distance = NOWHERE
        return ti.Vector([distance, normal[0], normal[1], normal[2]])

    @ti.func
    def beyond(self, k, side: ti.template(), y, z, x):
        """How far (m) a point is beyond a side of a face, towards it; just below zero right above a side of another."""
        far = component(self.face, k, side + of.INTO, offset(self.face, k, side, y, z, x))
        return far - self.face[k, side + of.OTHERS]

    @ti.func
    def gap_of_edge(self, k, y, z, x):
        """The gap of an edge."""
        off = offset(self.edge, k, 0, y, z, x)
        along = component(self.edge, k, of.ALONG, off)
        past = component(self.edge, k, of.ALONG, offset(self.edge, k, of.END, y, z, x))
        over = ti.max(component(self.edge, k, of.ONE, off), component(self.edge, k, of.TWO, off))
        faces = ti.max(0.0 - along, past) <= 0.0 and over < 0.0
        for a in ti.static(range(3)):
            off[a] -= along * self.edge[k, of.ALONG + a]
        return away(off, faces)

    @ti.func
    def gap_of_corner(self, k, y, z, x):
        """The gap of a corner."""
        off = offset(self.corner, k, 0, y, z, x)
        along = -NOWHERE + 0.0 * y
        for n in range(ti.cast(self.corner[k, of.FIRST], ti.i32), ti.cast(self.corner[k, of.LAST], ti.i32)):
            along = ti.max(along, component(self.spoke, n, 0, off))
        return away(off, along < 0.0)

    @ti.func
    def near(self, feature, shift: ti.template(), reach, y, z, x):
        """Whether a point is within `reach` (m) of a wall feature, on either side; some that are not may be, too."""
        found = False
        if feature < self.faces:
            distance = component(self.face, feature, of.NORMAL, offset(self.face, feature, of.SIDE, y, z, x))
            off = 0.0 - ti.abs(distance)
            for side in ti.static(range(3)):
                off = ti.min(off, self.beyond(feature, ti.static(of.SIDE + side * of.A_SIDE), y, z, x))
            found = off + reach > 0.0
        elif feature < self.faces + self.edges:
            k = feature - self.faces
            off = offset(self.edge, k, 0, y, z, x)
            along, length = component(self.edge, k, of.ALONG, off), 0.0 * y
            for a in ti.static(range(3)):
                length += self.edge[k, of.ALONG + a] * (self.edge[k, of.END + a] - self.edge[k, a])
            along = ti.max(0.0, ti.min(length, along))
            for a in ti.static(range(3)):
                off[a] -= along * self.edge[k, of.ALONG + a]
            found = off.dot(off) < reach * reach
        else:
            off = offset(self.corner, feature - self.faces - self.edges, 0, y, z, x)
            found = off.dot(off) < reach * reach
        return found

    @ti.func
    def holds(self, y, z, x):
        """Whether a point lies in the tank or above its mouth: a line straight down crosses it an odd number of times.

        Corners are looked at in the order of their numbers, so two triangles see the edge between them alike.
        """
        inside, c = False, self.columns
        column = c.column(y, x)
        for n in range(c.first[column], c.first[column + 1]):
            k, crossed = c.listed[n], 0
            for a, b in ti.static(((0, 1), (1, 2), (0, 2))):
                ay, ax, by, bx = c.seen[k, 2 * a], c.seen[k, 2 * a + 1], c.seen[k, 2 * b], c.seen[k, 2 * b + 1]
                if (ax > x) != (bx > x) and y < ay + (x - ax) / (bx - ax) * (by - ay):
                    crossed += 1
            slope = self.face[k, of.NORMAL + UP]
            if crossed == 1 and ti.abs(slope) > STEEP:
                distance = component(self.face, k, of.NORMAL, offset(self.face, k, of.SIDE, y, z, x))
                if distance * slope > 0.0:  # above it
                    inside = not inside
        return inside

    @ti.func
    def follows(self, y, z, x):
        """Whether a point lies in the box in which grains that have left the tank are followed."""
        beside = self.box[0] <= y <= self.box[3] and self.box[2] <= x <= self.box[5]
        return beside and self.box[1] <= z <= self.box[4]


@ti.func
def offset(table: ti.template(), row, column: ti.template(), y, z, x):
    """The vector (m) from the point in a row of a table, from a column on, to (y, z, x)."""
    return ti.Vector([y - table[row, column], z - table[row, column + 1], x - table[row, column + 2]])


@ti.func
def component(table: ti.template(), row, column: ti.template(), vector):
    """A vector's component along the direction in a row of a table, from a column on."""
    return vector[0] * table[row, column] + vector[1] * table[row, column + 1] + vector[2] * table[row, column + 2]


@ti.func
def away(off, faces):
    """The distance (m) and direction of an offset, nowhere unless the point `faces` the feature."""
    distance = off.norm()
    found = ti.Vector([distance, off[0] / distance, off[1] / distance, off[2] / distance])
    if not faces:
        found[0] = NOWHERE
    return found


def _some(rows: np.ndarray, columns: int) -> np.ndarray:
    """Rows for an array, which cannot be empty."""
    return rows if len(rows) else np.zeros((1, columns))
