"""Velocity Verlet in its leapfrog form."""

import taichi as ti


@ti.data_oriented
class Verlet:
    """Kick, then drift, with velocities half a step behind the positions (Hairer, Lubich and Wanner 2003, eq. 1.5).

    The very first kick is half a step, and where the step changes the mean of both. Second order. What forces see of
    the velocity at the positions' own time is predicted with the last acceleration.
    """

    extra, reach, damping = 0, 1.0, 1.0
    ahead, stiffer = 0.5, 1.0 / 6.0

    @ti.func
    def step(self, g: ti.template(), extra: ti.template(), w, i, ay, az, turn, kick, dt):
        """Move grain i by its acceleration (m/s²) and angular acceleration (rad/s²) over dt (s)."""
        vy = g.velocity_y[w, i] + kick * ay
        vz = g.velocity_z[w, i] + kick * az
        spin = g.spin[w, i] + kick * turn
        g.velocity_y[w, i], g.velocity_z[w, i], g.spin[w, i] = vy, vz, spin
        g.y[w, i] = g.y[w, i] + dt * vy
        g.z[w, i] = g.z[w, i] + dt * vz
        g.angle[w, i] = g.angle[w, i] + dt * spin
        g.now_y[w, i] = vy + 0.5 * dt * ay
        g.now_z[w, i] = vz + 0.5 * dt * az
        g.spin_now[w, i] = spin + 0.5 * dt * turn
        return vy * vy + vz * vz
