"""How water answers the acceleration of free bodies at once: the pressures of wall particles follow from it."""

import numpy as np
import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.terms.term import Sums, Term
from solvers.fluid.walls.tangential_correction import Leaning, TangentialCorrection
from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.motion.free import HELD
from solvers.space.axes import dot, named, named_turns, swing, turns
from solvers.space.tangent import moment
from solvers.tank.load import Load
from solvers.tank.pose import AT_START

SOLVED = 3  # times at most: once, and again while wall particles begin or cease to push


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
    on a, are taken from the step before. In space M has the inertia tensor, and the body needs a moment ω × I ω to go
    on turning as it does. The system is solved by elimination without pivots, which M + A, near to a mass, bears.

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
        self.axes, self.about, self.size = p.axes, turns(p.axes), p.axes + turns(p.axes)

        def of_load(what: str) -> list[ti.Field]:
            return own.wide(each, *named(what, p.axes), *named_turns(f"{what}_turn", p.axes), kept=False)

        self.lever, self.push, self.fixed = map(of_load, ("lever", "push", "fixed"))  # of 1 Pa, and of all else
        of_body = Axis("world", p.worlds), Axis("body", self.free.count), Axis("freedom", self.size)
        self.foreseen, self.solution = own.reals(of_body, "foreseen", "solution", kind=own.exact, kept=False)
        (self.rest,) = own.reals(of_body, "rest", kind=own.exact)
        system = Axis("world", p.worlds), Axis("number", self.size * (self.size + 1))  # A row by row, then F
        self.system, self.reduced = own.reals(system, "system", "reduced", kind=own.exact, kept=False)

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
            if ti.static(self.bodies.acceleration.slips):
                across = self.bodies.acceleration.across(b, row, whole)
                for a in ti.static(range(p.axes)):
                    whole[a] = across[a]
            force = 0.0 - p.load(p.volume, b) * self.constants.get("slope")
            steep = self.leaning.steep(sums)
            straight = [force * steep[a] for a in ti.static(range(p.axes))]
            turning = moment(arm, straight)
            if ti.static(self.tangential.acts):
                off = [(force * seen) * p.load(self.tangential.correction[a], b) for a in ti.static(range(p.axes))]
                before = [arm[a] - sums[self.way + a] / ti.max(seen, 1e-30) for a in ti.static(range(p.axes))]
                turned_off = moment(before, off)
                for k in ti.static(range(turns(p.axes))):
                    turning[k] = turning[k] - turned_off[k]
                for a in ti.static(range(p.axes)):
                    straight[a] = straight[a] - off[a]
            always = [force * sums[self.always + a] for a in ti.static(range(p.axes))]
            p.store(self.still, at, still)
            self.store(at, whole, moment(arm, whole), self.lever)
            self.store(at, straight, turning, self.push)
            self.store(at, always, moment(arm, always), self.fixed)

    @ti.func
    def store(self, at, force: ti.template(), turning: ti.template(), fields: ti.template()):
        """Store forces and moments of a block of wall particles."""
        p = self.particles
        for a in ti.static(range(p.axes)):
            p.store(fields[a], at, force[a])
        for k in ti.static(range(turns(p.axes))):
            p.store(fields[p.axes + k], at, turning[k])

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
        last = self.free.gains(w, i)
        for k in ti.static(range(self.size)):
            self.solution[w, i, k] = last[k]

    @ti.func
    def sum_up(self, w, i, first):
        """Sum A and F of a body's wall particles that push at the present solution; whether any began or ceased to.

        Their pressures become those at the solution. `first`: nothing is known of which pushed before.
        """
        p, part = self.particles, self.free.part_of[i]
        for k in range(self.size * (self.size + 1)):
            self.system[w, k] = 0.0
        a = [ti.cast(self.solution[w, i, k], p.real) for k in ti.static(range(self.size))]
        others = ti.cast(0.0, p.real)  # how many push that did not before, or the reverse
        for row in range(self.bodies.ends[part], self.bodies.ends[part + 1]):
            b, at = w * p.stride + p.fluid_blocks + self.bodies.first[0] + row, w * self.bodies.room + row
            lever = [p.load(self.lever[k], at) for k in ti.static(range(self.size))]
            push = [p.load(self.push[k], at) for k in ti.static(range(self.size))]
            still, before = p.load(self.still, at), p.load(p.pressure, b)
            pressure = still - dot(lever, a)
            pushes = p.ones()
            if ti.static(not self.constants.full):
                pushes = ti.select(pressure > 0.0, p.ones(), p.zeros())
                other = pushes - ti.select(before > 0.0, p.ones(), p.zeros())
                others += (other * other).sum()
            p.store(p.pressure, b, pushes * pressure)
            for k in ti.static(range(self.size)):
                held = pushes * push[k]
                for n in ti.static(range(self.size)):
                    self.add_to(w, self.size * k + n, (held * lever[n]).sum())
                self.add_to(w, self.size * self.size + k, (held * still + p.load(self.fixed[k], at)).sum())
        return first or others > 0.5

    @ti.func
    def add_to(self, w, number: ti.template(), value):
        """Add to a number of a world's system."""
        self.system[w, number] = self.system[w, number] + self.thickness[0] * ti.cast(value, self.free.exact)

    @ti.func
    def accelerate(self, w, i):
        """Solve for the acceleration of a body from the sums of `sum_up`."""
        rest = ti.Vector([self.rest[w, i, k] for k in ti.static(range(self.size))])
        for m in ti.static(range(len(self.others))):
            rest += self.free.borne(w, i, self.others[m])
        mass, tensor, gyration = self.free.mass(i), self.free.tensor(w, i), self.free.gyration(w, i)
        for a in ti.static(range(self.axes)):
            rest[a] += mass * self.poses.felt[a][w]
        for k in range(self.size * (self.size + 1)):
            self.reduced[w, k] = self.system[w, k]
        for k in ti.static(range(self.about)):
            rest[self.axes + k] -= gyration[k]
            for n in ti.static(range(self.about)):
                at = self.size * (self.axes + k) + self.axes + n
                self.reduced[w, at] = self.reduced[w, at] + tensor[self.about * k + n]
        for k in ti.static(range(self.size)):
            at = self.size * self.size + k
            self.reduced[w, at] = self.reduced[w, at] + rest[k]
            if ti.static(k < self.axes):
                self.reduced[w, (self.size + 1) * k] = self.reduced[w, (self.size + 1) * k] + mass
        self.eliminate(w)
        for k in ti.static(range(self.size)):
            self.solution[w, i, k] = self.reduced[w, self.size * self.size + k]

    @ti.func
    def eliminate(self, w):
        """Solve the system of a world by Gauss's elimination, in the place of its right side."""
        size, right = self.size, self.size * self.size
        r = ti.static(self.reduced)
        for k in range(size):
            for row in range(k + 1, size):
                share = r[w, size * row + k] / r[w, (size + 1) * k]
                for n in range(k + 1, size):
                    r[w, size * row + n] = r[w, size * row + n] - share * r[w, size * k + n]
                r[w, right + row] = r[w, right + row] - share * r[w, right + k]
        for back in range(size):
            row = size - 1 - back
            for n in range(row + 1, size):
                r[w, right + row] = r[w, right + row] - r[w, size * row + n] * r[w, right + n]
            r[w, right + row] = r[w, right + row] / r[w, (size + 1) * row]

    @ti.func
    def carry(self, w, i):
        """Give a body, and its wall particles, the velocities (m/s) that it has at the start with the solution."""
        p, part = self.particles, self.free.part_of[i]
        u = self.free.velocity_with(w, i, ti.Vector([self.solution[w, i, k] for k in ti.static(range(self.size))]))
        self.free.note_pose(w, i, AT_START, AT_START, u)
        rate = [ti.cast(u[self.particles.axes + k], p.real) for k in ti.static(range(turns(self.particles.axes)))]
        for row in range(self.bodies.ends[part], self.bodies.ends[part + 1]):
            b = w * p.stride + p.fluid_blocks + self.bodies.first[0] + row
            arm = [
                p.offset(b, ti.cast(self.free.place[a][w, i], p.where), a)
                for a in ti.static(range(self.particles.axes))
            ]
            speed = [p.ones() * ti.cast(u[a], p.real) for a in ti.static(range(self.particles.axes))]
            swing(rate, arm, speed)
            for a in ti.static(range(self.particles.axes)):
                p.store(p.velocity[a], b, speed[a])

    @ti.func
    def foresee(self, w, i):
        """Note the load by pressure that the solution has."""
        for k in ti.static(range(self.size)):
            load = self.system[w, self.size * self.size + k]
            for n in ti.static(range(self.size)):
                load -= self.system[w, self.size * k + n] * self.solution[w, i, n]
            self.foreseen[w, i, k] = load

    @ti.func
    def note_rest(self, w, t, kick, dt):
        """Note what the load on each free body of a world has besides, once the forces are known."""
        for i in range(self.free.count):
            if self.free.state[w, i] != HELD:
                load = self.free.about_centre(w, i, self.load.on_piece(w, self.free.first + self.free.part_of[i]))
                for k in ti.static(range(self.size)):
                    self.rest[w, i, k] = load[k] - self.foreseen[w, i, k]
