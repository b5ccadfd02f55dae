"""No resistance to rolling."""

import taichi as ti

from solvers.grains.materials import Interface
from solvers.machine.limit import Limit


@ti.data_oriented
class NoRolling:
    """M = 0: spheres roll freely.

    Source: none is needed, nothing is modelled.

    Limits: a single sphere on a plane rolls on for ever; real grains stop.

    Units: M N m.
    """

    wide = True
    constants = ()
    memory = ()

    def coefficients(self, between: Interface) -> list[float]:
        """None."""
        return []

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """None."""
        return []

    @ti.func
    def torque(self, c: ti.template(), contacts: ti.template(), w, block, normal, turning, dt):
        """Zero for every lane."""
        return ti.Vector([0.0 for _ in ti.static(range(contacts.lanes))])

    @ti.func
    def energy(self, contacts: ti.template(), w, block, lane):
        """The law stores no energy."""
        return 0.0
