"""Haff–Werner friction: a viscous shear force under a Coulomb cap, without memory (Haff and Werner 1986)."""

import taichi as ti

from solvers.grains.laws.splitting import FOLLOWING, NETWORK, PROMPT, lagging, relieved
from solvers.grains.materials import Interface
from solvers.machine.limit import Limit
from solvers.machine.quantity import PLANE
from solvers.machine.wide import minus
from solvers.space.extremes import greater, lesser
from solvers.space.tangent import capped, length, remembered


@ti.data_oriented
class HaffWerner:
    """F_t = −min(γ_s |u_s|, μ F_n) sign(u_s) (Spandonidis 2016, eq. 4.6).

    γ_s = 20 N s/m stops the slip of a 3 mm grain within 1e-7 s, far below any practical step. So the damper is split as
    in `splitting.lagging`, with the mass m_t = (2/7) m_eff. Under a lasting load the slip is F_t/γ_s, the creep of the
    law itself, whatever the step.

    Limits: a bed at rest on a slope creeps, since only slip makes a shear force; the history laws hold it still.

    Units: F_t and F_n N, u_s m/s, γ_s N s/m, m_eff kg, μ a pure number.
    """

    wide = True
    constants = ("limit",)
    network = NETWORK[PLANE]  # set where the scene is known
    memory = tangents = ("followed",)

    def coefficients(self, between: Interface) -> list[float]:
        """[μ, γ_s in N s/m, 0.2/γ_s in m/(N s)]."""
        damping = between.shear_damping
        return [between.friction, damping, self.network * FOLLOWING / damping if damping else 0.0]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """None: the damper is split, so that it is stable at any step."""
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
        share, at_once = lesser(c[2] * limit, 1.0), lesser(self.network * PROMPT * limit, c[1])
        turns = ti.static(range(len(slip)))
        kept = relieved(root, rate, dt)
        fast = [at_once * slip[k] for k in turns]
        followed = remembered(contacts.followed, w, block, way)
        before = [followed[k] * kept for k in turns]
        room = greater(cap - length(fast), 0.0)
        lag = lagging(c[1] - at_once, share, slip, before, room)
        for k in ti.static(turns):
            contacts.followed[k][w, block] = lag[k]
        return capped([minus(lag[k]) - fast[k] for k in turns], cap)

    @ti.func
    def energy(self, c: ti.template(), contacts: ti.template(), w, block, lane, root):
        """The law stores no energy."""
        return 0.0
