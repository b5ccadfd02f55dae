"""The matrix of a particle's neighbours: its smallest eigenvalue, and the density's gradient corrected by it."""

import taichi as ti

from solvers.fluid.state import Particles
from solvers.fluid.terms.term import Sums, Term
from solvers.space.symmetric import least_eigenvalue, solved

SINGULAR = 0.05  # smallest eigenvalue of Σ V_j r_ji ⊗ ∇W down to which it is inverted: spray has no gradient


@ti.data_oriented
class Renormalisation(Term):
    """G_i = L⁻¹ Σ V_j (s_j − s_i) ∇W, L = Σ V_j r_ji ⊗ ∇W (Randles & Libersky 1996), over the own phase.

    The smallest eigenvalue of L tells a surface and spray (Marrone, Colagrossi, Le Touzé & Graziani 2010). G is
    computed where diffusion needs it.
    """

    def __init__(self, sums: Sums, particles: Particles, constants):
        self.particles, self.constants = particles, constants
        self.renormalised = constants.diffusion.renormalised
        self.entries = [(a, b) for a in range(particles.axes) for b in range(a, particles.axes)]  # it is symmetric
        self.diagonal = [n for n, (a, b) in enumerate(self.entries) if a == b]
        self.matrix = sums.room(len(self.entries))
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
        for n in ti.static(range(len(self.entries))):
            sums[self.matrix + n] += pair.steep[self.entries[n][0]] * pair.apart[self.entries[n][1]]

    @ti.func
    def end(self, block: ti.template(), sums: ti.template()):
        """Store the smallest eigenvalue of a block's matrices, and their inverses times the raw gradients."""
        p, factor = self.particles, self.constants.get("slope")
        matrix = [factor * sums[self.matrix + n] for n in ti.static(range(len(self.entries)))]
        eigenvalue = least_eigenvalue(matrix)
        p.store(p.eigenvalue, block.b, eigenvalue)
        if ti.static(self.renormalised):
            gradient = [factor * sums[self.gradient + a] for a in ti.static(range(p.axes))]
            regular = eigenvalue > SINGULAR
            found, determinant = solved(matrix, gradient)
            over = ti.select(regular, determinant, p.ones())
            for a in ti.static(range(p.axes)):
                p.store(p.gradient[a], block.b, ti.select(regular, found[a] / over, p.zeros()))

    @ti.func
    def trace(self, sums: ti.template()):
        """The trace of the matrix, without the kernel's factor."""
        found = sums[self.matrix]
        for n in ti.static(self.diagonal[1:]):
            found += sums[self.matrix + n]
        return found
