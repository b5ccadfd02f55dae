"""Artificial viscosity between approaching particles only."""

import taichi as ti

from solvers.fluid.viscosity.artificial import Artificial


class Approaching(Artificial):
    """π = max((u_j − u_i)·r_ji/r², 0) (Monaghan 1992, eq. 4.2), signs of approach: pairs that part feel nothing.

    Else as the artificial viscosity; so it is in DualSPHysics.

    Limits: as of the artificial one; about half of it acts.

    Units: π 1/s, u m/s, r m.
    """

    @staticmethod
    @ti.func
    def pull(closing, square):
        """π of pairs that approach, 0 of others."""
        return ti.max(closing, 0.0) / square
