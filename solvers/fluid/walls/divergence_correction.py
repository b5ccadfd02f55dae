"""Wall divergence correction: how fast water closes on wall particles, which is what their pressure compresses.

It is the adjoint of the extrapolation of their pressures.
"""

import numpy as np
import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.state import Particles
from solvers.fluid.terms.term import Sums, Term
from solvers.fluid.walls.wall_layers import WallLayers
from solvers.machine.quantity import PLANE
from solvers.machine.state import State, padded
from solvers.motion.poses import AT_MIDDLE
from solvers.space.axes import dot, named

# m²: the least Σ V W, over the kernel's factor, that is divided by, far below that of a wall particle with a pressure;
# 32 bits bear its inverse times the factor of ∇W, in whatever order the compiler takes them (h from 0.1 mm on).
UNSEEN = {ti.f64: 1e-30, ti.f32: 1e-20}


@ti.data_oriented
class DivergenceCorrection:
    """C_w = Σ V_i (u_i − U_w)·∇W_iw / Σ V_f W_fw; dρ_f/dt has the term ρ_f Σ V_w W_fw C_w: the adjoint of p_w's push.

    A wall particle w pushes on the water i with a pressure that is a mean of that of the water f before it
    (`Extrapolation`). What it takes from the motion of i has to go to the compression of f, in the same shares: that
    term does so, if U_w is the wall's velocity (own derivation, from the power of p_w). Between particles force and
    divergence are adjoint by themselves (Bonet & Lok 1999, sec. 3). Wall particles that only stand still in the balance
    of mass are not: they give or take energy (Cercos-Pita, Antuono, Colagrossi & Souto-Iglesias 2017), sound in a
    column is too slow by 2 % at 40 layers, and with Antuono's diffusion it grows.

    U_w also slides with the water, by the mean of its velocity along the face, Σ V_f u_f W / Σ V_f W. Else water that
    rises along a wall would be compressed near its surface, where the sum of ∇W leans. The adjoint of this is
    `TangentialCorrection`, which takes the push along the face off. So U_w does not slide near free ends of plates and
    sharp corners that point into the water, where that push stays: water that goes round such an end would be driven by
    what slides without an adjoint, and still water stirred itself for ever, to 20 to 100 mm/s (r.m.s., 15 layers). In
    other corners, where no water goes round, and beside smooth bodies it slides, though that push stays there, too:
    static wall particles compress what rises along them. A wall particle whose pressure is cut off compresses nothing.
    Air has a wall pressure of its own, 2 p_i, and a wall's velocity of weight 2 as its adjoint, see
    `solvers.fluid.phases.interfaces`.

    Limits: the compression is right in sum over the layers before a wall; in a single particle, a flow against a wall
    gives a divergence that is off by 1.7 % of its strain. What gravity adds to p_w has no adjoint and stays in
    `stored`. Tanks without a free surface (`full`) do without: in one that was swayed for 20 000 steps particles crept
    by up to four spacings with it.
    """

    def __init__(self, arrays: State, context: FluidContext, layers: WallLayers, slots: np.ndarray):
        """`slots` are where the points of `layers` are among the lanes of the walls."""
        self.units, self.particles, self.ranges = context.units, context.particles, context.ranges
        self.lists, self.constants, self.poses = context.lists, context.constants, context.poses
        self.bodies, p = context.lists.bodies, context.particles
        along = layers.rows(layers.sliding, self.bodies.solids.sliding, slots, p.lanes)
        own = arrays.under("water.divergence")
        self.along = [
            own.holding(name, padded(along[..., a], max(p.wall_blocks, 1)), "row lane")
            for a, name in enumerate(named("along", p.axes))
        ]

    @ti.func
    def correct(self, u, frame, kick, dt):
        """C_w (1/s) of a unit's wall particles in the middle of the step, as their `rate`; returns that all is well."""
        first, end = self.ranges.walls(u)
        for b in range(first, end):
            self.correct_block(u, b, self.lists.facing.first[u, b - first], self.lists.facing.first[u, b - first + 1])
        return True

    @ti.func
    def correct_block(self, u, b, begin, end):
        """As `correct`, for a block of wall particles, from the entries `begin` to `end` of its list."""
        p, c, lists = self.particles, self.constants, self.lists
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        speed = [p.load(p.velocity[a], b) for a in ti.static(range(p.axes))]
        shrink, seen, closed = c.get("shrink"), p.zeros(), p.zeros()
        moved = [p.zeros() for _ in ti.static(range(p.axes))]
        steep = [p.zeros() for _ in ti.static(range(p.axes))]
        for k in range(begin, end):
            j = lists.facing.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(own, origin, j)
            t = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * shrink, 0.0)
            volume = p.volume[jb, lane] * lists.visible(b, j, apart, AT_MIDDLE)
            if ti.static(p.two):
                volume *= 1.0 - p.gas[jb, lane]
            weight, slope = volume * c.kernel.value(t), volume * c.kernel.slope(t)
            nearing = [p.velocity[a][jb, lane] - speed[a] for a in ti.static(range(p.axes))]
            seen += weight
            closed += slope * dot(nearing, apart)
            for a in ti.static(range(p.axes)):
                moved[a] += weight * nearing[a]
                steep[a] += slope * apart[a]
        few = 1.0 / ti.max(seen, ti.static(UNSEEN[p.real]))
        # Unit vectors along the faces before the wall particles, in the tank's axes.
        along = [p.load(self.along[a], b % p.stride - p.fluid_blocks) for a in ti.static(range(p.axes))]
        if ti.static(self.bodies.moving):
            self.bodies.turn(b, along, AT_MIDDLE)
        slid = (few * dot(moved, along)) * dot(along, steep)
        if ti.static(p.axes > PLANE):  # `along` is the normal n: what slides is square to it, where there is one
            slid = (few * dot(moved, steep)) * dot(along, along) - slid
        if ti.static(len(self.bodies.visibility.plates) > 0):
            slid *= self.bodies.visibility.off_ends(b, AT_MIDDLE)
        closed = closed - slid
        # A pressure that is cut off, or of a wall particle that sees no water, is exactly zero.
        pressure = p.load(p.pressure, b)
        acts = ti.select(pressure * pressure > 0.0, p.ones(), p.zeros())
        p.store(p.rate, b, acts * ((c.get("slope") / c.get("value")) * (closed * few)))


@ti.data_oriented
class Closing(Term):
    """Σ V_w W C_w of the wall particles beside a block of water: how fast it is closed on, without W's factor."""

    def __init__(self, sums: Sums, particles: Particles, constants: Constants):
        self.particles, self.constants, self.closed = particles, constants, sums.room()

    @ti.func
    def add_wall(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a wall particle."""
        rate = self.particles.rate[pair.jb, pair.lane]
        sums[self.closed] += (pair.volume * rate) * self.constants.kernel.value(pair.t)
