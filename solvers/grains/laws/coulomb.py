"""Coulomb friction, with a short ramp instead of a jump at zero slip."""

import taichi as ti

from solvers.grains.laws.splitting import FOLLOWING, NETWORK, PROMPT, lagging, relieved
from solvers.grains.materials import Interface
from solvers.machine.limit import Limit
from solvers.machine.quantity import PLANE
from solvers.machine.wide import minus
from solvers.space.extremes import greater, lesser
from solvers.space.tangent import capped, length, remembered

SLIP = 1e-6  # m/s, where the ramp ends: creep of 4 mm an hour under a load at the Coulomb cap
SMALLEST_FORCE = 1e-30  # N; keeps the division finite in contacts without normal force


@ti.data_oriented
class Coulomb:
    """F_t = −μ F_n sign(u_s) (Spandonidis 2016, table 4.2, first row), with a linear ramp for |u_s| < 1e-6 m/s.

    The ramp is a damper γ = μ F_n/(1e-6 m/s), too stiff for any step, so it is split as in `splitting.lagging`. Under a
    load F below the Coulomb cap the contact creeps at F/γ.

    Limits: friction without a spring: in a bed at rest the shear forces are those that the ramp happens to give.

    Units: F_t and F_n N, u_s m/s, γ N s/m, μ a pure number.
    """

    wide = True
    constants = ("limit",)
    network = NETWORK[PLANE]  # set where the scene is known
    memory = tangents = ("followed",)

    def coefficients(self, between: Interface) -> list[float]:
        """[μ]."""
        return [between.friction]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """None: the ramp is split, so that it is stable at any step."""
        return []

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """m_t/Δt (N s/m), with m_t = (2/7) m_eff for spheres."""
        return ti.Vector([(2.0 / 7.0) * mass / dt])

    @ti.func
    def force(
        self, c: ti.template(), contacts: ti.template(), w, block, root, rate, normal, slip, way: ti.template(), dt
    ):
        """F_t (N) of a block of contacts on their first grains along the tangent; slip u_s in m/s, F_n in N."""
        cap, limit = c[0] * normal, contacts.limit[w, block]
        share = lesser(self.network * FOLLOWING * SLIP * limit / greater(cap, SMALLEST_FORCE), 1.0)
        damping = cap * (1.0 / SLIP)
        at_once = lesser(damping, self.network * PROMPT * limit)
        turns = ti.static(range(len(slip)))
        kept = relieved(root, rate, dt)
        fast = [at_once * slip[k] for k in turns]
        followed = remembered(contacts.followed, w, block, way)
        before = [followed[k] * kept for k in turns]
        room = greater(cap - length(fast), 0.0)
        lag = lagging(damping - at_once, share, slip, before, room)
        for k in ti.static(turns):
            contacts.followed[k][w, block] = lag[k]
        return capped([minus(lag[k]) - fast[k] for k in turns], cap)

    @ti.func
    def energy(self, c: ti.template(), contacts: ti.template(), w, block, lane, root):
        """The law stores no energy."""
        return 0.0
