"""From forces and rates to motion: kick, drifts, and the step of density, in a tank that may move."""

import numpy as np
import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.state import DENSEST, DENSEST_AIR, DENSEST_SPRAY, INSIDE, THINNEST
from solvers.fluid.surface.void_indicator import VoidIndicator
from solvers.fluid.terms.damping import DampingZones
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.machine.state import State
from solvers.motion.poses import AT_MIDDLE, AT_START
from solvers.space.axes import dot
from solvers.tank.pose import AT_END
from solvers.tank.substeps import Substeps


@ti.data_oriented
class Mover:
    """The split scheme u += a Δt; r += u Δt/2; ρ += Δt dρ/dt; r += u Δt/2 of kick and drift, of second order.

    Velocities are kept half a step behind and carried from the middle of one step to that of the next: the scheme is
    kick–drift–kick with its two half kicks in one. They are inertial ones in the tank's axes (`Poses`). `fastest`
    (units,) m/s and `deviation` (units,), of the density, where DENSEST is the most, tell why a world was stopped. Of
    open tanks, `within` (units,) m/s is the largest speed of what has not left them (`Grid.watched`).
    """

    def __init__(
        self,
        arrays: State,
        context: FluidContext,
        walls: Extrapolation,
        voids: VoidIndicator,
        substeps: Substeps,
        damping: DampingZones,
    ):
        self.units, self.particles, self.ranges = context.units, context.particles, context.ranges
        self.lists, self.constants, self.poses = context.lists, context.constants, context.poses
        self.walls, self.bodies, self.voids = walls, context.lists.bodies, voids
        self.substeps, self.damping = substeps, damping
        own = arrays.under("water.mover")
        (self.fastest,) = own.reals((context.units.axis,), "fastest")
        (self.deviation,) = own.reals((context.units.axis,), "deviation", kept=False)
        box = context.lists.order.grid.watched
        self.spills = box is not None
        if self.spills:
            (self.within,) = own.reals((context.units.axis,), "within", kept=False)
            self.box = own.holding("box", np.concatenate(box), "number", own.place)

    @ti.func
    def kick(self, u, frame, kick, dt):
        """Change a unit's velocities, and move its particles to the middle of the step; returns that all is well."""
        p, c = self.particles, self.constants
        w = self.units.world(u)
        pull = [ti.cast(self.poses.felt[a][w], p.real) for a in ti.static(range(p.axes))]
        during = self.substeps.kick(w, kick)
        first, end = self.ranges.fluid(u)
        farthest = p.zeros()
        for b in range(first, end):
            filled = p.filled(b)
            weighs = filled
            if ti.static(c.modified):
                weighs = filled * c.reduced.sinking(c, p.gases(b))
            for a in ti.static(range(p.axes)):
                push = p.load(p.acceleration[a], b) + weighs * pull[a]
                if ti.static(c.pulled):
                    centre = ti.cast(c.get("pull_y" if a == 0 else "pull_z"), p.where)
                    push = push - (c.get("pull") * filled) * p.offset(b, centre, a)
                p.store(p.velocity[a], b, p.load(p.velocity[a], b) + during * push)
            if ti.static(self.damping.count > 0):
                self.damping.slow(u, b, during)
            farthest = ti.max(farthest, self.drift(w, b, filled, 0.5 * dt, AT_START))
            if ti.static(self.poses.rotating and c.diffusion.renormalised):
                gradient = [p.load(p.gradient[a], b) for a in ti.static(range(p.axes))]
                self.turn(w, b, gradient, p.gradient, AT_START)
        if ti.static(self.poses.moving and p.wall_blocks > 0):
            self.walls.carry(u)
        if ti.static(self.bodies.moving):
            self.bodies.place(u, AT_MIDDLE)
        self.lists.last[u] = ti.sqrt(self.largest(farthest))
        return True

    @ti.func
    def finish(self, u, frame, kick, dt):
        """Step a unit's densities, and move its particles to the end of the step; returns whether they are sound."""
        p, c = self.particles, self.constants
        w = self.units.world(u)
        first, end = self.ranges.fluid(u)
        farthest, deviation, tame, paced, watched = p.zeros(), p.zeros(), p.zeros(), p.zeros(), p.zeros()
        for b in range(first, end):
            filled = p.filled(b)
            gas = p.gases(b)
            step = dt * filled
            s = self.voids.stepped(b, p.load(p.deviation, b), p.load(p.rate, b), p.load(p.rate_of_walls, b), step)
            if ti.static(c.two):
                s = ti.max(s, (1.0 - gas) * (-1.0) + gas * THINNEST)
            p.store(p.deviation, b, s)
            if ti.static(c.shifting.carries):
                share = step / (p.load(p.mass, b) + (1.0 - filled))
                for a in ti.static(range(p.axes)):
                    p.store(p.velocity[a], b, p.load(p.velocity[a], b) + share * p.load(p.carried[a], b))
            loose = ti.select(p.load(p.eigenvalue, b) < INSIDE, p.ones() * (DENSEST / DENSEST_SPRAY), p.ones())
            if ti.static(c.two):
                loose = (1.0 - gas) * loose + gas * (DENSEST / DENSEST_AIR)
            deviation = ti.max(deviation, (loose * s) * (loose * s))
            tame += s
            gone = self.drift(w, b, filled, 0.5 * dt, AT_MIDDLE)
            farthest = ti.max(farthest, gone)
            if ti.static(c.two):
                pace = (1.0 - gas) + gas * c.get("air_pace")
                gone *= pace * pace
                paced = ti.max(paced, gone)
            if ti.static(self.spills):
                watched = ti.max(watched, gone * self.is_within(b))
        second, deviated = ti.sqrt(self.largest(farthest)), ti.sqrt(self.largest(deviation))
        whole = self.lists.last[u] + second
        if ti.static(self.bodies.moving):
            self.bodies.place(u, AT_END)
            whole = ti.max(whole, self.bodies.way[w])
        self.lists.last[u] = whole
        self.lists.displacement[u] = self.lists.displacement[u] + whole
        self.fastest[u], self.deviation[u] = 2.0 * second / dt, deviated
        if ti.static(c.two):
            self.fastest[u] = 2.0 * ti.sqrt(self.largest(paced)) / dt
        if ti.static(self.bodies.floats):  # a body that is thrown about stops the run, too
            self.fastest[u] = ti.max(self.fastest[u], self.bodies.way[w] / dt)
        if not tame.sum() < 1e30:  # largest values may pass over what is no number, sums do not
            self.deviation[u] = tame.sum()
        if ti.static(self.spills):
            self.within[u] = 2.0 * ti.sqrt(self.largest(watched)) / dt
        return self.bears(u) and self.deviation[u] < DENSEST

    @ti.func
    def bears(self, u):
        """Whether the liquid bears the speed of a unit's particles, those that have left an open tank aside."""
        speed = self.fastest[u]
        if ti.static(self.spills):
            speed = self.within[u]
        return speed < self.constants.get("fastest")

    @ti.func
    def is_within(self, b):
        """1 for the particles of a block that are in the box that is watched, else 0."""
        p, found = self.particles, self.particles.ones()
        for a in ti.static(range(p.axes)):
            place = p.load(p.place[a], b)
            beyond = ti.max(self.box[a] - place, place - self.box[2 + a])
            found *= ti.select(beyond > 0.0, p.zeros(), p.ones())
        return found

    @ti.func
    def drift(self, w, b, filled, half, part: ti.template()):
        """Move a block through half a step; returns the squares (m²) of how far its particles go in the tank."""
        p, poses = self.particles, self.poses
        u = [p.load(p.velocity[a], b) for a in ti.static(range(p.axes))]
        before = [p.load(p.place[a], b) for a in ti.static(range(p.axes))]
        after = [before[a] + p.long(half * u[a]) for a in ti.static(range(p.axes))]
        if ti.static(self.constants.shifting.acts and part == AT_MIDDLE):
            for a in ti.static(range(p.axes)):
                after[a] += p.long((2.0 * half) * p.load(p.shift[a], b))
        if ti.static(poses.moving):
            keep, seen = p.long(filled), poses.drifted(w, part, after, p.where)
            if ti.static(poses.rotating):
                self.turn(w, b, u, p.velocity, part)
            for a in ti.static(range(p.axes)):
                p.store(p.place[a], b, before[a] + keep * (seen[a] - before[a]))
        else:
            for a in ti.static(range(p.axes)):
                p.store(p.place[a], b, after[a])
        gone = [p.short(p.load(p.place[a], b) - before[a]) for a in ti.static(range(p.axes))]
        return dot(gone, gone)

    @ti.func
    def turn(self, w, b, vector: ti.template(), fields: ti.template(), part: ti.template()):
        """Turn the vectors of a block into the axes at the end of a half step."""
        p = self.particles
        found = self.poses.turned(w, part, vector, p.real)
        for a in ti.static(range(p.axes)):
            p.store(fields[a], b, found[a])

    @ti.func
    def largest(self, values):
        """The largest lane."""
        found = values[0]
        for lane in ti.static(range(1, self.particles.lanes)):
            found = ti.max(found, values[lane])
        return found
