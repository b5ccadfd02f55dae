"""Walls to which water sticks: the velocities that it sees in them, and their drag."""

import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.terms.balance import Balance
from solvers.fluid.terms.term import Sums, Term
from solvers.machine.state import Axis, State
from solvers.space.axes import dot, named, swing


@ti.data_oriented
class MirroredVelocity(Term):
    """2 u_w − ũ, ũ = Σ V_f u_f W/Σ V_f W: the velocity of walls that water sees (Adami, Hu & Adams 2012, eq. 23)."""

    def __init__(self, arrays: State, sums: Sums, context: FluidContext):
        self.particles = p = context.particles
        self.moved = sums.room(p.axes)
        each = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
        self.mirrored = arrays.under("water").wide(each, *named("mirrored", p.axes), kept=False)

    @ti.func
    def add(self, wall: ti.template(), seen: ti.template(), sums: ti.template()):
        """Add a particle before a block of walls."""
        p = self.particles
        for a in ti.static(range(p.axes)):
            sums[self.moved + a] += seen.weight * (seen.volume * p.velocity[a][seen.jb, seen.lane])

    @ti.func
    def note(self, b, whole, sums: ti.template()):
        """Store the velocities of a block of walls; `whole` is Σ V_f W."""
        p = self.particles
        for a in ti.static(range(p.axes)):
            mean = sums[self.moved + a] / ti.max(whole, 1e-30)
            p.store(self.mirrored[a], b, 2.0 * p.load(p.velocity[a], b) - mean)


@ti.data_oriented
class WallDrag(Term):
    """The viscous force between water and wall particles at their mirrored velocities.

    What the drag takes is its power on the wall less that on the water. The load is booked at the water's place, so the
    wall is taken to move as it would there.
    """

    def __init__(self, balance: Balance, context: FluidContext, velocity: MirroredVelocity):
        self.balance, self.velocity = balance, velocity
        self.particles, self.constants, self.poses = context.particles, context.constants, context.poses
        self.turns = context.poses.rotating or context.lists.bodies.moving

    @ti.func
    def add_wall(
        self,
        block: ti.template(),
        pair: ti.template(),
        turning: ti.template(),
        wall: ti.template(),
        sums: ti.template(),
    ):
        """Add a wall particle, of a wall that is `turning` at this rate (rad/s)."""
        p, c = self.particles, self.constants
        slides = [self.velocity.mirrored[a][pair.jb, pair.lane] - block.speed[a] for a in ti.static(range(p.axes))]
        lags = [p.velocity[a][pair.jb, pair.lane] - block.speed[a] for a in ti.static(range(p.axes))]
        heavy = pair.weight
        if ti.static(c.viscosity.central):
            drag = heavy * c.viscosity.pull(dot(slides, pair.apart), pair.square + c.get("floor"))
            if ti.static(c.two):
                drag *= c.of("strength", block.gas)
            pair.along[0] += c.strength() * drag
            sums[self.balance.taken] += drag * dot(lags, pair.apart)
        else:
            if ti.static(c.two):
                heavy *= c.of("strength", block.gas)
            for a in ti.static(range(p.axes)):
                wall[a] += (c.strength() * heavy) * slides[a]
            if ti.static(self.turns):
                swing(turning, pair.apart, lags)
            sums[self.balance.taken] += heavy * dot(slides, lags)
