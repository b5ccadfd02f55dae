"""Linear tangential spring with history under a Coulomb cap (Cundall and Strack 1979)."""

import taichi as ti

from solvers.laws.extremes import within
from solvers.laws.linear_spring import spring_coefficient, spring_stiffness
from solvers.laws.splitting import AT_ONCE, spring_limit
from solvers.materials import Interface, hertz_stiffness


@ti.data_oriented
class CundallStrack:
    """F_t = −(S + γ_t u_s), |F_t| ≤ μ F_n, Ṡ = k_t u_s (Spandonidis 2016, table 4.2, fourth row).

    k_t = (4 G*/E*) k_l with the spring k_l of the linear normal law, whichever normal law is chosen. The ratio is
    Mindlin's (1949), 2(1 − ν)/(2 − ν) for equal materials. The history S is a force: k_t does not change with the
    overlap, so S²/(2 k_t) is what the spring holds and a changing overlap cannot make energy; at the cap S is cut to
    the cap and the spring slides. γ_t = A k_t, with the dissipative time A of the material.
    """

    constants = ("shear_spring", "shear_dashpot")
    memory = ("stretched",)

    def coefficients(self, between: Interface) -> list[float]:
        """[μ, k_t's coefficient, A in s]."""
        ratio = 4.0 * between.shear_modulus / between.young_modulus
        return [between.friction, ratio * spring_coefficient(between.restitution_speed), between.dissipative_time]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[tuple[float, str]]:
        """Longest steps (s) and what sets them."""
        stiffness = hertz_stiffness(between.young_modulus, radius)
        spring = spring_stiffness(self.coefficients(between)[1], stiffness, mass)
        return [(spring_limit(spring, 2.0 / 7.0 * mass), "the tangential spring")]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """k_t (N/m), γ_t (N s/m) as far as the step resolves it."""
        spring = spring_stiffness(c[1], stiffness, mass)
        return ti.Vector([spring, ti.min(c[2] * spring, AT_ONCE * (2.0 / 7.0) * mass / dt)])

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, root, normal, slip, dt):
        """F_t (N) of a block of contacts on their first grains along the tangent; slip u_s in m/s, F_n in N."""
        cap = c[0] * normal
        stretched = contacts.stretched[w, block] + contacts.shear_spring[w, block] * slip * dt
        stretched = within(stretched, cap)
        contacts.stretched[w, block] = stretched
        return within(-stretched - contacts.shear_dashpot[w, block] * slip, cap)

    @ti.func
    def energy(self, c: ti.template(), contacts: ti.template(), w, block, lane, root):
        """Elastic energy S²/(2 k_t) (J) of one contact."""
        stretched = contacts.stretched[w, block][lane]
        return 0.5 * stretched * stretched / contacts.shear_spring[w, block][lane]
