"""Twisting friction with history: a spring and dashpot about the normal under a cap (Marshall 2009)."""

import taichi as ti

from solvers.grains.laws.splitting import AT_ONCE, NETWORK
from solvers.grains.materials import Interface
from solvers.machine.quantity import PLANE
from solvers.machine.wide import entry, minus
from solvers.space.extremes import greater, lesser, within

SMALLEST_ROOT = 1e-12  # √m; keeps ratios finite


@ti.data_oriented
class Marshall:
    """M_n = −(S + C ω_n), |M_n| ≤ (2/3) a μ F_n, Ṡ = k_n ω_n, ω_n = (ω_i − ω_j)·n (Marshall 2009).

    J. Comput. Phys. 228, 1541. k_n = k_t a²/2 with Mindlin's k_t = 8 G* a and the radius a = √(R_eff ξ) of the area of
    contact; C = A k_n with the dissipative time A of the material. The cap is the moment of friction that acts evenly
    over the area. S is a torque; as Mindlin's spring it shrinks with the stiffness in unloading.

    Limits: for spheres in space. The torque is that of a small area, some a/R of what a rolling law stands for.

    Units: M_n and S N m, ω rad/s, k_n N m, C N m s, a and R_eff m, F_n N, A s, μ a pure number.
    """

    resists = True
    wide = True
    constants = ("twist_arm", "twist_limit")
    memory = ("twisted", "twist_root")
    network = NETWORK[PLANE]  # set where the scene is known

    def coefficients(self, between: Interface) -> list[float]:
        """[(2/3) μ, k_n/(k R_eff ξ^(3/2)) = 3 G*/E*, A in s]."""
        ratio = 3.0 * between.shear_modulus / between.young_modulus
        return [2.0 / 3.0 * between.friction, ratio, between.dissipative_time]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """√R_eff (√m), and the strongest damper that the step resolves (N m s)."""
        return ti.Vector([ti.sqrt(radius), self.network * AT_ONCE * 0.4 * mass * radius * radius / dt])

    @ti.func
    def torque(self, c: ti.template(), contacts: ti.template(), w, block, root, normal, twisting, dt):
        """M_n (N m) of a block of contacts on their first grains; root √ξ in √m, F_n in N, twisting ω_n in rad/s."""
        arm = contacts.twist_arm[w, block] * root
        cap, spring = c[0] * arm * normal, self.spring(c, contacts.stiffness[w, block], arm, root)
        kept = lesser(root / greater(contacts.twist_root[w, block], SMALLEST_ROOT), 1.0)
        held = within(contacts.twisted[w, block] * (kept * kept * kept) + spring * twisting * dt, cap)
        contacts.twisted[w, block], contacts.twist_root[w, block] = held, root
        dashpot = lesser(c[2] * spring, contacts.twist_limit[w, block])
        return within(minus(held) - dashpot * twisting, cap)

    @ti.func
    def spring(self, c: ti.template(), stiffness, arm, root):
        """k_n (N m), with a = `arm` (m) and √ξ = `root`."""
        return c[1] * stiffness * root * arm * arm

    @ti.func
    def energy(self, c: ti.template(), contacts: ti.template(), w, block, lane, root):
        """Elastic energy S²/(2 k_n) (J) of one contact."""
        held, arm = entry(contacts.twisted, w, block, lane), entry(contacts.twist_arm, w, block, lane) * root
        return 0.5 * held * held / self.spring(c, entry(contacts.stiffness, w, block, lane), arm, root)
