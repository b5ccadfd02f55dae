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
    memory = tangents = ()

    def coefficients(self, between: Interface) -> list[float]:
        """None."""
        return []

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """None."""
        return []

    @ti.func
    def torque(self, c: ti.template(), contacts: ti.template(), w, block, normal, turning, way: ti.template(), dt):
        """Zero for every lane."""
        lanes = ti.static(range(contacts.lanes))
        return [ti.Vector([0.0 for _ in lanes]) for _ in ti.static(range(len(turning)))]

    @ti.func
    def energy(self, contacts: ti.template(), w, block, lane):
        """The law stores no energy."""
        return 0.0
