"""Grains in water, for tests: small tanks, and what the laws of drag say of them."""

from dataclasses import replace

import numpy as np

from solvers.fluid.given import Fluid, Water, particles
from solvers.fluid.timestep import longest_pace
from solvers.mixture.given import Mixture
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

DIAMETER, SPACING, GLASS = 4e-3, 8e-3, 2500.0  # m, m, kg/m³


def rows(columns: int, lines: int, gap: float, lowest: float) -> np.ndarray:
    """Places (1, n, 2) m of grains in a grid `gap` diameters apart, a little off their places, from a height on."""
    y = (np.arange(columns) - 0.5 * (columns - 1)) * gap * DIAMETER
    z = lowest + np.arange(lines) * gap * DIAMETER
    place = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)
    place[:, 0] += np.random.default_rng(0).uniform(-0.02, 0.02, len(place)) * DIAMETER
    return place[None]


def soaked(place: np.ndarray, width: float, height: float, level: float, count: int, **changes) -> Simulation:
    """A tank with grains at `place` (1, n, 2) m and so many particles of water up to a `level` (m)."""
    drops = particles(1, count)
    drops["volume"][0] = SPACING**2
    of_water = {"sound_speed": 10.0, "alpha": 0.02} | changes.pop("water", {})
    units = changes.pop("units", 1)
    mixture = Mixture(**{"level": level} | changes.pop("mixture", {}))
    glass = material(density=GLASS)
    scene = scene_of(
        np.full(place.shape[:2], 0.5 * DIAMETER), box(width, height), glass, glass, mixture=mixture,
        fluid=Fluid(Water(SPACING, **of_water), drops), thickness=DIAMETER, stiffness_scale=1e-3, **changes,
    )  # fmt: skip
    step = scene.time_step()
    scene = scene.holding(replace(scene.fluid, substeps=longest_pace(scene, step)), step=step)
    return Simulation(
        replace(scene, schedule="per-band" if units > 1 else "per-world"), place, units, arch="cpu", units=units
    )


def di_felice(speed: float, porosity: float, size: float = DIAMETER) -> float:
    """The drag of Di Felice (1994) per volume of grains and speed, kg/(m³ s), as the law is usually written."""
    density, viscosity = 1000.0, 1e-3
    reynolds = density * size * porosity * speed / viscosity
    coefficient = (0.63 + 4.8 / np.sqrt(reynolds)) ** 2
    power = 3.7 - 0.65 * np.exp(-0.5 * (1.5 - np.log10(reynolds)) ** 2)
    force = coefficient * np.pi / 8.0 * density * size**2 * (porosity * speed) ** 2 * porosity**-power
    return force / (np.pi / 6.0 * size**3) / speed


def speed_between(driven: float, porosity: float, size: float = DIAMETER) -> float:
    """The speed (m/s) between water and grains at which drag balances a force per volume of grains (N/m³)."""
    low, high = 1e-6, 10.0
    for _ in range(100):
        middle = np.sqrt(low * high)
        low, high = (middle, high) if di_felice(middle, porosity, size) * middle < driven else (low, middle)
    return low


def fixed_bed(width: float, height: float, size: float, share: float) -> np.ndarray:
    """Fixed grains (n, 3): y, z, radius in m, of a `size` (m) that fill a share of a tank, as a shaken crystal."""
    apart = size * np.sqrt(np.pi / (2.0 * np.sqrt(3.0) * share))
    columns = round(width / apart)
    apart = width / columns
    random, lines = np.random.default_rng(1), int((height - 0.5 * size) / (0.5 * np.sqrt(3.0) * apart)) + 1
    place = np.array(
        [
            [(k + 0.25 + 0.5 * (line % 2)) * apart - 0.5 * width, 0.5 * size + line * 0.5 * np.sqrt(3.0) * apart]
            for line in range(lines)
            for k in range(columns)
        ]
    )
    place += random.uniform(-0.15, 0.15, place.shape) * (apart - 0.8 * size)
    place[:, 0] = (place[:, 0] + 0.5 * width) % width - 0.5 * width
    return np.column_stack([place, np.full(len(place), 0.5 * size)])
