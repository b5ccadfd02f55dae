"""Energy losses of contacts, computed contact by contact from forces and speeds alone."""

import taichi as ti

from solvers.grains.laws.chosen import ChosenLaws
from solvers.machine.state import Axis
from solvers.machine.units import APART
from solvers.space.extremes import greater

SOFTEST = 1e-6  # N/m: a contact that only just touches


@ti.data_oriented
class CountedLaws(ChosenLaws):
    """The chosen laws, and what Hertz contacts and Mindlin's springs have turned into heat, `lost` (J) a unit.

    Of the normal force what is over k ξ^(3/2), times the rate of approach; of the shear force its work on the slip less
    what the spring has gained. No motion, no weight and no ship comes into it.
    """

    def __init__(self, arrays, units, *laws):
        super().__init__(arrays, units, *laws)
        (self.lost,) = arrays.reals((Axis("unit", APART * units.count),), "lost", kind=arrays.exact)

    @ti.func
    def forces(
        self,
        kind: ti.template(),
        contacts: ti.template(),
        u,
        block,
        approach,
        rate,
        slip,
        turning,
        way: ti.template(),
        dt,
    ):
        before = self.sprung(kind, contacts, u, block)
        pressing = self.normal_force(kind, contacts, u, block, approach, rate, dt)
        overlap = greater(approach, 0.0)
        shearing, torque = self.tangential_force(
            kind, contacts, u, block, overlap, rate, pressing, slip, turning, way, dt
        )
        elastic = contacts.stiffness[u, block] * overlap * ti.sqrt(overlap)
        work = ((pressing - elastic) * rate - shearing[0] * slip[0]).sum() * dt
        self.lost[APART * u] = self.lost[APART * u] + work - self.sprung(kind, contacts, u, block) + before
        return pressing, shearing, torque

    @ti.func
    def sprung(self, kind: ti.template(), contacts: ti.template(), u, block):
        """Energy (J) S²/(2 k_t) of a block's shear springs, as they were left last."""
        c, root = self.coefficients(1, u, kind, contacts, block), contacts.root_before[u, block]
        spring = c[1] * contacts.stiffness[u, block] * root
        held = contacts.stretched[0][u, block]
        return (0.5 * held * held / greater(spring, SOFTEST)).sum()
