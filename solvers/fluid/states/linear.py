"""The linear equation of state."""

import numpy as np
import taichi as ti


class Linear:
    """p = c0² (ρ − ρ0) (Antuono, Colagrossi, Marrone & Molteni 2010, eq. 3): pressure in proportion to compression.

    Limits: small compression; c0 is chosen, some ten times the speed of the water, and not that of real water.

    Units: p Pa, c0 m/s, ρ and ρ0 kg/m³.
    """

    @staticmethod
    @ti.func
    def share(s):
        """p/(ρ0 c0²) for the density deviation s."""
        return s

    @staticmethod
    def pressure(s: np.ndarray) -> np.ndarray:
        """As `share`, of an array."""
        return np.asarray(s, dtype=float)

    @staticmethod
    def deviation(share: np.ndarray) -> np.ndarray:
        """The density deviation s at which p/(ρ0 c0²) is `share`."""
        return np.asarray(share, dtype=float)

    @staticmethod
    @ti.func
    def energy(s):
        """Elastic energy per mass in units of c0², ∫ p/(ρ² c0²) dρ = ln(1 + s) + 1/(1 + s) − 1 (Antuono et al. 2015).

        By its series where s is small, since the terms cancel.
        """
        energy = ti.log(1.0 + s) + 1.0 / (1.0 + s) - 1.0
        if ti.abs(s) < 1e-2:
            energy = s * s * (0.5 - s * (2.0 / 3.0 - s * (0.75 - s * (0.8 - s * 5.0 / 6.0))))
        return energy
