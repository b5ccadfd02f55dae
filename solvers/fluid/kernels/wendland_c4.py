"""Wendland's kernel of fourth continuity."""

from math import pi

import numpy as np
import taichi as ti

from solvers.machine.quantity import PLANE, SPACE

FRONT = {PLANE: (9.0, 4.0), SPACE: (495.0, 256.0)}  # a π h^D, numerator and denominator


class WendlandC4:
    """W = a (1 − q/2)⁶ (35/12 q² + 3 q + 1), q = r/h (Wendland 1995): of fourth continuity.

    a = 9/(4 π h²) in the plane, 495/(256 π h³) in space.

    Smoother than C2 and broader in its effect (Dehnen & Aly 2012, table 1). With t = 1 − q/2:
    W = a t⁶ (35/3 (1 − t)² + 6 (1 − t) + 1), −W'/r = (14 a/(3 h²)) t⁵ (6 − 5 t).

    Limits: support 2 h; wants more neighbours than C2.

    Units: r and h m, W 1/m², in space 1/m³.
    """

    @staticmethod
    def factors(length: float, axes: int = PLANE) -> tuple[float, float]:
        """The constant factors of `value` (1/m², 1/m³) and `slope` (1/m⁴, 1/m⁵) for a smoothing length h (m)."""
        above, below = FRONT[axes]
        alone = above / (below * pi * length**axes)
        return alone, 14.0 / 3.0 * alone / length**2

    @classmethod
    def printed(cls, distance: np.ndarray | float, length: float, axes: int = PLANE) -> np.ndarray | float:
        """W (1/m², 1/m³) at distances (m) within the support."""
        q = distance / length
        return cls.factors(length, axes)[0] * (1.0 - 0.5 * q) ** 6 * (35.0 / 12.0 * q**2 + 3.0 * q + 1.0)

    @staticmethod
    @ti.func
    def value(t):
        """W without its factor."""
        square, outer = t * t, 1.0 - t
        return square * square * square * (35.0 / 3.0 * outer * outer + 6.0 * outer + 1.0)

    @staticmethod
    @ti.func
    def slope(t):
        """−W'/r without its factor."""
        square = t * t
        return square * square * t * (6.0 - 5.0 * t)
