"""No resistance to twisting."""

import taichi as ti

from solvers.grains.materials import Interface


@ti.data_oriented
class NoTwisting:
    """M_n = 0: spheres spin freely about the normals of their contacts.

    Source: none is needed, nothing is modelled.

    Limits: a sphere that spins on a plane about its vertical axis spins for ever.

    Units: M_n N m.
    """

    resists = False
    wide = True
    constants = memory = ()

    def coefficients(self, between: Interface) -> list[float]:
        """None."""
        return []
