"""The second pass over pairs: pressure and viscous forces, the walls' load, and the gradients that diffusion needs."""

import numpy as np
import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.phases.cohesion import CohesionForce
from solvers.fluid.phases.interfaces import InterfaceForce
from solvers.fluid.phases.tension import Tension
from solvers.fluid.surface.void_indicator import VoidIndicator
from solvers.fluid.terms.balance import Balance
from solvers.fluid.terms.end_walls import EndWallFriction
from solvers.fluid.terms.phase_gradient import PhaseGradient
from solvers.fluid.terms.renormalisation import Renormalisation
from solvers.fluid.terms.shift import Shift
from solvers.fluid.terms.surface_normal import SurfaceNormal
from solvers.fluid.terms.term import Block, Pair, Sums, Term, doing
from solvers.fluid.terms.viscous_force import ViscousForce
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.fluid.walls.face_loads import FaceLoads
from solvers.fluid.walls.wall_forces import WallForces
from solvers.machine.quantity import freedoms
from solvers.machine.state import State
from solvers.motion.poses import AT_START
from solvers.space.axes import dot
from solvers.tank.load import Load


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

    def __init__(
        self, arrays: State, context: FluidContext, walls: Extrapolation, load: Load, thickness: float, wall_points
    ):
        """`wall_points` are the walls' layers, their slots and the scene (`FaceLoads`)."""
        self.units, self.particles, self.ranges = context.units, context.particles, context.ranges
        self.lists, self.constants, self.poses = context.lists, context.constants, context.poses
        self.sums, self.freedoms = Sums(), len(freedoms(context.particles.axes))
        self.balance, self.load = Balance(self.sums, context.particles.axes), load
        terms = self._terms(arrays)
        self.walls = WallForces(context, walls, self.sums, self.balance, doing(terms, "add_wall"))
        terms.append(self.walls.push)
        self.faces = FaceLoads(arrays, context, self.walls, load, *wall_points)
        self.beginning, self.adding, self.ending = (doing(terms, part) for part in ("begin", "add", "end"))
        self.bodies, self.end_walls = context.lists.bodies, EndWallFriction(context.particles, context.constants)
        own = arrays.under("water.forces")
        self.counts = own.reals((context.units.axis,), "dissipated", "stored", "wall_work", kind=own.exact)
        self.dissipated, self.stored, self.wall_work = self.counts
        names = "dissipated_lately", "stored_lately", "wall_work_lately"  # the powers (W/m) of the last step
        self.powers = own.reals((context.units.axis,), *names, kind=own.exact)
        self.kept = *self.counts, *self.powers
        self.order = context.lists.order
        self.outlines = self.faces.count or self.order.layers  # pieces of the load before those of parts
        self.thick = arrays.under("water").holding("thickness", np.array([thickness]), "one", own.exact)

    def _terms(self, arrays: State) -> list[Term | None]:
        """The terms that the scene needs, in the order in which they add."""
        p, c, sums, balance = self.particles, self.constants, self.sums, self.balance
        phase = PhaseGradient(sums, p, c) if c.two and (c.shifting.acts or c.tense) else None
        normal = SurfaceNormal(sums, p, c) if c.shifting.acts and not (c.full or c.two) else None
        self.tension = Tension(sums, balance, p, c, phase) if c.tense else None
        matrix = Renormalisation(sums, p, c)
        self.voids = VoidIndicator(arrays, sums, p, c, matrix)
        return [
            Shift(sums, p, c, phase or normal) if c.shifting.acts else None,
            normal,
            InterfaceForce(p, c) if c.two else None,
            CohesionForce(c) if c.coheres else None,
            self.tension,
            phase,
            ViscousForce(balance, p, c) if c.viscous else None,
            self.voids.dispersed if self.voids.dispersed.acts else None,
            self.voids if self.voids.acts else None,
            matrix,
        ]

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
        total = ti.Vector([ti.cast(0.0, self.particles.exact) for _ in ti.static(range(self.freedoms + 2))])
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
        taken, stored = shown[self.freedoms], shown[self.freedoms + 1]
        self.dissipated[u] = self.dissipated[u] + taken * during
        self.stored[u] = self.stored[u] + stored * during
        self.powers[0][u], self.powers[1][u] = taken, stored
        if ti.static(self.poses.moving):
            load = [shown[k] for k in ti.static(range(self.freedoms))]
            power = dot(load, self.poses.of_walls(self.units.world(u), AT_START))
            self.wall_work[u] = self.wall_work[u] - power * during
            self.powers[2][u] = 0.0 - power
        if ti.static(self.bodies.count > 0):
            for k in range(self.bodies.count):
                load = [thick * self.bodies.force[n][u, k] for n in ti.static(range(self.freedoms))]
                self.load.book(u, self.outlines + k, ti.Vector(load), dt)
            before += self.bodies.borne(u, tank)
            self.bodies.book(u, kick, dt)
        if ti.static(self.faces.count > 0):
            self.faces.book(u, dt)
        else:
            self.book(u, tank, total - before, dt)

    @ti.func
    def book(self, u, tank, total, dt):
        """Book the load on a tank: force (N/m) and moment (N), in space N and N m."""
        load = [total[k] * self.thick[0] for k in ti.static(range(self.freedoms))]
        self.load.book(u, tank, ti.Vector(load), dt)

    @ti.func
    def pass_block(self, u, b, listed, kick):
        """As `momentum_pass`, for a block: force (N/m) and moment (N) on walls, powers (W/m) of viscosity and walls."""
        p, c, lists = self.particles, self.constants, self.lists
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        speed = [p.load(p.velocity[a], b) for a in ti.static(range(p.axes))]
        pressure, s, gas, shrink = p.load(p.pressure, b), p.load(p.deviation, b), p.gases(b), c.get("shrink")
        block = ti.static(Block(u, b, kick, origin, own, speed, pressure, s, gas))
        sums = [p.zeros() for _ in ti.static(range(self.sums.count))]
        wall = [p.zeros() for _ in ti.static(range(p.axes))]
        for term in ti.static(self.beginning):
            term.begin(block, sums)
        for k in range(lists.near.first[u, listed], lists.near.first[u, listed + 1]):
            j = lists.near.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(own, origin, j)
            square = dot(apart, apart)
            t = ti.max(1.0 - ti.sqrt(square) * shrink, 0.0)
            volume = p.volume[jb, lane] * lists.visible(b, j, apart, AT_START)
            weight = volume * c.kernel.slope(t)
            other, within = gas - p.gas_at(jb, lane), weight
            if ti.static(c.two):
                within = weight * (1.0 - other * other)
            steep = [(within * apart[a]) for a in ti.static(range(p.axes))]
            along = [(pressure + p.pressure[jb, lane]) * weight]
            pair = ti.static(Pair(jb, lane, apart, square, t, weight, volume, other, within, steep, along))
            for term in ti.static(self.adding):
                term.add(block, pair, sums)
            for a in ti.static(range(p.axes)):
                sums[self.balance.push + a] += along[0] * apart[a]
        sums[self.balance.taken] *= 0.5
        if ti.static(p.wall_blocks > 0):
            self.add_walls(block, listed, wall, sums)
        return self.accelerate(block, wall, sums)

    @ti.func
    def add_walls(self, block: ti.template(), listed, wall: ti.template(), sums: ti.template()):
        """Add what walls do to a block; each part in the tank bears its own."""
        p, lists, begin = self.particles, self.lists, listed * self.lists.pieces
        first = ti.static(self.lists.beside.first)
        if ti.static(lists.pieces == 1 and self.faces.count == 0):
            ends = [first[block.u, begin], first[block.u, begin + 1]]
            self.walls.add(block, 0, ends, wall, sums)
        else:
            for piece in range(lists.pieces):
                ends = [first[block.u, begin + piece], first[block.u, begin + piece + 1]]
                if ti.static(self.faces.count > 0):
                    self.add_faces(block, piece, ends, wall, sums)
                else:
                    off = [p.zeros() for _ in ti.static(range(p.axes))]
                    self.add_piece(block, piece, ends, off, wall, sums)
                    if piece > 0 and ends[0] < ends[1]:
                        self.bear(block, piece, off)

    @ti.func
    def add_piece(
        self,
        block: ti.template(),
        piece,
        ends: ti.template(),
        off: ti.template(),
        wall: ti.template(),
        sums: ti.template(),
    ):
        """Add what a piece, by entries between two `ends`, does to a block, `off` over V_i, also to that of all."""
        self.walls.add(block, piece, ends, off, sums)
        for a in ti.static(range(self.particles.axes)):
            wall[a] += off[a]

    @ti.func
    def bear(self, block: ti.template(), piece, off: ti.template()):
        """Have a part bear what it does to a block."""
        p = self.particles
        force = p.load(p.volume, block.b) * self.constants.get("slope")
        load = self.walls.on_walls(block, [force * off[a] for a in ti.static(range(p.axes))])
        self.bodies.bear(block.u, piece - 1, load)

    @ti.func
    def add_faces(self, block: ti.template(), piece, ends: ti.template(), wall: ti.template(), sums: ti.template()):
        """As `add_walls`, for the entries of a piece between two `ends`; each face of the tank bears its own."""
        p, begin = self.particles, ends[0]
        for k in range(ends[0], ends[1]):
            closes = k + 1 == ends[1]
            if piece == 0 and not closes:
                closes = self.faces.ends(block.u, k, ends[1])
            if closes:
                off = [p.zeros() for _ in ti.static(range(p.axes))]
                self.add_piece(block, piece, [begin, k + 1], off, wall, sums)
                if piece == 0:
                    self.faces.bear(block, k, off)
                elif ti.static(self.bodies.count > 0):
                    self.bear(block, piece, off)
                begin = k + 1

    @ti.func
    def accelerate(self, block: ti.template(), wall: ti.template(), sums: ti.template()):
        """Store the accelerations of a block, and what its terms end in; returns as `pass_block`."""
        p, c, b = self.particles, self.constants, block.b
        factor, strength, density = c.get("slope"), c.strength(), c.of("density", block.gas)
        lightness = (p.filled(b) * factor) / p.borne(b, density * (1.0 + block.s))
        past = [p.zeros() for _ in ti.static(range(p.axes))]  # the walls before and behind
        hold = [p.zeros() for _ in ti.static(range(p.axes))]  # their drag
        if ti.static(c.end_walls):
            self.walls.note_past(block, past)
            self.end_walls.drag(b, past, block.kick, hold)
        taken, stored = sums[self.balance.taken], sums[self.balance.stored]
        for a in ti.static(range(p.axes)):
            drag, own_push = sums[self.balance.drag + a], sums[self.balance.own_push + a]
            acceleration = lightness * (sums[self.balance.push + a] + strength * drag + wall[a]) - hold[a]
            p.store(p.acceleration[a], b, acceleration)
            # Velocities are half a kick behind the places at which the wall particles push.
            gain = acceleration + self.walls.weight(block.u, b, a)
            stored = stored - own_push * (block.speed[a] + (0.5 * block.kick) * gain)
            taken = taken - drag * ((0.5 * block.kick) * gain)
            past[a] += (0.5 * block.kick) * gain
        if ti.static(self.poses.moving and not self.bodies.moving):
            wall_speed = self.walls.walls_at(self.units.world(block.u), block.origin, block.own)
            stored += dot([sums[self.balance.own_push + a] for a in ti.static(range(p.axes))], wall_speed)
        for term in ti.static(self.ending):
            term.end(block, sums)
        volume = p.load(p.volume, b) * factor
        force = self.walls.borne(block.u, b, [volume * wall[a] for a in ti.static(range(p.axes))])
        power = strength * volume * taken
        if ti.static(c.end_walls):
            power += p.load(p.mass, b) * dot(hold, past)
            for a in ti.static(range(p.axes)):
                force[a] = force[a] - p.load(p.mass, b) * hold[a]
        total = self.walls.on_walls(block, force)
        total[self.freedoms] = ti.cast(power.sum(), p.exact)
        total[self.freedoms + 1] = ti.cast((volume * stored).sum(), p.exact)
        return total
