"""The water a ship floats in, and its dispersion relation."""

from dataclasses import dataclass
from math import inf

import numpy as np

NEWTON_STEPS = 6  # from a start within a few per cent; each step squares the error


@dataclass(frozen=True)
class Water:
    """Density (kg/m³), depth (m, infinite if deep) and gravity (m/s²)."""

    density: float = 1000.0
    depth: float = inf
    gravity: float = 9.81

    def wave_number(self, frequency: np.ndarray | float) -> np.ndarray:
        """Wave number k (rad/m) of angular frequencies ω (rad/s): ω² = g k tanh kh (Airy 1845)."""
        deep = np.asarray(frequency, dtype=float) ** 2 / self.gravity
        if self.depth == inf:
            return deep
        x = np.maximum(deep * self.depth, 1e-300)
        # Start of Eckart (1952), within 5 %.
        kh = x / np.sqrt(np.tanh(x))
        for _ in range(NEWTON_STEPS):
            tanh = np.tanh(kh)
            kh = kh - (kh * tanh - x) / (tanh + kh * (1.0 - tanh * tanh))
        return np.where(deep > 0.0, kh / self.depth, 0.0)

    def group_speed(self, frequency: np.ndarray | float) -> np.ndarray:
        """Speed (m/s) at which the energy of waves of angular frequency ω > 0 travels, dω/dk."""
        frequency = np.asarray(frequency, dtype=float)
        k = self.wave_number(frequency)
        if self.depth == inf:
            return 0.5 * frequency / k
        twice = np.minimum(2.0 * k * self.depth, 700.0)  # sinh overflows beyond, and the share is 0 long before
        return 0.5 * frequency / k * (1.0 + twice / np.sinh(twice))
