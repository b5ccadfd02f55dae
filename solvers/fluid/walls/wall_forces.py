"""What walls do to the water beside them: pressure, drag of water that sticks, and the load that they bear for it."""

from collections.abc import Sequence

import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.phases.wall_push import WallPushOfTwo
from solvers.fluid.terms.balance import Balance
from solvers.fluid.terms.term import Pair, Sums, Term
from solvers.fluid.terms.wall_push import WallPush
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.fluid.walls.no_slip import WallDrag
from solvers.machine.quantity import PLANE
from solvers.motion.poses import AT_START
from solvers.space.axes import dot, swing, turns
from solvers.space.tangent import moment


@ti.data_oriented
class WallForces:
    """Forces of walls on blocks of water, −Σ V_i V_w (p_i + p_w) ∇W and drag, whose reactions are the walls' load."""

    def __init__(
        self, context: FluidContext, walls: Extrapolation, sums: Sums, balance: Balance, terms: Sequence[Term]
    ):
        """`terms` are those of the momentum pass that see walls."""
        self.particles, self.lists, self.constants = context.particles, context.lists, context.constants
        self.poses, self.bodies, self.walls, self.balance = context.poses, context.lists.bodies, walls, balance
        self.push = WallPushOfTwo(sums, context, walls) if context.constants.two else WallPush(context)
        self.drag = WallDrag(balance, context, walls.velocity) if walls.sticks else None
        self.terms = list(terms)

    @ti.func
    def add(self, block: ti.template(), piece, ends: ti.template(), wall: ti.template(), sums: ti.template()):
        """Add what the wall particles of a piece, the entries between two `ends` of a list, do to a block.

        Piece 0 is the tank, the others are parts in it. `wall` is their force, over V_i and the kernel's factor."""
        p, c, lists = self.particles, self.constants, self.lists
        shrink, turning = c.get("shrink"), self.turning(block.u, piece)
        for k in range(ends[0], ends[1]):
            j = lists.beside.slots[block.u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(block.own, block.origin, j)
            square = dot(apart, apart)
            t = ti.max(1.0 - ti.sqrt(square) * shrink, 0.0)
            volume = p.volume[jb, lane] * lists.visible(block.b, j, apart, AT_START)
            weight = volume * c.kernel.slope(t)
            along = [p.zeros()]
            pair = ti.static(Pair(jb, lane, apart, square, t, weight, volume, 0, weight, apart, along))
            for term in ti.static(self.terms):
                term.add_wall(block, pair, sums)
            along[0] = self.push.along(block, pair, sums)
            more = self.push.of_wall(block, pair, along[0])
            for a in ti.static(range(p.axes)):
                sums[self.balance.own_push + a] += more * apart[a]
            if ti.static(self.walls.tangential.acts):
                self.take_off(pair, wall, sums)
            if ti.static(self.bodies.moving):
                moves = [p.velocity[a][jb, lane] for a in ti.static(range(p.axes))]
                sums[self.balance.stored] += more * dot(moves, apart)
            if ti.static(self.walls.sticks):
                self.drag.add_wall(block, pair, turning, wall, sums)
            for a in ti.static(range(p.axes)):
                wall[a] += along[0] * apart[a]

    @ti.func
    def take_off(self, pair: ti.template(), wall: ti.template(), sums: ti.template()):
        """Take off what a wall particle pushes along its face; see `TangentialCorrection`."""
        p, to = self.particles, self.balance
        by_wall = pair.volume * p.pressure[pair.jb, pair.lane] * self.constants.kernel.value(pair.t)
        for a in ti.static(range(p.axes)):
            off = self.walls.tangential.taken_off(pair.jb, pair.lane, by_wall, a)
            wall[a] = wall[a] - off
            sums[to.own_push + a] = sums[to.own_push + a] - off
            if ti.static(self.bodies.moving):
                sums[to.stored] = sums[to.stored] - p.velocity[a][pair.jb, pair.lane] * off

    @ti.func
    def turning(self, u, piece):
        """The rate of turning (rad/s) over the earth of the tank, piece 0, or of a part in it, as the step starts."""
        p, w = self.particles, self.lists.units.world(u)
        rate = [ti.cast(0.0, p.real) for _ in ti.static(range(turns(p.axes)))]
        if ti.static(self.poses.rotating):
            found = self.poses.of_walls(w, AT_START)
            for k in ti.static(range(turns(p.axes))):
                rate[k] = ti.cast(found[p.axes + k], p.real)
        if ti.static(self.bodies.moving):  # noqa: SIM102 (compiled only where parts move)
            if piece > 0:
                own = self.bodies.pose.rate(w, piece - 1, AT_START)
                for k in ti.static(range(turns(p.axes))):
                    rate[k] += ti.cast(own[k], p.real)
        return rate

    @ti.func
    def weight(self, u, b, axis: ti.template()):
        """The weight per mass (m/s²) of a block along an axis, in the tank's axes."""
        p, c = self.particles, self.constants
        found = p.filled(b) * ti.cast(self.poses.felt[axis][self.lists.units.world(u)], p.real)
        if ti.static(c.modified):
            found *= c.reduced.sinking(c, p.gases(b))
        return found

    @ti.func
    def borne(self, u, b, push: ti.template()):
        """The walls' push on a block, less what its particles lack of their weight (`ReducedPressure`)."""
        p, found = self.particles, [push[a] for a in ti.static(range(self.particles.axes))]
        if ti.static(self.constants.modified):
            for a in ti.static(range(p.axes)):
                whole = p.filled(b) * ti.cast(self.poses.felt[a][self.lists.units.world(u)], p.real)
                found[a] = found[a] - p.load(p.mass, b) * (whole - self.weight(u, b, a))
        return found

    @ti.func
    def on_walls(self, block: ti.template(), wall: ti.template()):
        """Minus the walls' force on a block, and its moment about the tank's origin; the last two entries are zero."""
        p = self.particles
        total = ti.Vector([ti.cast(0.0, p.exact) for _ in ti.static(range(p.axes + turns(p.axes) + 2))])
        turning = moment(block.own, wall)
        force = [ti.cast(wall[a].sum(), p.exact) for a in ti.static(range(p.axes))]
        origin = [ti.cast(block.origin[a], p.exact) for a in ti.static(range(p.axes))]
        for a in ti.static(range(p.axes)):
            total[a] = 0.0 - force[a]
        for k in ti.static(range(turns(p.axes))):
            a, b = ti.static((k + 1) % 3 if p.axes > PLANE else 0, (k + 2) % 3 if p.axes > PLANE else 1)
            swung = ti.cast(turning[k].sum(), p.exact) + origin[a] * force[b] - origin[b] * force[a]
            total[p.axes + k] = 0.0 - swung
        return total

    @ti.func
    def note_past(self, block: ti.template(), past: ti.template()):
        """The velocities (m/s) with which the particles of a block pass the end walls; see `EndWallFriction`."""
        p = self.particles
        for a in ti.static(range(p.axes)):
            past[a] = p.filled(block.b) * block.speed[a]
        if ti.static(self.poses.moving):
            tank = self.walls_at(self.lists.units.world(block.u), block.origin, block.own)
            for a in ti.static(range(p.axes)):
                past[a] = past[a] - p.filled(block.b) * tank[a]

    @ti.func
    def walls_at(self, w, origin: ti.template(), own: ti.template()):
        """The velocities (m/s) that the tank's wall would have at the places of a block, at the start of the step."""
        p = self.particles
        found = self.poses.of_walls(w, AT_START)
        speed = [p.ones() * ti.cast(found[a], p.real) for a in ti.static(range(p.axes))]
        if ti.static(self.poses.rotating):
            rate = [ti.cast(found[p.axes + k], p.real) for k in ti.static(range(turns(p.axes)))]
            at = [(own[a] + ti.cast(origin[a], p.real)) for a in ti.static(range(p.axes))]
            swing(rate, at, speed)
        return speed
