"""Dry grains, without cohesion."""

import taichi as ti

from solvers.grains.materials import Interface
from solvers.machine.limit import Limit


@ti.data_oriented
class NoCohesion:
    """f = 0: dry grains without cohesion; nothing of it is compiled or stored.

    Source: none is needed, nothing is modelled.

    Limits: dry grains of a tenth of a millimetre and more; finer ones stick by van der Waals' forces.

    Units: f N.
    """

    constants = ()
    memory = ()
    needs = ()
    pulls = False

    def coefficients(self, between: Interface) -> list[float]:
        """None."""
        return []

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """None."""
        return []

    def range(self, between: Interface) -> float:
        """Zero (m)."""
        return 0.0
