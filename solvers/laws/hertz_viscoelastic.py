"""Viscoelastic Hertz contact: the normal force of Brilliantov, Spahn, Hertzsch and Pöschel (1996)."""

import taichi as ti

from solvers.materials import Interface


@ti.data_oriented
class HertzViscoelastic:
    """F_n = k ξ^(3/2) + γ_n ξ^(1/2) ξ̇, with k = (4/3) E* √R_eff and γ_n = (3/2) A k.

    For equal materials k = 2Y√R_eff / (3(1 − ν²)), as Spandonidis (2016), eq. 4.4–4.5, writes it. A is the dissipative
    time of the material (Brilliantov et al. 1996). Dry grains do not pull: the force is cut at zero, so a contact
    ends where the force vanishes and not where the overlap does (Schwager and Pöschel 2008).
    """

    constants = ()
    memory = ()

    def coefficients(self, between: Interface) -> list[float]:
        """[(3/2) A in s]."""
        return [1.5 * between.dissipative_time]

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, overlap, root, rate):
        """F_n (N) of a block of contacts from the overlap ξ (m), its root √ξ and its rate ξ̇ (m/s)."""
        return ti.max(0.0, contacts.stiffness[w, block] * root * (overlap + c[0] * rate))

    @ti.func
    def energy(self, contacts: ti.template(), w, block, lane, overlap, root):
        """Elastic energy (2/5) k ξ^(5/2) (J) of one contact."""
        return 0.4 * contacts.stiffness[w, block][lane] * overlap * overlap * root
