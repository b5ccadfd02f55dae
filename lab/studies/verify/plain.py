"""An independent discrete element method in plain arrays: all pairs checked, walls that move in the earth frame."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from lab.studies.verify.references import sphere_mass
from lab.studies.verify.scenes import G

# Origin (2,) m and angle (rad) of the tank, and their rates.
Pose = tuple[np.ndarray, float, np.ndarray, float]


def turned(vectors: np.ndarray, angle: float) -> np.ndarray:
    """Vectors (…, 2) turned counter-clockwise by an angle (rad)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * vectors[..., 0] - s * vectors[..., 1], s * vectors[..., 0] + c * vectors[..., 1]], axis=-1)


def across(vectors: np.ndarray) -> np.ndarray:
    """Vectors (…, 2) turned by a right angle, counter-clockwise."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)


@dataclass(frozen=True)
class Tank:
    """Grains of radii (n,) m of one material in a box, floor centred on its origin, that moves as `pose(t)` says.

    Normal force: viscoelastic Hertz. Tangential: Haff and Werner's damper, small enough for the step. `material` holds
    Young's modulus, Poisson ratio, density, friction, dissipative_time and shear_damping, walls the same.
    """

    radius: np.ndarray
    material: Mapping[str, float]
    width: float
    height: float
    pose: Callable[[float], Pose]

    @property
    def mass(self) -> np.ndarray:
        """Masses (n,) kg."""
        return sphere_mass(self.radius, self.material["density"])

    def law(self, size: np.ndarray, overlap: np.ndarray, rate: np.ndarray, slip: np.ndarray) -> tuple[np.ndarray, ...]:
        """Normal and tangential forces (N) of contacts of effective radii `size`, of whatever shape."""
        m = self.material
        touching = np.sqrt(np.maximum(overlap, 0.0))
        modulus = m["young"] / (2.0 * (1.0 - m["poisson"] ** 2))
        pressing = 4.0 / 3.0 * modulus * np.sqrt(size) * touching * (overlap + 1.5 * m["dissipative_time"] * rate)
        pressing = np.maximum(pressing, 0.0) * (overlap > 0.0)
        return pressing, -np.clip(m["shear_damping"] * slip, -m["friction"] * pressing, m["friction"] * pressing)

    def accelerations(self, t: float, x: np.ndarray, v: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of grains at x (n, 2) with velocities v and spins (n,), in the earth frame: (n, 2) m/s² and (n,) rad/s²."""
        force, torque = self.between(x, v, spin)
        at_walls, turning = self.at_walls(t, x, v, spin)
        inertia = 0.4 * self.mass * self.radius**2
        return (force + at_walls) / self.mass[:, None] - [0.0, G], (torque + turning) / inertia

    def between(self, x: np.ndarray, v: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Forces (n, 2) N and torques (n,) N m of each grain (row) by every other one (column)."""
        apart, r = x[:, None] - x, self.radius
        distance = np.linalg.norm(apart, axis=-1) + np.eye(len(x))
        normal = apart / distance[..., None]
        overlap = r[:, None] + r - distance - 1e3 * np.eye(len(x))
        lever = r[:, None] - overlap * r / (r[:, None] + r)
        moving = v[:, None] - v
        slip = (moving * across(normal)).sum(-1) - lever * spin[:, None] - lever.T * spin
        size = r[:, None] * r / (r[:, None] + r)
        pressing, shearing = self.law(size, overlap, -(moving * normal).sum(-1), slip)
        force = pressing[..., None] * normal + shearing[..., None] * across(normal)
        return force.sum(axis=1), -(lever * shearing).sum(axis=1)

    def at_walls(self, t: float, x: np.ndarray, v: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The same by the floor, the lid and the sides (columns)."""
        origin, angle, velocity, rate = self.pose(t)
        half = 0.5 * self.width
        points = origin + turned(np.array([[0.0, 0.0], [0.0, self.height], [-half, 0.0], [half, 0.0]]), angle)
        normal = turned(np.array([[0.0, 1.0], [0.0, -1.0], [1.0, 0.0], [-1.0, 0.0]]), angle)
        overlap = self.radius[:, None] - ((x[:, None] - points) * normal).sum(-1)
        lever = self.radius[:, None] - 0.5 * overlap
        touched = x[:, None] - lever[..., None] * normal
        moving = v[:, None] - velocity - rate * across(touched - origin)
        slip = (moving * across(normal)).sum(-1) - lever * spin[:, None]
        pressing, shearing = self.law(self.radius[:, None], overlap, -(moving * normal).sum(-1), slip)
        force = pressing[..., None] * normal + shearing[..., None] * across(normal)
        return force.sum(axis=1), -(lever * shearing).sum(axis=1)

    def run(self, start: np.ndarray, step: float, steps: int) -> tuple[np.ndarray, ...]:
        """Places (n, 2) m, velocities (m/s), angles (rad) and spins (rad/s) in the tank's frame, from rest in it.

        By velocity Verlet, velocities predicted for the forces.
        """
        origin, angle, velocity, rate = self.pose(0.0)
        x = origin + turned(start, angle)
        v = velocity + rate * across(x - origin)
        spin, turn = np.full(len(x), rate), np.full(len(x), angle)
        a, spin_up = self.accelerations(0.0, x, v, spin)
        for k in range(1, steps + 1):
            half_v, half_spin = v + 0.5 * step * a, spin + 0.5 * step * spin_up
            x, turn = x + step * half_v, turn + step * half_spin
            a, spin_up = self.accelerations(k * step, x, half_v + 0.5 * step * a, half_spin + 0.5 * step * spin_up)
            v, spin = half_v + 0.5 * step * a, half_spin + 0.5 * step * spin_up
        origin, angle, velocity, rate = self.pose(steps * step)
        seen = v - velocity - rate * across(x - origin)
        return turned(x - origin, -angle), turned(seen, -angle), turn - angle, spin - rate
