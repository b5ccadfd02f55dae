"""Water at rest as a lattice of particles under hydrostatic pressure."""

import numpy as np

from solvers.fluid.given import EXCESS, VOLUME, Y, Z
from solvers.fluid.states.tait import GAMMA
from solvers.tank.outline import area_below, cut_off
from solvers.tank.tank import Tank

CLOSE = 0.25  # spacings: no particle starts nearer to a slanted wall
EXPONENTS = {"linear": 1, "tait": GAMMA}  # γ of the equations of state
NEAR = 1e-9  # of the spacing: rounding


def lattice(polygon: np.ndarray, level: float, spacing: float) -> tuple[np.ndarray, float]:
    """Places (n, 2) m of particles in a polygon (m, 2) up to a `level` (m), and the volume (m²) of each.

    The particles are half a spacing away from the floor and from the surface; the spacing should divide the depth. From
    side to side there is a whole number of columns, spread evenly: their distance is the spacing to within half of it
    over the whole width. A lattice with other gaps at the walls than within would start with a blow. Where walls are
    slanted, the lattice is cut off, and particles within CLOSE of a wall are left out. The volumes are equal, and their
    sum is exactly the polygon's area below the level.
    """
    corners = cut_off(polygon, level - polygon[:, 1].min())
    floor, (left, right) = corners[:, 1].min(), (corners[:, 0].min(), corners[:, 0].max())
    rows = max(1, round((level - floor) / spacing))
    columns = max(1, round((right - left) / spacing))
    y = left + (right - left) / columns * (np.arange(columns) + 0.5)
    z = floor + (level - floor) / rows * (np.arange(rows) + 0.5)
    points = np.stack(np.meshgrid(y, z), axis=-1).reshape(-1, 2)
    inside = Tank(polygon, 1.0).holds(points) & (from_edges(points, polygon) >= (CLOSE - NEAR) * spacing)
    points = points[inside]
    if not len(points):
        raise ValueError("no particle of this spacing fits in")
    return points, area_below(polygon, level - polygon[:, 1].min()) / len(points)


def from_edges(points: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Distances (n,) m of points (n, 2) from the nearest edge of a polygon (m, 2)."""
    nearest = np.full(len(points), np.inf)
    for begin, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        along = end - begin
        share = np.clip((points - begin) @ along / (along @ along), 0.0, 1.0)
        nearest = np.minimum(nearest, np.hypot(*(points - begin - share[:, None] * along).T))
    return nearest


def hydrostatic_excess(depth: np.ndarray, gravity: float, sound: float, state: str) -> np.ndarray:
    """Relative excess of density s = ρ/ρ0 − 1 of water at rest at depths (m) below its surface.

    dp/dz = −ρ g with p = ρ0 c0²/γ ((ρ/ρ0)^γ − 1) gives (ρ/ρ0)^(γ−1) = 1 + (γ − 1) g d/c0²; for the linear equation of
    state, γ = 1, ρ/ρ0 = exp(g d/c0²). Own derivation.
    """
    share, more = gravity * np.asarray(depth, dtype=float) / sound**2, EXPONENTS[state] - 1
    return np.expm1(np.log1p(more * share) / more) if more else np.expm1(share)


def at_rest(polygon: np.ndarray, level: float, water, gravity: float) -> np.ndarray:
    """The particles (n, 6) of a `given.Water` at rest in a polygon up to a level (m); columns as of `Scene.drops`.

    Each has the volume that it takes, so that its mass ρ0 (1 + s) V is that of the compressed water: with equal masses
    the level would sink by g H²/(2 c0²).
    """
    points, volume = lattice(polygon, level, water.spacing)
    drops = np.zeros((len(points), 6))
    drops[:, [Y, Z]] = points
    drops[:, EXCESS] = hydrostatic_excess(level - points[:, 1], gravity, water.sound_speed, water.state)
    drops[:, VOLUME] = volume
    return drops
