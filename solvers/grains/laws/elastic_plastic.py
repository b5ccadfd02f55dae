"""Rolling friction with history: a rotational spring and dashpot that yield."""

from math import sqrt

import taichi as ti

from solvers.grains.laws.linear_spring import spring_coefficient, spring_stiffness
from solvers.grains.laws.splitting import AT_ONCE, NETWORK, spring_limit
from solvers.grains.materials import Interface, hertz_stiffness
from solvers.machine.limit import Limit
from solvers.machine.quantity import PLANE
from solvers.machine.wide import entry, minus
from solvers.space.axes import dot
from solvers.space.tangent import capped, remembered


@ti.data_oriented
class ElasticPlastic:
    """M = −(S + C_r ω), |M| ≤ μ_r R_eff F_n, Ṡ = k_r ω, ω = ω_i − ω_j (Ai, Chen, Rotter and Ooi 2011, type C).

    k_r = 2.25 k_n (μ_r R_eff)² as in the source, with the spring k_l of the linear normal law for k_n, whichever normal
    law is chosen: k_r then does not depend on the overlap, and a changing overlap creates no energy. The contact
    history S is a torque; at the cap it is cut to the cap and the grain rolls. C_r = 2 η_r √(I_r k_r), η_r the
    material's `rolling_damping` and I_r = (7/5) m_eff R_eff², the inertia about the contact of a sphere on a wall; for
    equal grains the actual one is four times that. S is summed by whole steps and leads by half a step, which acts as a
    damper k_r Δt/2 (`solvers.grains.laws.history`); the dashpot is reduced by as much.

    Limits: k_r is one of many in use; it sets how far a held grain rocks, hardly where a bed slides.

    Units: M and S N m, ω rad/s, k_r N m, C_r N m s, I_r kg m², R_eff m, F_n N, μ_r and η_r pure numbers.
    """

    wide = True
    constants = ("rolling_radius", "rolling_spring", "rolling_dashpot")
    network = NETWORK[PLANE]  # set where the scene is known
    memory = tangents = ("wound",)

    def coefficients(self, between: Interface) -> list[float]:
        """[μ_r, k_r/(k⁴ m)^(1/5) R_eff², 2 η_r √(7/5)]."""
        friction = between.rolling_friction
        spring = 2.25 * friction**2 * spring_coefficient(between.restitution_speed)
        return [friction, spring, 2.0 * between.rolling_damping * sqrt(1.4)]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """Longest steps (s) and what sets them."""
        stiffness = hertz_stiffness(between.young_modulus, radius)
        spring = spring_stiffness(self.coefficients(between)[1], stiffness, mass) * radius**2
        return [Limit(spring_limit(spring, 0.4 * mass * radius**2, self.network), "the rolling spring")]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """μ_r R_eff (m), k_r (N m) and C_r (N m s), at most what the step resolves, less the damping by S."""
        inertia = mass * radius * radius
        spring = spring_stiffness(c[1], stiffness, mass) * radius * radius
        dashpot = ti.min(c[2] * ti.sqrt(spring * inertia), self.network * AT_ONCE * 0.4 * inertia / dt)
        led = self.integrator.ahead * spring * dt * self.integrator.damping
        return ti.Vector([c[0] * radius, spring, ti.max(dashpot - led, 0.0)])

    @ti.func
    def torque(self, c: ti.template(), contacts: ti.template(), w, block, normal, turning, way: ti.template(), dt):
        """M (N m) of a block of contacts on their first grains; turning ω_i − ω_j in rad/s, F_n in N."""
        cap = contacts.rolling_radius[w, block] * normal
        spring, dashpot = contacts.rolling_spring[w, block], contacts.rolling_dashpot[w, block]
        turns = ti.static(range(len(turning)))
        before = remembered(contacts.wound, w, block, way)
        wound = capped([before[k] + spring * turning[k] * dt for k in turns], cap)
        for k in ti.static(turns):
            contacts.wound[k][w, block] = wound[k]
        return capped([minus(wound[k]) - dashpot * turning[k] for k in turns], cap)

    @ti.func
    def energy(self, contacts: ti.template(), w, block, lane):
        """Elastic energy S²/(2 k_r) (J) of one contact; none without rolling friction."""
        wound = [entry(field, w, block, lane) for field in ti.static(contacts.wound)]
        spring, stored = entry(contacts.rolling_spring, w, block, lane), 0.0
        if spring > 0.0:
            stored = 0.5 * dot(wound, wound) / spring
        return stored
