"""Contacts of grains that hardly move past each other: looked at once, and carried along until they have moved."""

import taichi as ti

from solvers.laws.extremes import greater, lesser

# Elements of what a rule says of a contact: m, 1, m from the first grain's centre, and whether it is one.
OVERLAP, NORMAL_Y, NORMAL_Z, POINT_Y, POINT_Z, HOLDS = range(6)
# Of the smaller grain's radius. By then an overlap is off by the square of it, a normal by it, each times a radius over
# the outlines' radii of curvature.
HARDLY = 1e-5
STILL = "still"
SEEN = (STILL, "apart_y", "apart_z", "angle_first", "angle_second")
CONTACT = ("was_overlap", "was_normal_y", "was_normal_z", "was_point_y", "was_point_z")
SADDLE = ("saddle_overlap", "saddle_normal_y", "saddle_normal_z", "saddle_point_y", "saddle_point_z")


@ti.data_oriented
class Rest:
    """What a contact's rule said last, how the two grains lay then, and how far (m) they may move before it is asked.

    That is HARDLY, or as far as they were apart. The overlap changes as the points that touch move along the normal,
    which is exact to first order; normal and point stay.
    """

    def __init__(self, bent: bool):
        self.bent = bent
        self.memory = SEEN + CONTACT + (SADDLE if bent else ())

    @ti.func
    def moved(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p):
        """By how much the way from j to i (y, z) m and the angles of i and j (rad) have changed since then."""
        apart = g.apart(w, i, j)
        return ti.Vector(
            [
                apart[0] - pairs.apart_y[u, p][0],
                apart[1] - pairs.apart_z[u, p][0],
                g.angle[w, i] - pairs.angle_first[u, p][0],
                g.angle[w, j] - pairs.angle_second[u, p][0],
            ]
        )

    @ti.func
    def way(self, g: ti.template(), w, i, j, moved):
        """At most so far (m) any point of one grain has moved as the other sees it."""
        turned = g.reach[w, i] * ti.abs(moved[2]) + g.reach[w, j] * ti.abs(moved[3])
        return ti.abs(moved[0]) + ti.abs(moved[1]) + turned

    @ti.func
    def contact(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moved):
        """The contact as it is now."""
        return self.carried(
            g,
            w,
            i,
            j,
            moved,
            pairs.was_overlap[u, p][0],
            ti.Vector([pairs.was_normal_y[u, p][0], pairs.was_normal_z[u, p][0]]),
            ti.Vector([pairs.was_point_y[u, p][0], pairs.was_point_z[u, p][0]]),
        )

    @ti.func
    def saddle(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, moved):
        """The saddle before it as it is now, where grains bend."""
        saddle = ti.Vector([0.0 * moved[0] for _ in ti.static(range(HOLDS + 1))])
        if ti.static(self.bent):
            saddle = self.carried(
                g,
                w,
                i,
                j,
                moved,
                pairs.saddle_overlap[u, p][0],
                ti.Vector([pairs.saddle_normal_y[u, p][0], pairs.saddle_normal_z[u, p][0]]),
                ti.Vector([pairs.saddle_point_y[u, p][0], pairs.saddle_point_z[u, p][0]]),
            )
        return saddle

    @ti.func
    def carried(self, g: ti.template(), w, i, j, moved, overlap, normal, point):
        """A contact after its grains have moved."""
        far = point + g.apart(w, i, j)
        uy = moved[0] - moved[2] * point[1] + moved[3] * far[1]
        uz = moved[1] + moved[2] * point[0] - moved[3] * far[0]
        now = overlap - uy * normal[0] - uz * normal[1]
        return ti.Vector([now, normal[0], normal[1], point[0], point[1], 1.0 + 0.0 * now])

    @ti.func
    def note(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, c, d, dt):
        """Remember contact p and the saddle before it as the rule has just seen them, if that is of use."""
        still = self.still(g, pairs, w, i, j, u, p, c, d)
        turns = g.reach[w, i] * ti.abs(g.spin_now[w, i]) + g.reach[w, j] * ti.abs(g.spin_now[w, j])
        speed = ti.abs(g.now_y[w, i] - g.now_y[w, j]) + ti.abs(g.now_z[w, i] - g.now_z[w, j]) + turns
        still = ti.select(speed * dt < still, still, 0.0 * still)
        pairs.still[u, p][0] = still
        if still > 0.0:
            apart = g.apart(w, i, j)
            pairs.apart_y[u, p][0], pairs.apart_z[u, p][0] = apart[0], apart[1]
            pairs.angle_first[u, p][0], pairs.angle_second[u, p][0] = g.angle[w, i], g.angle[w, j]
            pairs.was_overlap[u, p][0] = c[OVERLAP]
            pairs.was_normal_y[u, p][0], pairs.was_normal_z[u, p][0] = c[NORMAL_Y], c[NORMAL_Z]
            pairs.was_point_y[u, p][0], pairs.was_point_z[u, p][0] = c[POINT_Y], c[POINT_Z]
            if ti.static(self.bent):
                pairs.saddle_overlap[u, p][0] = d[OVERLAP]
                pairs.saddle_normal_y[u, p][0], pairs.saddle_normal_z[u, p][0] = d[NORMAL_Y], d[NORMAL_Z]
                pairs.saddle_point_y[u, p][0], pairs.saddle_point_z[u, p][0] = d[POINT_Y], d[POINT_Z]

    @ti.func
    def still(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, c, d):
        """How far (m) the grains of a contact that the rule has just seen may move before it is asked again."""
        hardly = HARDLY * lesser(g.radius[w, i], g.radius[w, j])
        # A rule may know that there is a gap, and not where.
        still = ti.select(c[NORMAL_Y] == 0.0 and c[NORMAL_Z] == 0.0, 0.0 * hardly, hardly)
        watched = False
        if ti.static(self.bent):
            watched = pairs.saddle_first[u, p][0] >= 0.0
        still = ti.select(watched, still, greater(still, -c[OVERLAP]))
        ended = d[OVERLAP] > 0.0 and d[HOLDS] == 0.0  # a saddle that counts a last time
        return ti.select(c[HOLDS] == 1.0 and not ended, still, 0.0 * still)
