"""Springs with contact history: the slip distance at the time of the positions, as the integrator has gone it.

Contacts see velocities that the integrator predicts for the time of the positions. In Verlet's scheme they are

    w_n = u_(n−1/2) + (Δt/2) a_(n−1) = (3 u_(n−1/2) − u_(n−3/2))/2,

and what the surfaces have slipped in the step that ended is Δt u_(n−1/2). It follows from w_n and its own value of the
step before: u_(n−1/2) = (w_n + α u_(n−3/2))/(1 + α), α = 1/2 (`ahead`). An error of it falls to a third with each
step. So the spring's distance is that of the leapfrog, s_n = s_(n−1) + Δt u_(n−1/2): the spring has a potential, and
is stable for ω Δt < 2, ω² = k/m_t, as one between positions is. (The sum of Δt w_j leads s_n by half a step. Followed
as it is, it is a spring and a damper k Δt/2, which at 36 steps a collision takes a tenth of an undamped oscillation;
less half of the previous w, it is of second order, but stable for ω Δt < 1 only.)

The leapfrog's oscillation of a single contact is too fast by a share (ω Δt)²/24, like that of a spring stiffer by
(ω Δt)²/12; the spring is made softer by as much, `stiffer` = −1/12 (backward error analysis: Hairer, Lubich and Wanner
2006, IX). Symplectic Euler's velocities are those half a step before the positions, α = 0. Gear's are those of the
positions to higher order: with α = 1/2 the distance is then s_n + (Δt²/3) a_n, that of a spring softer by (ω Δt)²/3.
"""

import taichi as ti

M_T = 2.0 / 7.0  # of m_eff: effective mass against slip of spheres
STIFFEST = 0.1  # largest relative change of a spring: more only at steps far too long for valid results


@ti.pyfunc
def stiffening(stiffer, mass, step):
    """Relative stiffening per unit of stiffness (m/N) of a spring in a contact of m_eff (kg) at a step (s)."""
    return stiffer * step * step / (M_T * mass)
