"""Tangential spring with history: Mindlin's no-slip stiffness on Hertz contact under a Coulomb cap."""

from math import sqrt

import taichi as ti

from solvers.grains.laws.history import M_T, STIFFEST, stiffening
from solvers.grains.laws.splitting import AT_ONCE, NETWORK, shear_limit
from solvers.grains.materials import Interface, hertz_stiffness
from solvers.machine.limit import Limit
from solvers.machine.quantity import PLANE
from solvers.machine.wide import entry
from solvers.space.axes import dot
from solvers.space.extremes import greater, lesser, within
from solvers.space.impact import dragged, over_the_step
from solvers.space.tangent import capped, remembered

RESOLVED = 0.09  # (ω_t Δt)², for a slip right to 1.2 %
SMALLEST_ROOT = 1e-12  # √m; keeps ratios finite: an overlap of 1e-24 m counts as none


@ti.data_oriented
class Mindlin:
    """F_t = −(S + A k_t u_s), |F_t| ≤ μ F_n, Ṡ = k_t u_s with k_t = 8 G* √(R_eff ξ) (Mindlin 1949).

    The contact history S is kept as a force. In normal loading it grows with the present stiffness; in unloading it
    shrinks with the stiffness, S ← S k_t(now)/k_t(before), as Thornton, Cummins and Cleary (2013) require, since
    otherwise a changing overlap creates energy (Elata and Berryman 1996). The dashpot has the dissipative time A of the
    normal law, at most what the step resolves. At the Coulomb cap S is cut to the cap: the contact slides.

    S follows the slip of each step (`solvers.grains.laws.history`), with the mean of √ξ over its length, or since first
    touch, where k_t ~ √ξ begins.

    Limits: no micro-slip: the contact sticks as a whole until all of it slides (Mindlin and Deresiewicz 1953 have rings
    that slide before).

    Units: F_t, F_n and S N, u_s m/s, k_t N/m, G* Pa, R_eff and ξ m, A s, μ a pure number.
    """

    wide = True
    constants = ("shear_limit", "shear_stiffer")
    tangents = ("stretched", "sliding")
    network = NETWORK[PLANE]  # set where the scene is known
    memory = (*tangents, "root_before")

    def coefficients(self, between: Interface) -> list[float]:
        """[μ, k_t / (k √ξ) = 6 G*/E*, A in s]."""
        ratio = 6.0 * between.shear_modulus / between.young_modulus
        return [between.friction, ratio, between.dissipative_time]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """Longest steps (s) and what sets them, at the largest overlap of a collision without losses.

        The slip that an undamped contact gives back is off by up to (ω_t Δt)²/7 of what it had, ω_t² = k_t/m_t, and by
        a quarter of that in the mean over the moments of onset.
        """
        k = hertz_stiffness(between.young_modulus, radius)
        root = (1.25 * mass * speed**2 / k) ** 0.2
        spring = self.coefficients(between)[1] * k * root
        damped = shear_limit(spring, M_T * mass, between.dissipative_time, self.network)
        return [
            Limit(sqrt(RESOLVED * M_T * mass / spring), "the tangential spring"),
            Limit(damped, "the tangential spring and its dashpot"),
        ]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """The strongest damper, Δt k_t of the spring included (N s/m), and the step's stiffening (m/N)."""
        stiffer = stiffening(self.integrator.stiffer, mass, dt * self.integrator.damping)
        return ti.Vector([self.network * AT_ONCE * M_T * mass / dt, stiffer])

    @ti.func
    def force(
        self, c: ti.template(), contacts: ti.template(), w, block, root, rate, normal, slip, way: ti.template(), dt
    ):
        """F_t (N) of a block of contacts on their first grains along the tangent; slip u_s in m/s, F_n in N."""
        cap = c[0] * normal
        spring = c[1] * contacts.stiffness[w, block] * root
        stiff = spring + spring * within(contacts.shear_stiffer[w, block] * spring, STIFFEST)
        before, now = greater(contacts.root_before[w, block], SMALLEST_ROOT), greater(root, SMALLEST_ROOT)
        begins, deeper = root * root < rate * dt, greater(root - before, 0.0)
        turns = ti.static(range(len(slip)))
        slid, stretched = remembered(contacts.sliding, w, block, way), remembered(contacts.stretched, w, block, way)
        sliding = [over_the_step(slip[k], slid[k], self.integrator.ahead) for k in turns]
        # The mean of √ξ over the step, which ended here, or since first touch, over the present one.
        more = ti.select(begins, root * root, 0.0 - deeper * (now + before + before))
        more = more / ti.select(begins, 1.5 * rate * dt, 3.0 * now * (now + before))
        share = ti.select(begins, more, 1.0 + more)
        wound = [stiff * (share * sliding[k] * dt) for k in turns]
        kept = lesser(root / before, 1.0)
        held = capped([stretched[k] * kept + wound[k] for k in turns], cap)
        for k in ti.static(turns):
            contacts.stretched[k][w, block] = held[k]
            contacts.sliding[k][w, block] = ti.select(root > 0.0, sliding[k], 0.0 * sliding[k])
        contacts.root_before[w, block] = root
        dashpot = lesser(c[2] * spring, greater(contacts.shear_limit[w, block] - 0.25 * stiff * dt, 0.0))
        return dragged(held, dashpot, slip, cap)

    @ti.func
    def energy(self, c: ti.template(), contacts: ti.template(), w, block, lane, root):
        """Elastic energy S²/(2 k_t) (J) of one contact."""
        spring = c[1] * entry(contacts.stiffness, w, block, lane) * root
        spring += spring * within(entry(contacts.shear_stiffer, w, block, lane) * spring, STIFFEST)
        held = [entry(field, w, block, lane) for field in ti.static(contacts.stretched)]
        return 0.5 * dot(held, held) / spring
