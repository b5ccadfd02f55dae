"""Descriptors from a spectrum, and random outlines with given descriptors."""

from math import pi

import numpy as np

from solvers.grains.shapes.contour import Contour


def spectrum(d2: float, d3: float, d8: float, count: int, alpha: float = -2.0, beta: float = -2.0) -> np.ndarray:
    """Descriptors D_1 … D_count (count,), in the unit of d2, d3, d8 (Mollon and Zhao 2012; Spandonidis 2016, eq. 8.2).

    D_1 is zero, D_n = D_3 (n/3)^α for 3 < n < 8 and D_n = D_8 (n/8)^β for n > 8.
    """
    n = np.arange(1, count + 1)
    values = np.where(n < 8, d3 * (n / 3.0) ** alpha, d8 * (n / 8.0) ** beta)
    values[:1], values[1:2] = 0.0, d2
    return values


def draw(radius: float, descriptors: np.ndarray, random: np.random.Generator) -> Contour:
    """An outline with R0 = `radius` (m), descriptors (m) and random phases; raises BadOutline as `Contour` does."""
    return Contour(radius, descriptors, random.uniform(0.0, 2.0 * pi, len(descriptors)))
