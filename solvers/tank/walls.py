"""Walls: the tanks' outlines, polygons of straight segments, some of them open, and plates that move in them."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.state import State
from solvers.tank.parts import Part
from solvers.tank.pieces import COSINE, RATE, SINE, V_Y, V_Z, Pieces
from solvers.tank.pieces import Y as O_Y
from solvers.tank.pieces import Z as O_Z
from solvers.tank.tank import Tank

Y, Z, ALONG_Y, ALONG_Z, LENGTH, TWO_SIDED, PART = range(7)
AFTER_Y, AFTER_Z = LENGTH, TWO_SIDED  # columns that in a corner's row hold the direction of the segment after it
BEYOND = 0.5  # margin round an open tank in which spilled grains are followed, in its own width and height
NOWHERE = 1e30  # m, the gap of a point that does not face a feature
CHIMNEY = 5.0  # height above the mouth at which a grain still counts as in the tank, in the tank's size


@ti.data_oriented
class Walls:
    """The outlines of a world's tanks, with the grains inside, and thin plates.

    Features are segments and corners. A grain touches a segment only if its centre projects onto it, and a corner only
    beyond the ends of both of the corner's segments, so no contact counts twice. The walls of a closed tank act on the
    inside only, and only its re-entrant corners count. The walls of an open tank and the parts are plates without
    thickness, which act on both sides and round their edges; so are closed parts, whose inside is empty. Tanks `apart`,
    by their numbers, are not among these, with the parts in them: they hold no grains, and may overlap with those that
    do. Functions of a feature take the poses of all pieces, as `Pieces.at` tells them.
    """

    smooth = False  # whether features are parts of smooth surfaces, on which contacts go on from one to the next

    def __init__(self, arrays: State, tanks: Sequence[Tank], pieces: Pieces, apart: Sequence[int] = ()):
        parts, self.moved = pieces.parts, pieces
        self.tanks = len(tanks)
        self.outline = np.concatenate([tank.outline for tank in tanks])
        self.parts, self.pieces = len(parts), len(tanks) + len(parts)
        joint = {number: tank for number, tank in enumerate(tanks) if number not in apart}
        self.open = any(tank.open_edges for tank in joint.values())
        self.open_edges = tanks[0].open_edges
        aboard = [tank.outline for tank in tanks if tank.aboard is not None]
        self.within = np.concatenate(aboard) if aboard else self.outline  # where grains may be
        plates = [_shell(tank, number) for number, tank in joint.items()]
        plates += [_plate(part, number) for number, part in enumerate(parts) if part.tank not in apart]
        segments = [row for plate in plates for row in plate.segments]
        corners = [row for plate in plates for row in plate.corners]
        self.segments, self.corners = len(segments), len(corners)
        self.features = self.segments + self.corners
        self.rows = np.array(segments + corners, dtype=np.float64)
        own = arrays.under("walls")
        self.table = own.holding("table", self.rows, "feature number", own.place)
        self.fastest, self.moving, self.turning = pieces.fastest, pieces.moving, pieces.turning  # m/s
        edges = _edges([_with_chimneys(tank.outline, tank.open_edges) for tank in joint.values()])
        self.mouth_edges = len(edges)
        self.mouth = own.holding("mouth", edges, "edge number", own.place)
        if self.tanks > 1:
            ends = np.cumsum([0, *(len(tank.outline) for tank in tanks)])
            self.ends = own.holding("ends", ends, "end", ti.i32)
            self.sides = own.holding("sides", _edges([tank.outline for tank in tanks]), "side number", own.place)
        self.real = arrays.real
        self.edge = own.holding("edge", np.concatenate(self.bounds), "number", own.place)

    @property
    def said(self) -> str:
        """Its features in words."""
        return f"{self.segments} segments, {self.corners} corners"

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the box round all tanks, with a margin round open ones."""
        return self._box(self.outline)

    @property
    def bounds_of_grains(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the box in which grains, also those that have left the tank, are followed."""
        return self._box(self.within)

    def _box(self, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        lower, upper = corners.min(axis=0), corners.max(axis=0)
        margin = BEYOND * (upper - lower) if self.open else 0.0
        return lower - margin, upper + margin

    @ti.func
    def shift(self, w, t):
        """The poses of all pieces at time t (s)."""
        return self.moved.at(w, t)

    @ti.func
    def piece(self, feature):
        """Number of the piece that a feature belongs to: the walls of each tank come first, then the parts."""
        part = ti.cast(self.table[feature, PART], ti.i32)
        return ti.select(part < 0, -1 - part, self.tanks + part)

    @ti.func
    def from_start(self, feature, shift: ti.template(), y, z):
        """The vector (m) from the start of a feature to the point (y, z), in the axes in which the feature is drawn."""
        py, pz = y - self.table[feature, Y], z - self.table[feature, Z]
        if ti.static(self.parts > 0):
            part = ti.cast(self.table[feature, PART], ti.i32)
            for p in ti.static(range(self.parts)):
                first = ti.static(self.moved.size * p)
                if part == p:
                    if ti.static(self.turning):
                        far_y, far_z = y - shift[first + O_Y], z - shift[first + O_Z]
                        cos, sin = shift[first + COSINE], shift[first + SINE]
                        py = cos * far_y + sin * far_z - self.table[feature, Y]
                        pz = cos * far_z - sin * far_y - self.table[feature, Z]
                    else:
                        py -= shift[first + O_Y]
                        pz -= shift[first + O_Z]
        return ti.Vector([py, pz])

    @ti.func
    def turned(self, feature, shift: ti.template(), y, z):
        """A vector of the axes in which a feature is drawn, in those of the tank."""
        ty, tz = y, z
        if ti.static(self.turning):
            part = ti.cast(self.table[feature, PART], ti.i32)
            for p in ti.static(range(self.parts)):
                first = ti.static(self.moved.size * p)
                if part == p:
                    cos, sin = shift[first + COSINE], shift[first + SINE]
                    ty, tz = cos * y - sin * z, sin * y + cos * z
        return ti.Vector([ty, tz])

    @ti.func
    def velocity(self, feature, shift: ti.template(), y, z):
        """Velocity (m/s) of the point (y, z) of a feature in the tank's frame."""
        v = ti.Vector([ti.cast(0.0, self.real), ti.cast(0.0, self.real)])
        if ti.static(self.parts > 0):
            part = ti.cast(self.table[feature, PART], ti.i32)
            for p in ti.static(range(self.parts)):
                first = ti.static(self.moved.size * p)
                if part == p:
                    v = ti.Vector([shift[first + V_Y], shift[first + V_Z]])
                    if ti.static(self.turning):
                        v[0] -= shift[first + RATE] * ti.cast(z - shift[first + O_Z], self.real)
                        v[1] += shift[first + RATE] * ti.cast(y - shift[first + O_Y], self.real)
        return v

    @ti.func
    def rate(self, feature, shift: ti.template()):
        """Rate (rad/s) at which a feature turns in the tank's frame, a list as of all rotations."""
        rate = ti.cast(0.0, self.real)
        if ti.static(self.turning):
            part = ti.cast(self.table[feature, PART], ti.i32)
            for p in ti.static(range(self.parts)):
                if part == p:
                    rate = shift[ti.static(self.moved.size * p + RATE)]
        return [rate]

    @ti.func
    def gap(self, feature, shift: ti.template(), y, z):
        """Signed distance (m) of a point from a wall feature and the unit normal towards the point.

        There is no contact if the distance is huge, as for a point that does not face the feature, or negative, as
        behind a one-sided segment.
        """
        point = self.from_start(feature, shift, y, z)
        py, pz = point[0], point[1]
        ty, tz = self.table[feature, ALONG_Y], self.table[feature, ALONG_Z]
        along = py * ty + pz * tz
        distance, normal_y, normal_z = py * -tz + pz * ty, -tz, ty
        if ti.static(self.corners == 0) or feature < self.segments:
            if ti.static(self.open or self.parts > 0):  # noqa: SIM102 (compiled only where there are plates)
                if self.table[feature, TWO_SIDED] > 0.0 and distance < 0.0:
                    distance, normal_y, normal_z = -distance, -normal_y, -normal_z
            if along < 0.0 or along > self.table[feature, LENGTH]:
                distance = NOWHERE
        else:
            beyond = py * self.table[feature, AFTER_Y] + pz * self.table[feature, AFTER_Z]
            distance = ti.sqrt(py * py + pz * pz)
            normal_y, normal_z = py / distance, pz / distance
            if along <= 0.0 or beyond >= 0.0:
                distance = NOWHERE
        if ti.static(self.turning):
            normal = self.turned(feature, shift, normal_y, normal_z)
            normal_y, normal_z = normal[0], normal[1]
        return ti.Vector([distance, normal_y, normal_z])

    @ti.func
    def near(self, feature, shift: ti.template(), reach, y, z):
        """Whether a point is within `reach` (m) of a wall feature, on either side."""
        point = self.from_start(feature, shift, y, z)
        py, pz = point[0], point[1]
        if feature < self.segments:
            ty, tz = self.table[feature, ALONG_Y], self.table[feature, ALONG_Z]
            along = ti.max(0.0, ti.min(self.table[feature, LENGTH], py * ty + pz * tz))
            py -= along * ty
            pz -= along * tz
        return py * py + pz * pz < reach * reach

    @ti.func
    def holds(self, y, z):
        """Whether a point lies in the tank or above its mouth (even–odd rule)."""
        inside = False
        for k in range(self.mouth_edges):
            ay, az, by, bz = self.mouth[k, 0], self.mouth[k, 1], self.mouth[k, 2], self.mouth[k, 3]
            if (az > z) != (bz > z) and y < ay + (z - az) / (bz - az) * (by - ay):
                inside = not inside
        return inside

    @ti.func
    def is_off(self, tank, y, z, near):
        """Whether a point is outside one of several tanks, and farther than `near` (m) from its walls."""
        inside, beside = False, False
        for k in range(self.ends[tank], self.ends[tank + 1]):
            ay, az, by, bz = self.sides[k, 0], self.sides[k, 1], self.sides[k, 2], self.sides[k, 3]
            if (az > z) != (bz > z) and y < ay + (z - az) / (bz - az) * (by - ay):
                inside = not inside
            along_y, along_z = by - ay, bz - az
            share = ((y - ay) * along_y + (z - az) * along_z) / (along_y * along_y + along_z * along_z)
            share = ti.max(0.0, ti.min(1.0, share))
            off_y, off_z = y - ay - share * along_y, z - az - share * along_z
            if off_y * off_y + off_z * off_z < near * near:
                beside = True
        return not inside and not beside

    @ti.func
    def follows(self, y, z):
        """Whether a point lies in the box in which grains that have left the tank are followed."""
        return self.edge[0] <= y <= self.edge[2] and self.edge[1] <= z <= self.edge[3]


def _edges(outlines: Sequence[np.ndarray]) -> np.ndarray:
    """All edges of polygons (m, 2) m: both ends (k, 4) m of each."""
    return np.concatenate([np.column_stack([one, np.roll(one, -1, axis=0)]) for one in outlines])


class _Features:
    """Rows of the table: segments and corners of one polyline, `two_sided` or not, that belongs to part `part`.

    Tanks have the part numbers −1, −2, …
    """

    def __init__(self, two_sided: bool, part: float):
        self.two_sided, self.part = two_sided, part
        self.segments: list[list[float]] = []
        self.corners: list[list[float]] = []

    def add_segment(self, start: np.ndarray, end: np.ndarray) -> None:
        length = float(np.hypot(*(end - start)))
        self.segments.append([*start, *(end - start) / length, length, float(self.two_sided), self.part])

    def add_corner(self, points: np.ndarray, before: int | None, at: int, follows: bool) -> None:
        """Add the corner `at`, between segment `before` (or None) and the one that starts there, if one `follows`."""
        if before is None and not follows:
            return
        ahead = _direction(points, at) if follows else -_direction(points, before)
        behind = _direction(points, before) if before is not None else -ahead
        if self.two_sided or behind[0] * ahead[1] - behind[1] * ahead[0] < -1e-12:
            self.corners.append([*points[at], *behind, *ahead, self.part])


def _direction(points: np.ndarray, k: int) -> np.ndarray:
    """Unit vector from corner k to the next."""
    edge = points[(k + 1) % len(points)] - points[k]
    return edge / np.hypot(*edge)


def _shell(tank: Tank, number: int) -> _Features:
    """The features of a tank's outline."""
    outline, count = tank.outline, len(tank.outline)
    shell = _Features(bool(tank.open_edges), -1.0 - number)
    closed = [k for k in range(count) if k not in tank.open_edges]
    for k in closed:
        shell.add_segment(outline[k], outline[(k + 1) % count])
    for k in range(count):
        shell.add_corner(outline, (k - 1) % count if (k - 1) % count in closed else None, k, k in closed)
    return shell


def _plate(part: Part, number: int) -> _Features:
    """The features of a part: an open polyline, or a polygon."""
    points = np.asarray(part.points, dtype=np.float64)
    plate, count = _Features(True, float(number)), len(points)
    for k in range(count if part.closed else count - 1):
        plate.add_segment(points[k], points[(k + 1) % count])
    for k in range(count):
        before = (k - 1) % count if k or part.closed else None
        plate.add_corner(points, before, k, k < count - 1 or part.closed)
    return plate


def _with_chimneys(outline: np.ndarray, open_edges: Sequence[int]) -> np.ndarray:
    """The outline with a shaft on each open edge that faces up, since a grain above the mouth has not been spilled."""
    size = CHIMNEY * float(np.ptp(outline, axis=0).max())
    points = []
    for k, corner in enumerate(outline):
        points.append(corner)
        along = _direction(outline, k)
        if k in open_edges and along[0] < 0.0:
            out = size * np.array([along[1], -along[0]])
            points += [corner + out, outline[(k + 1) % len(outline)] + out]
    return np.array(points)
