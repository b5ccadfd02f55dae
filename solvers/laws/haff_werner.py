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
    first-order low-pass, Ṡ = k_f [(γ_s − γ_f) u_s − S] / (γ_s − γ_f), whose stiffness k_f = 0.02 m_t/Δt² the step
    resolves as well. Slip still stops within a few steps, and under a lasting load the slip is F_t/γ_s, the creep of
    the law itself, whatever the step. With γ_s < 0.2 m_t/Δt the law is integrated as written.
    """

    history = 1
    uses_mass = True

    def coefficients(self, between: Interface) -> list[float]:
        """[μ, γ_s in N s/m]."""
        return [between.friction, between.shear_damping]

    @ti.func
    def force(self, c: ti.template(), stiffness, mass, root, normal, slip, dt, past: ti.template()):
        """F_t (N) on the first grain along the tangent, and the new history S (N).

        `mass` is the effective mass m_eff (kg); m_t = (2/7) m_eff for spheres. `slip` u_s in m/s, `normal` F_n in N.
        """
        cap = c[0] * normal
        limit = (2.0 / 7.0) * mass / dt
        at_once = ti.min(c[1], AT_ONCE * limit)
        rest = c[1] - at_once
        followed = 0.0
        if rest > 0.0:
            follow = ti.min(1.0, FOLLOWING * limit / rest)
            followed = past[0] + follow * (rest * slip - past[0])
            followed = ti.max(-cap, ti.min(cap, followed))
        force = -ti.max(-cap, ti.min(cap, followed + at_once * slip))
        return force, ti.Vector([followed])

    @ti.func
    def energy(self, c: ti.template(), stiffness, root, past: ti.template()):
        """The law stores no energy."""
        return 0.0
