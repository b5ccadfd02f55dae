"""Diffusion of density between the particles of a phase."""

import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.state import Particles
from solvers.fluid.terms.term import Sums, Term
from solvers.machine.units import Units
from solvers.motion.poses import Poses
from solvers.space.axes import dot


@ti.data_oriented
class DensityDiffusion(Term):
    """δ h c0 Σ V_j ψ·∇W, with ψ of the model by name (`solvers.fluid.diffusion`)."""

    def __init__(self, sums: Sums, particles: Particles, constants: Constants, units: Units, poses: Poses):
        self.particles, self.constants, self.units, self.poses = particles, constants, units, poses
        self.evened, self.own = sums.room(), sums.room(particles.axes)

    @ti.func
    def begin(self, block: ti.template(), sums: ti.template()):
        """Begin with the block's own gradients, or what water at rest would have in their place."""
        p, c = self.particles, self.constants
        for a in ti.static(range(p.axes)):
            if ti.static(c.diffusion.renormalised):
                sums[self.own + a] = p.load(p.gradient[a], block.b)
            elif ti.static(c.diffusion.dynamic):
                sums[self.own + a] = c.of("hydrostatic", block.gas) * self.down(self.units.world(block.u), a)

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a neighbour of the own phase."""
        p, c = self.particles, self.constants
        more = 2.0 * (p.deviation[pair.jb, pair.lane] - block.s)
        if ti.static(c.diffusion.renormalised):
            both = [p.gradient[a][pair.jb, pair.lane] + sums[self.own + a] for a in ti.static(range(p.axes))]
            more += dot(both, pair.apart)
        elif ti.static(c.diffusion.dynamic):
            more += 2.0 * dot([sums[self.own + a] for a in ti.static(range(p.axes))], pair.apart)
        if ti.static(c.two):
            more *= 1.0 - pair.other * pair.other
        sums[self.evened] += pair.weight * more

    @ti.func
    def down(self, w, axis: ti.template()):
        """Direction of gravity along an axis of the tank, at the start of the step."""
        pull = [self.poses.felt[a][w] for a in ti.static(range(self.particles.axes))]
        size = ti.max(ti.sqrt(dot(pull, pull)), 1e-12)
        return ti.cast(pull[axis] / size, self.particles.real)
