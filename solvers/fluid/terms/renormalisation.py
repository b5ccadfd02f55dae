"""The matrix of a particle's neighbours: its smallest eigenvalue, and the density's gradient corrected by it."""

import taichi as ti

from solvers.fluid.state import Particles
from solvers.fluid.terms.term import Sums, Term

SINGULAR = 0.05  # smallest eigenvalue of Σ V_j r_ji ⊗ ∇W down to which it is inverted: spray has no gradient


@ti.data_oriented
class Renormalisation(Term):
    """G_i = L⁻¹ Σ V_j (s_j − s_i) ∇W, L = Σ V_j r_ji ⊗ ∇W (Randles & Libersky 1996), over the own phase.

    The smallest eigenvalue of L tells a surface and spray (Marrone, Colagrossi, Le Touzé & Graziani 2010). G is
    computed where diffusion needs it.
    """

    def __init__(self, sums: Sums, particles: Particles, constants):
        self.particles, self.constants = particles, constants
        self.matrix, self.renormalised = sums.room(3), constants.diffusion.renormalised
        if self.renormalised:
            self.gradient = sums.room(particles.axes)

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add a neighbour."""
        p = self.particles
        if ti.static(self.renormalised):
            more = p.deviation[pair.jb, pair.lane] - block.s
            for a in ti.static(range(p.axes)):
                sums[self.gradient + a] = sums[self.gradient + a] - more * pair.steep[a]
        sums[self.matrix] += pair.steep[0] * pair.apart[0]
        sums[self.matrix + 1] += pair.steep[0] * pair.apart[1]
        sums[self.matrix + 2] += pair.steep[1] * pair.apart[1]

    @ti.func
    def end(self, block: ti.template(), sums: ti.template()):
        """Store the smallest eigenvalue of a block's matrices, and their inverses times the raw gradients."""
        p, factor = self.particles, self.constants.get("slope")
        yy, yz, zz = factor * sums[self.matrix], factor * sums[self.matrix + 1], factor * sums[self.matrix + 2]
        middle, apart = 0.5 * (yy + zz), 0.5 * (yy - zz)
        eigenvalue = middle - ti.sqrt(apart * apart + yz * yz)
        p.store(p.eigenvalue, block.b, eigenvalue)
        if ti.static(self.renormalised):
            gradient = [factor * sums[self.gradient + a] for a in ti.static(range(p.axes))]
            regular = eigenvalue > SINGULAR
            determinant = ti.select(regular, yy * zz - yz * yz, p.ones())
            along_y = (zz * gradient[0] - yz * gradient[1]) / determinant
            along_z = (yy * gradient[1] - yz * gradient[0]) / determinant
            p.store(p.gradient[0], block.b, ti.select(regular, along_y, p.zeros()))
            p.store(p.gradient[1], block.b, ti.select(regular, along_z, p.zeros()))

    @ti.func
    def trace(self, sums: ti.template()):
        """The trace of the matrix, without the kernel's factor."""
        return sums[self.matrix] + sums[self.matrix + 2]
