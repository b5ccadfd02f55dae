"""Springs with history: how far one has come at the time of the positions, to second order in the step.

The contacts see velocities that the integrator predicts for the time of the positions: w_n = u_(n−1/2) + (Δt/2) a_(n−1)
of Verlet's scheme. The sum Q_n = Δt Σ w_j leads the true way s_n by half a step, Q_n = s_n + (Δt/2) u + O(Δt²). A
spring that follows Q_n is a spring and a damper k Δt/2, which at 36 steps a collision takes a tenth of an undamped
swing. Here it follows Q_n less half of the step before,

    s_n ≈ Q_n − (Δt/2) w_(n−1) = s_n + (Δt²/4) a_n + O(Δt⁴),

whose terms in Δt³, dampers of either sign, cancel, in any network of contacts. With Verlet's own error, Δt²/12 the
other way, the swing of a single contact is too slow by a share (ω Δt)²/12, as of a spring softer by (ω Δt)²/6,
ω² = k/m_t; the spring is taken `stiffer` by so much (backward error analysis: Hairer, Lubich and Wanner 2006, IX).
Symplectic Euler's velocities are those of the half step before the positions: its Q_n is s_n, nothing is taken back
(`ahead` = 0), and what is left is Verlet's error. Gear's are those of the positions to higher order: the rule's error
is then (Δt²/2) a_n.
"""

import taichi as ti

M_T = 2.0 / 7.0  # of m_eff: what resists a slip of spheres
STIFFEST = 0.1  # share of its stiffness; (ω Δt)²/6 reaches it far beyond all steps that results bear


@ti.pyfunc
def stiffening(stiffer, mass, step):
    """The share (m/N) of its stiffness by which a spring on a contact of m_eff (kg) is stiffer at a step (s)."""
    return stiffer * step * step / (M_T * mass)
