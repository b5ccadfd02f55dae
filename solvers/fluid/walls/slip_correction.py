"""Slip-wall correction: the mirror image of water in walls, as air beside it sees it."""

import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.machine.state import Axis, State
from solvers.space.axes import dot, named

FAINT = 1e-6  # of full coverage: a wall particle that sees less water is no image of it


@ti.data_oriented
class SlipCorrection:
    """dV_i/dt += V_i Σ V_w (1 + λ) χ (ũ − u_w)·(1 − n n)·∇W of air i: walls beside water go along with it.

    ũ is the velocity Σ V_f W u_f / Σ V_f W of the water at a wall particle (Adami, Hu & Adams 2012, eq. 22), χ the
    water's share of what the wall particle sees, and n the direction of the wall, that of Σ V_f W (r_f − r_w) over both
    phases. As a mirror image would, it squeezes air where the surface moves along a wall. Summed over all air, the
    volume then follows water and walls; without, 0.2 h of it are missed at each wall that water slides along (own
    derivation). What the image gives the water gets from the wall particles beside the air, which have its pressure,
    but for `stored`.
    """

    def __init__(self, arrays: State, context: FluidContext):
        self.particles, self.constants = context.particles, context.constants
        self.acts = context.constants.two and context.particles.wall_blocks > 0
        if self.acts:
            p, own = self.particles, arrays.under("water")
            each = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
            self.along = own.wide(each, *named("along", p.axes), kept=False)

    @ti.func
    def note(self, b, seen, flow: ti.template(), inward: ti.template()):
        """Store the velocities (m/s) with their weights, of Σ V W `seen` and Σ V W u `flow` of water, and of both Σ V W
        (r_f − r_w) `inward`."""
        p, c = self.particles, self.constants
        some = ti.select(seen * c.get("value") > FAINT, p.ones(), p.zeros())
        weight = some * (1.0 + c.get("lean_of_speed")) * p.load(p.share, b)
        whole, steep = ti.max(seen, 1e-30), ti.max(dot(inward, inward), 1e-30)
        slip = [flow[a] / whole - p.load(p.velocity[a], b) for a in ti.static(range(p.axes))]
        across = dot(slip, inward) / steep
        for a in ti.static(range(p.axes)):
            p.store(self.along[a], b, weight * (slip[a] - across * inward[a]))

    @ti.func
    def dotted(self, jb, lane, apart: ti.template()):
        """That velocity of a wall particle, times r_i − r_w of a block."""
        return dot([self.along[a][jb, lane] for a in ti.static(range(self.particles.axes))], apart)
