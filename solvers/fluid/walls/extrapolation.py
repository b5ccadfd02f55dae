"""Pressures of the wall particles, extrapolated from the water before them."""

import taichi as ti

from solvers.fluid.bodies.coupling import FreeBodyCoupling
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.walls.slip_correction import SlipCorrection
from solvers.fluid.walls.tangential_correction import TangentialCorrection
from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.motion.poses import AT_START
from solvers.space.axes import dot, named
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
        self.slip, self.tangential = SlipCorrection(arrays, context), tangential
        self.coupling = FreeBodyCoupling(arrays, context, tangential, load, thickness, self.sticks)
        if self.sticks:
            own = arrays.under("water")
            p = self.particles
            each = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
            self.mirrored = own.wide(each, *named("mirrored", p.axes), kept=False)

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
        w = self.units.world(u)
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        shrink = c.get("shrink")
        seen, pressed = p.zeros(), p.zeros()
        lever = [p.zeros() for _ in ti.static(range(p.axes))]
        airy, pressed_by_air = p.zeros(), p.zeros()  # of two phases, what of both is the air's
        lever_of_air = [p.zeros() for _ in ti.static(range(p.axes))]
        moved = [p.zeros() for _ in ti.static(range(p.axes))]
        flow, inward = [p.zeros() for _ in ti.static(range(p.axes))], [p.zeros() for _ in ti.static(range(p.axes))]
        steep = [p.zeros() for _ in ti.static(range(p.axes))]
        before, fixed = [p.zeros() for _ in ti.static(range(p.axes))], [p.zeros() for _ in ti.static(range(p.axes))]
        firm = p.zeros()
        if ti.static(self.coupling.acts):
            firm += p.load(p.firm, b)
        for k in range(begin, end):
            j = self.lists.facing.slots[u, k]
            jb, lane = self.lists.block_of(j), self.lists.lane_of(j)
            apart = self.lists.apart(own, origin, j)
            t = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * shrink, 0.0)
            visible, volume = self.lists.visible(b, j, apart, AT_START), p.volume[jb, lane]
            weight = visible * c.kernel.value(t)
            if ti.static(self.tangential.acts or self.coupling.acts):
                slope = c.kernel.slope(t)
                for a in ti.static(range(p.axes)):
                    steep[a] = steep[a] - (visible * (volume * slope)) * apart[a]
                if ti.static(self.coupling.acts):
                    always = self.coupling.fixed_push(dot(apart, apart), slope, p.pressure[jb, lane], firm)
                    for a in ti.static(range(p.axes)):
                        before[a] += (weight * volume) * apart[a]
                        fixed[a] = fixed[a] - (visible * (volume * always)) * apart[a]
            massive = weight * p.filling_mass(jb, lane)
            if ti.static(self.sticks):
                for a in ti.static(range(p.axes)):
                    moved[a] += weight * (volume * p.velocity[a][jb, lane])
            if ti.static(p.two):
                airy += weight * (volume * p.gas[jb, lane])
                pressed_by_air += weight * (volume * p.gas[jb, lane] * p.pressure[jb, lane])
                for a in ti.static(range(p.axes)):
                    lever_of_air[a] += (massive * p.gas[jb, lane]) * apart[a]
                    inward[a] = inward[a] - (weight * volume) * apart[a]
                weight *= 1.0 - p.gas[jb, lane]
                for a in ti.static(range(p.axes)):
                    flow[a] += weight * (volume * p.velocity[a][jb, lane])
                massive *= 1.0 - p.gas[jb, lane]
            seen += weight * volume
            pressed += weight * (volume * p.pressure[jb, lane])
            for a in ti.static(range(p.axes)):
                lever[a] += massive * apart[a]
        pull = self.felt(w, b)
        pull_of_air = self.of_air(w, pull)
        wet = (seen + airy) * c.get("value")
        if ti.static(c.modified):
            for a in ti.static(range(p.axes)):
                pull[a] = pull[a] + c.get("buoyed") * (pull_of_air[a] - pull[a])
        if ti.static(p.two):
            pressure = ti.max((pressed + dot(pull, lever)) / ti.max(seen, 1e-30), 0.0)
            p.store(p.pressure, b, pressure)
            p.store(p.pressure_of_air, b, (pressed_by_air + dot(pull_of_air, lever_of_air)) / ti.max(airy, 1e-30))
            p.store(p.share, b, seen / ti.max(seen + airy, 1e-30))
        else:
            pressure = (pressed + dot(pull, lever)) / ti.max(seen, 1e-30)
            if ti.static(not c.full):
                pressure = ti.max(pressure, 0.0)
            p.store(p.pressure, b, ti.select(wet > SEEN, pressure, p.zeros()))
        p.store(p.eigenvalue, b, wet)
        if ti.static(self.tangential.acts):
            self.tangential.note(b, seen, steep)
        if ti.static(self.slip.acts):
            self.slip.note(b, seen, flow, inward)
        if ti.static(self.coupling.acts):  # noqa: SIM102 (compiled only where bodies are free)
            if self.bodies.row(b) >= 0:
                sees = ti.select(wet > SEEN, p.ones(), p.zeros()) / ti.max(seen, 1e-30)
                for a in ti.static(range(p.axes)):
                    lever[a], before[a] = sees * lever[a], before[a] / ti.max(seen, 1e-30)
                still = sees * pressed + dot(pull, lever)
                self.coupling.note(b, still, lever, steep, fixed, before, seen)
        if ti.static(self.sticks):
            for a in ti.static(range(p.axes)):
                mean = moved[a] / ti.max(seen + airy, 1e-30)
                p.store(self.mirrored[a], b, 2.0 * p.load(p.velocity[a], b) - mean)

    @ti.func
    def felt(self, w, b):
        """g − a_w (m/s²) of a block of wall particles: gravity less the acceleration of the wall."""
        p = self.particles
        felt = [p.ones() * ti.cast(self.poses.felt[2 + a][w], p.real) for a in ti.static(range(p.axes))]
        if ti.static(self.poses.rotating):
            zero = ti.cast(0.0, p.where)
            y, z = p.offset(b, zero, 0), p.offset(b, zero, 1)
            rate, up = ti.cast(self.poses.felt[4][w], p.real), ti.cast(self.poses.felt[5][w], p.real)
            felt[0] += up * z + (rate * rate) * y
            felt[1] += (rate * rate) * z - up * y
        if ti.static(self.bodies.moving):
            self.bodies.hold_back(w, b, felt)
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
            zero = ti.cast(0.0, p.where)
            rate = ti.cast(self.poses.walls[2][w], p.real)
            y, z = p.offset(b, zero, 0), p.offset(b, zero, 1)
            p.store(p.velocity[0], b, ti.cast(self.poses.walls[0][w], p.real) - rate * z)
            p.store(p.velocity[1], b, ti.cast(self.poses.walls[1][w], p.real) + rate * y)
