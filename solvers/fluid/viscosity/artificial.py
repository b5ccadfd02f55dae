"""Artificial viscosity between all pairs."""

import taichi as ti

from solvers.machine.quantity import PLANE


class Artificial:
    """π = (u_j − u_i)·r_ji/r² (Monaghan & Gingold 1983; Antuono et al. 2010, eq. 7): artificial viscosity of all pairs.

    The force per volume is α h c0 ρ0 Σ V_j π ∇W. It is central, so that it keeps the angular momentum, and acts as a
    kinematic viscosity of α h c0/(2 (D + 2)), D the number of axes (Monaghan 2005, eq. 8.8).

    Limits: slip at walls unless `slip` is false; waves are damped by it, ζ = 2 ν k²/ω.

    Units: π 1/s, u m/s, r m.
    """

    central = True  # the force is along the line between the two particles

    @staticmethod
    def strength(water, axes: int = PLANE) -> float:
        """Factor α h c0 ρ0 (Pa s) of the pairs' sum for a `solvers.fluid.given.Water`."""
        return water.alpha * water.length * water.sound_speed * water.density

    @staticmethod
    @ti.func
    def pull(closing, square):
        """π for (u_j − u_i)·(r_i − r_j) = `closing` and a squared distance, floored by the caller."""
        return closing / square
