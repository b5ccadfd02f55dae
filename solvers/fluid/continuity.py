"""The first pass over pairs: the rate of density, from the motion of the neighbours and from diffusion."""

import taichi as ti

from solvers.fluid.forces import Forces
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.phases.slip_correction import SlidImage
from solvers.fluid.terms.carried_momentum import CarriedMomentum
from solvers.fluid.terms.density_diffusion import DensityDiffusion
from solvers.fluid.terms.term import Block, Pair, Sums, Term, doing
from solvers.fluid.walls.divergence_correction import Closing
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
        own, slip = arrays.under("water.continuity"), forces.walls.walls.slip
        self.stored, self.voids = forces.stored, forces.voids
        (self.diffused,) = own.reals((context.units.axis,), "diffused", kind=own.exact)
        self.sums, common = (sums := Sums()), (context.particles, context.constants, context.units, context.poses)
        self.opened, self.walled, c = sums.room(), sums.room(), context.constants
        self.corrects = context.particles.wall_blocks > 0 and not c.full
        self.closing = Closing(sums, context.particles, c) if self.corrects else None
        self.diffusion = DensityDiffusion(sums, *common) if c.diffusion.acts else None
        carried = CarriedMomentum(sums, *common) if c.shifting.carries else None
        self.slides = slip.acts
        self.slid = SlidImage(sums, slip) if slip.acts else None
        terms = [carried, self.diffusion, self.closing, self.slid]
        self.beginning, self.adding, self.of_walls, self.ending = (doing(terms, part) for part in Term.parts)

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
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        speed = [p.load(p.velocity[a], b) for a in ti.static(range(p.axes))]
        s, shrink, gas = p.load(p.deviation, b), c.get("shrink"), p.gases(b)
        block = ti.static(Block(u, b, dt, origin, own, speed, s, s, gas))
        sums = [p.zeros() for _ in ti.static(range(self.sums.count))]
        for term in ti.static(self.beginning):
            term.begin(block, sums)
        for k in range(lists.near.first[u, listed], lists.near.first[u, listed + 1]):
            j = lists.near.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(own, origin, j)
            square = dot(apart, apart)
            t = ti.max(1.0 - ti.sqrt(square) * shrink, 0.0)
            volume = p.volume[jb, lane] * lists.visible(b, j, apart, AT_MIDDLE)
            weight, other = volume * c.kernel.slope(t), gas - p.gas_at(jb, lane)
            nearing = [p.velocity[a][jb, lane] - speed[a] for a in ti.static(range(p.axes))]
            opening = weight
            if ti.static(c.two):
                opening = (1.0 + c.get("lean_of_speed") * other) * weight
            sums[self.opened] += opening * dot(nearing, apart)
            pair = ti.static(Pair(jb, lane, apart, square, t, weight, volume, other, weight, apart, []))
            for term in ti.static(self.adding):
                term.add(block, pair, sums)
        if ti.static(p.wall_blocks > 0):
            self.add_walls(block, listed, sums)
        for term in ti.static(self.ending):
            term.end(block, sums)
        return self.end(block, dt, sums)

    @ti.func
    def add_walls(self, block: ti.template(), listed, sums: ti.template()):
        """Add the wall particles beside a block."""
        p, c, lists, of_block = self.particles, self.constants, self.lists, listed * self.lists.pieces
        shrink = c.get("shrink")
        begin, end = lists.beside.first[block.u, of_block], lists.beside.first[block.u, of_block + self.lists.pieces]
        for k in range(begin, end):
            j = lists.beside.slots[block.u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(block.own, block.origin, j)
            square = dot(apart, apart)
            t = ti.max(1.0 - ti.sqrt(square) * shrink, 0.0)
            volume = p.volume[jb, lane] * lists.visible(block.b, j, apart, AT_MIDDLE)
            weight = volume * c.kernel.slope(t)
            nearing = [p.velocity[a][jb, lane] - block.speed[a] for a in ti.static(range(p.axes))]
            sums[self.walled] += weight * dot(nearing, apart)
            pair = ti.static(Pair(jb, lane, apart, square, t, weight, volume, 0, weight, apart, []))
            for term in ti.static(self.of_walls):
                term.add_wall(block, pair, sums)

    @ti.func
    def end(self, block: ti.template(), dt, sums: ti.template()):
        """Store the rates of a block; returns as `pass_block`."""
        p, c, s, gas, factor = self.particles, self.constants, block.s, block.gas, self.constants.get("slope")
        walled, closed, evened = sums[self.walled], p.zeros(), p.zeros()
        if ti.static(self.corrects):
            closed += sums[self.closing.closed] * c.get("value")
        if ti.static(c.two):  # air meets its mirror image at walls, see `solvers.fluid.phases.interfaces`
            walled *= 1.0 + gas
            closed = (1.0 - gas) * closed
            if ti.static(self.slides):
                closed += gas * (factor * sums[self.slid.slid])
        if ti.static(c.diffusion.acts):
            evened += sums[self.diffusion.evened] * (factor * c.of("spread", gas))
        rate = (1.0 + s) * (factor * sums[self.opened]) + evened
        rate_of_walls = (1.0 + s) * (factor * walled + closed)
        p.store(p.rate, block.b, rate)
        p.store(p.rate_of_walls, block.b, rate_of_walls)
        pressure, more = p.load(p.pressure, block.b), (0.5 * dt) * (rate + rate_of_walls)
        if ti.static(self.voids.acts):
            after = self.voids.stepped(block.b, s, rate, rate_of_walls, p.ones() * dt)
            evened += (after - s) * (1.0 / dt) - (rate + rate_of_walls)
            change = (0.5 * c.get("stiffness")) * (c.state.share(after) - c.state.share(s))
            pressure += (1.0 - gas) * change if ti.static(c.two) else change
        elif ti.static(c.two):
            pressure += (1.0 - gas) * (c.get("stiffness") * more)
        else:
            pressure += c.get("stiffness") * (c.state.share(s + more) - c.state.share(s))
        density = p.borne(block.b, (1.0 + s) * (1.0 + s) * c.of("density", gas))
        power, by_walls = pressure * p.load(p.mass, block.b) / density, (1.0 + s) * closed
        powers = ti.Vector([ti.cast(0.0, p.exact) for _ in ti.static(range(2))])
        powers[0], powers[1] = ti.cast((evened * power).sum(), p.exact), ti.cast((by_walls * power).sum(), p.exact)
        return powers
