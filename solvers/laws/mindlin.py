"""Tangential spring with history: Mindlin's no-slip stiffness on Hertz contact under a Coulomb cap."""

import taichi as ti

from solvers.materials import Interface


@ti.data_oriented
class Mindlin:
    """F_t = −(S + A k_t u_s), |F_t| ≤ μ F_n, Ṡ = k_t u_s with k_t = 8 G* √(R_eff ξ) (Mindlin 1949).

    The history S is kept as a force. While the contact loads, it grows with the present stiffness; while it unloads it
    shrinks with the stiffness, S ← S k_t(now)/k_t(before), as Thornton, Cummins and Cleary (2013) ask for, since
    otherwise a changing overlap makes energy (Elata and Berryman 1996). The dashpot has the dissipative time A of the
    normal law. At the cap S is cut to the cap: the spring slides.
    """

    history = 2
    uses_mass = False

    def coefficients(self, between: Interface) -> list[float]:
        """[μ, k_t / (k √ξ) = 6 G*/E*, A in s]."""
        ratio = 6.0 * between.shear_modulus / between.young_modulus
        return [between.friction, ratio, between.dissipative_time]

    @ti.func
    def force(self, c: ti.template(), stiffness, mass, root, normal, slip, dt, past: ti.template()):
        """F_t (N) on the first grain along the tangent, and the new history (S in N, √ξ in √m)."""
        cap = c[0] * normal
        spring = c[1] * stiffness * root
        kept = past[0]
        if root < past[1]:
            kept *= root / past[1]
        stretched = kept + spring * slip * dt
        stretched = ti.max(-cap, ti.min(cap, stretched))
        force = -ti.max(-cap, ti.min(cap, stretched + c[2] * spring * slip))
        return force, ti.Vector([stretched, root])

    @ti.func
    def energy(self, c: ti.template(), stiffness, root, past: ti.template()):
        """Elastic energy S²/(2 k_t) (J)."""
        return 0.5 * past[0] * past[0] / (c[1] * stiffness * root)
