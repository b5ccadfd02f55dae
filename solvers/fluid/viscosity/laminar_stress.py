"""Laminar viscosity by its whole stress, for liquids of unequal viscosity side by side."""

from solvers.fluid.viscosity.artificial import Artificial
from solvers.machine.quantity import PLANE


class LaminarStress(Artificial):
    """f = 2 (D + 2) ν ρ0 Σ V_j π ∇W, D axes, π of `Artificial` (Monaghan 2005, eq. 8.8): laminar flow of two fluids.

    Forces along the line between two particles have a symmetric stress, μ (∇u + ∇uᵀ) for a liquid that is not
    compressed, which at a surface between two liquids is what both must bear alike. Forces along the difference of
    velocities, as of `Laminar`, are right within one liquid, but make μ ∇u alike at a surface: a bubble in a liquid of
    ten times its viscosity then rises too fast on fine spacings (own derivation and trial).

    Limits: dilatation is resisted, too, by a bulk viscosity of 2 μ; no turbulence.

    Units: f N/m³, ν m²/s, u m/s.
    """

    @staticmethod
    def strength(water, axes: int = PLANE) -> float:
        """Factor 2 (D + 2) ν ρ0 (Pa s) of the pairs' sum for a `solvers.fluid.given.Water`."""
        return 2.0 * (axes + 2) * water.kinematic * water.density
