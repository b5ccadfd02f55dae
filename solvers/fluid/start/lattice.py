"""Water as a square lattice of particles."""

import numpy as np

from solvers.tank.outline import area_below, cut_off
from solvers.tank.tank import Tank

CLOSE = 0.25  # spacings: no particle starts nearer to a slanted wall
NEAR = 1e-9  # of the spacing: rounding


def lattice(polygon: np.ndarray, level: float, spacing: float) -> tuple[np.ndarray, float]:
    """Places (n, 2) m of particles in a polygon (m, 2) up to a `level` (m), and the volume (m²) of each.

    The particles are half a spacing away from the floor and from the surface; the spacing should divide the depth. From
    side to side there is a whole number of columns, spread evenly: their distance is the spacing to within half of it
    over the whole width. A lattice with other gaps at the walls than within would start with a blow. Where walls are
    slanted, the lattice is cut off, and particles within CLOSE of a wall are left out. The volumes are equal, and their
    sum is exactly the polygon's area below the level.

    A lattice under a pressure p is elastic. To a flow without rotation and divergence, ξ = ∇φ, it answers with the
    energy p [a φ_yy² + b φ_yz²] per area, a = S_yyyy − S_yzyz − 1, b = S_yyzz + S_yzyz − 1, S_abcd = Σ V ∂²W/∂r_a∂r_b
    r_c r_d: zero for integrals, a = 0.018 and b = 0.007 for Wendland's C2 and h = 2 Δx, which quickens deep waves by
    (a + b)/4, shallow ones by a/2, 0.6 and 0.9 % at any spacing. Own derivation.
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


def lattice_in_space(polygon: np.ndarray, level: float, spacing: float, along: float) -> tuple[np.ndarray, float]:
    """Places (n, 3) m of particles in a prism over a polygon, `along` (m) long, and the volume (m³) of each.

    A lattice of the polygon, as of `lattice`, in equal slices along x.
    """
    section, area = lattice(polygon, level, spacing)
    count = max(1, round(along / spacing))
    x = along / count * (np.arange(count) + 0.5) - 0.5 * along
    points = np.column_stack([np.tile(section, (count, 1)), np.repeat(x, len(section))])
    return points, area * along / count


def from_edges(points: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Distances (n,) m of points (n, 2) from the nearest edge of a polygon (m, 2)."""
    nearest = np.full(len(points), np.inf)
    for begin, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        along = end - begin
        share = np.clip((points - begin) @ along / (along @ along), 0.0, 1.0)
        nearest = np.minimum(nearest, np.hypot(*(points - begin - share[:, None] * along).T))
    return nearest
