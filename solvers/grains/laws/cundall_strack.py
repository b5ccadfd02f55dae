"""Linear tangential spring with history under a Coulomb cap (Cundall and Strack 1979)."""

import taichi as ti

from solvers.grains.laws.history import M_T, STIFFEST, stiffening
from solvers.grains.laws.linear_spring import spring_coefficient, spring_stiffness
from solvers.grains.laws.splitting import AT_ONCE, NETWORK, shear_limit, spring_limit
from solvers.grains.materials import Interface, hertz_stiffness
from solvers.machine.limit import Limit
from solvers.machine.quantity import PLANE
from solvers.machine.wide import entry
from solvers.space.axes import dot
from solvers.space.extremes import within
from solvers.space.impact import dragged, over_the_step, stretched
from solvers.space.tangent import remembered


@ti.data_oriented
class CundallStrack:
    """F_t = −(S + γ_t u_s), |F_t| ≤ μ F_n, Ṡ = k_t u_s (Spandonidis 2016, table 4.2, fourth row).

    k_t = (4 G*/E*) k_l with the spring k_l of the linear normal law, whichever normal law is chosen. The ratio is
    Mindlin's (1949), 2(1 − ν)/(2 − ν) for equal materials. The contact history S is a force. Since k_t does not depend
    on the overlap, the spring's energy is S²/(2 k_t) and a changing overlap creates none; at the Coulomb cap S is cut
    to the cap and the contact slides. γ_t = A k_t, with the dissipative time A of the material. S follows the slip
    of each step (`solvers.grains.laws.history`); in the first step of a contact it counts from first touch.

    Limits: a spring that does not depend on the load; under light loads it is stiffer than Mindlin's, under heavy ones
    softer. No micro-slip.

    Units: F_t, F_n and S N, u_s m/s, k_t and k_l N/m, γ_t N s/m, A s, μ a pure number.
    """

    wide = True
    constants = ("shear_spring", "shear_dashpot")
    network = NETWORK[PLANE]  # set where the scene is known
    memory = tangents = ("stretched", "sliding")

    def coefficients(self, between: Interface) -> list[float]:
        """[μ, k_t's coefficient, A in s]."""
        ratio = 4.0 * between.shear_modulus / between.young_modulus
        return [between.friction, ratio * spring_coefficient(between.restitution_speed), between.dissipative_time]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """Longest steps (s) and what sets them."""
        stiffness = hertz_stiffness(between.young_modulus, radius)
        spring = spring_stiffness(self.coefficients(between)[1], stiffness, mass)
        damped = shear_limit(spring, M_T * mass, between.dissipative_time, self.network)
        return [
            Limit(spring_limit(spring, M_T * mass, self.network), "the tangential spring"),
            Limit(damped, "the tangential spring and its dashpot"),
        ]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """k_t (N/m), stiffened for the step (`history`), and γ_t (N s/m), at most what the step resolves."""
        spring = spring_stiffness(c[1], stiffness, mass)
        dashpot = ti.min(c[2] * spring, ti.max(self.network * AT_ONCE * M_T * mass / dt - 0.25 * spring * dt, 0.0))
        stiffer = stiffening(self.integrator.stiffer, mass, dt * self.integrator.damping) * spring
        return ti.Vector([spring + spring * within(stiffer, STIFFEST), dashpot])

    @ti.func
    def force(
        self, c: ti.template(), contacts: ti.template(), w, block, root, rate, normal, slip, way: ti.template(), dt
    ):
        """F_t (N) of a block of contacts on their first grains along the tangent; slip u_s in m/s, F_n in N."""
        cap, spring = c[0] * normal, contacts.shear_spring[w, block]
        turns = ti.static(range(len(slip)))
        slid, before = remembered(contacts.sliding, w, block, way), remembered(contacts.stretched, w, block, way)
        sliding = [over_the_step(slip[k], slid[k], self.integrator.ahead) for k in turns]
        held = stretched(before, spring, root * root, rate, slip, sliding, cap, dt)
        for k in ti.static(turns):
            contacts.stretched[k][w, block] = held[k]
            contacts.sliding[k][w, block] = ti.select(root > 0.0, sliding[k], 0.0 * sliding[k])
        return dragged(held, contacts.shear_dashpot[w, block], slip, cap)

    @ti.func
    def energy(self, c: ti.template(), contacts: ti.template(), w, block, lane, root):
        """Elastic energy S²/(2 k_t) (J) of one contact."""
        spring = entry(contacts.shear_spring, w, block, lane)
        held = [entry(field, w, block, lane) for field in ti.static(contacts.stretched)]
        return 0.5 * dot(held, held) / spring
