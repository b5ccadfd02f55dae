"""Reuse of contacts between evaluations of a rule: carried along with the grains until these have moved too far."""

import taichi as ti

from solvers.grains.lists.gathering import gathered
from solvers.grains.lists.neighbours import LANES
from solvers.grains.lists.validity import NEVER
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.machine.wide import enter, entry, size
from solvers.space.extremes import greater, lesser

# Elements of a rule's contact: overlap (m), unit normal, point from the first grain's centre (m), whether it exists.
OVERLAP, NORMAL_Y, NORMAL_Z, POINT_Y, POINT_Z, HOLDS = range(6)
# Movement, in radii of the smaller grain, after which a rule is evaluated again. The errors are then HARDLY² radii for
# an overlap and HARDLY for a normal, each times a radius over the outlines' radii of curvature.
HARDLY = 1e-5
STILL = "still"
SURE = "sure"  # memory of rules: how far (m) two grains may still move until new contacts are looked for
SEEN = (STILL, "apart_y", "apart_z", "angle_first", "angle_second")
SAID = ("overlap", "normal_y", "normal_z", "point_y", "point_z")
CACHE_LINES = 16  # numbers in two cache lines, a distance at which no two threads write to one line


@ti.data_oriented
class Rest:
    """The last contacts from a rule, the grains' poses then, and how far (m) they may move until it is evaluated again.

    That distance is HARDLY, or the gap if the grains were apart. Meanwhile the overlap changes with the motion of the
    contact point along the normal, which is exact to first order; normal and point are kept.

    Contacts are carried one block at a time, with `wide` of them in a block on real vectors. They are laid out in `now`
    only where the rule must be evaluated for some of them, since what is written lane by lane is slow to read as a
    vector. `asked` is then 1 for these, else 0. Saddles, if outlines are non-convex (`bent`), are in `saddle_now`. The
    order is that of SAID.
    """

    said, elements = SAID, (OVERLAP, NORMAL_Y, NORMAL_Z, POINT_Y, POINT_Z)  # stored elements by name and number

    def __init__(self, arrays: State, units: Units, bent: bool, wide: int = 0):
        # With non-convex outlines most entries are free; blocks of one contact can be skipped.
        self.bent, self.lanes = bent, 1 if bent or units.single else wide or LANES
        self.contact = tuple(f"was_{name}" for name in self.said)
        self.saddle = tuple(f"saddle_{name}" for name in self.said) if bent else ()
        self.memory = SEEN + self.contact + self.saddle
        self.spacing = 1 if units.single else max(2, CACHE_LINES // self.lanes)
        own, rows = arrays.under("rest"), Axis("unit", self.spacing * units.count)
        axes, ways = (rows, Axis("block", 1), Axis("lane", self.lanes)), {"kept": False, "wide": wide > 0}
        self.now = own.vectors(axes, *SAID, **ways)
        self.saddle_now = own.vectors(axes, *self.saddle, **ways)
        (self.asked,) = own.vectors(axes, "asked", **ways)

    @ti.func
    def is_open(self, g: ti.template(), pairs: ti.template(), i, j, u, p):
        """Whether two grains that were apart still are, for blocks of a single contact."""
        y, z, angle_i, angle_j = self.moves(g, pairs, i, j, u, p)
        way = self.way(pairs, u, p, y, z, angle_i, angle_j)[0]
        return pairs.was_overlap[u, p][0] <= -way and way < pairs.still[u, p][0]

    @ti.func
    def carry(self, g: ti.template(), pairs: ti.template(), i, j, u, block):
        """Carry a block of contacts along with grains i and j.

        Returns the vectors (y, z) m from j to i, the contacts in the order of SAID, and for each 1 if the rule must be
        evaluated, else 0.
        """
        y, z, angle_i, angle_j = self.moves(g, pairs, i, j, u, block)
        moves = [y, z, angle_i, angle_j]
        overlap, ny, nz, py, pz, slid = self.carried(self.contact, pairs, u, block, moves)
        if ti.static(self.bent):
            saddle, my, mz, qy, qz, _ = self.carried(self.saddle, pairs, u, block, moves)
            self.lay(self.saddle_now, u, [saddle, my, mz, qy, qz])
        way, still = self.way(pairs, u, block, y, z, angle_i, angle_j), pairs.still[u, block]
        far = self.far(pairs, u, block, way, slid, angle_i, angle_j)
        asked = ti.select(far < still, 0.0 * still, 1.0 + 0.0 * still)  # 1 also if `far` is NaN
        return y + pairs.apart_y[u, block], z + pairs.apart_z[u, block], overlap, ny, nz, py, pz, asked

    @ti.func
    def lay_out(self, u, now: ti.template(), asked):
        """Write a unit's block of contacts to memory, and for which the rule must be evaluated."""
        self.lay(self.now, u, now)
        self.asked[self.place(u), 0] = asked

    @ti.func
    def lay(self, where: ti.template(), u, block: ti.template()):
        """Write a unit's block to `now` or `saddle_now`."""
        for k in ti.static(range(len(SAID))):
            where[k][self.place(u), 0] = block[k]

    @ti.func
    def place(self, u):
        """Row of a unit's block in `now`, `saddle_now` and `asked`."""
        return self.spacing * u

    @ti.func
    def is_asked(self, u, lane):
        """Whether the rule must be evaluated for this contact of a unit's block."""
        return entry(self.asked, self.place(u), 0, lane) > 0.0

    @ti.func
    def present(self, of: ti.template(), u):
        """Overlaps (m), normals (y, z) and points (y, z) m of a unit's block, from `now` or `saddle_now`."""
        at = self.place(u)
        return of[OVERLAP][at, 0], of[NORMAL_Y][at, 0], of[NORMAL_Z][at, 0], of[POINT_Y][at, 0], of[POINT_Z][at, 0]

    @ti.func
    def moves(self, g: ti.template(), pairs: ti.template(), i, j, u, block):
        """Changes of the vectors from j to i (y, z) m and the angles of i and j (rad) since the last evaluation."""
        lanes = ti.static(range(self.lanes))  # cast lane by lane, as real vectors have to be
        y = ti.Vector([ti.cast(g.y[0, i[k]] - g.y[0, j[k]], g.real) for k in lanes])
        z = ti.Vector([ti.cast(g.z[0, i[k]] - g.z[0, j[k]], g.real) for k in lanes])
        angle_i = gathered(g.angle[0], i, self.lanes) - pairs.angle_first[u, block]
        angle_j = gathered(g.angle[0], j, self.lanes) - pairs.angle_second[u, block]
        return y - pairs.apart_y[u, block], z - pairs.apart_z[u, block], angle_i, angle_j

    @ti.func
    def way(self, pairs: ti.template(), u, block, y, z, angle_i, angle_j):
        """Upper bound on the displacement (m) of any point of one grain relative to the other."""
        return size(y) + size(z) + pairs.reach[u, block] * (size(angle_i) + size(angle_j))

    @ti.func
    def far(self, pairs: ti.template(), u, block, way, slid, angle_i, angle_j):
        """The displacement (m) to compare with the limit `still`."""
        return way

    @ti.func
    def carried(self, names: ti.template(), pairs: ti.template(), u, block, moves: ti.template()):
        """Contacts as they are after these moves, and zero for their slides (m), which are not known."""
        overlap, ny, nz, py, pz = self.heard(names, pairs, u, block)
        far_y, far_z = py + pairs.apart_y[u, block], pz + pairs.apart_z[u, block]
        uy = moves[0] - moves[2] * pz + moves[3] * far_z
        uz = moves[1] + moves[2] * py - moves[3] * far_y
        return overlap - uy * ny - uz * nz, ny, nz, py, pz, 0.0 * overlap

    @ti.func
    def heard(self, names: ti.template(), pairs: ti.template(), u, block):
        """Stored overlaps, normals and points of a block of contacts or of their saddles."""
        of = ti.static([getattr(pairs, name) for name in names])
        at = u, block
        return of[OVERLAP][at], of[NORMAL_Y][at], of[NORMAL_Z][at], of[POINT_Y][at], of[POINT_Z][at]

    @ti.func
    def note(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, c, d, dt):
        """Store contact p of grains i and j, and its saddle, as the rule has just given them."""
        still = self.still(g, pairs, w, i, j, u, p, c, d)
        still = ti.select(self.step(g, w, i, j, dt) < still, still, 0.0 * still)
        block, lane, at = p // self.lanes, p % self.lanes, self.place(u)
        for k in ti.static(range(len(SAID))):
            enter(self.now[k], at, 0, lane, c[k])
            if ti.static(self.bent):
                enter(self.saddle_now[k], at, 0, lane, d[k])
        enter(pairs.still, u, block, lane, still)
        if still > 0.0:
            apart = g.apart(w, i, j)
            enter(pairs.apart_y, u, block, lane, apart[0])
            enter(pairs.apart_z, u, block, lane, apart[1])
            enter(pairs.angle_first, u, block, lane, g.angle[0][w, i])
            enter(pairs.angle_second, u, block, lane, g.angle[0][w, j])
            self.remember(self.contact, pairs, u, block, lane, c)
            if ti.static(self.bent):
                self.remember(self.saddle, pairs, u, block, lane, d)

    @ti.func
    def step(self, g: ti.template(), w, i, j, dt):
        """Upper bound on how far (m) any points of two grains move past each other in a step."""
        turns = g.reach[w, i] * ti.abs(g.spin_now[0][w, i]) + g.reach[w, j] * ti.abs(g.spin_now[0][w, j])
        return dt * (ti.abs(g.now[0][w, i] - g.now[0][w, j]) + ti.abs(g.now[1][w, i] - g.now[1][w, j]) + turns)

    @ti.func
    def passed(self, g: ti.template(), w, i, j, dt):
        """Upper bound on how far (m) two grains that touch have moved past each other since the last evaluation."""
        return self.step(g, w, i, j, dt) + HARDLY * lesser(g.radius[w, i], g.radius[w, j])

    @ti.func
    def remember(self, names: ti.template(), pairs: ti.template(), u, block, lane, c):
        """Store the elements of a contact or a saddle."""
        fields = ti.static([getattr(pairs, name) for name in names])
        for k in ti.static(range(len(names))):
            enter(fields[k], u, block, lane, c[self.elements[k]])

    @ti.func
    def forget(self, pairs: ti.template(), u, p, is_one):
        """Forget the stored contact p; the rule must be evaluated for it if the entry `is_one`.

        Without a normal nothing in a padded block becomes infinite, however far off its ghost is.
        """
        block, lane = p // self.lanes, p % self.lanes
        normal = ti.static([getattr(pairs, self.contact[k]) for k in (NORMAL_Y, NORMAL_Z)])
        for k in ti.static(range(len(normal))):
            enter(normal[k], u, block, lane, 0.0)
        enter(pairs.was_overlap, u, block, lane, -NEVER)
        enter(pairs.still, u, block, lane, ti.select(is_one, 0.0, NEVER))

    @ti.func
    def still(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, c, d):
        """How far (m) the grains of a contact may move until the rule must be evaluated again."""
        hardly = HARDLY * lesser(g.radius[w, i], g.radius[w, j])
        # A rule may give a gap without a normal.
        still = ti.select(c[NORMAL_Y] == 0.0 and c[NORMAL_Z] == 0.0, 0.0 * hardly, hardly)
        watched = False
        if ti.static(self.bent):
            watched = pairs.saddle_first[u, p][0] >= 0.0
        still = ti.select(watched, still, greater(still, -c[OVERLAP]))
        ended = d[OVERLAP] > 0.0 and d[HOLDS] == 0.0  # a saddle that ends in this step and still counts
        return ti.select(c[HOLDS] == 1.0 and not ended, still, 0.0 * still)
