"""The first pass over pairs: the rate of density, from the motion of the neighbours and from diffusion."""

import taichi as ti

from solvers.fluid.forces import Forces
from solvers.fluid.lists.context import FluidContext
from solvers.machine.state import State
from solvers.motion.poses import AT_MIDDLE
from solvers.space.axes import dot


@ti.data_oriented
class Continuity:
    """dρ_i/dt = −ρ_i Σ V_j (u_j − u_i)·∇W + δ h c0 Σ V_j ψ·∇W (Antuono et al. 2010, eq. 6); the second sum over water.

    Of two phases, the second sum is over the own phase, and pairs of both have the weight of `solvers.fluid.phases`.
    Broken water bears no pressure, see `solvers.fluid.surface.void_indicator`; water keeps its volume, see
    `solvers.fluid.surface.reinitialisation`.

    `diffused` (units,) J is the energy that diffusion, the relief of broken water and the keeping of volume have taken:
    −Σ m_i p_i/ρ_i² times their share of the rate (Antuono, Marrone, Colagrossi & Bouscasse 2015, eq. 22), by the
    water's pressure in the middle of the step. What the water before wall particles takes (`DivergenceCorrection`), and
    what images of water take from air (`SlipCorrection`), goes to `stored` (units,) J. The momentum that shifts carry
    is summed up over the same pairs.
    """

    def __init__(self, arrays: State, context: FluidContext, forces: Forces):
        self.units, self.particles, self.ranges = context.units, context.particles, context.ranges
        self.lists, self.constants, self.poses = context.lists, context.constants, context.poses
        own, self.slip, self.stored = arrays.under("water.continuity"), forces.walls.walls.slip, forces.stored
        (self.diffused,) = own.reals((context.units.axis,), "diffused", kind=own.exact)
        self.corrects = context.particles.wall_blocks > 0 and not context.constants.full
        self.voids = forces.voids

    @ti.func
    def continuity_pass(self, u, frame, kick, dt):
        """The rates of density of a unit's particles in the middle of the step; returns that all is well."""
        first, end = self.ranges.fluid(u)
        powers = ti.Vector([ti.cast(0.0, self.particles.exact) for _ in ti.static(range(2))])
        for b in range(first, end):
            powers += self.lists.order.weight(b) * self.pass_block(u, b, b - first, dt)
        self.diffused[u] = self.diffused[u] - powers[0] * ti.cast(dt, self.particles.exact)
        self.stored[u] = self.stored[u] - powers[1] * ti.cast(dt, self.particles.exact)
        return True

    @ti.func
    def pass_block(self, u, b, listed, dt):
        """As `continuity_pass`, for a block; returns the powers (W/m) of diffusion and of walls at rest."""
        p, c = self.particles, self.constants
        lists = self.lists
        w = self.units.world(u)
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        speed = [p.load(p.velocity[a], b) for a in ti.static(range(p.axes))]
        gradient = [p.load(p.gradient[a], b) for a in ti.static(range(p.axes))]
        s, shrink = p.load(p.deviation, b), c.get("shrink")
        gas = p.gases(b)
        rest = [c.of("hydrostatic", gas) * self.down(w, a) for a in ti.static(range(p.axes))]
        opened, evened, walled, closed = p.zeros(), p.zeros(), p.zeros(), p.zeros()
        slid = p.zeros()
        carried = [p.zeros() for _ in ti.static(range(p.axes))]
        shift = [p.zeros() for _ in ti.static(range(p.axes))]
        if ti.static(c.shifting.carries):
            for a in ti.static(range(p.axes)):
                shift[a] += p.load(p.shift[a], b)
        tank = [ti.cast(self.tank_speed(w, a), p.real) for a in ti.static(range(p.axes))]
        for k in range(lists.near.first[u, listed], lists.near.first[u, listed + 1]):
            j = lists.near.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(own, origin, j)
            t = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * shrink, 0.0)
            weight = p.volume[jb, lane] * lists.visible(b, j, apart, AT_MIDDLE) * c.kernel.slope(t)
            nearing = [p.velocity[a][jb, lane] - speed[a] for a in ti.static(range(p.axes))]
            other = gas - p.gas_at(jb, lane)
            if ti.static(c.two):
                opened += (1.0 + c.get("lean_of_speed") * other) * weight * dot(nearing, apart)
            else:
                opened += weight * dot(nearing, apart)
            if ti.static(c.shifting.carries):
                away = (weight * (1.0 + s)) * dot(shift, apart)
                shift_there = [p.shift[a][jb, lane] for a in ti.static(range(p.axes))]
                away_there = (weight * (1.0 + p.deviation[jb, lane])) * dot(shift_there, apart)
                for a in ti.static(range(p.axes)):
                    own_flow, its_flow = away * (speed[a] - tank[a]), away_there * (p.velocity[a][jb, lane] - tank[a])
                    carried[a] = carried[a] - (own_flow + its_flow)
            if ti.static(c.diffusion.acts):
                more = 2.0 * (p.deviation[jb, lane] - s)
                if ti.static(c.diffusion.renormalised):
                    both = [p.gradient[a][jb, lane] + gradient[a] for a in ti.static(range(p.axes))]
                    more += dot(both, apart)
                elif ti.static(c.diffusion.dynamic):
                    more += 2.0 * dot(rest, apart)
                if ti.static(c.two):
                    more *= 1.0 - other * other
                evened += weight * more
        if ti.static(p.wall_blocks > 0):
            pieces = lists.pieces
            for k in range(lists.beside.first[u, listed * pieces], lists.beside.first[u, (listed + 1) * pieces]):
                j = lists.beside.slots[u, k]
                jb, lane = lists.block_of(j), lists.lane_of(j)
                apart = lists.apart(own, origin, j)
                t = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * shrink, 0.0)
                volume = p.volume[jb, lane] * lists.visible(b, j, apart, AT_MIDDLE)
                weight = volume * c.kernel.slope(t)
                nearing = [p.velocity[a][jb, lane] - speed[a] for a in ti.static(range(p.axes))]
                walled += weight * dot(nearing, apart)
                if ti.static(self.corrects):
                    closed += (volume * p.rate[jb, lane]) * c.kernel.value(t)
                if ti.static(self.slip.acts):
                    slid += weight * self.slip.dotted(jb, lane, apart)
            closed *= c.get("value")
        if ti.static(c.two):  # air meets its mirror image at walls, see `solvers.fluid.phases.interfaces`
            walled *= 1.0 + gas
            closed = (1.0 - gas) * closed + gas * (c.get("slope") * slid)
        factor = c.get("slope")
        evened *= factor * c.of("spread", gas)
        rate, rate_of_walls = (1.0 + s) * (factor * opened) + evened, (1.0 + s) * (factor * walled + closed)
        p.store(p.rate, b, rate)
        p.store(p.rate_of_walls, b, rate_of_walls)
        if ti.static(c.shifting.carries):
            flux = p.load(p.volume, b) * (factor * c.get("density"))
            for a in ti.static(range(p.axes)):
                p.store(p.carried[a], b, flux * carried[a])
        pressure, more = p.load(p.pressure, b), (0.5 * dt) * (rate + rate_of_walls)
        if ti.static(self.voids.acts):
            after = self.voids.stepped(b, s, rate, rate_of_walls, p.ones() * dt)
            evened += (after - s) * (1.0 / dt) - (rate + rate_of_walls)
            change = (0.5 * c.get("stiffness")) * (c.state.share(after) - c.state.share(s))
            pressure += (1.0 - gas) * change if ti.static(c.two) else change
        elif ti.static(c.two):
            pressure += (1.0 - gas) * (c.get("stiffness") * more)
        else:
            pressure += c.get("stiffness") * (c.state.share(s + more) - c.state.share(s))
        power = pressure * p.load(p.mass, b) / p.borne(b, (1.0 + s) * (1.0 + s) * c.of("density", gas))
        by_walls = (1.0 + s) * closed
        powers = ti.Vector([ti.cast(0.0, p.exact) for _ in ti.static(range(2))])
        powers[0], powers[1] = ti.cast((evened * power).sum(), p.exact), ti.cast((by_walls * power).sum(), p.exact)
        return powers

    @ti.func
    def tank_speed(self, w, axis: ti.template()):
        """The velocity (m/s) of the tank's origin along its own axis, in the middle of the step."""
        speed = ti.cast(0.0, self.particles.exact)
        if ti.static(self.poses.moving):
            speed = self.poses.walls[axis][w]
        return speed

    @ti.func
    def down(self, w, axis: ti.template()):
        """Direction of gravity along an axis of the tank, at the start of the step."""
        pull = [self.poses.felt[a][w] for a in ti.static(range(2))]
        size = ti.max(ti.sqrt(dot(pull, pull)), 1e-12)
        return ti.cast(pull[axis] / size, self.particles.real)
