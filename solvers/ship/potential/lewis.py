"""Lewis forms: sections by a conformal map with two parameters, and the exact limits of their added mass.

The outside of a half circle, ζ = r e^(iθ) with θ from the keel, is mapped on the water beside a section (Lewis 1929,
Trans. SNAME 37): half-breadth and depth below the waterline of its points are, at r = 1,

    y = M [(1 + a₁) sin θ − a₃ sin 3θ],   d = M [(1 − a₁) cos θ + a₃ cos 3θ].

A beam-draught ratio H = B/2T and an area coefficient σ = A/BT give (von Kerczek & Tuck 1969, J. Ship Res. 13)

    a₃ = (3 − C + √(9 − 2C))/C,   a₁ = (1 + a₃)(H − 1)/(H + 1),   C = 3 + 4σ/π + (1 − 4σ/π)((H − 1)/(H + 1))².

Limits: 3π/32 (2 − h) ≤ σ ≤ 3π/32 (3 + h/4), h the lesser of H and 1/H; outside of these a form is dented or bulges.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.section import Section

TERMS = 400  # of the series, which converge as m⁻³ or faster
ROUNDING = 1e-9  # of the limits of σ


def limits(ratio: float) -> tuple[float, float]:
    """Least and largest area coefficient σ of a Lewis form with a ratio H of half-breadth to draught."""
    less = min(ratio, 1.0 / ratio)
    return 3.0 * pi / 32.0 * (2.0 - less), 3.0 * pi / 32.0 * (3.0 + 0.25 * less)


@dataclass(frozen=True)
class Lewis:
    """The Lewis form of a `breadth` and `draught` (m) whose area is `fullness` (σ) times both.

    Raises `Unavailable` for a fullness beyond the limits.
    """

    breadth: float
    draught: float
    fullness: float

    def __post_init__(self):
        least, most = limits(0.5 * self.breadth / self.draught)
        if not least * (1.0 - ROUNDING) <= self.fullness <= most * (1.0 + ROUNDING):
            raise Unavailable(
                f"a Lewis form of {self.breadth:.4g} by {self.draught:.4g} m has an area coefficient from {least:.3f} "
                f"to {most:.3f}, not {self.fullness:.3f}."
            )

    @cached_property
    def map(self) -> tuple[float, float, float]:
        """M (m), a₁ and a₃."""
        ratio = 0.5 * self.breadth / self.draught
        share, full = (ratio - 1.0) / (ratio + 1.0), 4.0 * self.fullness / pi
        c = 3.0 + full + (1.0 - full) * share**2
        third = (3.0 - c + sqrt(max(0.0, 9.0 - 2.0 * c))) / c
        first = (1.0 + third) * share
        return 0.5 * self.breadth / (1.0 + first + third), first, third

    def half(self, count: int) -> np.ndarray:
        """Half-breadth and height above the keel (count + 1, 2) m, from the keel to the waterline."""
        theta = np.linspace(0.0, 0.5 * pi, count + 1)
        scale, first, third = self.map
        y = scale * ((1.0 + first) * np.sin(theta) - third * np.sin(3.0 * theta))
        depth = scale * ((1.0 - first) * np.cos(theta) + third * np.cos(3.0 * theta))
        found = np.column_stack([y, self.draught - depth])
        found[0], found[-1] = (0.0, 0.0), (0.5 * self.breadth, self.draught)
        return found

    def section(self, height: float, count: int = 24) -> Section:
        """The form with upright sides up to a height (m) above the keel."""
        side = self.half(count)
        side = np.vstack([side, [0.5 * self.breadth, height]])
        return Section(np.vstack([side, (side[1:] * [-1.0, 1.0])[::-1]]))

    @property
    def slow(self) -> np.ndarray:
        """Added mass (2, 2) over the water's density, of sway and roll about the waterline's middle, for ω → 0.

        In m², m³ and m⁴. The surface is a wall there, φ = Σ b_m r^(1−2m) sin (2m − 1)θ. Of sway it is
        π M² ((1 − a₁)² + 3a₃²)/2.
        """
        return self._series(2.0 * np.arange(1, TERMS + 1) - 1.0)

    @property
    def fast(self) -> np.ndarray:
        """Added mass (3, 3) over the water's density, of sway, heave and roll, for ω → ∞.

        In m², m³ and m⁴. The surface is one of zero potential there, φ = Σ b_m r^(−2m) sin 2mθ of sway and roll; of
        heave it is π M² ((1 + a₁)² + 3a₃²)/2 (Lewis 1929).
        """
        scale, first, third = self.map
        found = np.zeros((3, 3))
        found[np.ix_((0, 2), (0, 2))] = self._series(2.0 * np.arange(1, TERMS + 1))
        found[1, 1] = 0.5 * pi * scale**2 * ((1.0 + first) ** 2 + 3.0 * third**2)
        return found

    def _series(self, order: np.ndarray) -> np.ndarray:
        """Added mass (2, 2) of sway and roll by a series r^(−n) sin nθ with orders n."""
        scale, first, third = self.map
        # ∂φ/∂r on the circle for unit velocity, as sums of sin kθ: of sway y's slope, of roll that of |y² + d²|/2
        flows = {1.0: scale * (1.0 - first), 3.0: 3.0 * scale * third}, self._turning()
        parts = np.array([sum(size * _overlap(k, order) for k, size in flow.items()) for flow in flows])
        # φ = −Σ (2/π) p/n sin nθ, and −∫ φ ∂φ/∂r dθ over both sides
        return (2.0 / pi) * (parts / order) @ parts.T

    def _turning(self) -> dict[float, float]:
        """Velocity of a rolling form through the circle by sin 2θ and sin 4θ."""
        scale, first, third = self.map
        return {2.0: -2.0 * scale**2 * first * (1.0 + third), 4.0: 4.0 * scale**2 * third}


def _overlap(k: float, order: np.ndarray) -> np.ndarray:
    """∫ sin kθ sin nθ dθ from −π/2 to π/2 for orders n."""
    far, near = k + order, k - order
    close = np.where(near == 0.0, 0.5 * pi, np.sin(0.5 * pi * near) / np.where(near == 0.0, 1.0, near))
    return close - np.sin(0.5 * pi * far) / far
