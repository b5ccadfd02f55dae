"""Drag in a packed bed."""

import taichi as ti


class Ergun:
    """β = 150 μ (1 − ε)²/(ε d²) + 1.75 ρ (1 − ε) |w|/d (Ergun 1952; Gidaspow 1994), as a coefficient.

    That is the pressure drop 150 μ (1 − ε)² U/(ε³ d²) + 1.75 ρ (1 − ε) U²/(ε³ d) at the superficial speed U = ε |w|.

    Limits: packed beds, ε < 0.8; it tells nothing of a single grain.

    Units: w m/s, d m, ρ kg/m³, μ Pa s; the coefficient kg/(m³ s).
    """

    @staticmethod
    @ti.func
    def coefficient(speed, porosity, size, density, viscosity):
        """β/(1 − ε) at a speed |w|."""
        return 150.0 * viscosity * (1.0 - porosity) / (porosity * size * size) + 1.75 * density * speed / size
