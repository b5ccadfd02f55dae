"""The velocities with which particles are shifted."""

import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.state import Particles
from solvers.fluid.terms.phase_gradient import PhaseGradient
from solvers.fluid.terms.surface_normal import SurfaceNormal
from solvers.fluid.terms.term import Sums, Term
from solvers.space.axes import dot


@ti.data_oriented
class Shift(Term):
    """δu of the model by name (`solvers.fluid.shifting`), without its part across a `surface` that is near.

    A full tank has no surface: what lacks water near it, lacks it at a wall, whose particles stand for it.
    """

    def __init__(
        self, sums: Sums, particles: Particles, constants: Constants, surface: SurfaceNormal | PhaseGradient | None
    ):
        self.particles, self.constants, self.surface = particles, constants, surface
        self.bounded, self.shift = surface is not None, sums.room(particles.axes)

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add what a neighbour, or a wall particle, crowds."""
        c = self.constants
        crowded = pair.weight * c.shifting.crowded(c.get("shift_scale") * c.kernel.value(pair.t))
        for a in ti.static(range(self.particles.axes)):
            sums[self.shift + a] += crowded * pair.apart[a]

    add_wall = add

    @ti.func
    def end(self, block: ti.template(), sums: ti.template()):
        """Store the velocities of a block's shifts."""
        p, c = self.particles, self.constants
        shift, lasting = [sums[self.shift + a] for a in ti.static(range(p.axes))], p.filled(block.b)
        if ti.static(self.bounded):
            across = self.surface.across(block, shift, sums)
            lasting = self.surface.lasting(block, sums)
            for a in ti.static(range(p.axes)):
                shift[a] = shift[a] - across[a]
        moved = [lasting * c.get("shift") * shift[a] for a in ti.static(range(p.axes))]
        fast = ti.sqrt(dot(moved, moved))
        limited = ti.min(1.0, c.get("shift_most") / ti.max(fast, 1e-30))
        for a in ti.static(range(p.axes)):
            p.store(p.shift[a], block.b, limited * moved[a])
