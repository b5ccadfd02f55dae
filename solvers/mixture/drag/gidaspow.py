"""Drag from a packed bed to a loose suspension, by two laws."""

import taichi as ti

from solvers.mixture.drag.ergun import Ergun
from solvers.mixture.drag.wen_yu import WenYu

PASSAGE = 0.2  # share of grains at which one law gives way to the other
STEEP = 262.5  # 150 · 1.75, of the passage


class Gidaspow:
    """`Ergun` below ε = 0.8, `WenYu` above (Gidaspow 1994), joined smoothly (Huilin & Gidaspow 2003).

    β = (1 − ψ) β_Ergun + ψ β_WenYu with ψ = ½ + arctan(150 · 1.75 (0.2 − (1 − ε)))/π.

    Units: w m/s, d m, ρ kg/m³, μ Pa s; the coefficient kg/(m³ s).
    """

    @staticmethod
    @ti.func
    def coefficient(speed, porosity, size, density, viscosity):
        """β/(1 − ε) at a speed |w|."""
        share = 0.5 + ti.atan2(STEEP * (PASSAGE - (1.0 - porosity)), 1.0) * 0.3183098862
        dense = Ergun.coefficient(speed, porosity, size, density, viscosity)
        loose = WenYu.coefficient(speed, porosity, size, density, viscosity)
        return (1.0 - share) * dense + share * loose
