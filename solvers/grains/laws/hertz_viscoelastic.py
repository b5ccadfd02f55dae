"""Viscoelastic Hertz contact: the normal force of Brilliantov, Spahn, Hertzsch and Pöschel (1996)."""

from math import sqrt

import taichi as ti

from solvers.grains.laws.extremes import greater
from solvers.grains.laws.hertz import ELASTIC_STEPS, Hertz, hertz_duration
from solvers.grains.materials import Interface, hertz_stiffness

# Steps per collision: DAMPED_STEPS times √x, and for x > 1 a share STRONGLY more per unit of x, since the error of the
# restitution falls as Δt² and grows with x. Measured with Verlet's scheme and contacts that begin anywhere in a step:
# restitution 0.02 … 1 is right to 0.1 %.
DAMPED_STEPS, STRONGLY = 105.0, 0.03


def damping(between: Interface, mass: float, radius: float, speed: float) -> float:
    """Damping x = β v^(1/5), β = (γ_n/m_eff)(m_eff/k)^(3/5), which sets the restitution of a viscoelastic collision."""
    k = hertz_stiffness(between.young_modulus, radius)
    return 1.5 * between.dissipative_time * (k / mass) ** 0.4 * speed**0.2


@ti.data_oriented
class HertzViscoelastic(Hertz):
    """F_n = k ξ^(3/2) + γ_n ξ^(1/2) ξ̇, with k = (4/3) E* √R_eff and γ_n = (3/2) A k.

    For equal materials k = 2Y√R_eff / (3(1 − ν²)), as Spandonidis (2016), eq. 4.4–4.5, writes it. A is the dissipative
    time of the material (Brilliantov et al. 1996). Dry grains do not attract: the force is cut at zero, so a contact
    ends when the force vanishes, not when the overlap does (Schwager and Pöschel 2008).

    Limits: small overlaps, ξ ≪ R, of spheres that do not yield, and impacts slow beside waves in the grains (Johnson
    1985, chapter 11). The restitution falls with speed, as that of elastic grains with internal friction does.

    Units: F_n N, ξ m, ξ̇ m/s, k N/m^(3/2), γ_n N s/m^(3/2), A s, Y and E* Pa, R_eff m.
    """

    def coefficients(self, between: Interface) -> list[float]:
        """[(3/2) A in s]."""
        return [1.5 * between.dissipative_time]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[tuple[float, str]]:
        """Longest steps (s) and what sets them."""
        collision = hertz_duration(mass, radius, between.young_modulus, speed)
        x = damping(between, mass, radius, speed)
        steps = max(ELASTIC_STEPS, DAMPED_STEPS * sqrt(x) * (1.0 + STRONGLY * max(0.0, x - 1.0)))
        return [(collision / steps, f"1/{steps:.0f} of the Hertz collision")]

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, overlap, root, rate, dt):
        """F_n (N) of a block of contacts from the overlap ξ (m), its root √ξ and its rate ξ̇ (m/s)."""
        return greater(contacts.stiffness[w, block] * root * (overlap + c[0] * rate), 0.0)
