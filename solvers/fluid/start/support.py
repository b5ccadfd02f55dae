"""What water that is let go stands on and how deep it lies, by which its pressure begins."""

from collections.abc import Sequence

import numpy as np

from solvers.fluid.bodies.solids import is_solid, sides_of
from solvers.tank.parts import Part
from solvers.tank.tank import Tank

TOUCHES = 0.5  # spacings: water that is nearer to a wall stands on it


def depths(
    points: np.ndarray, polygon: np.ndarray, level: float, tank: Tank, parts: Sequence[Part], spacing: float
) -> np.ndarray:
    """Depth (n,) m under its surface of water at points (n, 2) m in a polygon (m, 2) m; 0 where it stands on nothing.

    Straight down from a point the water ends on a wall of the tank or a part, which bears it, or free: then it falls,
    and in free fall p = 0 (Euler's equation, du/dt = g). Straight up it ends at its surface; where a wall or a part
    ends it, it is as deep as below the `level`, as in vessels that are connected.

    Limits: each column stands for itself. Where one that stands meets one that falls the pressure jumps, as at the side
    of a column whose gate is gone at once; in a liquid without sound it would be harmonic from the first instant on.
    """
    solid = [sides_of(part.points, is_solid(part)) for part in parts]
    solid.append(np.delete(sides_of(tank.outline), tank.open_edges, axis=0))
    floor, roof = (_ended(points, sides_of(polygon), np.concatenate(solid), spacing, way) for way in (-1.0, 1.0))
    surface = np.where(roof[1], level, np.minimum(roof[0], level))
    return np.where(floor[1], surface - points[:, 1], 0.0)


def _ended(
    points: np.ndarray, own: np.ndarray, solid: np.ndarray, spacing: float, way: float
) -> tuple[np.ndarray, np.ndarray]:
    """Heights (n,) m at which the water ends up (`way` 1) or down (−1) from points, and whether something firm ends it.

    The water has its `own` sides, walls and parts the `solid` ones, (k, 4) m as of `sides_of`.
    """
    end, firm = np.full(len(points), way * np.inf), np.zeros(len(points), dtype=bool)
    for y, z, along, rise in own:
        met = _met(points, y, z, along, rise)
        nearer = (way * (met - points[:, 1]) >= 0.0) & (way * (end - met) > 0.0)
        end[nearer] = met[nearer]
    for y, z, along, rise in solid:
        met = _met(points, y, z, along, rise)
        close = TOUCHES * spacing * np.hypot(along, rise) / max(abs(along), 1e-300)
        firm |= (way * (met - points[:, 1]) >= 0.0) & (way * (met - end) < close)
    return end, firm


def _met(points: np.ndarray, y: float, z: float, along: float, rise: float) -> np.ndarray:
    """Heights (n,) m at which the verticals through points (n, 2) m cross a side; NaN where they do not."""
    share = (points[:, 0] - y) / along if along else np.full(len(points), np.nan)
    return np.where((share >= 0.0) & (share <= 1.0), z + share * rise, np.nan)
