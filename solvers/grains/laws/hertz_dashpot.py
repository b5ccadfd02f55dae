"""Hertz contact with a linear dashpot."""

import taichi as ti

from solvers.grains.laws.hertz import Hertz, hertz_duration
from solvers.grains.laws.kick import cut_at_zero, reached
from solvers.grains.materials import Interface
from solvers.grains.restitution import CONSTANT, damping_for
from solvers.machine.limit import Limit
from solvers.space.extremes import greater

# Steps per collision, at least and times g: restitution 0.02 … 1 is right to 0.1 %, measured.
STEPS, DAMPED_STEPS = 28.0, 50.0


@ti.data_oriented
class HertzDashpot(Hertz):
    """F_n = k ξ^(3/2) + γ_n ξ̇, k = (4/3) E* √R_eff, cut at zero (Spandonidis 2016, table 4.1, third row).

    γ_n = g (k² m_eff³ v)^(1/5), with the number g that gives the material's restitution at its restitution speed v, for
    grains of any size. In units of the elastic collision the motion is ξ̈ = −ξ^(3/2) − g ξ̇, and g falls as v^(−1/5).
    So slower collisions lose more, contrary to experiment (Schäfer, Dippel and Wolf 1996), and the restitution is right
    at that one speed only.

    Limits: those of Hertz's law, and impacts near the restitution speed.

    Units: F_n N, ξ m, ξ̇ m/s, k N/m^(3/2), γ_n N s/m, m_eff kg, v m/s, g a pure number.
    """

    constants = ("dashpot", "lag")

    def coefficients(self, between: Interface) -> list[float]:
        """[g v^(1/5)], v in m/s."""
        return [damping_for(between.restitution, CONSTANT) * between.restitution_speed**0.2]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """Longest steps (s) and what sets them."""
        collision = hertz_duration(mass, radius, between.young_modulus, speed)
        steps = max(STEPS, DAMPED_STEPS * self.coefficients(between)[0] * speed**-0.2)
        return [Limit(collision / steps, f"1/{steps:.0f} of the Hertz collision")]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """γ_n (N s/m), and the lag of the damper per √ξ (m^(-1/2)), (3/2) `late` Δt² k/m_eff."""
        step = dt * self.integrator.damping
        lag = 1.5 * self.integrator.late * step * step * stiffness / mass
        return ti.Vector([c[0] * stiffness**0.4 * mass**0.6, lag])

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, approach, overlap, root, rate, dt):
        """F_n (N) of a block of contacts from the overlap ξ (m), its root √ξ and its rate ξ̇ (m/s)."""
        spring = contacts.stiffness[w, block] * root
        end, begin = reached(approach, rate, dt)
        lag = greater(1.0 - contacts.lag[w, block] * root, 0.0)
        damper = contacts.dashpot[w, block] * (1.0 / dt) * (end - begin) * lag
        return cut_at_zero(spring * overlap, damper, (0.75 * dt) * spring * rate)
