"""Laminar viscosity."""

import taichi as ti

from solvers.machine.quantity import PLANE


class Laminar:
    """f = 2 ν ρ0 Σ V_j (u_j − u_i) (−W'/r) (Morris, Fox & Zhu 1997, eq. 22): laminar flow of constant viscosity ν.

    The force per volume is along the difference of velocities.

    Limits: shear is right, angular momentum is kept only on average; no turbulence.

    Units: f N/m³, ν m²/s, u m/s.
    """

    central = False

    @staticmethod
    def strength(water, axes: int = PLANE) -> float:
        """Factor 2 ν ρ0 (Pa s) of the pairs' sum for a `solvers.fluid.given.Water`."""
        return 2.0 * water.kinematic * water.density

    @staticmethod
    @ti.func
    def pull(closing, square):
        """Not used: the force is not central."""
        return 0.0 * closing
