"""The second pass over pairs: pressure and viscous forces, the walls' load, and the gradients that diffusion needs."""

import numpy as np
import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.phases.tension import Tension
from solvers.fluid.state import INSIDE, SPRAY
from solvers.fluid.surface.void_indicator import VoidIndicator
from solvers.fluid.walls.end_walls import EndWallFriction
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.fluid.walls.wall_forces import WallForces
from solvers.machine.state import State
from solvers.motion.poses import AT_START
from solvers.space.axes import dot
from solvers.tank.load import Load

SINGULAR = 0.05  # smallest eigenvalue of Σ V_j r_ji ⊗ ∇W down to which it is inverted: spray has no gradient
NEAR = 1e-3  # of (2 h)² times the squared gradient of the phase: from there on the other phase is near


@ti.data_oriented
class Forces:
    """m du/dt = −Σ V_i V_j (p_i + p_j) ∇W + viscosity (Antuono, Colagrossi, Marrone & Molteni 2010, eq. 6).

    Forces between pairs of particles are equal and opposite; those of wall particles are booked on the tank.
    `dissipated` (units,) is the energy that viscosity has taken, `stored` that which wall particles hold, `wall_work`
    the work of the walls, J per metre of thickness. What wall particles hold, they give back by compressing the water
    before them, see `Continuity`. Powers are those of forces on the velocities of water and walls at the same time,
    that of the forces, so that each is right to the second order of the step; velocities are kept up to half a step
    later, and `counted` adds that half.
    """

    def __init__(self, arrays: State, context: FluidContext, walls: Extrapolation, load: Load, thickness: float):
        self.units, self.particles, self.ranges = context.units, context.particles, context.ranges
        self.lists, self.constants, self.poses = context.lists, context.constants, context.poses
        self.voids = VoidIndicator(arrays, context.particles, context.constants)
        self.walls, self.load = WallForces(context, walls, self.voids), load
        self.bodies, self.end_walls = context.lists.bodies, EndWallFriction(context.particles, context.constants)
        own = arrays.under("water.forces")
        self.counts = own.reals((context.units.axis,), "dissipated", "stored", "wall_work", kind=own.exact)
        self.dissipated, self.stored, self.wall_work = self.counts
        names = "dissipated_lately", "stored_lately", "wall_work_lately"  # the powers (W/m) of the last step
        self.powers = own.reals((context.units.axis,), *names, kind=own.exact)
        self.sums = *self.counts, *self.powers
        self.order, self.outlines = context.lists.order, context.lists.order.layers
        self.tension = Tension(context.particles, context.constants)
        self.thick = arrays.under("water").holding("thickness", np.array([thickness]), "one", own.exact)

    def counted(self, behind: np.ndarray) -> list[np.ndarray]:
        """`dissipated`, `stored` and `wall_work` (W,) J/m up to now, if the last kick was `behind` (W,) s ago."""
        sums = [[f.to_numpy().reshape(len(behind), -1).sum(axis=1) for f in of] for of in (self.counts, self.powers)]
        return [count + behind * power for count, power in zip(*sums, strict=True)]

    @ti.func
    def update_state(self, u, t, kick, dt):
        """The volumes and pressures of a unit's particles, from their densities."""
        p, c = self.particles, self.constants
        first, end = self.ranges.fluid(u)
        density, stiffness = c.get("density"), c.get("stiffness")
        for b in range(first, end):
            s = p.load(p.deviation, b)
            if ti.static(c.two):
                self.update_both(b, s)
            else:
                p.store(p.volume, b, p.load(p.mass, b) / p.borne(b, density * (1.0 + s)))
                pressure = stiffness * c.state.share(s)
                if ti.static(c.pressed):
                    pressure += p.filled(b) * c.get("background")
                p.store(p.pressure, b, pressure)
            if ti.static(c.shifting.acts):
                p.store(p.eigenvalue_before, b, p.load(p.eigenvalue, b))
            if ti.static(c.tense):
                self.tension.update_state(b)
            if ti.static(self.bodies.hulls.count > 0):
                self.bodies.hulls.note_block(b)

    @ti.func
    def update_both(self, b, s):
        """As `update_state`, for a block of two phases; pressures have the background's on top."""
        p, c = self.particles, self.constants
        p.store(p.volume, b, p.load(p.mass, b) / (c.of("density", p.load(p.gas, b)) * (1.0 + s)))
        p.store(p.pressure, b, c.get("stiffness") * c.state.share(s) + c.get("background"))
        for lane in range(p.lanes):
            if p.gas[b, lane] > 0.5:
                p.pressure[b, lane] = self.voids.dispersed.borne(c.pressure_of_air(p.deviation[b, lane]))

    @ti.func
    def momentum_pass(self, u, t, kick, dt):
        """Accelerations of a unit's particles, their gradients of density, and the load on the walls."""
        self.load.begin(u)
        first, end = self.ranges.fluid(u)
        total = ti.Vector([ti.cast(0.0, self.particles.exact) for _ in ti.static(range(5))])
        tank, before, shown = 0, total, total  # `shown`: each tank as long as it is
        if first < end:
            tank = self.order.layer(first)
        for b in range(first, end):
            found = self.pass_block(u, b, b - first, kick)
            if ti.static(self.order.layers > 1):  # noqa: SIM102 (blocks are in the order of the tanks)
                if self.order.layer(b) != tank:
                    self.book(u, tank, total - before - self.bodies.borne(u, tank), dt)
                    tank, before = self.order.layer(b), total
            total += found
            shown += self.order.weight(b) * found
        thick, during = self.thick[0], ti.cast(kick, self.particles.exact)
        self.dissipated[u] = self.dissipated[u] + shown[3] * during
        self.stored[u] = self.stored[u] + shown[4] * during
        self.powers[0][u], self.powers[1][u] = shown[3], shown[4]
        if ti.static(self.poses.moving):
            w = self.units.world(u)
            power = dot([shown[0], shown[1], shown[2]], [self.poses.walls[3 + k][w] for k in ti.static(range(3))])
            self.wall_work[u] = self.wall_work[u] - power * during
            self.powers[2][u] = 0.0 - power
        if ti.static(self.bodies.count > 0):
            for k in range(self.bodies.count):
                load = [self.bodies.force[n][u, k] for n in ti.static(range(3))]
                self.load.book(u, self.outlines + k, ti.Vector([thick * load[n] for n in ti.static(range(3))]), dt)
            before += self.bodies.borne(u, tank)
            self.bodies.book(u, kick, dt)
        self.book(u, tank, total - before, dt)

    @ti.func
    def book(self, u, tank, total, dt):
        """Book the load on a tank: force (y, z; N/m) and moment (N)."""
        self.load.book(u, tank, ti.Vector([total[k] * self.thick[0] for k in ti.static(range(3))]), dt)

    @ti.func
    def pass_block(self, u, b, listed, kick):
        """As `momentum_pass`, for a block: force (N/m) and moment (N) on walls, powers (W/m) of viscosity and walls."""
        p, c, lists = self.particles, self.constants, self.lists
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        speed = [p.load(p.velocity[a], b) for a in ti.static(range(p.axes))]
        pressure, s, gas = p.load(p.pressure, b), p.load(p.deviation, b), p.gases(b)
        shrink, floor, strength = c.get("shrink"), c.get("floor"), c.strength()
        push = [p.zeros() for _ in ti.static(range(p.axes))]
        wall = [p.zeros() for _ in ti.static(range(p.axes))]
        own_push = [p.zeros() for _ in ti.static(range(p.axes))]  # of the wall particles' own pressures
        drag = [p.zeros() for _ in ti.static(range(p.axes))]  # of viscosity
        gradient = [p.zeros() for _ in ti.static(range(p.axes))]
        shift = [p.zeros() for _ in ti.static(range(p.axes))]
        inwards = [p.zeros() for _ in ti.static(range(p.axes))]
        stress = [p.zeros() for _ in ti.static(range(3))]
        if ti.static(c.tense):
            self.tension.load(b, stress)
        eigenvalue, least = p.ones(), p.ones()
        if ti.static(c.shifting.acts):
            eigenvalue = p.load(p.eigenvalue_before, b)
        yy, yz, zz, viscous, stored = p.zeros(), p.zeros(), p.zeros(), p.zeros(), p.zeros()
        fill = [p.zeros() for _ in ti.static(range(self.voids.sums))]  # of `VoidIndicator`
        for k in range(lists.near.first[u, listed], lists.near.first[u, listed + 1]):
            j = lists.near.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(own, origin, j)
            square = dot(apart, apart)
            t = ti.max(1.0 - ti.sqrt(square) * shrink, 0.0)
            weight = p.volume[jb, lane] * lists.visible(b, j, apart, AT_START) * c.kernel.slope(t)
            if ti.static(c.shifting.acts):
                crowded = weight * c.shifting.crowded(c.get("shift_scale") * c.kernel.value(t))
                for a in ti.static(range(p.axes)):
                    shift[a] += crowded * apart[a]
                if ti.static(not (c.full or c.two)):
                    deeper = p.eigenvalue_before[jb, lane] - eigenvalue
                    least = ti.min(least, ti.select(weight > 0.0, p.ones() * p.eigenvalue_before[jb, lane], p.ones()))
                    for a in ti.static(range(p.axes)):
                        inwards[a] = inwards[a] - (deeper * weight) * apart[a]
            along = (pressure + p.pressure[jb, lane]) * weight
            other, heavy = gas - p.gas_at(jb, lane), weight  # `heavy`: as strong as the viscosity of the two
            if ti.static(c.two):
                along += (c.get("lean_of_pressure") * other) * (pressure - p.pressure[jb, lane]) * weight
                if ti.static(c.coheres):
                    along += (gas * c.get("cohesion")) * c.cohesion.push(s) * weight
                heavy = weight * c.drag(gas, p.gas[jb, lane])
                if ti.static(c.tense):
                    self.tension.add(stress, jb, lane, weight, apart, push)
                if ti.static(c.shifting.acts or c.tense):
                    for a in ti.static(range(p.axes)):
                        inwards[a] += (other * weight) * apart[a]
            if ti.static(c.viscous):
                nearing = [p.velocity[a][jb, lane] - speed[a] for a in ti.static(range(p.axes))]
                if ti.static(c.viscosity.central):
                    closing = dot(nearing, apart)
                    pull = heavy * c.viscosity.pull(closing, square + floor)
                    viscous += pull * closing
                    for a in ti.static(range(p.axes)):
                        drag[a] += pull * apart[a]
                else:
                    viscous += heavy * dot(nearing, nearing)
                    for a in ti.static(range(p.axes)):
                        drag[a] += heavy * nearing[a]
            self.voids.dispersed.add(fill, other * other, t, weight * square, jb, lane)
            if ti.static(c.two):  # from here on within a phase
                weight *= 1.0 - other * other
            weighted = [(weight * apart[a]) for a in ti.static(range(p.axes))]
            for a in ti.static(range(p.axes)):
                push[a] += along * apart[a]
                if ti.static(self.voids.acts):
                    fill[a] += weighted[a]
            if ti.static(self.constants.diffusion.renormalised):
                more = p.deviation[jb, lane] - s
                for a in ti.static(range(p.axes)):
                    gradient[a] = gradient[a] - more * weighted[a]
            yy += weighted[0] * apart[0]
            yz += weighted[0] * apart[1]
            zz += weighted[1] * apart[1]
        viscous *= 0.5
        if ti.static(p.wall_blocks > 0):
            begin = listed * lists.pieces
            if ti.static(lists.pieces == 1):
                ends = [lists.beside.first[u, begin], lists.beside.first[u, begin + 1]]
                self.walls.add(
                    u, b, 0, ends, own, origin, speed, pressure, wall, own_push, shift, fill, [viscous, stored]
                )
            else:
                for piece in range(lists.pieces):
                    ends = [lists.beside.first[u, begin + piece], lists.beside.first[u, begin + piece + 1]]
                    off = [p.zeros() for _ in ti.static(range(p.axes))]
                    self.walls.add(
                        u, b, piece, ends, own, origin, speed, pressure, off, own_push, shift, fill, [viscous, stored]
                    )
                    for a in ti.static(range(p.axes)):
                        wall[a] += off[a]
                    if piece > 0 and ends[0] < ends[1]:
                        force = p.load(p.volume, b) * c.get("slope")
                        load = self.walls.on_walls(b, origin, own, [force * off[a] for a in ti.static(range(p.axes))])
                        self.bodies.bear(u, piece - 1, load)
        factor, density = c.get("slope"), c.of("density", gas)
        lightness = (p.filled(b) * factor) / p.borne(b, density * (1.0 + s))
        past = [p.zeros() for _ in ti.static(range(p.axes))]  # the walls before and behind
        hold = [p.zeros() for _ in ti.static(range(p.axes))]  # their drag
        if ti.static(c.end_walls):
            self.walls.note_past(u, b, origin, own, speed, past)
            self.end_walls.drag(b, past, kick, hold)
        for a in ti.static(range(p.axes)):
            acceleration = lightness * (push[a] + strength * drag[a] + wall[a]) - hold[a]
            p.store(p.acceleration[a], b, acceleration)
            # Velocities are half a kick behind the places at which the wall particles push.
            gain = acceleration + self.walls.weight(u, b, a)
            stored = stored - own_push[a] * (speed[a] + (0.5 * kick) * gain)
            viscous = viscous - drag[a] * ((0.5 * kick) * gain)
            past[a] += (0.5 * kick) * gain
        if ti.static(self.poses.moving and not self.bodies.moving):
            wall_speed = self.walls.walls_at(self.units.world(u), origin, own)
            stored += dot(own_push, wall_speed)
        if ti.static(c.tense):
            self.tension.note(b, [factor * inwards[a] for a in ti.static(range(p.axes))])
        if ti.static(c.shifting.acts):
            self.note_shift(b, shift, inwards, least, eigenvalue)
        self.invert(b, factor * yy, factor * yz, factor * zz, [factor * gradient[a] for a in ti.static(range(p.axes))])
        if ti.static(self.voids.acts):
            self.voids.note(b, yy + zz, fill)
        volume = p.load(p.volume, b) * factor
        force = self.walls.borne(u, b, [volume * wall[a] for a in ti.static(range(p.axes))])
        taken = strength * volume * viscous
        if ti.static(c.end_walls):
            taken += p.load(p.mass, b) * dot(hold, past)
            for a in ti.static(range(p.axes)):
                force[a] = force[a] - p.load(p.mass, b) * hold[a]
        total = self.walls.on_walls(b, origin, own, force)
        total[3] = ti.cast(taken.sum(), p.exact)
        total[4] = ti.cast((volume * stored).sum(), p.exact)
        return total

    @ti.func
    def note_shift(self, b, shift: ti.template(), inwards: ti.template(), least, eigenvalue):
        """Store the velocity with which the particles of a block are shifted; see `DeltaPlus`.

        A full tank has no free surface: what lacks water near it, lacks it at a wall, whose particles stand for it.
        """
        p, c = self.particles, self.constants
        along, lasting = p.zeros(), p.filled(b)
        steep = ti.max(dot(inwards, inwards), 1e-30)
        if ti.static(c.two):  # `inwards` is the gradient of the phase: there is a surface where there are two
            near = c.get("slope") * c.get("reach")
            along = ti.select(steep * (near * near) > NEAR, dot(shift, inwards) / steep, p.zeros())
        elif ti.static(not c.full):
            along = ti.select(least < INSIDE, dot(shift, inwards) / steep, p.zeros())
            lasting = ti.select(eigenvalue < SPRAY, p.zeros(), lasting)
            if ti.static(c.shifting.carries):
                lasting = ti.select(least < INSIDE, p.zeros(), lasting)
        moved = [lasting * c.get("shift") * (shift[a] - along * inwards[a]) for a in ti.static(range(p.axes))]
        fast = ti.sqrt(dot(moved, moved))
        limited = ti.min(1.0, c.get("shift_most") / ti.max(fast, 1e-30))
        for a in ti.static(range(p.axes)):
            p.store(p.shift[a], b, limited * moved[a])

    @ti.func
    def invert(self, b, yy, yz, zz, gradient: ti.template()):
        """Store the smallest eigenvalue of the matrix Σ V_j r_ji ⊗ ∇W, and its inverse times the raw gradient."""
        p = self.particles
        middle, apart = 0.5 * (yy + zz), 0.5 * (yy - zz)
        eigenvalue = middle - ti.sqrt(apart * apart + yz * yz)
        p.store(p.eigenvalue, b, eigenvalue)
        if ti.static(self.constants.diffusion.renormalised):
            regular = eigenvalue > SINGULAR
            determinant = ti.select(regular, yy * zz - yz * yz, p.ones())
            along_y = (zz * gradient[0] - yz * gradient[1]) / determinant
            along_z = (yy * gradient[1] - yz * gradient[0]) / determinant
            p.store(p.gradient[0], b, ti.select(regular, along_y, p.zeros()))
            p.store(p.gradient[1], b, ti.select(regular, along_z, p.zeros()))
