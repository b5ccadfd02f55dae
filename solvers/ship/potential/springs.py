"""Liquid in a box-shaped tank by linear potential theory: masses on springs that load the tank as the liquid does.

Small sway and roll of a rectangular tank l wide with liquid h deep (Graham & Rodriguez 1952, J. Appl. Mech. 19, 381; in
the notation of Abramson 1966, NASA SP-106, section 6.3). For each odd n, with k = nπ/l,

    m_n = m 8 tanh(k h)/(n³π³ h/l),   ω_n² = g k tanh(k h),   H_n = h − (2/k) tanh(k h/2),

at H_n above the floor, each held by a spring m_n ω_n² and free to move along the floor. The other liquid moves with the
tank: a mass m_0 at H_0 so that all masses have the mass and the centre of the liquid, and a moment of inertia I_0 so
that all together turn as the liquid does under a lid,

    I/I_solid = 1 − 4/(1 + r²) + 768/(π⁵ r (1 + r²)) Σ_odd tanh(nπr/2)/n⁵,   r = h/l.

The weight of the displaced masses makes the free surface's loss of stability: Σ m_n g²/ω_n² = ρ g l³/12.

Its answer at a frequency is that of `potential.sloshing.SloshingLiquid`, which has it from the potential itself.

Limits: waves of small height; vertical walls; even modes, which neither sway nor roll moves, are left out.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np

MODES = 8  # of odd numbers: the loss of stability is then right to 1e-5
SERIES = 200  # terms of the sum for the moment of inertia


@dataclass(frozen=True)
class BoxLiquid:
    """Liquid of a `density` (kg/m³) in a tank `width` (m) wide and `depth` (m) deep, per metre of its length."""

    width: float
    depth: float
    density: float
    gravity: float

    @property
    def mass(self) -> float:
        """Mass (kg/m) of the liquid."""
        return self.density * self.width * self.depth

    @cached_property
    def wave_numbers(self) -> np.ndarray:
        """k (MODES,) 1/m."""
        return pi * (2 * np.arange(MODES) + 1) / self.width

    @property
    def frequencies(self) -> np.ndarray:
        """ω_n (MODES,) rad/s in the tank at rest."""
        k = self.wave_numbers
        return np.sqrt(self.gravity * k * np.tanh(k * self.depth))

    @property
    def masses(self) -> np.ndarray:
        """m_n (MODES,) kg/m."""
        k, n = self.wave_numbers, 2 * np.arange(MODES) + 1
        return self.mass * 8.0 * np.tanh(k * self.depth) / (n**3 * pi**3 * self.depth / self.width)

    @property
    def heights(self) -> np.ndarray:
        """H_n (MODES,) m above the floor."""
        k = self.wave_numbers
        return self.depth - 2.0 / k * np.tanh(0.5 * k * self.depth)

    @property
    def turning(self) -> float:
        """Moment of inertia (kg m) of the liquid under a lid about its centre."""
        r, n = self.depth / self.width, 2 * np.arange(SERIES) + 1
        series = float((np.tanh(0.5 * n * pi * r) / n**5).sum())
        share = 1.0 - 4.0 / (1.0 + r * r) + 768.0 / (pi**5 * r * (1.0 + r * r)) * series
        return share * self.solid_turning

    @property
    def solid_turning(self) -> float:
        """Moment of inertia (kg m) of the frozen liquid about its centre."""
        return self.mass * (self.width**2 + self.depth**2) / 12.0
