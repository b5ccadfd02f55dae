"""No tangential force."""

import taichi as ti

from solvers.grains.materials import Interface
from solvers.machine.limit import Limit


@ti.data_oriented
class Frictionless:
    """F_t = 0: perfectly smooth grains, whose spins never change.

    Source: none is needed, nothing is modelled.

    Limits: for comparison with closed forms; a bed without friction flows as a fluid.

    Units: F_t N.
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
    def force(
        self, c: ti.template(), contacts: ti.template(), w, block, root, rate, normal, slip, way: ti.template(), dt
    ):
        """Zero for every lane."""
        lanes = ti.static(range(contacts.lanes))
        return [ti.Vector([0.0 for _ in lanes]) for _ in ti.static(range(len(slip)))]

    @ti.func
    def energy(self, c: ti.template(), contacts: ti.template(), w, block, lane, root):
        """The law stores no energy."""
        return 0.0
