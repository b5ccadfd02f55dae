"""Tension of the surface between water and air, as a stress (continuum surface force)."""

import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.state import Particles
from solvers.fluid.terms.balance import Balance
from solvers.fluid.terms.phase_gradient import PhaseGradient
from solvers.fluid.terms.term import Sums, Term
from solvers.space.axes import dot

FAINT = 0.02  # of 1/(2 h): a smaller gradient of the phase is no surface


@ti.data_oriented
class Tension(Term):
    """m_i du_i/dt += Σ V_i V_j (Π_i + Π_j)·∇W, Π = σ (|∇C| I − ∇C ∇C/|∇C|) (Lafaurie et al. 1994; Hu & Adams 2006).

    C is 0 in water and 1 in air, ∇C_i = Σ V_j (C_j − C_i) ∇W. Forces are equal and opposite. The stress is that of the
    step before. Wall particles have no phase of their own: the surface stands on walls at a right angle.

    The energy of the surface is σ Σ V_i |∇C_i|, the trace of V Π. It is the whole stress that follows from this energy
    (own derivation); that of Hu & Adams, eqs. 20 to 22, has |∇C| I/2 instead, and leaves a pressure of −σ |∇C|/2 to the
    equation of state, which draws the particles of the surface apart.

    Limits: the surface is two smoothing lengths thick. Units: σ N/m.
    """

    def __init__(self, sums: Sums, balance: Balance, particles: Particles, constants: Constants, phase: PhaseGradient):
        self.particles, self.constants, self.balance, self.phase = particles, constants, balance, phase
        self.stress = sums.room(3)

    @ti.func
    def update_state(self, b):
        """Let the neighbours of a block see its stresses of the step before, while it notes those of this step."""
        p = self.particles
        for k in ti.static(range(3)):
            p.store(p.stress_before[k], b, p.load(p.stress[k], b))

    @ti.func
    def begin(self, block: ti.template(), sums: ti.template()):
        """Begin with the block's own stresses (N/m), yy, yz and zz."""
        for k in ti.static(range(3)):
            sums[self.stress + k] = self.particles.load(self.particles.stress_before[k], block.b)

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add what the stresses of a block and of a neighbour do."""
        p, to = self.particles, self.balance
        yy = sums[self.stress] + p.stress_before[0][pair.jb, pair.lane]
        yz = sums[self.stress + 1] + p.stress_before[1][pair.jb, pair.lane]
        zz = sums[self.stress + 2] + p.stress_before[2][pair.jb, pair.lane]
        sums[to.push] = sums[to.push] - pair.weight * (yy * pair.apart[0] + yz * pair.apart[1])
        sums[to.push + 1] = sums[to.push + 1] - pair.weight * (yz * pair.apart[0] + zz * pair.apart[1])

    @ti.func
    def end(self, block: ti.template(), sums: ti.template()):
        """Store the stresses of a block from its gradient ∇C (1/m), for the next step."""
        p, c, b = self.particles, self.constants, block.b
        gradient = [c.get("slope") * sums[self.phase.gradient + a] for a in ti.static(range(p.axes))]
        size = ti.sqrt(dot(gradient, gradient))
        strength = ti.select(size * c.get("reach") > FAINT, p.ones() * c.get("tension"), p.zeros())
        least = ti.max(size, 1e-20)
        p.store(p.stress[0], b, strength * (size - gradient[0] * gradient[0] / least))
        p.store(p.stress[1], b, strength * (gradient[0] * gradient[1] / least) * (-1.0))
        p.store(p.stress[2], b, strength * (size - gradient[1] * gradient[1] / least))
