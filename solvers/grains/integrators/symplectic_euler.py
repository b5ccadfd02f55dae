"""Symplectic (semi-implicit) Euler."""

import taichi as ti

from solvers.space.axes import dot


@ti.data_oriented
class SymplecticEuler:
    """v_(n+1) = v_n + Δt a_n, r_(n+1) = r_n + Δt v_(n+1) (Hairer, Lubich and Wanner 2006, I.1.9).

    Kick by a whole step, drift with the new velocity.

    Limits: first order. The losses of a contact are of first order in the step, too: at the derived step a restitution
    of 0.1 is off by 1.5 %, one of 0.4 by 1 %, and one of 0.8 or more by at most 0.1 %.

    Units: r m, v m/s, a m/s², Δt s.
    """

    extra, reach, damping, bearing = 0, 1.0, 1.0, 1.0
    ahead, stiffer, late = 0.0, -1.0 / 12.0, 0.0

    @ti.func
    def step(self, g: ti.template(), extra: ti.template(), w, i, acceleration: ti.template(), turn, kick, dt):
        """Move grain i by its linear (m/s²) and angular acceleration (rad/s²), lists, over dt (s)."""
        v = [g.velocity[a][w, i] + dt * acceleration[a] for a in ti.static(range(g.axes))]
        spin = [g.spin[k][w, i] + dt * turn[k] for k in ti.static(range(g.turns))]
        for a in ti.static(range(g.axes)):
            g.velocity[a][w, i], g.now[a][w, i] = v[a], v[a]
            g.place[a][w, i] = g.place[a][w, i] + dt * v[a]
        for k in ti.static(range(g.turns)):
            g.spin[k][w, i], g.spin_now[k][w, i] = spin[k], spin[k]
            g.angle[k][w, i] = g.angle[k][w, i] + dt * spin[k]
        return dot(v, v)
