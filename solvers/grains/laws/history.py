"""Springs with contact history: the slip distance at the time of the positions, to second order in the step.

Contacts see velocities that the integrator predicts for the time of the positions: w_n = u_(n−1/2) + (Δt/2) a_(n−1) in
Verlet's scheme. The sum Q_n = Δt Σ w_j leads the true distance s_n by half a step, Q_n = s_n + (Δt/2) u + O(Δt²). A
spring that follows Q_n acts as a spring and a damper k Δt/2, which at 36 steps a collision takes a tenth of an undamped
oscillation. Here it follows Q_n less half of the previous step,

    s_n ≈ Q_n − (Δt/2) w_(n−1) = s_n + (Δt²/4) a_n + O(Δt⁴),

whose terms in Δt³, dampers of either sign, cancel, in any network of contacts. With Verlet's own error, Δt²/12 the
other way, the oscillation of a single contact is too slow by a share (ω Δt)²/12, like that of a spring softer by
(ω Δt)²/6, ω² = k/m_t; the spring is made `stiffer` by as much (backward error analysis: Hairer, Lubich and Wanner 2006,
IX). Symplectic Euler's velocities are those half a step before the positions: its Q_n is s_n, nothing is subtracted
(`ahead` = 0), and Verlet's error is left. Gear's velocities are those of the positions to higher order: the error of
the rule is then (Δt²/2) a_n.
"""

import taichi as ti

M_T = 2.0 / 7.0  # of m_eff: effective mass against slip of spheres
STIFFEST = 0.1  # largest relative stiffening; (ω Δt)²/6 reaches it only at steps far too long for valid results


@ti.pyfunc
def stiffening(stiffer, mass, step):
    """Relative stiffening per unit of stiffness (m/N) of a spring in a contact of m_eff (kg) at a step (s)."""
    return stiffer * step * step / (M_T * mass)
