"""Friction that does not depend on how fast the bed is sheared."""

import taichi as ti


@ti.data_oriented
class Constant:
    """|s| = μ_s p where the bed yields (Drucker & Prager 1952): shear stress s over the pressure p.

    Limits: starts and stops at one angle, arctan μ_s; fast flows of real grains hold more.

    Units: all are those of a stress but μ_s, a pure number.
    """

    @ti.func
    def held(self, tried, pressure, friction, faster, share):
        """The shear stress (Pa) that stays of one that was `tried` elastically, above the friction's."""
        return friction * pressure
