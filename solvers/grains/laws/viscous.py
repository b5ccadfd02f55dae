"""Viscous shear force without a Coulomb cap."""

import taichi as ti

from solvers.grains.laws.haff_werner import HaffWerner
from solvers.grains.materials import Interface

UNCAPPED = 1e9  # a friction coefficient that no force reaches; without normal force the cap is still zero


@ti.data_oriented
class Viscous(HaffWerner):
    """F_t = −γ_s u_s (Spandonidis 2016, table 4.2, second row): Haff and Werner's law without the Coulomb cap.

    Without the cap even a grazing contact stops all slip if γ_s is high, unlike real grains.

    Limits: for comparison with other codes and with closed forms; no real friction is without a cap.

    Units: F_t N, u_s m/s, γ_s N s/m.
    """

    def coefficients(self, between: Interface) -> list[float]:
        """Those of Haff–Werner, with a friction coefficient that never caps the force."""
        return [UNCAPPED, *super().coefficients(between)[1:]]
