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
        """Move grain i by its linear (m/s²) and angular acceleration (rad/s²), lists, over dt (s)."""
        v = [g.velocity[a][w, i] + kick * acceleration[a] for a in ti.static(range(g.axes))]
        spin = [g.spin[k][w, i] + kick * turn[k] for k in ti.static(range(g.turns))]
        for a in ti.static(range(g.axes)):
            g.velocity[a][w, i] = v[a]
            g.place[a][w, i] = g.place[a][w, i] + dt * v[a]
            g.now[a][w, i] = v[a] + 0.5 * dt * acceleration[a]
        for k in ti.static(range(g.turns)):
            g.spin[k][w, i] = spin[k]
            g.angle[k][w, i] = g.angle[k][w, i] + dt * spin[k]
            g.spin_now[k][w, i] = spin[k] + 0.5 * dt * turn[k]
        return dot(v, v)
