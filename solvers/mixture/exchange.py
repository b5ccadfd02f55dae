"""Exchange of momentum between grains and the water between them."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.lists.order import BINS
from solvers.fluid.matter import WaterMatter
from solvers.grains.matter import GrainMatter
from solvers.machine.errors import Unavailable
from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.mixture.drag import DRAG
from solvers.mixture.frame import InTank, OnHull
from solvers.mixture.given import Mixture
from solvers.mixture.porosity import Porosity
from solvers.mixture.pull import Pull
from solvers.mixture.start import Laying
from solvers.space.axes import dot, named
from solvers.tank.context import Context
from solvers.tank.matter import Matter

NEAR, FAR = 1.0, 1.5  # spacings in the bed from a particle of water: drag on a grain is whole, and none
THIN = 1.0e-6  # m²/s, kinematic viscosity at most of the liquid out of which a bed settles: that of water


@ti.data_oriented
class Exchange(Pull):
    """F_g = −V_g ∇p + V_g ∇·τ + F_d (Anderson & Jackson 1967): what a grain feels, and the water the opposite.

    The water's own pairs and walls make the force F_i on a particle as if it filled its volume alone. It keeps ε_i F_i,
    and the grains about it get the rest, V_g W(r_ig)/Γ_i F_i each: what is taken is what is given, and water at rest
    stays so in a bed of any shape (own derivation). The force on the water, −ε ∇p, is the adjoint of how its density
    changes, −(ρ/ε) ∇·(ε u), so that neither makes energy. A force that is first interpolated to the grains, and spread
    from there, is not: with it the surface of a bed blew up.

    Drag is between the grain and the velocity u_f at its place, interpolated with the weights V_i W/Σ V W, by which its
    reaction is spread, too. The water acts in steps of its own, T, the grains in many shorter ones. Through these the
    drag is the mean over the step of the exact solution of

        du_g/dt = a_g + κ (u_f − u_g)/m_g,   du_f/dt = a_f − κ (u_f − u_g)/m_s

    with the water's share m_s = ρ V_g ε/(1 − ε) (own derivation): neither step is limited by drag, however fine the
    grains. The coefficient κ stands through a step of the water. Impulses of drag are summed for each grain and go to
    the water at the step's end.

    The lift stands through T, too. Grains would then follow it as by Euler's method, x'' = −ω² x growing at the rate
    ω² T/4. So as a step begins, each gets half a step of the change of its lift besides: its mean velocities over the
    steps are those of the water's leapfrog (own derivation), and a lift that does not change does not knock. At the end
    of a step grains are thus ahead of the water by ½ T of their lift.

    The drag of a grain counts whole where the nearest particle of water is within a spacing of the bed, Δx/√ε, and not
    at all from 1.5 on. Liquid bridges pull by the rest, (1 − s_i)(1 − s_j) of both grains' shares s in the drag: none
    in full pores, whole where no free water is near. What is lost of a bridge's energy as it drowns goes nowhere, and
    comes from nowhere as the water leaves.

    Limits: within 2 h of a plane wall the lift of a single grain is off, by −30 % at the wall and 7 % at h from it (the
    kernel's integral over W/Γ), their sum is not. No added mass, no lift across the flow, no lubrication, no friction
    of the slab's end planes.

    Units: κ kg/s, u m/s, a m/s², m kg, V_g m³, p Pa.
    """

    def __init__(self, arrays: State, context: Context, scene, grains: GrainMatter, water: WaterMatter):
        self.scene, hold = scene, grains.mover.hold
        self.grains, self.water, self.carrier = grains.grains, water, context.carrier
        self.particles, self.constants, self.order = water.particles, water.constants, water.order
        self.lists, self.ranges, self.poses, self.substeps = water.lists, water.ranges, water.poses, water.substeps
        self.water_units, self.units = water.units, context.units(self.grains.count, 0, arrays.under("mixture.units"))
        mixture: Mixture = scene.mixture
        self.law, thickness = DRAG[mixture.drag](), scene.tanks[scene.hold].thickness
        hulled = arrays, scene, self.grains, hold, water.bodies.hulls, context.parts
        self.frame = frame = OnHull(*hulled) if hold else InTank(self.grains)
        self.porosity = Porosity(arrays, water.context, frame, context.walls.bounds, thickness)
        self.laying = Laying(scene)
        g, own = self.grains, arrays.under("mixture")
        each = Axis("world", g.worlds), Axis("place", g.room)
        self.flow, self.lift, self.rise, self.impulse, self.push = (
            own.reals(each, *named(name, g.axes), kept=False) for name in ("flow", "lift", "rise", "impulse", "push")
        )
        self.former = own.reals(g.each, *named("former", g.axes))
        names = "share", "partner", "held", "gained"  # the last two: κ times the means of `means`, kg/s and kg
        self.share, self.partner, self.held, self.gained = own.reals(each, *names, kept=False)
        density = scene.fluid.water.density
        viscosity = density * mixture.kinematic
        self.numbers = own.holding("numbers", np.array([thickness, density, viscosity, 1.0 / mixture.finer]), "number")
        self.own_drag, self.thin = (viscosity, 1.0 / mixture.finer), (min(viscosity, density * THIN), 1.0)
        first, last = water.substeps.first, water.substeps.last
        noting = [Phase(frame.note)] if frame.aboard else []
        self.opening = first([*noting, Phase(self.porosity.sort), Phase(self.porosity.find, water.units)])
        self.phases = first([Phase(self.gather, self.units)])
        self.closing = last([Phase(self.close), Phase(self.spread, water.units)])

    def lay(self, position: np.ndarray) -> np.ndarray:
        """The water (W, n) at rest between grains at `position` (W, n, 2) m; what was is forgotten.

        Grains in a hull are dry at first, and the water is where the scene has it.
        """
        for field in (*self.former, *([self.grains.dry] if self.grains.soaks else [])):
            field.fill(0.0)
        return self.scene.fluid.particles if self.frame.aboard else self.laying.particles(position)

    def ease(self, settles: bool) -> None:
        """Let the water drain out of a bed that `settles` as through grains of its own size, and be as thin as water.

        Fine grains or a thick liquid would drain for minutes; the bed at rest is the same.
        """
        self.numbers[2], self.numbers[3] = self.thin if settles else self.own_drag

    @ti.func
    def gather(self, u, t, kick, dt):
        """What the water does to each grain of a unit through the coming step of the water."""
        w = self.units.world(u)
        for i in range(self.units.first(u), self.units.end(u)):
            self.gather_at(w, i, ti.select(i < self.grains.units.moving(), dt / self.substeps.every, kick))
            self.lead(w, i, kick, dt)

    @ti.func
    def gather_at(self, w, i, during):
        """As `gather`, for a grain whose own steps last so long (s)."""
        p, c, order = self.particles, self.constants, self.order
        zero = ti.cast(0.0, p.real)
        far = ti.cast(c.get("reach") + 0.5 * self.lists.fixed_skin, p.where)
        seen, porosity, near = zero, zero, ti.cast(1e30, p.real)
        flow, push = [zero for _ in ti.static(range(p.axes))], [zero for _ in ti.static(range(p.axes))]
        lift = [zero for _ in ti.static(range(p.axes))]
        start = w * p.stride * p.lanes
        for n in range(self.porosity.images):
            image = self.porosity.image(n)
            here = [self.frame.place[a][w, i] - self.porosity.shift(image, a) for a in ti.static(range(p.axes))]
            left, right = order.bin_of(here[0] - far), order.bin_of(here[0] + far)
            for strip in range(order.strip_of(here[1] - far), order.strip_of(here[1] + far) + 1):
                begin, end = (
                    order.first[w, strip * order.sizes[BINS] + left],
                    order.first[w, strip * order.sizes[BINS] + right + 1],
                )
                for k in range(start + begin, start + end):
                    b, lane = k // p.lanes, k % p.lanes
                    apart = [ti.cast(here[a] - p.place[a][b, lane], p.real) for a in ti.static(range(p.axes))]
                    square = dot(apart, apart)
                    weight = c.kernel.value(ti.max(1.0 - ti.sqrt(square) * c.get("shrink"), 0.0))
                    if ti.static(self.frame.aboard):
                        away = [0.0 - apart[a] for a in ti.static(range(p.axes))]
                        weight *= self.frame.share_of_one(w, b, lane, self.short(here), away)
                        square = ti.select(weight > 0.0, square, ti.cast(1e30, p.real))
                    heavy, weight = weight * p.mass[b, lane], weight * p.volume[b, lane]
                    seen += weight
                    porosity += weight * p.porosity[b, lane]
                    near = ti.min(near, square)
                    for a in ti.static(range(p.axes)):
                        flow[a] += weight * p.velocity[a][b, lane]
                        pushed = heavy * p.acceleration[a][b, lane]
                        push[a] += pushed
                        lift[a] += pushed * self.porosity.whole[b, lane]
        wet = zero
        if seen > 0.0:
            porosity /= seen
            away = ti.sqrt(near * porosity) / c.get("spacing")
            wet = ti.max(0.0, ti.min(1.0, (FAR - away) / (FAR - NEAR)))
        if ti.static(self.grains.soaks):
            self.grains.dry[w, i] = 1.0 - wet
        self.share[w, i], self.partner[w, i], self.held[w, i], self.gained[w, i] = zero, zero, zero, zero
        for a in ti.static(range(p.axes)):
            self.impulse[a][w, i], self.lift[a][w, i], self.rise[a][w, i] = zero, zero, zero
        if seen > 0.0:
            if wet > 0.0:
                self.share[w, i] = 1.0 / (self.numbers[0] * seen)
            mean = [flow[a] / seen for a in ti.static(range(p.axes))]
            self.wet(w, i, during, wet, porosity, mean, push, lift, seen)

    @ti.func
    def wet(self, w, i, during, wet, porosity, flow: ti.template(), push: ti.template(), lift: ti.template(), seen):
        """Note what acts on a grain that is in water by the share `wet`, from the sums of what it sees."""
        g, p, radius = self.grains, self.particles, self.grains.radius[w, i]
        volume, density = self.porosity.sphere[0] * self.numbers[0] * radius * radius * radius, self.numbers[1]
        walls = self.walls_at(w, i)
        for a in ti.static(range(p.axes)):
            self.flow[a][w, i] = flow[a] - walls[a]
            self.lift[a][w, i] = volume * lift[a]
            self.rise[a][w, i] = push[a] / (seen * density)
        now = self.now(w, i)
        slip = [self.flow[a][w, i] - now[a] for a in ti.static(range(p.axes))]
        size = 2.0 * radius * self.numbers[3]
        law = self.law.coefficient(ti.sqrt(dot(slip, slip)), porosity, size, density, self.numbers[2])
        rate, partner = wet * volume * law, (1.0 - porosity) / (density * porosity * volume)
        first, second = self.means(rate * (g.inverse_mass[w, i] + partner) * ti.cast(during, g.real))
        self.partner[w, i], self.held[w, i] = partner, rate * first
        self.gained[w, i] = rate * second * ti.cast(during, g.real)

    @ti.func
    def short(self, place: ti.template()):
        """A place (m) with the digits of what is in a block."""
        return [ti.cast(place[a], self.particles.real) for a in ti.static(range(self.particles.axes))]

    @ti.func
    def now(self, w, i):
        """The velocity (m/s) of a grain in the tank as the step of the water begins."""
        if ti.static(self.frame.aboard):
            return self.frame.now(w, i)
        else:
            return [self.grains.now[a][w, i] for a in ti.static(range(self.grains.axes))]

    @ti.func
    def walls_at(self, w, i):
        """The velocity (m/s) of the tank at a grain, in the tank's axes."""
        g, real = self.grains, self.particles.real
        walls = [ti.cast(0.0, real) for _ in ti.static(range(g.axes))]
        if ti.static(self.poses.moving):
            rate = ti.cast(self.poses.walls[5][w], real)
            walls[0] = ti.cast(self.poses.walls[3][w], real) - rate * ti.cast(g.place[1][w, i], real)
            walls[1] = ti.cast(self.poses.walls[4][w], real) + rate * ti.cast(g.place[0][w, i], real)
        return walls

    @ti.func
    def close(self, w, frame, kick, dt):
        """Have all grains of a world give back what the water gave them; returns that all is well."""
        g = self.grains
        for i in range(g.units.moving(), g.units.all()):
            still = [ti.cast(0.0, g.real) for _ in ti.static(range(g.axes))]
            felt = [ti.cast(self.poses.felt[2 + a][w], g.real) for a in ti.static(range(g.axes))]
            self.act(w, i, still, felt, self.substeps.kick(w, kick))
        for k in range(g.units.all()):
            i = self.porosity.cells.sorted[w, k]
            for a in ti.static(range(g.axes)):
                self.push[a][w, k] = -self.share[w, i] * self.impulse[a][w, i]
        return True

    @ti.func
    def spread(self, u, frame, kick, dt):
        """Add the reaction of the grains to the accelerations of a unit's particles; returns that all is well."""
        p, c, lists, of = self.particles, self.constants, self.lists, self.porosity
        w = self.water_units.world(u)
        first, end = self.ranges.fluid(u)
        during = self.substeps.kick(w, kick)
        for b in range(first, end):
            origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
            own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
            push = [p.zeros() for _ in ti.static(range(p.axes))]
            for n in range(of.images):
                image = of.image(n)
                lower, upper = lists.box(b)
                lists.seen_in(image, lower, upper)
                for row in range(of.row_of(lower[1], -1), of.row_of(upper[1], 1) + 1):
                    for k in range(of.begin(w, row, lower[0]), of.end(w, row, upper[0])):
                        apart = [
                            own[a] - ti.cast(of.place[a][w, k] + of.shift(image, a) - origin[a], p.real)
                            for a in ti.static(range(p.axes))
                        ]
                        t = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * c.get("shrink"), 0.0)
                        weight = c.kernel.value(t)
                        if ti.static(self.frame.aboard):
                            weight *= self.frame.share(w, b, of.place_of(w, k), apart)
                        for a in ti.static(range(p.axes)):
                            push[a] += self.push[a][w, k] * weight
            mass, share = p.load(p.mass, b), p.load(p.porosity, b)
            per_mass = p.load(p.volume, b) / (during * ti.max(mass, 1e-30))
            for a in ti.static(range(p.axes)):
                p.store(p.acceleration[a], b, p.load(p.acceleration[a], b) * share + per_mass * push[a])
        return True


def make_exchange(scene, context: Context, matters: Sequence[Matter]) -> Exchange | None:
    """What grains and water of a scene (`solvers.scene.Scene`) exchange; None where they do not meet."""
    if scene.mixture is None:
        return None
    if context.per_particle:
        raise Unavailable('grains in water are not computed particle by particle; take run.schedule = "per-world".')
    grains, water = matters
    exchange = Exchange(context.arrays, context, scene, grains, water)
    grains.mover.soak(exchange)
    water.lay_by(exchange)
    return exchange
