"""How water answers the acceleration of free bodies at once: the pressures of wall particles follow from it."""

import numpy as np
import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.terms.term import Sums, Term
from solvers.fluid.walls.tangential_correction import Leaning, TangentialCorrection
from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.motion.free import HELD, INERTIA, MASS
from solvers.motion.poses import AT_START
from solvers.space.axes import dot
from solvers.tank.load import Load

SOLVED = 3  # times at most: once, and again while wall particles begin or cease to push
OF_LOAD = ("y", "z", "turn")


@ti.data_oriented
class FreeBodyCoupling(Term):
    """(M + A) a = F: a free body and the water before it, solved together for the acceleration a of the body.

    A wall particle w of a body that is accelerated by a_w has the pressure p_w = p0 − q·a_w, with q = Σ m_f W (r_w −
    r_f)/Σ V_f W (`Extrapolation`), and pushes the body by p_w g_w, g_w = −V_w Σ V_f (−W'/r) (r_f − r_w). So the load on
    the body is F − A a, with

        A = Σ_w (g_w; (r_w − c) × g_w) ⊗ (q_w; (r_w − c) × q_w)

    summed over the wall particles that push, p_w > 0, about the centre of mass c (own derivation; see `added_mass` for
    ships). Where these are others with the a that is found, it is solved again, up to SOLVED times. Were A a taken from
    the step before, a body that displaces more than it weighs would be thrown about at once (Causin, Gerbeau & Nobile
    2005). The forces themselves are those of pairs, as everywhere (`WallForces`), so that the body gains what the water
    loses; what is found here is the acceleration that they will have, to rounding. Viscous forces, which do not depend
    on a, are taken from the step before.

    Limits: in water of one phase; bodies answer each other only through the water's motion.
    """

    def __init__(
        self,
        arrays: State,
        sums: Sums,
        context: FluidContext,
        of_walls: tuple[TangentialCorrection, Leaning],
        borne: tuple[Load, float],
        sticks: bool,
    ):
        """`borne` is the water's load, and the tank's thickness (m)."""
        self.units, self.particles, self.constants = context.units, context.particles, context.constants
        self.poses, self.bodies, (self.tangential, self.leaning) = context.poses, context.lists.bodies, of_walls
        self.free, (self.load, thickness) = self.bodies.pieces.bodies, borne
        self.acts = self.bodies.floats
        self.before = (Phase(self.solve),) if self.acts else ()
        self.between = (Phase(self.note_rest),) if self.acts and sticks else ()
        if not self.acts:
            return
        p, own = self.particles, arrays.under("water.coupling")
        self.way, self.always, self.firm = sums.room(p.axes), sums.room(p.axes), sums.room()
        self.thickness = own.holding("thickness", np.array([thickness]), "one", own.exact)
        each = Axis("block", p.worlds * self.bodies.room), Axis("lane", p.lanes)
        (self.still,) = own.wide(each, "still", kept=False)  # the pressure p0 at a = 0, cut off nowhere; Pa
        self.lever = own.wide(each, *(f"lever_{name}" for name in OF_LOAD), kept=False)
        self.push = own.wide(each, *(f"push_{name}" for name in OF_LOAD), kept=False)  # the load of 1 Pa
        self.fixed = own.wide(each, *(f"fixed_{name}" for name in OF_LOAD), kept=False)  # that of all else
        of_body = Axis("world", p.worlds), Axis("body", self.free.count), Axis("freedom", 3)
        self.foreseen, self.solution = own.reals(of_body, "foreseen", "solution", kind=own.exact, kept=False)
        (self.rest,) = own.reals(of_body, "rest", kind=own.exact)
        system = Axis("world", p.worlds), Axis("number", 12)
        (self.system,) = own.reals(system, "system", kind=own.exact, kept=False)

    @property
    def others(self) -> list[Load]:
        """The loads of other matters."""
        return [load for load in self.free.loads if load is not self.load]

    def forget(self) -> None:
        """Forget what the forces of the last step had besides pressure."""
        if self.acts:
            self.rest.fill(0.0)

    @ti.func
    def begin(self, b, sums: ti.template()):
        """Begin with how far (m) a block of wall particles is from its wall's face."""
        sums[self.firm] = self.particles.load(self.particles.firm, b)

    @ti.func
    def add(self, b, seen: ti.template(), sums: ti.template()):
        """Add a particle before a block of walls: the way from it, and what it pushes besides, as of `WallForces`."""
        p, c, none = self.particles, self.constants, ti.cast(0.0, self.particles.real)
        hard = c.hardness(seen.square, sums[self.firm], p.zeros())
        always = c.clipped(p.pressure[seen.jb, seen.lane], none) * seen.slope + hard
        for a in ti.static(range(p.axes)):
            sums[self.way + a] += (seen.weight * seen.volume) * seen.apart[a]
            sums[self.always + a] = sums[self.always + a] - (seen.visible * (seen.volume * always)) * seen.apart[a]

    @ti.func
    def note(self, b, still: ti.template(), lever: ti.template(), seen: ti.template(), sums: ti.template()):
        """Note what a block of wall particles of a free body is to its load, from the sums of `Extrapolation`.

        `still` is p0 (Pa) and `lever` q, both zero of those that see no water; `seen` is Σ V_f W.
        """
        p, w, row = self.particles, b // self.particles.stride, self.bodies.row(b)
        at = w * self.bodies.room + row
        i = self.free.loose(w, self.bodies.owner[row])
        if i >= 0:
            arm = [p.offset(b, ti.cast(self.free.place[a][w, i], p.where), a) for a in ti.static(range(p.axes))]
            whole = [lever[a] for a in ti.static(range(p.axes))]
            if ti.static(self.bodies.slips):
                along = [p.load(self.bodies.along[a], row) for a in ti.static(range(p.axes))]
                self.bodies.turn(b, along, AT_START)
                slid = dot(whole, along)
                for a in ti.static(range(p.axes)):
                    whole[a] = whole[a] - slid * along[a]
            force = 0.0 - p.load(p.volume, b) * self.constants.get("slope")
            steep = self.leaning.steep(sums)
            straight = [force * steep[a] for a in ti.static(range(p.axes))]
            turning = arm[0] * straight[1] - arm[1] * straight[0]
            if ti.static(self.tangential.acts):
                off = [(force * seen) * p.load(self.tangential.correction[a], b) for a in ti.static(range(p.axes))]
                before = [sums[self.way + a] / ti.max(seen, 1e-30) for a in ti.static(range(p.axes))]
                turning = turning - ((arm[0] - before[0]) * off[1] - (arm[1] - before[1]) * off[0])
                for a in ti.static(range(p.axes)):
                    straight[a] = straight[a] - off[a]
            always = [force * sums[self.always + a] for a in ti.static(range(p.axes))]
            p.store(self.still, at, still)
            for a in ti.static(range(p.axes)):
                p.store(self.lever[a], at, whole[a])
                p.store(self.push[a], at, straight[a])
                p.store(self.fixed[a], at, always[a])
            p.store(self.lever[2], at, arm[0] * whole[1] - arm[1] * whole[0])
            p.store(self.push[2], at, turning)
            p.store(self.fixed[2], at, arm[0] * always[1] - arm[1] * always[0])

    @ti.func
    def solve(self, w, t, kick, dt):
        """Solve for the acceleration of each free body of a world, and give its wall particles their pressures."""
        for i in range(self.free.count):
            if self.free.state[w, i] != HELD:
                self.begin_solution(w, i)
                solved, changed = 0, True
                while changed:
                    changed = self.sum_up(w, i, solved == 0)
                    if solved == SOLVED:
                        changed = False
                    if changed:
                        self.accelerate(w, i)
                        solved += 1
                self.foresee(w, i)
                self.carry(w, i)

    @ti.func
    def begin_solution(self, w, i):
        """Begin with the acceleration of the last step."""
        for k in ti.static(range(3)):
            self.solution[w, i, k] = self.free.acceleration[k][w, i]

    @ti.func
    def sum_up(self, w, i, first):
        """Sum A and F of a body's wall particles that push at the present solution; whether any began or ceased to.

        Their pressures become those at the solution. `first`: nothing is known of which pushed before.
        """
        p, part = self.particles, self.free.part_of[i]
        total = ti.Vector([ti.cast(0.0, self.free.exact) for _ in ti.static(range(12))])
        a = [ti.cast(self.solution[w, i, k], p.real) for k in ti.static(range(3))]
        others = ti.cast(0.0, p.real)  # how many push that did not before, or the reverse
        for row in range(self.bodies.ends[part], self.bodies.ends[part + 1]):
            b, at = w * p.stride + p.fluid_blocks + self.bodies.first[0] + row, w * self.bodies.room + row
            lever = [p.load(self.lever[k], at) for k in ti.static(range(3))]
            push = [p.load(self.push[k], at) for k in ti.static(range(3))]
            still, before = p.load(self.still, at), p.load(p.pressure, b)
            pressure = still - (lever[0] * a[0] + lever[1] * a[1] + lever[2] * a[2])
            pushes = p.ones()
            if ti.static(not self.constants.full):
                pushes = ti.select(pressure > 0.0, p.ones(), p.zeros())
                other = pushes - ti.select(before > 0.0, p.ones(), p.zeros())
                others += (other * other).sum()
            p.store(p.pressure, b, pushes * pressure)
            for k in ti.static(range(3)):
                held = pushes * push[k]
                for n in ti.static(range(3)):
                    total[3 * k + n] += ti.cast((held * lever[n]).sum(), self.free.exact)
                total[9 + k] += ti.cast((held * still + p.load(self.fixed[k], at)).sum(), self.free.exact)
        for k in ti.static(range(12)):
            self.system[w, k] = total[k] * self.thickness[0]
        return first or others > 0.5

    @ti.func
    def accelerate(self, w, i):
        """Solve for the acceleration of a body from the sums of `sum_up`."""
        rest = ti.Vector([self.rest[w, i, k] for k in ti.static(range(3))])
        for m in ti.static(range(len(self.others))):
            rest += self.free.borne(w, i, self.others[m])
        mass, inertia = self.free.table[i, MASS], self.free.table[i, INERTIA]
        whole = ti.Matrix.zero(self.free.exact, 3, 3)
        for k in ti.static(range(3)):
            for n in ti.static(range(3)):
                whole[k, n] = self.system[w, 3 * k + n]
            whole[k, k] += inertia if ti.static(k == 2) else mass
        f = ti.Vector([self.system[w, 9 + k] + rest[k] for k in ti.static(range(3))])
        f[0] += mass * self.poses.felt[0][w]
        f[1] += mass * self.poses.felt[1][w]
        found = whole.inverse() @ f
        for k in ti.static(range(3)):
            self.solution[w, i, k] = found[k]

    @ti.func
    def carry(self, w, i):
        """Give a body, and its wall particles, the velocities (m/s) that it has at the start with the solution."""
        p, part = self.particles, self.free.part_of[i]
        u = self.free.velocity_with(w, i, ti.Vector([self.solution[w, i, k] for k in ti.static(range(3))]))
        self.free.note_pose(w, i, AT_START, 3, u)
        rate = ti.cast(u[2], p.real)
        for row in range(self.bodies.ends[part], self.bodies.ends[part + 1]):
            b = w * p.stride + p.fluid_blocks + self.bodies.first[0] + row
            arm = [p.offset(b, ti.cast(self.free.place[a][w, i], p.where), a) for a in ti.static(range(p.axes))]
            p.store(p.velocity[0], b, ti.cast(u[0], p.real) - rate * arm[1])
            p.store(p.velocity[1], b, ti.cast(u[1], p.real) + rate * arm[0])

    @ti.func
    def foresee(self, w, i):
        """Note the load by pressure that the solution has."""
        for k in ti.static(range(3)):
            load = self.system[w, 9 + k]
            for n in ti.static(range(3)):
                load -= self.system[w, 3 * k + n] * self.solution[w, i, n]
            self.foreseen[w, i, k] = load

    @ti.func
    def note_rest(self, w, t, kick, dt):
        """Note what the load on each free body of a world has besides, once the forces are known."""
        for i in range(self.free.count):
            if self.free.state[w, i] != HELD:
                load = self.free.about_centre(w, i, self.load.on_piece(w, self.free.first + self.free.part_of[i]))
                for k in ti.static(range(3)):
                    self.rest[w, i, k] = load[k] - self.foreseen[w, i, k]
