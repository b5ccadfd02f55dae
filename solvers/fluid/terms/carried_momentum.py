"""The momentum that shifts of particles carry."""

import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.state import Particles
from solvers.fluid.terms.term import Sums, Term
from solvers.machine.units import Units
from solvers.motion.poses import Poses
from solvers.space.axes import dot


@ti.data_oriented
class CarriedMomentum(Term):
    """Σ V_i V_j (ρ_j w_j δu_j + ρ_i w_i δu_i)·∇W (Sun et al. 2019), see `DeltaPlusMomentum`.

    w is the velocity over that of the tank's origin, in the middle of the step.
    """

    def __init__(self, sums: Sums, particles: Particles, constants: Constants, units: Units, poses: Poses):
        self.particles, self.constants, self.units, self.poses = particles, constants, units, poses
        self.shift, self.tank = sums.room(particles.axes), sums.room(particles.axes)
        self.carried = sums.room(particles.axes)

    @ti.func
    def begin(self, block: ti.template(), sums: ti.template()):
        """Begin with the block's own shifts, and the velocity of the tank."""
        p = self.particles
        for a in ti.static(range(p.axes)):
            sums[self.shift + a] = p.load(p.shift[a], block.b)
            if ti.static(self.poses.moving):
                sums[self.tank + a] = p.ones() * ti.cast(self.poses.walls[a][self.units.world(block.u)], p.real)

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add the flows to and from a neighbour."""
        p = self.particles
        shift = [sums[self.shift + a] for a in ti.static(range(p.axes))]
        away = (pair.weight * (1.0 + block.s)) * dot(shift, pair.apart)
        shift_there = [p.shift[a][pair.jb, pair.lane] for a in ti.static(range(p.axes))]
        away_there = (pair.weight * (1.0 + p.deviation[pair.jb, pair.lane])) * dot(shift_there, pair.apart)
        for a in ti.static(range(p.axes)):
            tank = sums[self.tank + a]
            flows = away * (block.speed[a] - tank) + away_there * (p.velocity[a][pair.jb, pair.lane] - tank)
            sums[self.carried + a] = sums[self.carried + a] - flows

    @ti.func
    def end(self, block: ti.template(), sums: ti.template()):
        """Store the momentum (N/m) that shifts bring to a block."""
        p, c = self.particles, self.constants
        flux = p.load(p.volume, block.b) * (c.get("slope") * c.get("density"))
        for a in ti.static(range(p.axes)):
            p.store(p.carried[a], block.b, flux * sums[self.carried + a])
