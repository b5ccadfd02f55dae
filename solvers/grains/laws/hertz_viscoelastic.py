"""Viscoelastic Hertz contact: the normal force of Brilliantov, Spahn, Hertzsch and Pöschel (1996)."""

from math import sqrt

import taichi as ti

from solvers.grains.laws.hertz import ELASTIC_STEPS, Hertz, hertz_duration
from solvers.grains.laws.kick import cut_at_zero, reached
from solvers.grains.laws.splitting import NETWORK
from solvers.grains.materials import Interface, hertz_stiffness
from solvers.machine.limit import Limit
from solvers.machine.quantity import PLANE
from solvers.space.extremes import greater

BORNE = 2.0  # of the damper's derived step: longer ones are not stable in the most compressed packings
LEAST = 1e-3  # x of a damper that limits nothing


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

    Damper and end are taken as their means over a kick (`solvers.grains.laws.kick`): the damper's impulse is the change
    of (2/3) γ_n ξ^(3/2), exactly. Verlet's predicted ξ̇ lags behind by Δt²/2 of the jerk, which in a collision is
    −(3/2) k √ξ ξ̇/m_eff; so the damper is multiplied by 1 − (3/4) Δt² k √ξ/m_eff.

    Limits: small overlaps, ξ ≪ R, of spheres that do not yield, and impacts slow beside waves in the grains (Johnson
    1985, chapter 11). The restitution falls with speed, as that of elastic grains with internal friction does.

    Units: F_n N, ξ m, ξ̇ m/s, k N/m^(3/2), γ_n N s/m^(3/2), A s, Y and E* Pa, R_eff m.
    """

    network = NETWORK[PLANE]  # set where the scene is known
    constants = ("lag",)

    def coefficients(self, between: Interface) -> list[float]:
        """[(3/2) A in s]."""
        return [1.5 * between.dissipative_time]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """Longest steps (s) and what sets them.

        The error of the restitution grows with the damping x, and √x times the steps of an elastic collision keep it at
        0.1 % for restitutions from 0.02 to 1. For x > 1 the damper's own limit of stability counts, in a grain that
        touches six others as deep as in the hardest impact: x times the steps are half of it, with Gear's scheme three
        fifths. No step, forced or not, may be longer than BORNE of that.
        """
        collision, x = hertz_duration(mass, radius, between.young_modulus, speed), damping(between, mass, radius, speed)
        steps = ELASTIC_STEPS * max(1.0, sqrt(x), x)
        firm = self.network * BORNE * collision / (ELASTIC_STEPS * max(x, LEAST))
        return [
            Limit(collision / steps, f"1/{steps:.0f} of the Hertz collision"),
            Limit(firm, "what the normal damper bears", firm=True),
        ]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """Lag of the damper per √ξ (m^(-1/2)), (3/2) `late` Δt² k/m_eff."""
        step = dt * self.integrator.damping
        return ti.Vector([1.5 * self.integrator.late * step * step * stiffness / mass])

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, approach, overlap, root, rate, dt):
        """F_n (N) of a block of contacts from the overlap ξ (m), its root √ξ and its rate ξ̇ (m/s)."""
        k = contacts.stiffness[w, block]
        end, begin = reached(approach, rate, dt)
        swept = end * ti.sqrt(end) - begin * ti.sqrt(begin)
        spring, lag = k * root, greater(1.0 - contacts.lag[w, block] * root, 0.0)
        damper = (c[0] * (2.0 / 3.0) / dt) * k * swept * lag
        return cut_at_zero(spring * overlap, damper, 0.5 * dt * spring * rate)
