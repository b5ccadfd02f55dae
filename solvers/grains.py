"""The grains: what is known of each of n discs in each of W worlds."""

import numpy as np
import taichi as ti

from solvers.runtime import Arrays

FAR = 1e3  # m


def _with_ghost(values: np.ndarray, ghost: float = 0.0) -> np.ndarray:
    """Grain values (W, n) with the ghost's appended."""
    return np.pad(np.asarray(values, dtype=np.float64), ((0, 0), (0, 1)), constant_values=ghost)


@ti.data_oriented
class Grains:
    """Arrays (W, n), SI, in the tank's frame. A disc has the mass and inertia of the sphere it stands for.

    Leapfrog keeps `velocity` and `spin` half a step behind the positions; `*_now` are their values at the positions'
    own time, predicted with the last acceleration, for forces that depend on velocity.
    """

    def __init__(self, arrays: Arrays, radius: np.ndarray, density: float):
        self.worlds, self.count = radius.shape
        self.ghost = self.count  # index of a point far off, for pairs that stand for none
        shape = (self.worlds, self.count + 1)
        self.y, self.z, self.angle = arrays.reals(3, shape)
        self.velocity_y, self.velocity_z, self.spin = arrays.reals(3, shape)
        self.now_y, self.now_z, self.spin_now = arrays.reals(3, shape)
        self.force_y, self.force_z, self.torque = arrays.reals(3, shape)
        self.mass = 4.0 / 3.0 * np.pi * radius**3 * density
        self.radius = arrays.holding(_with_ghost(radius))
        self.inverse_mass = arrays.holding(_with_ghost(1.0 / self.mass))
        self.inverse_inertia = arrays.holding(_with_ghost(2.5 / (self.mass * radius**2)))

    def place(self, position: np.ndarray) -> None:
        """Put the grains at `position` (W, n, 2) m, at rest and without history."""
        self.y.from_numpy(_with_ghost(position[..., 0], FAR))
        self.z.from_numpy(_with_ghost(position[..., 1], FAR))
        self.angle.fill(0.0)
        self.launch(np.zeros_like(position), np.zeros(position.shape[:2]))

    def launch(self, velocity: np.ndarray, spin: np.ndarray) -> None:
        """Set the velocities (W, n, 2) m/s and spins (W, n) rad/s."""
        for fields, values in (
            ((self.velocity_y, self.now_y), velocity[..., 0]),
            ((self.velocity_z, self.now_z), velocity[..., 1]),
            ((self.spin, self.spin_now), spin),
        ):
            for field in fields:
                field.from_numpy(_with_ghost(values))
        for field in (self.force_y, self.force_z, self.torque):
            field.fill(0.0)

    def read(self) -> dict[str, np.ndarray]:
        """Positions (W, n, 2), velocities (W, n, 2), angles (W, n) and spins (W, n) at the present time."""
        fields = self.y, self.z, self.now_y, self.now_z, self.angle, self.spin_now
        y, z, velocity_y, velocity_z, angle, spin = (field.to_numpy()[:, : self.count] for field in fields)
        return {
            "position": np.stack([y, z], axis=-1),
            "velocity": np.stack([velocity_y, velocity_z], axis=-1),
            "angle": angle,
            "spin": spin,
        }

    @ti.func
    def push(self, w, i, force_y, force_z, torque):
        """Add a force (N) and a torque (N m) on grain i. Written out, since Taichi takes `+=` on a field as atomic."""
        self.force_y[w, i] = self.force_y[w, i] + force_y
        self.force_z[w, i] = self.force_z[w, i] + force_z
        self.torque[w, i] = self.torque[w, i] + torque

    @ti.func
    def kick_and_drift(self, w, body, rotating: ti.template(), kick, dt):
        """Leapfrog form of velocity Verlet (Hairer, Lubich and Wanner 2003): kick by `kick`, drift by `dt` (s).

        `body` = (b_y, b_z, φ̇, φ̈) is the tank's motion; in its frame a grain feels b − φ̈ × r + φ̇² r − 2 φ̇ × u and
        its spin changes by −φ̈. Forces are cleared.

        Returns a bound on the speeds (m/s), their 16-norm: at most n^(1/16) times the largest (1.6 for 2000 grains),
        and NaN or huge where the state is bad. The compiler turns the loop into SIMD instructions with a sum in it, but
        not with a largest value.
        """
        total = 0.0
        for i in range(self.count):
            m, j = self.inverse_mass[w, i], self.inverse_inertia[w, i]
            ay = self.force_y[w, i] * m + body[0]
            az = self.force_z[w, i] * m + body[1]
            turn = self.torque[w, i] * j
            if ti.static(rotating):
                rate, y, z = body[2], self.y[w, i], self.z[w, i]
                ay += body[3] * z + rate * (rate * y + 2.0 * self.now_z[w, i])
                az += -body[3] * y + rate * (rate * z - 2.0 * self.now_y[w, i])
                turn -= body[3]
            vy = self.velocity_y[w, i] + kick * ay
            vz = self.velocity_z[w, i] + kick * az
            spin = self.spin[w, i] + kick * turn
            self.velocity_y[w, i], self.velocity_z[w, i], self.spin[w, i] = vy, vz, spin
            self.y[w, i] = self.y[w, i] + dt * vy
            self.z[w, i] = self.z[w, i] + dt * vz
            self.angle[w, i] = self.angle[w, i] + dt * spin
            self.now_y[w, i] = vy + 0.5 * dt * ay
            self.now_z[w, i] = vz + 0.5 * dt * az
            self.spin_now[w, i] = spin + 0.5 * dt * turn
            self.force_y[w, i], self.force_z[w, i], self.torque[w, i] = 0.0, 0.0, 0.0
            square = vy * vy + vz * vz
            fourth = square * square
            eighth = fourth * fourth
            total += eighth * eighth
        return ti.sqrt(ti.sqrt(ti.sqrt(ti.sqrt(total))))
