"""Wendland's kernel of second continuity."""

from math import pi

import numpy as np
import taichi as ti

from solvers.machine.quantity import PLANE, SPACE

FRONT = {PLANE: (7.0, 4.0), SPACE: (21.0, 16.0)}  # a π h^D, numerator and denominator


class WendlandC2:
    """W = a (1 − q/2)⁴ (2 q + 1), q = r/h (Wendland 1995): of second continuity.

    a = 7/(4 π h²) in the plane, 21/(16 π h³) in space.

    Its transform is positive, so that particles do not pair (Dehnen & Aly 2012, table 1). With t = 1 − q/2:
    W = a t⁴ (5 − 4 t), −W'/r = (5 a/h²) t³.

    Limits: support 2 h; needs about 1.5 to 2 spacings in h.

    Units: r and h m, W 1/m², in space 1/m³.
    """

    @staticmethod
    def factors(length: float, axes: int = PLANE) -> tuple[float, float]:
        """The constant factors of `value` (1/m², 1/m³) and `slope` (1/m⁴, 1/m⁵) for a smoothing length h (m)."""
        above, below = FRONT[axes]
        alone = above / (below * pi * length**axes)
        return alone, 5.0 * alone / length**2

    @classmethod
    def printed(cls, distance: np.ndarray | float, length: float, axes: int = PLANE) -> np.ndarray | float:
        """W (1/m², 1/m³) at distances (m) within the support."""
        q = distance / length
        return cls.factors(length, axes)[0] * (1.0 - 0.5 * q) ** 4 * (2.0 * q + 1.0)

    @staticmethod
    @ti.func
    def value(t):
        """W without its factor."""
        square = t * t
        return square * square * (5.0 - 4.0 * t)

    @staticmethod
    @ti.func
    def slope(t):
        """−W'/r without its factor."""
        return t * t * t
