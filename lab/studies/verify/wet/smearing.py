"""What the kernel makes of the surface of a bed through which water flows."""

import numpy as np

from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS

FINE, DEEP = 0.01, 8.0  # of h: the steps, and how far from the surface sums go


def lowered(water: Water, porosity: float) -> float:
    """By how much (m) the surface of a bed of a porosity is lower for water that flows through it slowly.

    Grains fill the room up to a plane, and water passes u = q/ε. Water sees the grains smeared by the kernel W, grains
    see ε and u smeared once more, and water feels their drag smeared: ε ∂p/∂z = W ∗ (φ C(ε_g) u_g). With Ergun's C ∝ (1
    − ε)/ε the pressure falls by less than along a bed with a sharp surface (own derivation).
    """
    step = FINE * water.length
    z = np.arange(-round(water.reach / step), round(water.reach / step) + 1) * step
    away = np.hypot(z[:, None], z)
    weight = np.where(away < water.reach, KERNELS[water.kernel].printed(np.minimum(away, water.reach), water.length), 0)
    weight = weight.sum(axis=1) / weight.sum()

    def smeared(values: np.ndarray) -> np.ndarray:
        return np.convolve(values, weight, "same")

    height = np.arange(-round(2.0 * DEEP / FINE), round(2.0 * DEEP / FINE) + 1) * step
    solid = (height < 0.0) * (1.0 - porosity)
    seen = 1.0 - smeared(solid)
    at_grains, passing = smeared(seen), smeared(1.0 / seen)
    slope = smeared(solid * (1.0 - at_grains) / at_grains * passing) / seen
    whole = ((1.0 - porosity) / porosity) ** 2 / porosity
    inner = np.abs(height) < DEEP * water.length
    return DEEP * water.length - slope[inner].sum() * step / whole
