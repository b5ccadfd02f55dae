"""Contact forces of grains with outlines: the scene's laws applied to the contacts of a rule."""

import taichi as ti

from solvers.grains.contacts import Contacts
from solvers.grains.laws.chosen import PAIR, WALL
from solvers.grains.lists.gathering import gathered
from solvers.grains.shapes.rules.rest import HOLDS, NORMAL_Y, NORMAL_Z, OVERLAP, POINT_Y, POINT_Z, SURE
from solvers.machine.wide import enter, entry, minus
from solvers.space.extremes import greater, lesser
from solvers.space.tangent import NO_WAY


@ti.data_oriented
class ShapedContacts(Contacts):
    """Forces of the listed contacts on grains with outlines.

    The force acts on both grains at one point between their outlines, as for discs (see `Contacts`), so angular
    momentum is conserved exactly. Slip and closing speed are those at that point. The laws' effective radius is that of
    the discs of equal area, so that the elastic energy depends on the overlap only. If a rule has saddles, the force of
    the normal law at the saddle's overlap is subtracted from a contact's normal force (`Tracked`), and friction uses
    the difference. The hysteretic law has memory and uses the contact's memory for its saddle, too, so its force may
    jump when two contacts merge.
    """

    def __init__(self, arrays, units, grains, walls, lists, laws, load, rule):
        super().__init__(arrays, units, grains, walls, lists, laws, load)
        self.rule, self.rest = rule, rule.rest

    @ti.func
    def pair_forces(self, g: ti.template(), pairs: ti.template(), u, dt):
        """Forces between the grains g, a block of contacts at a time; those across two units are computed in both."""
        load = self.nothing()
        for block in range(pairs.blocks(u)):
            i, j = self.in_order(pairs, u, block)
            if not self.idle(g, pairs, i, j, u, block):
                far_y, far_z, overlap, ny, nz, py, pz, asked = self.rest.carry(g, pairs, i, j, u, block)
                if asked.sum() > 0.0:
                    self.rest.lay_out(u, [overlap, ny, nz, py, pz], asked)
                    self.ask(g, pairs, u, block, dt)
                    overlap, ny, nz, py, pz = self.rest.present(self.rest.now, u)
                now = [overlap, ny, nz, py, pz]
                self.block_forces(g, pairs, i, j, u, block, far_y, far_z, now, load, dt)
        if ti.static(self.lined):
            self.load.book(u, self.lining, load, dt)

    @ti.func
    def in_order(self, pairs: ti.template(), u, block):
        """The two grains of each contact, the lower number first."""
        listed, mate = pairs.grain[u, block], pairs.mate[u, block]
        i, j = listed, mate
        if ti.static(not self.units.whole):
            i, j = lesser(listed, mate), greater(listed, mate)
        return i, j

    @ti.func
    def idle(self, g: ti.template(), pairs: ti.template(), i, j, u, p):
        """Whether a block of a single contact can be skipped; larger blocks never are."""
        nothing = False
        if ti.static(pairs.lanes == 1):
            nothing = self.rule.is_lost(pairs, u, p) or self.rest.is_open(g, pairs, i, j, u, p)
        return nothing

    @ti.func
    def ask(self, g: ti.template(), pairs: ti.template(), u, block, dt):
        """Evaluate the rule for those contacts of a block that have moved too far since its last evaluation."""
        w = self.units.world(u)
        for lane in range(pairs.lanes):
            if self.rest.is_asked(u, lane):
                p = block * pairs.lanes + lane
                listed, mate = pairs.first_of(u, p), pairs.second_of(u, p)
                i, j = ti.min(listed, mate), ti.max(listed, mate)
                if ti.static(hasattr(pairs, SURE)):
                    enter(pairs.sure, u, p, 0, entry(pairs.sure, u, p, 0) - self.rest.passed(g, w, i, j, dt))
                c, d = self.rule.pair(g, pairs, w, i, j, u, p, True), ti.Vector([0.0 for _ in range(HOLDS + 1)])
                if self.unsettled(pairs, u, p, c):
                    c[OVERLAP] = -g.reach[w, i]
                if ti.static(self.rule.bent):
                    d = self.rule.pair_saddle(g, pairs, w, i, j, u, p, True)
                self.rest.note(g, pairs, w, i, j, u, p, c, d, dt)

    @ti.func
    def block_forces(
        self,
        g: ti.template(),
        pairs: ti.template(),
        i,
        j,
        u,
        block,
        apart_y,
        apart_z,
        now: ti.template(),
        load: ti.template(),
        dt,
    ):
        """Apply the forces of a block of contacts, less those of their saddles, to grains i and j.

        `apart_y` and `apart_z` are the vectors (m) from j to i, `now` the contacts as in `Rest`. `load` sums the load
        on fixed grains.

        Arithmetic on short vectors without branches, as in `Contacts.pair_forces`.
        """
        approach, ny, nz, py, pz = now[OVERLAP], now[NORMAL_Y], now[NORMAL_Z], now[POINT_Y], now[POINT_Z]
        # Offset from the middle of the overlap to where the outlines of discs would cross, in overlaps.
        back = 0.5 - pairs.share[u, block]
        if ti.static(not self.units.whole):
            back = ti.select(pairs.grain[u, block] == i, back, minus(back))
        overlap = greater(approach, 0.0)
        ly, lz = py + back * overlap * ny, pz + back * overlap * nz
        uy, uz, turning = self.passing(g, pairs, i, j, ly, lz, apart_y, apart_z)
        rate = minus(uy * ny + uz * nz)
        pressing = self.laws.normal_force(PAIR, pairs, u, block, approach, rate, dt)
        fy, fz, torque = pressing * ny, pressing * nz, pressing * (ly * nz - lz * ny)
        if ti.static(self.rule.bent):
            shallow, my, mz, qy, qz = self.rest.present(self.rest.saddle_now, u)
            if shallow[0] > 0.0 and overlap[0] > 0.0:
                ky, kz = qy + back * shallow * my, qz + back * shallow * mz
                vy, vz, _ = self.passing(g, pairs, i, j, ky, kz, apart_y, apart_z)
                less = self.laws.normal_force(PAIR, pairs, u, block, shallow, -(vy * my + vz * mz), dt)
                fy, fz, torque = fy - less * my, fz - less * mz, torque - less * (ky * mz - kz * my)
                pressing -= less
        slip = uz * ny - uy * nz
        bearing = greater(pressing, 0.0)
        shear, roll = self.laws.tangential_force(
            PAIR, pairs, u, block, overlap, rate, bearing, [slip], [turning], NO_WAY, dt
        )
        ft = shear[0]
        fy, fz, torque = fy - ft * nz, fz + ft * ny, torque + ft * (ly * ny + lz * nz) + roll[0]
        self.push_block(g, pairs, i, u, block, fy, fz, torque, minus(torque) - (apart_y * fz - apart_z * fy), load)

    @ti.func
    def passing(self, g: ti.template(), pairs: ti.template(), i, j, ly, lz, apart_y, apart_z):
        """Velocities (y, z) m/s of grains i relative to j at points (y, z) m from i's centres, and relative spins."""
        spin_i, spin_j = gathered(g.spin_now[0], i, pairs.lanes), gathered(g.spin_now[0], j, pairs.lanes)
        uy = gathered(g.now[0], i, pairs.lanes) - gathered(g.now[0], j, pairs.lanes)
        uz = gathered(g.now[1], i, pairs.lanes) - gathered(g.now[1], j, pairs.lanes)
        uy = uy - spin_i * lz + spin_j * (lz + apart_z)
        uz = uz + spin_i * ly - spin_j * (ly + apart_y)
        return uy, uz, spin_i - spin_j

    @ti.func
    def push_block(
        self, g: ti.template(), pairs: ti.template(), i, u, block, fy, fz, torque_i, torque_j, load: ti.template()
    ):
        """Apply the forces (N) on grains i of a block, their reactions, and the torques (N m) on i and j."""
        listed = pairs.grain[u, block]
        if ti.static(not self.units.whole):
            swapped = listed != i
            fy, fz = ti.select(swapped, minus(fy), fy), ti.select(swapped, minus(fz), fz)
            torque_i, torque_j = ti.select(swapped, torque_j, torque_i), ti.select(swapped, torque_i, torque_j)
        self.push_both(g, pairs, u, block, listed, [fy, fz], [[torque_i], [torque_j]])
        if ti.static(self.lined):
            load += self.on_lining(g, pairs, u, listed, pairs.mate[u, block], [fy, fz], [torque_i])

    @ti.func
    def unsettled(self, contacts: ti.template(), u, p, c):
        """Whether contact p no longer exists; its pair is searched again if it is lost or other contacts appear."""
        if c[HOLDS] == 0.0:
            self.lists.lose(contacts, u, p)
        elif c[HOLDS] > 1.0:
            self.lists.want(contacts, u, p)
        return c[HOLDS] == 0.0

    @ti.func
    def pressed(self, kind: ti.template(), contacts: ti.template(), u, p, c, velocity, dt):
        """Closing speed and slip (m/s) and normal force (N) of a contact with a relative velocity (m/s)."""
        n = ti.Vector([c[NORMAL_Y], c[NORMAL_Z]])
        approach, rate = ti.Vector([c[OVERLAP]]), -velocity.dot(n)
        return rate, n.cross(velocity), self.laws.normal_force(kind, contacts, u, p, approach, ti.Vector([rate]), dt)[0]

    @ti.func
    def rubbed(self, kind: ti.template(), contacts: ti.template(), u, p, c, rate, pressing, slip, turning, dt):
        """Tangential force (N) and rolling torque (N m) of a contact."""
        overlap, bearing = ti.Vector([greater(c[OVERLAP], 0.0)]), ti.Vector([greater(pressing, 0.0)])
        slips, spins = [ti.Vector([slip])], [ti.Vector([turning])]
        ft, roll = self.laws.tangential_force(
            kind, contacts, u, p, overlap, ti.Vector([rate]), bearing, slips, spins, NO_WAY, dt
        )
        return ft[0][0], roll[0][0]

    @ti.func
    def wall_forces(self, g: ti.template(), contacts: ti.template(), u, t, dt):
        """Forces of the walls on the grains g."""
        w, load = self.units.world(u), self.nothing()
        shift = self.walls.shift(w, t)
        for p in range(contacts.length[u]):
            if not self.rule.is_lost(contacts, u, p):
                self.wall_force(g, contacts, w, u, p, shift, load, dt)
        self.book_walls(u, load, dt)

    @ti.func
    def wall_force(
        self, g: ti.template(), contacts: ti.template(), w, u, p, shift: ti.template(), load: ti.template(), dt
    ):
        """Apply the force of contact p to its grain and to the wall."""
        i, feature = contacts.first_of(u, p), contacts.second_of(u, p)
        turning = g.spin_now[0][w, i] - self.walls.rate(feature, shift)[0]
        if ti.static(hasattr(contacts, SURE)):
            velocity = self.walls.velocity(feature, shift, g.y[w, i], g.z[w, i])
            speed = ti.abs(g.now[0][w, i] - velocity[0]) + ti.abs(g.now[1][w, i] - velocity[1])
            passed = dt * (speed + g.reach[w, i] * ti.abs(turning))
            enter(contacts.sure, u, p, 0, entry(contacts.sure, u, p, 0) - passed)
        c = self.rule.wall(g, contacts, w, i, feature, shift, u, p, True)
        if self.unsettled(contacts, u, p, c):
            c[OVERLAP] = -g.reach[w, i]
        lever = lever_of(c, 0.5)
        rate, slip, pressing = self.wall_pressed(g, contacts, w, i, feature, shift, u, p, c, lever, dt)
        n = ti.Vector([c[NORMAL_Y], c[NORMAL_Z]])
        force, torque = pressing * n, pressing * lever.cross(n)
        if ti.static(self.rule.bent):
            d = self.rule.wall_saddle(g, contacts, w, i, feature, shift, u, p, True)
            if d[OVERLAP] > 0.0 and c[OVERLAP] > 0.0:
                arm, m = lever_of(d, 0.5), ti.Vector([d[NORMAL_Y], d[NORMAL_Z]])
                less = self.wall_pressed(g, contacts, w, i, feature, shift, u, p, d, arm, dt)[2]
                force, torque, pressing = force - less * m, torque - less * arm.cross(m), pressing - less
        ft, roll = self.rubbed(WALL, contacts, u, p, c, rate, pressing, slip, turning, dt)
        force += ft * ti.Vector([-n[1], n[0]])
        torque = torque + ft * lever.dot(n) + roll
        self.push_off(g, w, i, u, feature, [force[0], force[1]], [torque], load)

    @ti.func
    def wall_pressed(
        self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p, c, lever, dt
    ):
        """Closing speed and slip (m/s) of a grain on a wall, and the normal force (N)."""
        velocity = self.walls.velocity(feature, shift, g.y[w, i] + lever[0], g.z[w, i] + lever[1])
        uy = g.now[0][w, i] - velocity[0] - g.spin_now[0][w, i] * lever[1]
        uz = g.now[1][w, i] - velocity[1] + g.spin_now[0][w, i] * lever[0]
        return self.pressed(WALL, contacts, u, p, c, ti.Vector([uy, uz]), dt)

    @ti.func
    def pair_press(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p):
        """Place (y, z) m of contact p of grains i and j, its elastic force (N) on i, overlap (m); memory stays."""
        c = self.rule.pair(g, pairs, w, i, j, u, p, False)
        force = self.elastic_along(pairs, u, p, c, self.rule.is_lost(pairs, u, p))
        if ti.static(self.rule.bent):  # noqa: SIM102 (compiled only there)
            if c[OVERLAP] > 0.0:
                saddle = self.rule.pair_saddle(g, pairs, w, i, j, u, p, False)
                force -= self.elastic_along(pairs, u, p, saddle, self.rule.is_lost(pairs, u, p))
        return ti.Vector([g.y[w, i] + c[POINT_Y], g.z[w, i] + c[POINT_Z], force[0], force[1], c[OVERLAP]])

    @ti.func
    def wall_press(self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p):
        """Place (y, z) m of contact p of a grain with a wall, its elastic force (N) on the grain, overlap (m)."""
        c = self.rule.wall(g, contacts, w, i, feature, shift, u, p, False)
        force = self.elastic_along(contacts, u, p, c, self.rule.is_lost(contacts, u, p))
        if ti.static(self.rule.bent):  # noqa: SIM102 (compiled only there)
            if c[OVERLAP] > 0.0:
                saddle = self.rule.wall_saddle(g, contacts, w, i, feature, shift, u, p, False)
                force -= self.elastic_along(contacts, u, p, saddle, self.rule.is_lost(contacts, u, p))
        return ti.Vector([g.y[w, i] + c[POINT_Y], g.z[w, i] + c[POINT_Z], force[0], force[1], c[OVERLAP]])

    @ti.func
    def elastic_along(self, contacts: ti.template(), u, p, c, lost):
        """Elastic force (N) along the normal of a contact or saddle c; zero if it is lost."""
        force = self.laws.elastic(contacts, u, p, ti.select(lost, 0.0 * c[OVERLAP], c[OVERLAP]))
        return force * ti.Vector([c[NORMAL_Y], c[NORMAL_Z]])

    @ti.func
    def diagnostics(self, g: ti.template(), pairs: ti.template(), contacts: ti.template(), u, t):
        """Number of touching contacts of a unit, largest overlap in radii of the smaller grain, elastic energy (J)."""
        w, start, end = self.units.world(u), self.units.first(u), self.units.end(u)
        zero = ti.cast(0.0, g.exact)
        touching, deepest, energy = zero, zero, zero
        for p in range(pairs.length[u]):
            i, j = pairs.first_of(u, p), pairs.second_of(u, p)
            overlap = self.rule.pair(g, pairs, w, ti.min(i, j), ti.max(i, j), u, p, False)[OVERLAP]
            if overlap > 0.0:
                part = ti.select(start <= j < end or j >= self.units.moving(), 1.0, 0.5)
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
    """Lever (y, z) m from a grain's centre to the force of a contact, `back` overlaps from the overlap's middle."""
    return ti.Vector(
        [
            c[POINT_Y] + back * greater(c[OVERLAP], 0.0) * c[NORMAL_Y],
            c[POINT_Z] + back * greater(c[OVERLAP], 0.0) * c[NORMAL_Z],
        ]
    )
