"""Drag in a loose suspension."""

import taichi as ti

FAST = 1000.0  # Reynolds number from which the drag coefficient is constant


class WenYu:
    """β = ¾ C_D ε (1 − ε) ρ |w| ε^−2.65/d (Wen & Yu 1966; Gidaspow 1994), as a coefficient.

    C_D = 24 (1 + 0.15 Re^0.687)/Re (Schiller & Naumann 1935), 0.44 from Re = 1000 on; Re = ρ d ε |w|/μ.

    Limits: ε > 0.8.

    Units: w m/s, d m, ρ kg/m³, μ Pa s; the coefficient kg/(m³ s).
    """

    @staticmethod
    @ti.func
    def coefficient(speed, porosity, size, density, viscosity):
        """β/(1 − ε) at a speed |w|."""
        reynolds = density * size * porosity * speed / viscosity
        slow = 24.0 * (1.0 + 0.15 * reynolds**0.687)
        drag = ti.select(reynolds < FAST, slow, 0.44 * reynolds)  # C_D Re
        return 0.75 * viscosity / (size * size) * drag * porosity ** (-2.65)
