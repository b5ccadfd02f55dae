"""Viscous shear force without a cap."""

import taichi as ti

from solvers.grains.laws.haff_werner import HaffWerner
from solvers.grains.materials import Interface

UNCAPPED = 1e9  # a friction coefficient that no force reaches; grains that do not press have a cap of zero all the same


@ti.data_oriented
class Viscous(HaffWerner):
    """F_t = −γ_s u_s (Spandonidis 2016, table 4.2, second row): Haff and Werner's law without friction's cap.

    Without the cap even a grazing touch stops all slip where γ_s is high, which is not what grains do.
    """

    def coefficients(self, between: Interface) -> list[float]:
        """As of Haff–Werner, with a friction that never caps."""
        return [UNCAPPED, *super().coefficients(between)[1:]]
