"""Rolling friction: a torque of constant size against the rolling, with a short ramp instead of a jump at zero."""

import taichi as ti

from solvers.grains.laws.splitting import FOLLOWING, NETWORK, PROMPT, lagging
from solvers.grains.materials import Interface
from solvers.machine.limit import Limit
from solvers.machine.quantity import PLANE
from solvers.machine.wide import minus
from solvers.space.extremes import greater, lesser
from solvers.space.tangent import capped, remembered

TURNING = 1e-3  # rad/s, where the ramp ends: under the full torque a 3 mm grain creeps 5 mm an hour
SMALLEST_TORQUE = 1e-30  # N m; keeps the division finite in contacts without normal force


@ti.data_oriented
class ConstantTorque:
    """M = −μ_r R_eff F_n sign(ω_i − ω_j) (Ai, Chen, Rotter and Ooi 2011, type A), with a ramp below 1e-3 rad/s.

    At a wall R_eff is the grain's radius, so a sphere rolls down slopes steeper than μ_r. The ramp is a damper
    c = μ_r R_eff F_n/(1e-3 rad/s), too stiff for any step, so it is split as in `splitting.lagging`. Under a torque M
    below the cap the grain creeps: it turns at M/c.

    Limits: a grain at rest is held by creep alone: on a slope below μ_r it turns slowly.

    Units: M N m, R_eff m, F_n N, ω rad/s, c N m s, μ_r a pure number.
    """

    wide = True
    constants = ("rolling_radius", "rolling_limit")
    network = NETWORK[PLANE]  # set where the scene is known
    memory = tangents = ("rolling_followed",)

    def coefficients(self, between: Interface) -> list[float]:
        """[μ_r]."""
        return [between.rolling_friction]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """None: the ramp is split, so that it is stable at any step."""
        return []

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """μ_r R_eff (m) and I/Δt (N m s), I = (2/5) m_eff R_eff²: a sphere's on a wall, less than two spheres'."""
        return ti.Vector([c[0] * radius, 0.4 * mass * radius * radius / dt])

    @ti.func
    def torque(self, c: ti.template(), contacts: ti.template(), w, block, normal, turning, way: ti.template(), dt):
        """M (N m) of a block of contacts on their first grains; turning ω_i − ω_j in rad/s, F_n in N."""
        cap, limit = contacts.rolling_radius[w, block] * normal, contacts.rolling_limit[w, block]
        share = lesser(self.network * FOLLOWING * TURNING * limit / greater(cap, SMALLEST_TORQUE), 1.0)
        damping = cap * (1.0 / TURNING)
        at_once = lesser(damping, self.network * PROMPT * limit)
        turns = ti.static(range(len(turning)))
        before = remembered(contacts.rolling_followed, w, block, way)
        lag = lagging(damping - at_once, share, turning, before, cap)
        for k in ti.static(turns):
            contacts.rolling_followed[k][w, block] = lag[k]
        return capped([minus(lag[k]) - at_once * turning[k] for k in turns], cap)

    @ti.func
    def energy(self, contacts: ti.template(), w, block, lane):
        """The law stores no energy."""
        return 0.0
