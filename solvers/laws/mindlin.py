"""Tangential spring with history: Mindlin's no-slip stiffness on Hertz contact under a Coulomb cap."""

import taichi as ti

from solvers.laws.extremes import greater, lesser, within
from solvers.laws.splitting import AT_ONCE
from solvers.materials import Interface

SMALLEST_ROOT = 1e-12  # √m; an overlap of 1e-24 m is none


@ti.data_oriented
class Mindlin:
    """F_t = −(S + A k_t u_s), |F_t| ≤ μ F_n, Ṡ = k_t u_s with k_t = 8 G* √(R_eff ξ) (Mindlin 1949).

    The history S is kept as a force. While the contact loads, it grows with the present stiffness; while it unloads it
    shrinks with the stiffness, S ← S k_t(now)/k_t(before), as Thornton, Cummins and Cleary (2013) ask for, since
    otherwise a changing overlap makes energy (Elata and Berryman 1996). The dashpot has the dissipative time A of the
    normal law, as far as the step resolves it. At the cap S is cut to the cap: the spring slides.
    """

    constants = ("shear_limit",)
    memory = ("stretched", "root_before")

    def coefficients(self, between: Interface) -> list[float]:
        """[μ, k_t / (k √ξ) = 6 G*/E*, A in s]."""
        ratio = 6.0 * between.shear_modulus / between.young_modulus
        return [between.friction, ratio, between.dissipative_time]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[tuple[float, str]]:
        """None: where the overlap is deepest, a step that resolves the Hertz collision resolves this spring."""
        return []

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """The strongest damper (N s/m) that the step resolves, on m_t = (2/7) m_eff."""
        return ti.Vector([AT_ONCE * (2.0 / 7.0) * mass / dt])

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, root, normal, slip, dt):
        """F_t (N) of a block of contacts on their first grains along the tangent; slip u_s in m/s, F_n in N."""
        cap = c[0] * normal
        spring = c[1] * contacts.stiffness[w, block] * root
        before = greater(contacts.root_before[w, block], SMALLEST_ROOT)
        stretched = contacts.stretched[w, block] * lesser(root / before, 1.0) + spring * slip * dt
        stretched = within(stretched, cap)
        dashpot = lesser(c[2] * spring, contacts.shear_limit[w, block])
        contacts.stretched[w, block] = stretched
        contacts.root_before[w, block] = root
        return within(-stretched - dashpot * slip, cap)

    @ti.func
    def energy(self, c: ti.template(), contacts: ti.template(), w, block, lane, root):
        """Elastic energy S²/(2 k_t) (J) of one contact."""
        stretched = contacts.stretched[w, block][lane]
        return 0.5 * stretched * stretched / (c[1] * contacts.stiffness[w, block][lane] * root)
