"""The equation of state after Tait."""

import numpy as np
import taichi as ti

GAMMA = 7


class Tait:
    """p = ρ0 c0²/γ ((ρ/ρ0)^γ − 1) (Monaghan 1994, eq. 2.6), γ = 7: stiffer the more the water is compressed.

    Limits: as of the linear one, which it equals for small compression.

    Units: p Pa, c0 m/s, ρ and ρ0 kg/m³.
    """

    @staticmethod
    @ti.func
    def share(s):
        """p/(ρ0 c0²) for the density deviation s."""
        ratio = 1.0 + s
        square = ratio * ratio
        return (square * square * square * ratio - 1.0) / GAMMA

    @staticmethod
    def pressure(s: np.ndarray) -> np.ndarray:
        """As `share`, of an array."""
        return (np.power(1.0 + s, GAMMA) - 1.0) / GAMMA

    @staticmethod
    def deviation(share: np.ndarray) -> np.ndarray:
        """The density deviation s at which p/(ρ0 c0²) is `share`."""
        return np.expm1(np.log1p(GAMMA * np.asarray(share, dtype=float)) / GAMMA)

    @staticmethod
    @ti.func
    def energy(s):
        """Elastic energy per mass in units of c0², ∫ p/(ρ² c0²) dρ = ((1 + s)⁶/6 + 1/(1 + s))/7 − 1/6.

        By its series where s is small, since the terms cancel.
        """
        ratio = 1.0 + s
        cube = ratio * ratio * ratio
        energy = (cube * cube / 6.0 + 1.0 / ratio) / GAMMA - 1.0 / 6.0
        if ti.abs(s) < 1e-2:
            energy = s * s * (0.5 + s * (1.0 / 3.0 + s * (0.5 + s * s / 6.0)))
        return energy
