"""What walls do to the water beside them: pressure, drag of water that sticks, and the load that they bear for it."""

import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.surface.void_indicator import VoidIndicator
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.motion.poses import AT_START
from solvers.space.axes import dot
from solvers.tank.pieces import RATE


@ti.data_oriented
class WallForces:
    """Forces of walls on blocks of water, −Σ V_i V_w (p_i + p_w) ∇W and drag, whose reactions are the walls' load."""

    def __init__(self, context: FluidContext, walls: Extrapolation, voids: VoidIndicator):
        self.particles, self.lists, self.constants = context.particles, context.lists, context.constants
        self.poses, self.bodies, self.walls, self.voids = context.poses, context.lists.bodies, walls, voids

    @ti.func
    def add(
        self,
        u,
        b,
        piece,
        ends: ti.template(),
        own: ti.template(),
        origin: ti.template(),
        speed: ti.template(),
        pressure: ti.template(),
        wall: ti.template(),
        own_push: ti.template(),
        shift: ti.template(),
        fill: ti.template(),
        taken: ti.template(),
    ):
        """Add what the wall particles of a piece, the entries between two `ends` of a list, do to a block.

        `fill` are sums of `VoidIndicator`, `taken` the powers that viscosity and wall particles take. Piece 0 is the
        tank, the others are parts in it."""
        p, c, lists = self.particles, self.constants, self.lists
        shrink, floor, strength, gas = c.get("shrink"), c.get("floor"), c.strength(), p.gases(b)
        squeezed = 1.0 + gas * p.load(p.deviation, b)  # of air as heavy as before in less volume
        weighs = [p.zeros() for _ in ti.static(range(p.axes))]
        if ti.static(c.two):
            w = self.lists.units.world(u)
            felt = self.walls.of_air(w, self.walls.felt(w, b))
            for a in ti.static(range(p.axes)):
                weighs[a] += (gas * squeezed * c.get("air_density")) * felt[a]
        turning = self.turning(u, piece)
        for k in range(ends[0], ends[1]):
            j = lists.beside.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(own, origin, j)
            square = dot(apart, apart)
            t = ti.max(1.0 - ti.sqrt(square) * shrink, 0.0)
            volume = p.volume[jb, lane] * lists.visible(b, j, apart, AT_START)
            weight = volume * c.kernel.slope(t)
            if ti.static(c.shifting.acts):
                crowded = weight * c.shifting.crowded(c.get("shift_scale") * c.kernel.value(t))
                for a in ti.static(range(p.axes)):
                    shift[a] += crowded * apart[a]
            if ti.static(self.voids.acts):
                fill[p.axes] += weight * square
                for a in ti.static(range(p.axes)):
                    off = weight * apart[a]
                    fill[a] += (1.0 - gas) * off if ti.static(c.two) else off  # walls are no part of the air
            along = self.wall_pressure(jb, lane, gas, pressure) + c.clipped(pressure, gas)
            spring = volume * c.hardness(square, p.firm[jb, lane], gas)
            if ti.static(c.two):
                spring *= squeezed
                along = along - dot(weighs, apart)
                if ti.static(c.coheres):
                    along += (gas * c.get("cohesion")) * c.cohesion.push(p.load(p.deviation, b))
            along = along * weight + spring
            more = along - pressure * weight
            if ti.static(c.two):
                more = along - (pressure * weight) * (1.0 + gas)
            for a in ti.static(range(p.axes)):
                own_push[a] += more * apart[a]
            if ti.static(self.walls.tangential.acts):
                by_wall = volume * p.pressure[jb, lane] * c.kernel.value(t)
                for a in ti.static(range(p.axes)):
                    off = self.walls.tangential.taken_off(jb, lane, by_wall, a)
                    wall[a] = wall[a] - off
                    own_push[a] = own_push[a] - off
                    if ti.static(self.bodies.moving):
                        taken[1] = taken[1] - p.velocity[a][jb, lane] * off
            if ti.static(self.bodies.moving):
                taken[1] += more * dot([p.velocity[a][jb, lane] for a in ti.static(range(p.axes))], apart)
            if ti.static(self.walls.sticks):
                slides = [self.walls.mirrored[a][jb, lane] - speed[a] for a in ti.static(range(p.axes))]
                # What the drag takes is its power on the wall less that on the water.
                lags = [p.velocity[a][jb, lane] - speed[a] for a in ti.static(range(p.axes))]
                if ti.static(c.viscosity.central):
                    closing = dot(slides, apart)
                    drag = weight * c.viscosity.pull(closing, square + floor)
                    if ti.static(c.two):
                        drag *= c.of("strength", gas)
                    along += strength * drag
                    taken[0] += drag * dot(lags, apart)
                else:
                    heavy = weight
                    if ti.static(c.two):
                        heavy *= c.of("strength", gas)
                    for a in ti.static(range(p.axes)):
                        wall[a] += (strength * heavy) * slides[a]
                    if ti.static(self.poses.rotating or self.bodies.moving):
                        # The load is booked at the water's place, so that the wall moves as it would there.
                        lags[0] = lags[0] - turning * apart[1]
                        lags[1] += turning * apart[0]
                    taken[0] += heavy * dot(slides, lags)
            for a in ti.static(range(p.axes)):
                wall[a] += along * apart[a]

    @ti.func
    def turning(self, u, piece):
        """The rate of turning (rad/s) over the earth of the tank, piece 0, or of a part in it, as the step starts."""
        rate, w = ti.cast(0.0, self.particles.real), self.lists.units.world(u)
        if ti.static(self.poses.rotating):
            rate = ti.cast(self.poses.walls[5][w], self.particles.real)
        if ti.static(self.bodies.moving):  # noqa: SIM102 (compiled only where parts move)
            if piece > 0:
                rate += ti.cast(self.bodies.poses[w, piece - 1, RATE], self.particles.real)
        return rate

    @ti.func
    def wall_pressure(self, b, lane, gas: ti.template(), pressure: ti.template()):
        """The pressure (Pa) of a wall particle, as particles of these phases and pressures see it: air its own."""
        p = self.particles
        if ti.static(p.two):
            return (1.0 - gas) * p.pressure[b, lane] + gas * pressure
        else:
            return p.pressure[b, lane]

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
    def on_walls(self, b, origin: ti.template(), own: ti.template(), wall: ti.template()):
        """Minus the walls' force on a block, and its moment about the tank's origin; the last two entries are zero."""
        p = self.particles
        total = ti.Vector([ti.cast(0.0, p.exact) for _ in ti.static(range(5))])
        turning = own[0] * wall[1] - own[1] * wall[0]
        force = [ti.cast(wall[a].sum(), p.exact) for a in ti.static(range(p.axes))]
        y, z = ti.cast(origin[0], p.exact), ti.cast(origin[1], p.exact)
        total[0], total[1] = 0.0 - force[0], 0.0 - force[1]
        total[2] = 0.0 - (ti.cast(turning.sum(), p.exact) + y * force[1] - z * force[0])
        return total

    @ti.func
    def note_past(self, u, b, origin: ti.template(), own: ti.template(), speed: ti.template(), past: ti.template()):
        """The velocities (m/s) with which the particles of a block pass the end walls; see `EndWallFriction`."""
        p = self.particles
        for a in ti.static(range(p.axes)):
            past[a] = p.filled(b) * speed[a]
        if ti.static(self.poses.moving):
            tank = self.walls_at(self.lists.units.world(u), origin, own)
            for a in ti.static(range(p.axes)):
                past[a] = past[a] - p.filled(b) * tank[a]

    @ti.func
    def walls_at(self, w, origin: ti.template(), own: ti.template()):
        """The velocities (m/s) that the tank's wall would have at the places of a block, at the start of the step."""
        p = self.particles
        speed = [p.ones() * ti.cast(self.poses.walls[3 + a][w], p.real) for a in ti.static(range(p.axes))]
        if ti.static(self.poses.rotating):
            rate = ti.cast(self.poses.walls[5][w], p.real)
            speed[0] = speed[0] - rate * (own[1] + ti.cast(origin[1], p.real))
            speed[1] += rate * (own[0] + ti.cast(origin[0], p.real))
        return speed
