"""The viscous force between particles, and on those beside walls to which water sticks."""

import taichi as ti

from solvers.fluid.constants import Constants
from solvers.fluid.state import Particles
from solvers.fluid.terms.balance import Balance
from solvers.fluid.terms.term import Term
from solvers.space.axes import dot


@ti.data_oriented
class ViscousForce(Term):
    """m_i du_i/dt += μ V_i Σ V_j f_ij, with f of the model by name (`solvers.fluid.viscosity`) and its strength μ.

    The power that it takes is half of that of its pairs. Of two phases each pair has a strength of its own.
    """

    def __init__(self, balance: Balance, particles: Particles, constants: Constants):
        self.balance, self.particles, self.constants = balance, particles, constants

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add the drag of a neighbour, and its power."""
        p, c = self.particles, self.constants
        nearing = [p.velocity[a][pair.jb, pair.lane] - block.speed[a] for a in ti.static(range(p.axes))]
        heavy = pair.weight
        if ti.static(c.two):
            heavy = pair.weight * c.drag(block.gas, p.gas[pair.jb, pair.lane])
        if ti.static(c.viscosity.central):
            closing = dot(nearing, pair.apart)
            pull = heavy * c.viscosity.pull(closing, pair.square + c.get("floor"))
            sums[self.balance.taken] += pull * closing
            for a in ti.static(range(p.axes)):
                sums[self.balance.drag + a] += pull * pair.apart[a]
        else:
            sums[self.balance.taken] += heavy * dot(nearing, nearing)
            for a in ti.static(range(p.axes)):
                sums[self.balance.drag + a] += heavy * nearing[a]
