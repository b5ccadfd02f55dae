"""Artificial viscosity between approaching particles only."""

import taichi as ti

from solvers.fluid.viscosity.artificial import Artificial


class Approaching(Artificial):
    """As `Artificial`, but pairs that part feel nothing (Monaghan 1992, eq. 4.2; as in DualSPHysics)."""

    @staticmethod
    @ti.func
    def pull(closing, square):
        """π of pairs that approach, 0 of others."""
        return ti.max(closing, 0.0) / square
