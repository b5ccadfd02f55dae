"""Capillary cohesion of grains in humid air: rings of water that condense where grains touch."""

from math import cos, log, pi

import taichi as ti

from solvers.grains.laws.capillary import NO_RANGE, Capillary
from solvers.grains.materials import Interface
from solvers.machine.wide import entry

MOLAR_VOLUME = 18.07e-6  # m³/mol of water at 25 °C
THERMAL = 8.314 * 298.15  # R T, J/mol at 25 °C


def kelvin_radius(humidity: float, surface_tension: float) -> float:
    """r_K (m) = γ_s V_m/(R T |ln H|) of water at 25 °C (Thomson 1871), 1.47 nm at 70 % and 0.072 N/m."""
    return surface_tension * MOLAR_VOLUME / (THERMAL * -log(humidity))


@ti.data_oriented
class Humid(Capillary):
    """f₀ = 2π γ_s cos θ R_eff while the grains touch, f₀ (1 − s/r_K) at a gap s < r_K (Spandonidis 2016, eq. 4.9–4.11).

    The source takes the law from Oger et al. (2013) and the linear decay from Charlaix and Crassous (2005). It is read
    as follows:
    - R_eff as printed, 1/R_eff = 1/R_i + 1/R_j. This makes f₀ half of the pull of two smooth spheres, 4π γ_s cos θ
      R_eff (Fisher 1926; used in `bridge`).
    - The source prints F_m = f₀ (a₀ + a₁ √r_K + a₂ r_K) at the start of the decay without values, which are said to be
      in Crassous et al. (2011). With a₀ = 1, a₁ = a₂ = 0 the force is continuous at s = 0. By the toroidal form a ring
      between equal smooth spheres pulls with f₀ (1 − √(r_K/2R) + …), a thousandth less for grains of mm.
    - r_K by Kelvin's equation for water at 25 °C, which gives the source's 1.47 nm at 70 %.

    So the humidity changes only the range, which is a few nanometres at most. As an extension of the source,
    `asperities` of height h (m) keep the surfaces apart: touching grains are then at s = h on the line, with a force
    f₀ (1 − h/r_K) and a range of r_K − h; there is none in air so dry that r_K < h.

    Limits: air below saturation, grains of mm with surfaces as smooth as the asperities say; no water between them but
    the condensed rings. The pull does not depend on the humidity.

    Units: f₀ N, γ_s N/m, θ rad, R_eff, s, h and r_K m, V_m m³/mol, T K, H a pure number.
    """

    constants = ("bridge_pull", "bridge_range", "bridge_yield")
    needs = ("humidity",)

    def range(self, between: Interface) -> float:
        """Range r_K − h (m), or zero if negative."""
        return max(0.0, kelvin_radius(between.humidity, between.surface_tension) - between.asperities)

    def coefficients(self, between: Interface) -> list[float]:
        """[f₀/R_eff in N/m, range in m]."""
        radius, reach = kelvin_radius(between.humidity, between.surface_tension), self.range(between)
        tension = 2.0 * pi * between.surface_tension * cos(between.contact_angle)
        return [tension * reach / radius, reach]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """f₀ (N), range (m), 1/m_eff (1/kg)."""
        return ti.Vector([c[0] * radius, c[1], 1.0 / mass])

    @ti.func
    def profile(self, contacts: ti.template(), w, block, gap, reach):
        """p(s) = 1 − s/range of a block of contacts."""
        return 1.0 - gap / reach

    @ti.func
    def stretch(self, contacts: ti.template(), w, block, lane, gap):
        """∫ p ds (m) up to a gap (m) of one contact."""
        return gap - 0.5 * gap * gap / ti.max(entry(contacts.bridge_range, w, block, lane), NO_RANGE)
