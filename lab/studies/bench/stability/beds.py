"""The parts of the cases: materials, tanks, and grains at their start."""

from math import ceil

import numpy as np

from lab.studies.bench.stability.trial import Trial
from solvers.grains.bed.filling import SPACING, radii, start_positions
from solvers.grains.materials import Material
from solvers.scene import Scene

G = 9.81  # m/s²
RADIUS = 1.5e-3  # m, where nothing else is said
SPREAD = 0.1  # of the diameters, each way
# Spandonidis (2016), tables 5.1 (C) and 5.2; the restitution is our choice.
GOLD_ORE = Material(density=17800.0, young=3.2e9, poisson=0.28, friction=0.25, restitution=0.6)
ACETATE = Material(density=1319.0, young=3.2e9, poisson=0.28, friction=0.25, restitution=0.6)


def tank(width: float, height: float) -> np.ndarray:
    """Outline (4, 2) m of a closed tank, its floor centred on the origin."""
    half = 0.5 * width
    return np.array([[-half, 0.0], [half, 0.0], [half, height], [-half, height]])


def bed(
    count: int,
    duration: float,
    material: Material = ACETATE,
    diameter: float = 2.0 * RADIUS,
    across: int = 10,
    looks: int = 200,
    **scene: object,
) -> Trial:
    """Grains let go of on a loose lattice `across` grains wide (`start_positions`), in a tank twice as high as that."""
    random = np.random.default_rng(1)
    radius = radii(count, diameter, SPREAD, random)
    pitch = SPACING * diameter * (1.0 + SPREAD)
    outline = tank((across + 0.5) * pitch, 2.0 * ceil(count / across) * pitch)
    position = start_positions(radius, outline, random)
    return Trial(Scene(radius, outline, material, material, **scene), position, duration, looks=looks)


def square(columns: int, rows: int, pitch: float) -> np.ndarray:
    """Places (n, 2) m on a square lattice centred on y = 0, the lowest at half a pitch."""
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"))
    return pitch * np.column_stack([column - 0.5 * (columns - 1), row + 0.5])


def hexagonal(columns: int, rows: int, radius: float) -> np.ndarray:
    """Places (n, 2) m of touching equal grains in hexagonal rows upon z = 0, centred on y = 0."""
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"))
    y = radius * (2.0 * column + row % 2 - columns + 0.5)
    return np.column_stack([y, radius * (1.0 + np.sqrt(3.0) * row)])
