"""Tangential correction: what wall particles would push water along a face is taken off their push."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.bodies.solids import sides_of
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.state import Particles
from solvers.fluid.terms.term import Sums, Term
from solvers.fluid.walls.layers import FAR, deep
from solvers.fluid.walls.wall_layers import WallLayers
from solvers.machine.quantity import PLANE
from solvers.machine.state import Axis, State, padded
from solvers.motion.poses import AT_START
from solvers.space.axes import dot, named
from solvers.tank.pieces import COSINE, SINE, Y, Z
from solvers.tank.tank import Tank


@ti.data_oriented
class Leaning(Term):
    """Σ V_f (−W'/r)(r_f − r_w) of wall particles: how far the water before them leans to one side."""

    def __init__(self, sums: Sums, particles: Particles):
        self.particles, self.first = particles, sums.room(particles.axes)

    @ti.func
    def add(self, b, seen: ti.template(), sums: ti.template()):
        """Add a particle before a block of walls."""
        for a in ti.static(range(self.particles.axes)):
            weight = seen.visible * (seen.volume * seen.slope)
            sums[self.first + a] = sums[self.first + a] - weight * seen.apart[a]

    @ti.func
    def steep(self, sums: ti.template()):
        """The sum as a vector."""
        return [sums[self.first + a] for a in ti.static(range(self.particles.axes))]


@ti.data_oriented
class TangentialCorrection:
    """∇W_iw of the own pressure p_w becomes ∇W_iw − t (t·Σ_k V_k ∇W_kw) W_iw/Σ_f V_f W_fw, t along the face.

    Summed over the water i, no wall particle then pushes along its face, as a wall without friction, or the mirror
    image of the water, does not. Else those near the surface do, who see water on one side alone: they draw the line
    where it meets the wall down, by ρ g h² in all. The power of this push is the adjoint of the sliding in
    `DivergenceCorrection` (own derivation; for adjoint pairs see Bonet & Lok 1999, sec. 3). Without it what slides is
    taken from waves: a standing wave of 20 layers decays by 4.5 % faster.

    Limits: only away from corners, ends and other walls (FAR). There the water leans because another wall ends it, and
    the pushes of both walls bear each other; with part of them taken off, the pressure of 40 layers at rest between
    chamfers was off by 2 % of ρ g H, and a piston's waves were lower by a tenth. So a surface within 1.5 reaches of a
    corner, a wall of short edges, water beside air and full tanks, which have no `DivergenceCorrection`, are as they
    were. In space a body is not looked for: near another wall its wall particles do as if they were alone.
    """

    def __init__(
        self, arrays: State, context: FluidContext, layers: WallLayers, slots: np.ndarray, tanks: Sequence[Tank]
    ):
        """`slots` are where the points of `layers` are among the lanes of the walls.

        What `layers` have for directions along faces are normals in space.
        """
        self.particles, self.constants = p, c = context.particles, context.constants
        self.bodies, self.order = (bodies := context.lists.bodies), context.lists.order
        self.acts = p.wall_blocks > 0 and not (c.full or c.two)
        if self.acts:
            own, each = arrays.under("water.tangential"), (Axis("block", p.worlds * p.stride), Axis("lane", p.lanes))
            rows = layers.rows(layers.straight, bodies.solids.straight, slots, p.lanes)
            self.along = [
                own.holding(name, padded(rows[..., a], p.wall_blocks), "row lane")
                for a, name in enumerate(named("along", p.axes))
            ]
            self.correction = own.wide(each, *named("correction", p.axes), kept=False)
            self.looks = bodies.count > 0 and p.axes == PLANE  # for other walls
            if self.looks:
                off = np.zeros(len(layers.points))
                for number, tank in enumerate(tanks):
                    mine = layers.tanks == number
                    off[mine] = deep(layers.points[mine], layers.along[mine], tank.outline)
                off = layers.rows(off, bodies.solids.deep, slots, p.lanes)
                self.deep = own.holding("deep", padded(off, p.wall_blocks), "row lane")
                goes_on = (bodies.solids.prolongs | np.eye(bodies.count, dtype=bool)).astype(np.int32)
                self.goes_on = own.holding("goes_on", goes_on, "part other", ti.i32)
                sides = [*bodies.solids.sides, *(sides_of(tank.outline) for tank in tanks)]
                self.tanks = [*bodies.tanks, *range(len(tanks))]  # in which each of these is
                self.ends = np.cumsum([0, *(len(of_one) for of_one in sides)]).tolist()
                self.sides = own.holding("sides", np.concatenate(sides), "side number", own.exact)
                self.near = own.holding("near", np.array([FAR * bodies.reach]), "length", p.real)

    @ti.func
    def note(self, b, seen, steep: ti.template()):
        """Store t (t·Σ V (−W'/r)(r_f − r_w))/Σ V W of a block of walls, from Σ V W `seen` and that sum, `steep`."""
        p = self.particles
        along = [p.load(self.along[a], b % p.stride - p.fluid_blocks) for a in ti.static(range(p.axes))]
        if ti.static(self.bodies.moving):
            self.bodies.turn(b, along, AT_START)
        leans = dot(along, steep) / ti.max(seen, 1e-30)
        if ti.static(self.looks):
            leans *= self.clear(b, along)
        for a in ti.static(range(p.axes)):
            if ti.static(p.axes == PLANE):
                p.store(self.correction[a], b, leans * along[a])
            else:  # `along` is the normal n: steep − n (n·steep), where there is one
                p.store(self.correction[a], b, dot(along, along) * steep[a] / ti.max(seen, 1e-30) - leans * along[a])

    @ti.func
    def clear(self, b, along: ti.template()):
        """1 for the wall particles of a block that are away from all walls but their own as the step begins; else 0.

        Their own is a plate with those that go on in its line (`prolonging`).
        """
        p, w, row = self.particles, b // self.particles.stride, self.bodies.row(b)
        clear, deep = p.ones(), p.load(self.deep, b % p.stride - p.fluid_blocks)
        to_face = [0.0 - deep * along[1], deep * along[0]]
        for k in ti.static(range(self.bodies.count)):
            owner = self.bodies.owner[ti.max(row, 0)]
            if (row < 0 or self.goes_on[owner, k] == 0) and self.is_in(k, b):
                pose = [self.bodies.pieces.poses[w, k, n] for n in ti.static((Y, Z, COSINE, SINE))]
                clear *= self.clear_of(b, k, pose, to_face)
        for k in ti.static(range(self.bodies.count, len(self.tanks))):
            if row >= 0 and self.is_in(k, b):
                clear *= self.clear_of(b, k, [0.0, 0.0, 1.0, 0.0], to_face)
        return clear

    @ti.func
    def is_in(self, k: ti.template(), b):
        """Whether a part or tank k is in the tank of a block, or that tank itself."""
        found = True
        if ti.static(self.order.layers > 1):
            found = self.tanks[k] == self.order.layer(b)
        return found

    @ti.func
    def clear_of(self, b, k: ti.template(), pose: ti.template(), to_face: ti.template()):
        """1 for the wall particles of a block that are away from the part k at a pose (y, z, cosine, sine), else 0.

        The tanks follow the parts. Distances are from the face, and from there on to the wall particle: so is the one
        from the corner between two walls.
        """
        p, clear = self.particles, self.particles.ones()
        o_y, o_z, cos, sin = pose
        deep = dot(to_face, to_face)
        for side in range(self.ends[k], self.ends[k + 1]):
            y, z, way_y, way_z = [self.sides[side, n] for n in ti.static(range(4))]
            at = [o_y + cos * y - sin * z, o_z + sin * y + cos * z]
            way = [ti.cast(cos * way_y - sin * way_z, p.real), ti.cast(sin * way_y + cos * way_z, p.real)]
            off = [p.offset(b, ti.cast(at[a], p.where), a) + to_face[a] for a in ti.static(range(p.axes))]
            share = ti.max(0.0, ti.min(1.0, dot(off, way) / dot(way, way)))
            for a in ti.static(range(p.axes)):
                off[a] = off[a] - share * way[a]
            clear = ti.select(dot(off, off) + deep > self.near[0] * self.near[0], clear, p.zeros())
        return clear

    @ti.func
    def taken_off(self, jb, lane, value, axis: ti.template()):
        """What is to be taken from (−W'/r)(r_i − r_w) along an axis, for particles at which W is `value`."""
        return value * self.correction[axis][jb, lane]
