"""Haff–Werner friction: a viscous shear force under a Coulomb cap, without memory (Haff and Werner 1986)."""

import taichi as ti

from solvers.materials import Interface

# Shares of the contact's own limit m_t/Δt (damper) and m_t/Δt² (spring) that stay stable with every neighbour
# of a grain in touch: the contact network's largest eigenvalue is 4.3 for six equal spheres around one in a plane.
AT_ONCE = 0.2
FOLLOWING = 0.02


@ti.data_oriented
class HaffWerner:
    """F_t = −min(γ_s |u_s|, μ F_n) sign(u_s) (Spandonidis 2016, eq. 4.6).

    γ_s = 20 N s/m stops the slip of a 3 mm grain within 1e-7 s, far below any step worth taking. So the damper is
    split: what the step Δt resolves, γ_f = min(γ_s, 0.2 m_t/Δt), acts at once; the rest acts on the slip through a
    first-order low-pass, Ṡ = [(γ_s − γ_f) u_s − S]/T with T = γ_s Δt²/(0.02 m_t) but at least Δt, whose stiffness
    (γ_s − γ_f)/T the step resolves as well. Slip still stops within a few steps, and under a lasting load the slip is
    F_t/γ_s, the creep of the law itself, whatever the step. With γ_s < 0.2 m_t/Δt the law is integrated as written.
    """

    constants = ("limit",)
    memory = ("followed",)

    def coefficients(self, between: Interface) -> list[float]:
        """[μ, γ_s in N s/m, 0.02/γ_s in m/(N s)]."""
        damping = between.shear_damping
        return [between.friction, damping, FOLLOWING / damping if damping else 0.0]

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, dt):
        """m_t/Δt (N s/m), with m_t = (2/7) m_eff for spheres."""
        return ti.Vector([(2.0 / 7.0) * mass / dt])

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, root, normal, slip, dt):
        """F_t (N) of a block of contacts on their first grains along the tangent; slip u_s in m/s, F_n in N."""
        cap, limit = c[0] * normal, contacts.limit[w, block]
        at_once = ti.min(c[1], AT_ONCE * limit)
        share = ti.min(1.0, c[2] * limit)
        followed = contacts.followed[w, block]
        followed = followed + share * ((c[1] - at_once) * slip - followed)
        followed = ti.max(-cap, ti.min(cap, followed))
        contacts.followed[w, block] = followed
        return -ti.max(-cap, ti.min(cap, followed + at_once * slip))

    @ti.func
    def energy(self, c: ti.template(), contacts: ti.template(), w, block, lane, root):
        """The law stores no energy."""
        return 0.0
