"""How the water's load answers an acceleration of the tank at once: by the pressures of the walls' dummies alone."""

import taichi as ti

from solvers.fluid.forces import Forces
from solvers.fluid.lists import Medium
from solvers.fluid.walls.extrapolation import SEEN
from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.motion.poses import AT_START
from solvers.space.axes import dot, named
from solvers.tank.load import ENTRIES


@ti.data_oriented
class Answer:
    """Load(a) = F − A a of the tank's acceleration a = (a_y, a_z, φ̈) at its origin, exactly (own derivation).

    A dummy's pressure is linear in its wall's acceleration a_w: Δp_w = −q·Δa_w with q = Σ m_f W (r_w − r_f)/Σ V_f W, or
    zero where the pressure is cut off. It pushes the water with Σ_f V_f V_w η (r_f − r_w) = g for each pascal, so that

        A = −Σ_w (g; r_w × g) ⊗ (q; r_w × q).

    This is the mass of the layer of water before the walls, some 0.3 ρ h S. The load is that of a tank that is not
    accelerated; once its carrier has answered, pressures and pushes are corrected for the acceleration that came of it,
    so that nothing lags and momentum closes. `noted`, `offered` and `corrected` are the phases that do this.

    Limits: viscous forces of walls to which water sticks do not depend on a_w and are not in it.
    """

    def __init__(self, arrays: State, medium: Medium, forces: Forces, carrier):
        load = forces.load
        self.units, self.particles, self.shares = medium.units, medium.particles, medium.shares
        self.lists, self.constants, self.poses = medium.lists, medium.constants, medium.poses
        self.order, self.load, self.carrier = medium.lists.order, load, carrier
        self.wanted, self.outlines = getattr(carrier, "takes_inertia", False), forces.outlines
        self.work, self.held, self.thickness = forces.work, forces.held, forces.thick
        self.noted, self.offered, self.corrected = (), (), ()
        if self.wanted:
            units = self.units
            self.noted, self.offered = (Phase(self.note, units),), (Phase(self.offer, units),)
            self.corrected = Phase(self.note_change), Phase(self.press, units), Phase(self.push, units)
            p, own = medium.particles, arrays.under("water.answer")
            load.answer(arrays.under("water"))
            each = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
            self.lever = own.wide(each, *named("lever", p.axes), kept=False)
            (self.extra,) = own.wide(each, "extra", kept=False)
            names = "change_y", "change_z", "change_up"
            self.change = own.reals((Axis("world", p.worlds),), *names, kind=own.exact, kept=False)

    @ti.func
    def note(self, u, t, kick, dt):
        """The matrix A of a unit's dummies."""
        first, end = self.shares.dry(u)
        for piece in range(self.outlines):
            for k in ti.static(range(len(ENTRIES))):
                self.load.inertia[u, piece, k] = 0.0
        for b in range(first, end):
            self.note_block(u, b, self.lists.facing.first[u, b - first], self.lists.facing.first[u, b - first + 1])

    @ti.func
    def note_block(self, u, b, begin, end):
        """Levers q of a block of dummies, and its part of A."""
        p, c, lists = self.particles, self.constants, self.lists
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        seen, lever, push = p.zeros(), [p.zeros(), p.zeros()], [p.zeros(), p.zeros()]
        for k in range(begin, end):
            j = lists.facing.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(b, own, origin, j, AT_START)
            rest = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * c.get("shrink"), 0.0)
            weight, volume = c.kernel.value(rest), p.volume[jb, lane]
            steep = c.kernel.slope(rest) * volume
            seen += weight * volume
            massive = weight * p.mass[jb, lane]
            for a in ti.static(range(p.axes)):
                lever[a] += massive * apart[a]
                push[a] = push[a] - steep * apart[a]
        acts = ti.select(seen * c.get("value") > SEEN, p.ones(), p.zeros())
        if ti.static(not c.full):
            acts = ti.select(p.load(p.pressure, b) > 0.0, acts, p.zeros())
        zero = ti.cast(0.0, p.where)
        y, z = p.offset(b, zero, 0), p.offset(b, zero, 1)
        strength = p.load(p.volume, b) * c.get("slope")
        for a in ti.static(range(p.axes)):
            lever[a] = acts * lever[a] / ti.max(seen, 1e-30)
            p.store(self.lever[a], b, lever[a])
            push[a] = strength * push[a]
        pushes = [push[0], push[1], y * push[1] - z * push[0]]
        levers = [lever[0], lever[1], y * lever[1] - z * lever[0]]
        tank, thick = self.order.layer(b), self.thickness[0]
        for k in ti.static(range(len(ENTRIES))):
            i, j = ti.static(ENTRIES[k])
            found = ti.cast((pushes[i] * levers[j]).sum(), p.exact)
            self.load.inertia[u, tank, k] = self.load.inertia[u, tank, k] - thick * found

    @ti.func
    def acceleration(self, w):
        """The acceleration that the dummies' pressures were found with, in the tank's axes."""
        a_y = self.poses.felt[0][w] - self.poses.felt[2][w]
        a_z = self.poses.felt[1][w] - self.poses.felt[3][w]
        return ti.Vector([a_y, a_z, self.poses.felt[5][w]])

    @ti.func
    def offer(self, u, t, kick, dt):
        """Turn a unit's load into that of a tank that is not accelerated."""
        a = self.acceleration(self.units.world(u))
        for piece in range(self.outlines):
            for k in ti.static(range(len(ENTRIES))):
                i, j = ti.static(ENTRIES[k])
                more = self.load.inertia[u, piece, k] * a[j]
                self.load.instant[i][u, piece] = self.load.instant[i][u, piece] + more

    @ti.func
    def note_change(self, w, t, kick, dt):
        """Note by how much the tank of a world is accelerated more than the pressures knew."""
        before = self.acceleration(w)
        self.change[0][w] = self.poses.felt[0][w] - self.carrier.hold.felt[w, 0] - before[0]
        self.change[1][w] = self.poses.felt[1][w] - self.carrier.hold.felt[w, 1] - before[1]
        self.change[2][w] = self.carrier.hold.felt[w, 3] - before[2]

    @ti.func
    def press(self, u, t, kick, dt):
        """Correct the pressures of a unit's dummies."""
        p, w = self.particles, self.units.world(u)
        first, end = self.shares.dry(u)
        a_y, a_z = ti.cast(self.change[0][w], p.real), ti.cast(self.change[1][w], p.real)
        up = ti.cast(self.change[2][w], p.real)
        for b in range(first, end):
            zero = ti.cast(0.0, p.where)
            y, z = p.offset(b, zero, 0), p.offset(b, zero, 1)
            lever_y, lever_z = p.load(self.lever[0], b), p.load(self.lever[1], b)
            extra = 0.0 - lever_y * (a_y - up * z) - lever_z * (a_z + up * y)
            p.store(self.extra, b, extra)
            p.store(p.pressure, b, p.load(p.pressure, b) + extra)

    @ti.func
    def push(self, u, t, kick, dt):
        """Correct the accelerations of a unit's particles before walls, and the load."""
        lists, w = self.lists, self.units.world(u)
        first, end = self.shares.wet(u)
        for b in range(first, end):
            begin, last = lists.beside.first[u, b - first], lists.beside.first[u, b - first + 1]
            if begin < last:
                self.push_block(u, w, b, begin, last, kick, dt)

    @ti.func
    def push_block(self, u, w, b, begin, last, kick, dt):
        """As `push`, for a block with the entries `begin` to `last` of walls beside it."""
        p, c, lists = self.particles, self.constants, self.lists
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        push = [p.zeros(), p.zeros()]
        for k in range(begin, last):
            j = lists.beside.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(b, own, origin, j, AT_START)
            rest = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * c.get("shrink"), 0.0)
            along = self.extra[jb, lane] * p.volume[jb, lane] * c.kernel.slope(rest)
            for a in ti.static(range(p.axes)):
                push[a] += along * apart[a]
        lightness = (p.filled(b) * c.get("slope")) / (c.get("density") * (1.0 + p.load(p.excess, b)))
        volume = p.load(p.volume, b) * c.get("slope")
        for a in ti.static(range(p.axes)):
            p.store(p.acceleration[a], b, p.load(p.acceleration[a], b) + lightness * push[a])
            push[a] = volume * push[a]
        turning = own[0] * push[1] - own[1] * push[0]
        y, z = ti.cast(origin[0], p.exact), ti.cast(origin[1], p.exact)
        force_y, force_z = ti.cast(push[0].sum(), p.exact), ti.cast(push[1].sum(), p.exact)
        moment = ti.cast(turning.sum(), p.exact) + y * force_z - z * force_y
        load, during, tank = [0.0 - force_y, 0.0 - force_z, 0.0 - moment], ti.cast(dt, p.exact), self.order.layer(b)
        power = ti.cast(0.0, p.exact)
        for k in ti.static(range(3)):
            pushed = self.thickness[0] * load[k] * during
            self.load.impulse[k][u, tank] = self.load.impulse[k][u, tank] + pushed
            power += load[k] * self.poses.walls[3 + k][w]
        weight = self.order.weight(b)
        self.work[u] = self.work[u] - weight * power * ti.cast(kick, p.exact)
        taken = p.zeros()
        for a in ti.static(range(p.axes)):
            gain = p.load(p.acceleration[a], b) + p.filled(b) * ti.cast(self.poses.felt[a][w], p.real)
            taken = taken - push[a] * (p.load(p.velocity[a], b) + (0.5 * kick) * gain)
        wall = 0.0 - power  # of the dummies that move with the tank
        self.held[u] = self.held[u] + weight * (ti.cast(taken.sum(), p.exact) + wall) * ti.cast(kick, p.exact)
