"""Gear's predictor–corrector of fifth order, the source's scheme (Spandonidis 2016, appendix B)."""

import taichi as ti

from solvers.space.axes import dot

# Corrector coefficients of the six-value scheme for second-order equations with velocity-dependent forces (Gear 1971;
# Allen and Tildesley 1987, table E.1), for the scaled derivatives q_k = Δt^k/k! d^k r/dt^k.
C0, C1, C3, C4, C5 = 3.0 / 16.0, 251.0 / 360.0, 11.0 / 18.0, 1.0 / 6.0, 1.0 / 60.0
DERIVATIVES = 4  # kept beyond position and velocity


@ti.data_oriented
class Gear:
    """q_k ← q_k + C_k (r̈ Δt²/2 − q_2), q_k = (Δt^k/k!) d^k r/dt^k (Gear 1971; Spandonidis 2016, appendix B).

    Between steps the arrays hold the prediction, at which forces are computed for the correction. The source writes Δr̈
    Δt²/2 for the correction (its eq. B.4), which is Δq_2 here. The first step only sets the acceleration; higher
    derivatives start at zero.

    Limits: fifth order for smooth forces, which a contact that begins or ends within a step is not. Stable for
    ω Δt < 0.47 with a spring and γ Δt/m < 0.164 with a damper (spectral radius of the step), where Verlet with
    predicted velocities reaches 2 and 1.

    Units: r and all q_k m or rad, r̈ m/s² or rad/s², Δt s, C_k pure numbers.
    """

    extra, reach, damping, bearing = DERIVATIVES, 0.25, 0.15, 0.8
    ahead, stiffer, late = 0.5, 1.0 / 3.0, 0.0

    @ti.func
    def step(self, g: ti.template(), extra: ti.template(), w, i, acceleration: ti.template(), turn, kick, dt):
        """Correct grain i by its linear (m/s²) and angular acceleration (rad/s²), lists; predict it dt (s) later."""
        half, first = 0.5 * dt * dt, kick < dt
        way = [
            self.along(extra, a, w, i, g.velocity[a][w, i] * dt, half * acceleration[a], first)
            for a in ti.static(range(g.axes))
        ]
        turned = [
            self.along(extra, g.axes + k, w, i, g.spin[k][w, i] * dt, half * turn[k], first)
            for k in ti.static(range(g.turns))
        ]
        v = [way[a][1] / dt for a in ti.static(range(g.axes))]
        for a in ti.static(range(g.axes)):
            g.place[a][w, i] = g.place[a][w, i] + way[a][0]
            g.velocity[a][w, i], g.now[a][w, i] = v[a], v[a]
        for k in ti.static(range(g.turns)):
            spin = turned[k][1] / dt
            g.angle[k][w, i] = g.angle[k][w, i] + turned[k][0]
            g.spin[k][w, i], g.spin_now[k][w, i] = spin, spin
        return dot(v, v)

    @ti.func
    def along(self, extra: ti.template(), axis: ti.template(), w, i, q1, bend, first):
        """One coordinate, the angles after the axes: its change and the next q_1, from q_1 and q_2 = Δt²/2 r̈ now."""
        k = ti.static(axis * DERIVATIVES)
        q2, q3, q4, q5 = extra[k][w, i], extra[k + 1][w, i], extra[k + 2][w, i], extra[k + 3][w, i]
        miss = bend - q2
        learnt = ti.select(first, 0.0, miss)
        q1 += C1 * learnt
        q2 += miss
        q3 += C3 * learnt
        q4 += C4 * learnt
        q5 += C5 * learnt
        extra[k][w, i] = q2 + 3.0 * q3 + 6.0 * q4 + 10.0 * q5
        extra[k + 1][w, i] = q3 + 4.0 * q4 + 10.0 * q5
        extra[k + 2][w, i] = q4 + 5.0 * q5
        extra[k + 3][w, i] = q5
        return ti.Vector([C0 * learnt + q1 + q2 + q3 + q4 + q5, q1 + 2.0 * q2 + 3.0 * q3 + 4.0 * q4 + 5.0 * q5])
