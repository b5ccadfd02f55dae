"""Velocity Verlet in its leapfrog form."""

import taichi as ti

from solvers.space.axes import dot


@ti.data_oriented
class Verlet:
    """v_(n+½) = v_(n−½) + Δt a_n, r_(n+1) = r_n + Δt v_(n+½) (Hairer, Lubich and Wanner 2003, eq. 1.5).

    Kick, then drift, with velocities half a step behind the positions. The first kick is half a step; where the step
    changes, the kick is the mean of both steps. Second order. The forces use a velocity at the time of the positions,
    predicted with the last acceleration.

    Limits: stable for ω Δt < 2 with a spring and γ Δt/m < 1 with a damper.

    Units: r m, v m/s, a m/s², Δt s.
    """

    extra, reach, damping, bearing = 0, 1.0, 1.0, 1.0
    ahead, stiffer, late = 0.5, -1.0 / 12.0, 0.5

    @ti.func
    def step(self, g: ti.template(), extra: ti.template(), w, i, acceleration: ti.template(), turn, kick, dt):
        """Move grain i by its acceleration (m/s²) and angular acceleration (rad/s²) over dt (s)."""
        v = [g.velocity[a][w, i] + kick * acceleration[a] for a in ti.static(range(g.axes))]
        spin = g.spin[w, i] + kick * turn
        for a in ti.static(range(g.axes)):
            g.velocity[a][w, i] = v[a]
            g.place[a][w, i] = g.place[a][w, i] + dt * v[a]
            g.now[a][w, i] = v[a] + 0.5 * dt * acceleration[a]
        g.spin[w, i] = spin
        g.angle[w, i] = g.angle[w, i] + dt * spin
        g.spin_now[w, i] = spin + 0.5 * dt * turn
        return dot(v, v)
