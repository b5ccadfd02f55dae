"""Pressures of the wall particles, extrapolated from the water before them."""

import taichi as ti

from solvers.fluid.bodies.coupling import FreeBodyCoupling
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.phases.air_at_walls import AirAtWalls
from solvers.fluid.phases.slip_correction import SlipCorrection
from solvers.fluid.terms.term import Seen, Sums, Term, doing
from solvers.fluid.walls.no_slip import MirroredVelocity
from solvers.fluid.walls.tangential_correction import Leaning, TangentialCorrection
from solvers.machine.phase import Phase
from solvers.machine.state import State
from solvers.motion.poses import AT_MIDDLE, AT_START
from solvers.space.axes import dot, swing, turns
from solvers.tank.load import Load

SEEN = 1e-6  # of full coverage: a wall particle that sees less water has no pressure


@ti.data_oriented
class Extrapolation:
    """p_w = Σ V_f [p_f + ρ_f (g − a_w)·(r_w − r_f)] W / Σ V_f W over the water f (Adami, Hu & Adams 2012, eq. 27).

    Weighted with volumes, which are nearly equal. Walls do not pull (p_w ≥ 0) unless the tank is full: a clip is needed
    where there is a free surface, which would stick to a wall. Where water sticks (no slip), its mean velocity ũ at the
    wall particle gives the velocity 2 u_w − ũ for the viscous force (eq. 23). Of two phases, water sees a pressure
    that is extrapolated from water alone, and air its own, see `solvers.fluid.phases.interfaces`; gauges see both.

    Limits: the mean is of first order; what its push does to the energy is given back by `DivergenceCorrection`. A wall
    that does not pull may throw a particle off that lies on its face or behind it: of four films of three rows, with
    c0² of 20 000 g H and particles up to 0.35 Δx off their places at the start, three gained energy so, of four of five
    rows one; up to 0.2 Δx off none of four.
    """

    def __init__(
        self, arrays: State, context: FluidContext, tangential: TangentialCorrection, load: Load, thickness: float
    ):
        self.units, self.particles, self.ranges = context.units, context.particles, context.ranges
        self.lists, self.constants, self.poses = context.lists, context.constants, context.poses
        self.bodies = context.lists.bodies
        self.sticks = context.constants.viscous and not context.constants.slip
        self.sums = sums = Sums()
        axes, two = context.particles.axes, context.constants.two
        self.seen, self.pressed, self.lever = sums.room(), sums.room(), sums.room(axes)
        self.tangential, self.air = tangential, AirAtWalls(sums, context) if two else None
        self.leaning = Leaning(sums, context.particles)
        self.coupling = FreeBodyCoupling(
            arrays, sums, context, (tangential, self.leaning), (load, thickness), self.sticks
        )
        self.slip = SlipCorrection(arrays, sums, context)
        self.velocity = MirroredVelocity(arrays, sums, context) if self.sticks else None
        self.beginning, self.adding = (doing(self._terms(), part) for part in ("begin", "add"))

    def _terms(self) -> list[Term | None]:
        """The terms that the scene needs, in the order in which they add."""
        leans = self.tangential.acts or self.coupling.acts
        return [
            self.leaning if leans else None,
            self.coupling if self.coupling.acts else None,
            self.velocity,
            self.air,
            self.slip if self.slip.acts else None,
        ]

    @property
    def phases(self) -> tuple[Phase, ...]:
        """What finds the pressures of all wall particles; none where there are none."""
        return (Phase(self.extrapolate, self.units), *self.coupling.before) if self.particles.wall_blocks else ()

    @ti.func
    def extrapolate(self, u, t, kick, dt):
        """The pressures of a unit's wall particles, and what share of each one's surroundings is water."""
        first, end = self.ranges.walls(u)
        for b in range(first, end):
            self.extrapolate_block(
                u, b, self.lists.facing.first[u, b - first], self.lists.facing.first[u, b - first + 1]
            )

    @ti.func
    def extrapolate_block(self, u, b, begin, end):
        """The pressures of a block of wall particles from the entries `begin` to `end` of its list."""
        p, c = self.particles, self.constants
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        shrink = c.get("shrink")
        sums = [p.zeros() for _ in ti.static(range(self.sums.count))]
        for term in ti.static(self.beginning):
            term.begin(b, sums)
        for k in range(begin, end):
            j = self.lists.facing.slots[u, k]
            jb, lane = self.lists.block_of(j), self.lists.lane_of(j)
            apart = self.lists.apart(own, origin, j)
            square = dot(apart, apart)
            t = ti.max(1.0 - ti.sqrt(square) * shrink, 0.0)
            visible, volume = self.lists.visible(b, j, apart, AT_START), p.volume[jb, lane]
            weight, slope = visible * c.kernel.value(t), c.kernel.slope(t)
            massive = weight * p.filling_mass(jb, lane)
            seen = ti.static(Seen(jb, lane, apart, square, t, visible, volume, weight, massive, slope))
            for term in ti.static(self.adding):
                term.add(b, seen, sums)
            of_water, heavy = weight, massive
            if ti.static(p.two):
                of_water, heavy = weight * (1.0 - p.gas[jb, lane]), massive * (1.0 - p.gas[jb, lane])
            sums[self.seen] += of_water * volume
            sums[self.pressed] += of_water * (volume * p.pressure[jb, lane])
            for a in ti.static(range(p.axes)):
                sums[self.lever + a] += heavy * apart[a]
        self.end(self.units.world(u), b, sums)

    @ti.func
    def end(self, w, b, sums: ti.template()):
        """Store the pressures of a block of wall particles, and what its terms end in."""
        p, c, pull = self.particles, self.constants, self.felt(w, b)
        seen, pressed, whole = sums[self.seen], sums[self.pressed], sums[self.seen]
        lever = [sums[self.lever + a] for a in ti.static(range(p.axes))]
        if ti.static(p.two):
            whole += sums[self.air.seen]
            pull_of_air = self.of_air(w, pull)
            if ti.static(c.modified):
                for a in ti.static(range(p.axes)):
                    pull[a] = pull[a] + c.get("buoyed") * (pull_of_air[a] - pull[a])
            self.air.note(b, pull_of_air, seen, sums)
        wet = whole * c.get("value")
        pressure = (pressed + dot(pull, lever)) / ti.max(seen, 1e-30)
        if ti.static(p.two):
            p.store(p.pressure, b, ti.max(pressure, 0.0))
        else:
            if ti.static(not c.full):
                pressure = ti.max(pressure, 0.0)
            p.store(p.pressure, b, ti.select(wet > SEEN, pressure, p.zeros()))
        p.store(p.eigenvalue, b, wet)
        if ti.static(self.tangential.acts):
            self.tangential.note(b, seen, self.leaning.steep(sums))
        if ti.static(self.slip.acts):
            self.slip.note(b, seen, sums)
        if ti.static(self.coupling.acts):  # noqa: SIM102 (compiled only where bodies are free)
            if self.bodies.row(b) >= 0:
                sees = ti.select(wet > SEEN, p.ones(), p.zeros()) / ti.max(seen, 1e-30)
                for a in ti.static(range(p.axes)):
                    lever[a] = sees * lever[a]
                self.coupling.note(b, sees * pressed + dot(pull, lever), lever, seen, sums)
        if ti.static(self.sticks):
            self.velocity.note(b, whole, sums)

    @ti.func
    def felt(self, w, b):
        """g − a_w (m/s²) of a block of wall particles: gravity less the acceleration of the wall."""
        p = self.particles
        felt = [p.ones() * ti.cast(self.poses.felt[p.axes + a][w], p.real) for a in ti.static(range(p.axes))]
        if ti.static(self.poses.rotating):
            zero = ti.cast(0.0, p.where)
            self.poses.press(w, [p.offset(b, zero, a) for a in ti.static(range(p.axes))], felt)
        if ti.static(self.bodies.moving):
            self.bodies.acceleration.take_off(w, b, felt)
        return felt

    @ti.func
    def of_air(self, w, felt: ti.template()):
        """`felt`, less gravity where pressures are over those of the air at rest (`ReducedPressure`)."""
        p = self.particles
        left = [felt[a] for a in ti.static(range(p.axes))]
        if ti.static(self.constants.modified):
            for a in ti.static(range(p.axes)):
                left[a] = left[a] - ti.cast(self.poses.felt[a][w], p.real)
        return left

    @ti.func
    def carry(self, u):
        """Give a unit's wall particles the velocities (m/s) of their walls in the middle of the step."""
        p = self.particles
        w = self.units.world(u)
        first, end = self.ranges.walls(u)
        for b in range(first, end):
            zero, found = ti.cast(0.0, p.where), self.poses.of_walls(w, AT_MIDDLE)
            speed = [p.ones() * ti.cast(found[a], p.real) for a in ti.static(range(p.axes))]
            rate = [ti.cast(found[p.axes + k], p.real) for k in ti.static(range(turns(p.axes)))]
            swing(rate, [p.offset(b, zero, a) for a in ti.static(range(p.axes))], speed)
            for a in ti.static(range(p.axes)):
                p.store(p.velocity[a], b, speed[a])
