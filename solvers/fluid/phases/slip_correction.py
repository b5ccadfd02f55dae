"""Slip-wall correction: the mirror image of water in walls, as air beside it sees it."""

import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.terms.term import Sums, Term
from solvers.machine.state import Axis, State
from solvers.space.axes import dot, named

FAINT = 1e-6  # of full coverage: a wall particle that sees less water is no image of it


@ti.data_oriented
class SlipCorrection(Term):
    """dV_i/dt += V_i Σ V_w (1 + λ) χ (ũ − u_w)·(1 − n n)·∇W of air i: walls beside water go along with it.

    ũ is the velocity Σ V_f W u_f / Σ V_f W of the water at a wall particle (Adami, Hu & Adams 2012, eq. 22), χ the
    water's share of what the wall particle sees, and n the direction of the wall, that of Σ V_f W (r_f − r_w) over both
    phases. As a mirror image would, it squeezes air where the surface moves along a wall. Summed over all air, the
    volume then follows water and walls; without, 0.2 h of it are missed at each wall that water slides along (own
    derivation). What the image gives the water gets from the wall particles beside the air, which have its pressure,
    but for `stored`.
    """

    def __init__(self, arrays: State, sums: Sums, context: FluidContext):
        self.particles, self.constants = context.particles, context.constants
        self.acts = context.constants.two and context.particles.wall_blocks > 0
        if self.acts:
            p, own = self.particles, arrays.under("water")
            each = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
            self.along = own.wide(each, *named("along", p.axes), kept=False)
            self.inward, self.flow = sums.room(p.axes), sums.room(p.axes)

    @ti.func
    def add(self, b, seen: ti.template(), sums: ti.template()):
        """Add a particle before a block of walls: of both phases V W (r_f − r_w), of water V W u."""
        p, of_water = self.particles, seen.weight * (1.0 - self.particles.gas[seen.jb, seen.lane])
        for a in ti.static(range(p.axes)):
            sums[self.inward + a] = sums[self.inward + a] - (seen.weight * seen.volume) * seen.apart[a]
            sums[self.flow + a] += of_water * (seen.volume * p.velocity[a][seen.jb, seen.lane])

    @ti.func
    def note(self, b, seen, sums: ti.template()):
        """Store the velocities (m/s) of a block with their weights; `seen` is Σ V W of water."""
        p, c = self.particles, self.constants
        some = ti.select(seen * c.get("value") > FAINT, p.ones(), p.zeros())
        weight = some * (1.0 + c.get("lean_of_speed")) * p.load(p.share, b)
        inward = [sums[self.inward + a] for a in ti.static(range(p.axes))]
        whole, steep = ti.max(seen, 1e-30), ti.max(dot(inward, inward), 1e-30)
        slip = [sums[self.flow + a] / whole - p.load(p.velocity[a], b) for a in ti.static(range(p.axes))]
        across = dot(slip, inward) / steep
        for a in ti.static(range(p.axes)):
            p.store(self.along[a], b, weight * (slip[a] - across * inward[a]))


@ti.data_oriented
class SlidImage(Term):
    """Σ V_w (1 + λ) χ (ũ − u_w)·(1 − n n)·∇W of `SlipCorrection`: how far the images of water squeeze a block's air."""

    def __init__(self, sums: Sums, correction: SlipCorrection):
        self.particles, self.correction, self.slid = correction.particles, correction, sums.room()

    @ti.func
    def add_wall(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a wall particle."""
        along = [self.correction.along[a][pair.jb, pair.lane] for a in ti.static(range(self.particles.axes))]
        sums[self.slid] += pair.weight * dot(along, pair.apart)
