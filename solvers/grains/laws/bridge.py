"""Capillary cohesion of wet grains: liquid bridges of a given volume."""

from math import cos, pi

import taichi as ti

from solvers.grains.laws.capillary import Capillary
from solvers.grains.materials import Interface
from solvers.machine.wide import entry

LINEAR, SQUARE = 1.05, 2.5  # coefficients of x and x² in the decay of the force with the gap
ROOT = (4.0 * SQUARE - LINEAR**2) ** 0.5


@ti.func
def unwound(x):
    """arctan of (2.5 · 2 x + 1.05)/√(4 · 2.5 − 1.05²), times 2/√(…): the integral of 1/(1 + 1.05 x + 2.5 x²)."""
    return 2.0 / ROOT * ti.atan2(2.0 * SQUARE * x + LINEAR, ROOT)


@ti.data_oriented
class Bridge(Capillary):
    """f₀/(1 + 1.05 x + 2.5 x²), x = s √(R/V), f₀ = 2π γ R cos θ (Willett, Adams, Johnson and Seville 2000, eq. 12).

    V is the bridge's volume and R = 2 R_eff: the radius of equal spheres, the harmonic mean of unequal ones, twice the
    radius on a wall. Their eq. 12 holds for small bridges, V < 1e-3 R³ within some per cent. The bridge forms on
    contact with its full volume and breaks at s = (1 + θ/2) V^(1/3) (Lian, Thornton and Adams 1993). Viscous forces are
    left out.

    Limits: small bridges that do not touch each other, slow rupture; the volume does not move from bridge to bridge.

    Units: f₀ N, γ N/m, θ rad, R, s m, V m³, x a pure number.
    """

    constants = ("bridge_pull", "bridge_range", "bridge_yield", "bridge_scale")
    needs = ("bridge_volume",)

    def range(self, between: Interface) -> float:
        """Rupture distance (1 + θ/2) V^(1/3) (m)."""
        return (1.0 + 0.5 * between.contact_angle) * between.bridge_volume ** (1.0 / 3.0)

    def coefficients(self, between: Interface) -> list[float]:
        """[f₀/R_eff in N/m, range in m, √(2/V) in m^-1.5]."""
        tension = 4.0 * pi * between.surface_tension * cos(between.contact_angle)
        return [tension, self.range(between), (2.0 / between.bridge_volume) ** 0.5]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """f₀ (N), range (m), 1/m_eff (1/kg), x/s (1/m)."""
        return ti.Vector([c[0] * radius, c[1], 1.0 / mass, c[2] * ti.sqrt(radius)])

    @ti.func
    def profile(self, contacts: ti.template(), w, block, gap, reach):
        """p(s) of a block of contacts."""
        x = gap * contacts.bridge_scale[w, block]
        return 1.0 / (1.0 + x * (LINEAR + SQUARE * x))

    @ti.func
    def stretch(self, contacts: ti.template(), w, block, lane, gap):
        """∫ p ds (m) up to a gap (m) of one contact."""
        scale = entry(contacts.bridge_scale, w, block, lane)
        return (unwound(gap * scale) - unwound(0.0)) / scale
