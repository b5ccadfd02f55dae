"""Contact forces of grains with outlines: the laws of the scene on what a rule of contact says."""

import taichi as ti

from solvers.contacts import Contacts
from solvers.laws.chosen import PAIR, WALL
from solvers.laws.extremes import greater
from solvers.shapes.rest import HOLDS, NORMAL_Y, NORMAL_Z, OVERLAP, POINT_Y, POINT_Z, Rest


@ti.data_oriented
class ShapedContacts(Contacts):
    """What the listed contacts do to grains with outlines.

    The force acts at one point on both grains, so angular momentum is exact: between their outlines, where it is for
    discs, too (see `Contacts`). Slip and rate are of that point. The laws' effective radius is that of the discs of
    equal area, so that the elastic energy depends on the overlap alone. Where a rule knows saddles, a contact's normal
    force is less by what the law says of the saddle's overlap (`Tracked`); what is left is what friction has.
    A law that remembers, the hysteretic one, takes what it knows of the contact for its saddle, too: where two contacts
    become one its force may jump.
    """

    def __init__(self, arrays, units, grains, walls, lists, laws, rule):
        super().__init__(arrays, units, grains, walls, lists, laws)
        self.rule, self.rest = rule, Rest(rule.bent)

    @ti.func
    def pair_forces(self, g: ti.template(), pairs: ti.template(), u, dt):
        """Forces between the grains g, a contact at a time; one across two units is worked out in both."""
        w = self.units.world(u)
        for p in range(pairs.length[u]):
            listed, mate = pairs.first_of(u, p), pairs.second_of(u, p)
            i, j = ti.min(listed, mate), ti.max(listed, mate)
            if not self.rule.is_lost(pairs, u, p):
                # From the middle of the overlap to where the outlines of discs would cross.
                back = pairs.share[u, p][0] - 0.5
                self.pair_force(g, pairs, w, i, j, u, p, ti.select(listed == i, -back, back), dt)

    @ti.func
    def pair_force(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, back, dt):
        """The force of contact p on grains i and j; none if it was open and they have hardly moved since."""
        moved = self.rest.moved(g, pairs, w, i, j, u, p)
        way = self.rest.way(g, w, i, j, moved)
        hardly, touching = way < pairs.still[u, p][0], -pairs.was_overlap[u, p][0] < way
        if not hardly or touching:
            c, d = self.rest.contact(g, pairs, w, i, j, u, p, moved), self.rest.saddle(g, pairs, w, i, j, u, p, moved)
            if not hardly:
                c = self.rule.pair(g, pairs, w, i, j, u, p, True)
                if self.unsettled(pairs, u, p, c):
                    c[OVERLAP] = -g.reach[w, i]
                if ti.static(self.rule.bent):
                    d = self.rule.pair_saddle(g, pairs, w, i, j, u, p, True)
                self.rest.note(g, pairs, w, i, j, u, p, c, d, dt)
            self.push_pair(g, pairs, w, i, j, u, p, c, d, back, dt)

    @ti.func
    def push_pair(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, c, d, back, dt):
        """Push grains i and j apart at a contact c, by so much less as the saddle d before it says."""
        start, end = self.units.first(u), self.units.end(u)
        lever = lever_of(c, back)
        slip, pressing = self.pair_pressed(g, pairs, w, i, j, u, p, c, lever, dt)
        n = ti.Vector([c[NORMAL_Y], c[NORMAL_Z]])
        force, torque = pressing * n, pressing * lever.cross(n)
        if ti.static(self.rule.bent):  # noqa: SIM102 (compiled only there)
            if d[OVERLAP] > 0.0 and c[OVERLAP] > 0.0:
                arm, m = lever_of(d, back), ti.Vector([d[NORMAL_Y], d[NORMAL_Z]])
                less = self.pair_pressed(g, pairs, w, i, j, u, p, d, arm, dt)[1]
                force, torque, pressing = force - less * m, torque - less * arm.cross(m), pressing - less
        turning = g.spin_now[w, i] - g.spin_now[w, j]
        ft, roll = self.rubbed(PAIR, pairs, u, p, c, pressing, slip, turning, dt)
        force += ft * ti.Vector([-n[1], n[0]])
        torque += ft * lever.dot(n)
        if start <= i < end:
            g.push(w, i, force[0], force[1], torque + roll)
        if start <= j < end:
            g.push(w, j, -force[0], -force[1], -torque - g.apart(w, i, j).cross(force) - roll)

    @ti.func
    def unsettled(self, contacts: ti.template(), u, p, c):
        """Whether contact p does not hold any more; asks for a new look if it has been lost, or others have come up."""
        if c[HOLDS] == 0.0:
            self.lists.lose(contacts, u, p)
        elif c[HOLDS] > 1.0:
            self.lists.want(contacts, u, p)
        return c[HOLDS] == 0.0

    @ti.func
    def pair_pressed(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, c, lever, dt):
        """Slip (m/s) of two grains at a point `lever` (m) from the centre of i, and the normal force (N) there."""
        far, spin_i, spin_j = lever + g.apart(w, i, j), g.spin_now[w, i], g.spin_now[w, j]
        uy = g.now_y[w, i] - g.now_y[w, j] - spin_i * lever[1] + spin_j * far[1]
        uz = g.now_z[w, i] - g.now_z[w, j] + spin_i * lever[0] - spin_j * far[0]
        return self.pressed(PAIR, pairs, u, p, c, ti.Vector([uy, uz]), dt)

    @ti.func
    def pressed(self, kind: ti.template(), contacts: ti.template(), u, p, c, velocity, dt):
        """Slip (m/s) and normal force (N) of a contact whose bodies pass each other at a velocity (m/s)."""
        n = ti.Vector([c[NORMAL_Y], c[NORMAL_Z]])
        overlap, rate = ti.Vector([greater(c[OVERLAP], 0.0)]), ti.Vector([-velocity.dot(n)])
        return n.cross(velocity), self.laws.press(kind, contacts, u, p, overlap, rate, dt)[0]

    @ti.func
    def rubbed(self, kind: ti.template(), contacts: ti.template(), u, p, c, pressing, slip, turning, dt):
        """Tangential force (N) and rolling torque (N m) of a contact."""
        ft, roll = self.laws.rub(
            kind,
            contacts,
            u,
            p,
            ti.Vector([greater(c[OVERLAP], 0.0)]),
            ti.Vector([greater(pressing, 0.0)]),
            ti.Vector([slip]),
            ti.Vector([turning]),
            dt,
        )
        return ft[0], roll[0]

    @ti.func
    def wall_forces(self, g: ti.template(), contacts: ti.template(), u, t, dt):
        """Forces of the walls on the grains g."""
        w = self.units.world(u)
        shift = self.walls.shift(w, t)
        for p in range(contacts.length[u]):
            if not self.rule.is_lost(contacts, u, p):
                self.wall_force(g, contacts, w, u, p, shift, dt)

    @ti.func
    def wall_force(self, g: ti.template(), contacts: ti.template(), w, u, p, shift: ti.template(), dt):
        """The force of contact p on a grain."""
        i, feature = contacts.first_of(u, p), contacts.second_of(u, p)
        c = self.rule.wall(g, contacts, w, i, feature, shift, u, p, True)
        if self.unsettled(contacts, u, p, c):
            c[OVERLAP] = -g.reach[w, i]
        velocity = self.walls.velocity(feature, shift)
        lever = lever_of(c, 0.5)
        slip, pressing = self.wall_pressed(g, contacts, w, i, u, p, c, lever, velocity, dt)
        n = ti.Vector([c[NORMAL_Y], c[NORMAL_Z]])
        force, torque = pressing * n, pressing * lever.cross(n)
        if ti.static(self.rule.bent):
            d = self.rule.wall_saddle(g, contacts, w, i, feature, shift, u, p, True)
            if d[OVERLAP] > 0.0 and c[OVERLAP] > 0.0:
                arm, m = lever_of(d, 0.5), ti.Vector([d[NORMAL_Y], d[NORMAL_Z]])
                less = self.wall_pressed(g, contacts, w, i, u, p, d, arm, velocity, dt)[1]
                force, torque, pressing = force - less * m, torque - less * arm.cross(m), pressing - less
        ft, roll = self.rubbed(WALL, contacts, u, p, c, pressing, slip, g.spin_now[w, i], dt)
        force += ft * ti.Vector([-n[1], n[0]])
        g.push(w, i, force[0], force[1], torque + ft * lever.dot(n) + roll)

    @ti.func
    def wall_pressed(
        self, g: ti.template(), contacts: ti.template(), w, i, u, p, c, lever, velocity: ti.template(), dt
    ):
        """Slip (m/s) of a grain on a wall that moves at a velocity (m/s), and the normal force (N)."""
        uy = g.now_y[w, i] - velocity[0] - g.spin_now[w, i] * lever[1]
        uz = g.now_z[w, i] - velocity[1] + g.spin_now[w, i] * lever[0]
        return self.pressed(WALL, contacts, u, p, c, ti.Vector([uy, uz]), dt)

    @ti.func
    def pair_press(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p):
        """Where contact p of grains i and j is (y, z) m, and its elastic force on i (N); nothing is remembered."""
        c = self.rule.pair(g, pairs, w, i, j, u, p, False)
        force = self.elastic_along(pairs, u, p, c, self.rule.is_lost(pairs, u, p))
        if ti.static(self.rule.bent):  # noqa: SIM102 (compiled only there)
            if c[OVERLAP] > 0.0:
                saddle = self.rule.pair_saddle(g, pairs, w, i, j, u, p, False)
                force -= self.elastic_along(pairs, u, p, saddle, self.rule.is_lost(pairs, u, p))
        return ti.Vector([g.y[w, i] + c[POINT_Y], g.z[w, i] + c[POINT_Z], force[0], force[1]])

    @ti.func
    def wall_press(self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p):
        """Where contact p of a grain with a wall is (y, z) m, and its elastic force on the grain (N)."""
        c = self.rule.wall(g, contacts, w, i, feature, shift, u, p, False)
        force = self.elastic_along(contacts, u, p, c, self.rule.is_lost(contacts, u, p))
        if ti.static(self.rule.bent):  # noqa: SIM102 (compiled only there)
            if c[OVERLAP] > 0.0:
                saddle = self.rule.wall_saddle(g, contacts, w, i, feature, shift, u, p, False)
                force -= self.elastic_along(contacts, u, p, saddle, self.rule.is_lost(contacts, u, p))
        return ti.Vector([g.y[w, i] + c[POINT_Y], g.z[w, i] + c[POINT_Z], force[0], force[1]])

    @ti.func
    def elastic_along(self, contacts: ti.template(), u, p, c, lost):
        """Elastic force (N) along the normal of a contact or saddle c; none of one that has been lost sight of."""
        force = self.laws.elastic(contacts, u, p, ti.select(lost, 0.0 * c[OVERLAP], c[OVERLAP]))
        return force * ti.Vector([c[NORMAL_Y], c[NORMAL_Z]])

    @ti.func
    def census(self, g: ti.template(), pairs: ti.template(), contacts: ti.template(), u, t):
        """Number of touching contacts, largest overlap in radii of the smaller grain, their energy (J), of a unit."""
        w, start, end = self.units.world(u), self.units.first(u), self.units.end(u)
        zero = ti.cast(0.0, g.exact)
        touching, deepest, energy = zero, zero, zero
        for p in range(pairs.length[u]):
            i, j = pairs.first_of(u, p), pairs.second_of(u, p)
            overlap = self.rule.pair(g, pairs, w, ti.min(i, j), ti.max(i, j), u, p, False)[OVERLAP]
            if overlap > 0.0:
                part = ti.select(start <= j < end or j >= g.mobile, 1.0, 0.5)
                touching += part
                deepest = ti.max(deepest, overlap / ti.min(g.radius[w, i], g.radius[w, j]))
                energy += part * self.laws.energy(PAIR, pairs, u, p, overlap)
                if ti.static(self.rule.bent):
                    saddle = self.rule.pair_saddle(g, pairs, w, ti.min(i, j), ti.max(i, j), u, p, False)[OVERLAP]
                    energy -= part * self.laws.pressed_energy(pairs, u, p, greater(saddle, 0.0))
        shift = self.walls.shift(w, t)
        for p in range(contacts.length[u]):
            i, feature = contacts.first_of(u, p), contacts.second_of(u, p)
            overlap = self.rule.wall(g, contacts, w, i, feature, shift, u, p, False)[OVERLAP]
            if overlap > 0.0:
                touching += 1.0
                deepest = ti.max(deepest, overlap / g.radius[w, i])
                energy += self.laws.energy(WALL, contacts, u, p, overlap)
                if ti.static(self.rule.bent):
                    saddle = self.rule.wall_saddle(g, contacts, w, i, feature, shift, u, p, False)[OVERLAP]
                    energy -= self.laws.pressed_energy(contacts, u, p, greater(saddle, 0.0))
        return ti.Vector([touching, deepest, energy])


@ti.func
def lever_of(c, back):
    """From a grain's centre (y, z) m to where the force of a contact acts, that part of the overlap from its middle."""
    return ti.Vector(
        [
            c[POINT_Y] + back * greater(c[OVERLAP], 0.0) * c[NORMAL_Y],
            c[POINT_Z] + back * greater(c[OVERLAP], 0.0) * c[NORMAL_Z],
        ]
    )
