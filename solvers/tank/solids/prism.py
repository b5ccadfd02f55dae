"""Walls of a tank that is a prism: those of its outline, drawn out, and the end walls with their rims."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.quantity import SPACE
from solvers.machine.state import State
from solvers.tank.pieces import Pieces
from solvers.tank.solids.bearing import faces_of
from solvers.tank.solids.solid import Prism
from solvers.tank.tank import Tank
from solvers.tank.walls import BEYOND, NOWHERE, Walls

# Columns of a rim's row: its start (m), then three vectors, its length (m).
#   An edge: its direction, and the directions from it into the two walls that meet there, zero where there is none.
#   A point: the directions along the edges that meet there.
START, FIRST, SECOND, THIRD, LENGTH = 0, 3, 6, 9, 12


@ti.data_oriented
class PrismWalls:
    """The walls of a prism, with the grains inside, as `Walls` has them in the plane: features, and their gaps.

    In the order of their numbers these are: the segments and corners of the outline and of the plates in it, drawn out
    along x; the two end walls; and in an open tank, whose walls act on both sides, the edges round the end walls and
    their points. A grain touches an end wall only where its centre is over it, an edge only between the edge's ends and
    beside both walls, and a point only beyond all edges there. So no contact counts twice, as in the plane. Plates in
    the tank reach from one end wall to the other.
    """

    smooth = False

    def __init__(self, arrays: State, tanks: Sequence[Tank], pieces: Pieces, solid: Prism):
        self.section = Walls(arrays, tanks, pieces)
        self.tanks, self.parts = self.section.tanks, self.section.parts
        self.moved, self.moving, self.fastest = pieces, pieces.moving, pieces.fastest
        self.solid, self.open, self.ends = solid, self.section.open, 0 if solid.periodic else 2
        own = arrays.under("prism")
        half = 0.5 * solid.along
        far = self.bounds[1][-1]
        self.half = own.holding("half", np.array([half, far]), "one", own.place)  # and how far grains are followed
        outline = tanks[0].outline
        self.sides = own.holding(
            "sides", np.column_stack([outline, np.roll(outline, -1, axis=0)]), "side number", own.place
        )
        self.count = len(outline)
        edges, points = _rims(tanks[0], half) if self.open and self.ends else ([], [])
        self.edges, self.points = len(edges), len(points)
        rims = np.array([*edges, *points] or [np.zeros(LENGTH + 1)])
        self.rims = own.holding("rims", rims, "rim number", own.place)
        self.drawn = self.section.features  # those of the outline and of plates
        self.features, self.real = self.drawn + self.ends + self.edges + self.points, arrays.real
        faces = len(solid.faces(outline))
        self.pieces = faces + self.parts
        ends = self.count + np.arange(self.ends)
        round_ends = np.repeat(ends, self.edges // 2), np.repeat(ends, self.points // 2)
        bearing = np.concatenate([faces_of(self.section, outline, faces), ends, *round_ends])
        self.bearing = own.holding("bearing", bearing, "feature", ti.i32)

    @property
    def said(self) -> str:
        """Its features in words."""
        rims = f", {self.edges} edges and {self.points} points round these" if self.open else ""
        ends = f", and 2 end walls{rims}" if self.ends else " without an end"
        return f"{self.section.said}, drawn out along x{ends}"

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the box round the tank, with a margin round an open one."""
        outline = self.section.outline
        half, (lower, upper) = self.solid.half(outline), self.section.bounds
        if self.ends and self.open:
            half *= 1.0 + 2.0 * BEYOND
        return np.append(lower, -half), np.append(upper, half)

    bounds_of_grains = bounds

    @ti.func
    def shift(self, w, t):
        """The poses of all pieces at time t (s)."""
        return self.section.shift(w, t)

    @ti.func
    def piece(self, feature):
        """Number of the piece of a feature: the faces of the tank come first (`Prism.faces`), then the parts."""
        return self.bearing[feature]

    @ti.func
    def velocity(self, feature, shift: ti.template(), y, z, x):
        """Velocity (m/s) of the point (y, z, x) of a feature in the tank's frame."""
        v = ti.Vector([ti.cast(0.0, self.real), ti.cast(0.0, self.real)])
        if feature < self.drawn:
            v = self.section.velocity(feature, shift, y, z)
        return ti.Vector([v[0], v[1], ti.cast(0.0, self.real)])

    @ti.func
    def rate(self, feature, shift: ti.template()):
        """Rate (rad/s) at which a feature turns in the tank's frame: about x alone."""
        rate, none = ti.cast(0.0, self.real), ti.cast(0.0, self.real)
        if feature < self.drawn:
            rate = self.section.rate(feature, shift)[0]
        return [none, none, rate]

    @ti.func
    def gap(self, feature, shift: ti.template(), y, z, x):
        """Signed distance (m) of a point from a wall feature and the unit normal towards the point, as of `Walls`."""
        found = ti.Vector([NOWHERE + 0.0 * y, 0.0 * y, 0.0 * y, 0.0 * y])
        if feature < self.drawn:
            flat = self.section.gap(feature, shift, y, z)
            found = ti.Vector([flat[0], flat[1], flat[2], 0.0 * y])
            if ti.static(self.open and self.ends > 0):  # noqa: SIM102 (only where grains may be beside the tank)
                if ti.abs(x) > self.half[0]:
                    found[0] = NOWHERE
        elif feature < self.drawn + self.ends:
            found = self.gap_of_end(feature - self.drawn, y, z, x)
        elif ti.static(self.edges > 0):
            found = self.gap_of_rim(feature - self.drawn - self.ends, y, z, x)
        return found

    @ti.func
    def gap_of_end(self, end, y, z, x):
        """The gap of the end wall at −half the length (0) or half the length (1)."""
        inward = 1.0 - 2.0 * end
        distance = self.half[0] + inward * x
        found = ti.Vector([distance, 0.0 * y, 0.0 * y, inward + 0.0 * y])
        if ti.static(self.open):
            if distance < 0.0:
                found = -found
            if not self.is_over(y, z):
                found[0] = NOWHERE
        return found

    @ti.func
    def is_over(self, y, z):
        """Whether a point is over an end wall (even–odd rule)."""
        inside = False
        for k in range(self.count):
            ay, az, by, bz = self.sides[k, 0], self.sides[k, 1], self.sides[k, 2], self.sides[k, 3]
            if (az > z) != (bz > z) and y < ay + (z - az) / (bz - az) * (by - ay):
                inside = not inside
        return inside

    @ti.func
    def gap_of_rim(self, rim, y, z, x):
        """The gap of an edge or a point of the end walls."""
        off = self.from_rim(rim, y, z, x)
        first, second, third = self.along(rim, FIRST, off), self.along(rim, SECOND, off), self.along(rim, THIRD, off)
        faces = second <= 0.0 and third <= 0.0
        if rim < self.edges:
            faces = faces and 0.0 <= first <= self.rims[rim, LENGTH]
            for a in ti.static(range(3)):
                off[a] -= first * self.rims[rim, FIRST + a]
        else:
            faces = faces and first < 0.0
        distance = off.norm()
        if not faces:
            distance = NOWHERE
        return ti.Vector([distance, off[0] / off.norm(), off[1] / off.norm(), off[2] / off.norm()])

    @ti.func
    def from_rim(self, rim, y, z, x):
        """The vector (m) from the start of an edge, or from a point, to (y, z, x)."""
        return ti.Vector([y - self.rims[rim, START], z - self.rims[rim, START + 1], x - self.rims[rim, START + 2]])

    @ti.func
    def along(self, rim, column: ti.template(), off):
        """A vector's component (m) along the direction of a rim that begins in a column."""
        found = off[0] * self.rims[rim, column]
        for a in ti.static(range(1, SPACE)):
            found += off[a] * self.rims[rim, column + a]
        return found

    @ti.func
    def near(self, feature, shift: ti.template(), reach, y, z, x):
        """Whether a point is within `reach` (m) of a wall feature, on either side."""
        found = False
        if feature < self.drawn:
            found = self.section.near(feature, shift, reach, y, z)
        elif feature < self.drawn + self.ends:
            found = ti.abs(self.half[0] + (1.0 - 2.0 * (feature - self.drawn)) * x) < reach
        elif ti.static(self.edges > 0):
            rim = feature - self.drawn - self.ends
            off = self.from_rim(rim, y, z, x)
            if rim < self.edges:
                along = ti.max(0.0, ti.min(self.rims[rim, LENGTH], self.along(rim, FIRST, off)))
                for a in ti.static(range(3)):
                    off[a] -= along * self.rims[rim, FIRST + a]
            found = off.dot(off) < reach * reach
        return found

    @ti.func
    def holds(self, y, z, x):
        """Whether a point lies in the tank or above its mouth."""
        inside = self.section.holds(y, z)
        if ti.static(self.ends > 0):
            inside = inside and ti.abs(x) <= self.half[0]
        return inside

    @ti.func
    def follows(self, y, z, x):
        """Whether a point lies in the box in which grains that have left the tank are followed."""
        near = self.section.follows(y, z)
        if ti.static(self.ends > 0):
            near = near and ti.abs(x) <= self.half[1]
        return near


def _rims(tank: Tank, half: float) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """The edges round both end walls of an open tank, and their points, as rows."""
    outline, count = tank.outline, len(tank.outline)
    ahead = np.roll(outline, -1, axis=0) - outline
    length = np.hypot(*ahead.T)
    ahead = ahead / length[:, None]
    walled = [k not in tank.open_edges for k in range(count)]
    edges, points = [], []
    for end in (-half, half):
        across = np.array([0.0, 0.0, -np.sign(end)])  # from the end wall into the tank
        for k in range(count):
            along, inward = np.array([*ahead[k], 0.0]), np.array([-ahead[k, 1], ahead[k, 0], 0.0])
            side = across if walled[k] else np.zeros(3)
            edges.append(np.array([*outline[k], end, *along, *inward, *side, length[k]]))
            back = np.array([*-ahead[k - 1], 0.0])
            through = across if walled[k] or walled[k - 1] else np.zeros(3)
            points.append(np.array([*outline[k], end, *along, *back, *through, 0.0]))
    return edges, points
