"""What a peer code is asked to do with water, and what it gives back."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Pool:
    """Particles of water in a closed rectangular tank, and the time that a peer is to follow them for.

    position, velocity: (n, 2) centres (y, z) in m and m/s; the floor is z = 0, the walls are y = ± width / 2.
    pressure, mass: (n,) in Pa and kg per metre of the tank's length; a peer whose masses are equal takes their mean.
    width, height: inner size of the tank (m).
    spacing, smoothing: Δx (m) and h/Δx.
    density, sound_speed: ρ0 (kg/m³) and c0 (m/s).
    alpha, delta: strength of artificial viscosity and of the diffusion of density.
    seconds, every: how long (s), and after what time (s) the particles are written.
    """

    position: np.ndarray
    velocity: np.ndarray
    pressure: np.ndarray
    mass: np.ndarray
    width: float
    height: float
    spacing: float
    sound_speed: float
    seconds: float
    every: float
    smoothing: float = 2.0
    density: float = 1000.0
    alpha: float = 0.01
    delta: float = 0.1
    gravity: float = 9.81
    threads: int = 1
    workdir: Path | None = None

    @property
    def length(self) -> float:
        """Smoothing length h (m)."""
        return self.smoothing * self.spacing

    @property
    def particle_mass(self) -> float:
        """Mean mass of the particles (kg/m)."""
        return float(np.mean(self.mass))


@dataclass(frozen=True)
class Frame:
    """Particles at a time (s): (n, 2) places (m) and velocities (m/s), (n,) pressures (Pa)."""

    time: float
    position: np.ndarray
    velocity: np.ndarray
    pressure: np.ndarray


@dataclass(frozen=True)
class PoolRun:
    """What a code made of a pool: time of the stepping without set-up (s), steps, and frames, the last at the end.

    `loop_s` is wall time, `busy_s` that of the processor, over all threads; `seconds` the physical time of the steps.
    """

    loop_s: float
    busy_s: float
    steps: int
    seconds: float
    particles: int
    frames: list[Frame]


def tait_density(pool: Pool, exponent: float) -> np.ndarray:
    """Densities (n,) whose pressures are the pool's by p = ρ0 c0²/γ ((ρ/ρ0)^γ − 1) (Cole 1948)."""
    stiffness = pool.density * pool.sound_speed**2 / exponent
    return pool.density * (1.0 + pool.pressure / stiffness) ** (1.0 / exponent)


def tait_pressure(pool: Pool, density: np.ndarray, exponent: float) -> np.ndarray:
    """The pressures (Pa) of densities (kg/m³)."""
    return pool.density * pool.sound_speed**2 / exponent * ((density / pool.density) ** exponent - 1.0)


CALM = 0.1  # of √(g H): up to this speed walls start with the pressure of water at rest


def wall_densities(pool: Pool, points: np.ndarray) -> np.ndarray:
    """Densities (m,) at the start of wall particles at points (m, 2): of water at rest before them, if it is calm."""
    level = pool.position[:, 1].max() + 0.5 * pool.spacing
    fastest = np.linalg.norm(pool.velocity, axis=1).max()
    calm = fastest < CALM * np.sqrt(pool.gravity * level) and pool.pressure.max() > 0.0
    below = np.maximum(level - points[:, 1], 0.0) * pool.gravity / pool.sound_speed**2
    return pool.density * (1.0 + (below if calm else np.zeros(len(points))))


def wall_particles(pool: Pool, layers: int) -> tuple[np.ndarray, np.ndarray]:
    """Places (m, 2) of wall particles on the lattice of a tank's particles, and their nearest points on the walls."""
    dx, half = pool.spacing, 0.5 * pool.width
    columns, rows = round(pool.width / dx), round(pool.height / dx)
    y = -half + (np.arange(-layers, columns + layers) + 0.5) * dx
    z = (np.arange(-layers, rows + layers) + 0.5) * dx
    points = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)
    nearest = np.clip(points, [-half, 0.0], [half, rows * dx])
    outside = np.abs(points - nearest).max(axis=1) > 0.25 * dx
    return points[outside], nearest[outside]
