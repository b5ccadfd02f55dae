"""Water in plain numpy: a step by double sums over all particles, without lists or blocks, in a tank that may move."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lab.studies.verify.plain import across, turned
from solvers.fluid.kernels.wendland_c2 import WendlandC2
from solvers.fluid.surface.void_indicator import PACKING, RAMP, plane
from solvers.fluid.walls.layers import layers
from solvers.scene import Scene


def kernel(distance: np.ndarray, length: float, axes: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """Wendland's C2 kernel as printed, W(r), and W'(r)/r by its derivative, in the plane or in space."""
    q = np.minimum(distance / length, 2.0)
    factor = 7.0 / (4.0 * np.pi * length**2) if axes == 2 else 21.0 / (16.0 * np.pi * length**3)
    value = factor * (1.0 - 0.5 * q) ** 4 * (2.0 * q + 1.0)
    slope = factor * (-2.0 * (1.0 - 0.5 * q) ** 3 * (2.0 * q + 1.0) + 2.0 * (1.0 - 0.5 * q) ** 4)
    return value, slope / (length * np.maximum(distance, 1e-12))


class PlainWater:
    """The equations of a box with free slip, linear state, Antuono's diffusion and artificial viscosity.

    `felt` (n, 2) m/s² is gravity less the acceleration of each wall particle, `speed` (n, 2) m/s its velocity: at rest
    here.
    """

    liquid: np.ndarray | float = 1.0  # 1 for water, 0 for air

    def __init__(self, scene: Scene):
        self.water, self.gravity = scene.fluid.water, np.array([0.0, -scene.gravity])
        rows = int(np.ceil(scene.fluid.water.reach / scene.fluid.water.spacing))
        self.wall, self.wall_volume, _ = layers(scene.outline, scene.fluid.water.spacing, rows)
        off = self.wall - np.clip(self.wall, scene.outline.min(axis=0), scene.outline.max(axis=0))  # of a box
        self.along = np.stack([-off[:, 1], off[:, 0]], axis=1) / np.linalg.norm(off, axis=1)[:, None]
        away = np.linalg.norm(self.wall[:, None] - scene.outline, axis=2).min(axis=1)
        self.straight = self.along * (away > 1.5 * scene.fluid.water.reach)[:, None]
        self.felt, self.speed = np.tile(self.gravity, (len(self.wall), 1)), np.zeros_like(self.wall)

    def volume(self, mass: np.ndarray, s: np.ndarray) -> np.ndarray:
        """V = m/ρ."""
        return mass / (self.water.density * (1.0 + s))

    def between(self, r: np.ndarray, others: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """r_j − r_i, its square, W and ∇_i W for all pairs."""
        apart = others[None] - r[:, None]
        square = (apart**2).sum(axis=2)
        value, slope = kernel(np.sqrt(square), self.water.length, r.shape[1])
        return apart, square, value, -slope[..., None] * apart

    def wall_pressure(self, r: np.ndarray, mass: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Adami, Hu & Adams (2012), eq. 27, weighted with volumes and without pull."""
        volume = self.volume(mass, s)
        apart, _, value, _ = self.between(self.wall, r)
        pressure = self.water.density * self.water.sound_speed**2 * s
        total = (volume * value).sum(axis=1)
        lever = -(apart * self.felt[:, None]).sum(axis=2) * mass + volume * pressure
        return np.where(total > 1e-6, np.maximum((value * lever).sum(axis=1), 0.0) / np.maximum(total, 1e-30), 0.0)

    def push(self, r, u, s, mass) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Accelerations without gravity, renormalised gradients of s, and the walls' forces on each particle."""
        water, volume = self.water, self.volume(mass, s)
        pressure = water.density * water.sound_speed**2 * s
        apart, square, _, gradient = self.between(r, r)
        pairs = -(pressure[:, None] + pressure[None]) * volume[:, None] * volume[None]
        pi = ((u[None] - u[:, None]) * apart).sum(axis=2) / (square + 1e-6 * water.length**2)
        viscous = water.alpha * water.length * water.sound_speed * water.density * volume[:, None] * volume[None] * pi
        force = ((pairs + viscous)[..., None] * gradient).sum(axis=1)
        _, _, _, at_wall = self.between(r, self.wall)
        push = np.maximum(pressure, 0.0)[:, None] + self.wall_pressure(r, mass, s)[None]
        walls = -((push * volume[:, None] * self.wall_volume[None])[..., None] * at_wall).sum(axis=1)
        walls += self.along_walls(r, mass, s)
        matrix = np.einsum("j,ija,ijb->iab", volume, apart, gradient)
        raw = np.einsum("j,ij,ija->ia", volume, s[None] - s[:, None], gradient)
        regular = np.linalg.eigvalsh(matrix)[:, 0] > 0.05
        slope = np.zeros_like(r)
        slope[regular] = np.linalg.solve(matrix[regular], raw[regular][..., None])[..., 0]
        return (force + walls) / mass[:, None], slope, walls

    def along_walls(self, r, mass, s) -> np.ndarray:
        """What is taken from that: wall particles' own pressures do not push along straight walls in sum."""
        volume = self.volume(mass, s) * self.liquid
        _, _, value, gradient = self.between(r, self.wall)
        seen = np.maximum(volume @ value, 1e-30)
        leans = (np.einsum("i,iwa->wa", volume, gradient) * self.straight).sum(axis=1) / seen
        strength = self.wall_volume * self.wall_pressure(r, mass, s) * leans
        return volume[:, None] * (value @ (strength[:, None] * self.straight))

    def closing(self, r, u, s, mass, pressed) -> np.ndarray:
        """Minus what wall particles that are `pressed` add to the divergence: the adjoint of their pressures' forces.

        They slide over the tank with the mean velocity of the water, square to the shortest line to the tank.
        """
        volume = self.volume(mass, s) * self.liquid
        _, _, value, gradient = self.between(r, self.wall)
        seen = volume @ value
        mean = (volume * value.T) @ u / np.maximum(seen, 1e-30)[:, None] - self.speed
        over = u[:, None] - self.speed - (mean * self.along).sum(axis=1, keepdims=True) * self.along
        closed = np.where(pressed & (seen > 0.0), volume @ (over * gradient).sum(axis=2), 0.0)
        return self.liquid * (value @ (self.wall_volume * closed / np.maximum(seen, 1e-30)))

    def void_indicator(
        self, r: np.ndarray, mass: np.ndarray, s: np.ndarray, plane: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Σ V (−W'/r) r²/D + b |Σ V ∇W| over water and walls, b being `plane` (m), and its second part alone."""
        both, volume = np.concatenate([r, self.wall]), np.append(self.volume(mass, s), self.wall_volume)
        apart, _, _, gradient = self.between(r, both)
        trace = (apart * gradient).sum(axis=2) @ volume
        lacking = plane * np.linalg.norm(np.einsum("j,ija->ia", volume, gradient), axis=1)
        return trace / r.shape[1] + lacking, lacking

    def keeping(self, fullness: np.ndarray, lacking: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Rate of s by which the density follows the room that is taken, in packed water away from the surface."""
        deep = np.where(fullness > 0.93, np.maximum(1.0 - lacking / 0.1, 0.0), 0.0)
        off = np.clip(self.over(fullness), -self.most(s), self.most(s))
        return 0.01 * self.water.delta * self.water.sound_speed / self.water.length * deep * (1.0 + s) * off

    def most(self, s: np.ndarray) -> np.ndarray:
        """The most that counts of what a fullness is off."""
        return 10.0 * np.abs(s)

    def over(self, fullness: np.ndarray) -> np.ndarray:
        """By what share a fullness is over that of a square lattice."""
        n = np.arange(-8.0, 9.0)
        apart = np.hypot(n[:, None], n[None]).ravel()
        lattice = -0.5 * (kernel(apart, self.water.smoothing)[1] * apart**2).sum()
        return fullness / lattice - 1.0

    def rate(self, r, u, s, mass, slope, pressed) -> np.ndarray:
        """Rate of s, in the middle of a step at whose start wall particles were `pressed`."""
        water, volume = self.water, self.volume(mass, s)
        apart, _, _, gradient = self.between(r, r)
        flow = ((u[None] - u[:, None]) * gradient).sum(axis=2) @ volume
        _, _, _, at_wall = self.between(r, self.wall)
        flow += ((self.speed - u[:, None]) * at_wall).sum(axis=2) @ self.wall_volume
        flow -= self.closing(r, u, s, mass, pressed)
        more = 2.0 * (s[None] - s[:, None]) - ((slope[:, None] + slope[None]) * apart).sum(axis=2)
        eta = -kernel(np.linalg.norm(apart, axis=2), water.length, r.shape[1])[1]
        return -(1.0 + s) * flow + water.delta * water.length * water.sound_speed * (more * eta) @ volume


@dataclass(frozen=True)
class Pose:
    """Where a tank is over the earth: its origin (2,) m and angle (rad), and their rates and accelerations."""

    origin: np.ndarray
    angle: float
    velocity: np.ndarray
    rate: float
    acceleration: np.ndarray
    gain: float

    def places(self, inside: np.ndarray) -> np.ndarray:
        """Points (n, 2) m of the tank over the earth."""
        return self.origin + turned(inside, self.angle)


class EarthWater(PlainWater):
    """The same over the earth, in the earth's axes: the walls move there, as `pose(t)` says."""

    def __init__(self, scene: Scene, pose: Callable[[float], Pose]):
        super().__init__(scene)
        self.pose, self.inside = pose, (self.wall, self.along, self.straight)
        self.plane = plane(WendlandC2) * scene.fluid.water.length

    def stand(self, time: float) -> None:
        """Put the walls where they are at a time (s)."""
        pose, (wall, along, straight) = self.pose(time), self.inside
        arm = turned(wall, pose.angle)
        self.wall = pose.origin + arm
        self.along, self.straight = turned(along, pose.angle), turned(straight, pose.angle)
        self.speed = pose.velocity + pose.rate * across(arm)
        self.felt = self.gravity - (pose.acceleration + pose.gain * across(arm) - pose.rate**2 * arm)

    def step(self, r, u, s, mass, time: float, dt: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Places, velocities, half a step behind, and density deviations a step of dt (s) after a time (s)."""
        self.stand(time)
        push, slope, _ = self.push(r, u, s, mass)
        pressed = self.wall_pressure(r, mass, s) > 0.0
        full, lacking = self.void_indicator(r, mass, s, self.plane)
        u = u + dt * (push + self.gravity)
        middle = r + 0.5 * dt * u
        self.stand(time + 0.5 * dt)
        s = s + dt * (self.rate(middle, u, s, mass, slope, pressed) + self.keeping(full, lacking, s))
        relief = self.water.sound_speed / self.water.length * np.clip((PACKING - full) / RAMP, 0.0, 1.0)
        return middle + 0.5 * dt * u, u, s / (1.0 + dt * relief)
