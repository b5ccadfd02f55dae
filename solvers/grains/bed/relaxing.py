"""Removal of excessive overlaps at the start, which would make grains burst apart."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from solvers.grains.materials import hertz_stiffness
from solvers.tank.solids.solid import Solid, overlaps

# Elastic energy that a contact may have at the start, and may keep, relative to that which lifts the smallest grain by
# its diameter.
BURSTING, AT_REST = 1.0, 0.01
SWEEPS = 2000


def relaxed(
    position: np.ndarray,
    radius: np.ndarray,
    edges: np.ndarray,
    bursting: float,
    at_rest: float,
    solid: Solid | None = None,
) -> np.ndarray:
    """Positions (n, axes) m of a world's grains, moved apart if any overlap would make grains jump by a diameter.

    `radius` (n,) m; `edges` (k, 2, 2) m, the two ends of each wall, in space those of the section of a `solid`;
    `bursting` and `at_rest` (m) are the overlaps that a contact may have at the start and may keep. Each sweep shares a
    pair's overlap equally between its grains and pushes grains off walls (projection of constraints, Müller,
    Heidelberger, Hennix and Ratcliff 2007), until none is deeper than `at_rest`, or for SWEEPS sweeps. Beds with
    overlaps due to their weight only stay as they are.
    """
    walls = Walls(edges, solid)
    if _deepest(position, radius, walls) <= bursting:
        return position
    position = position.copy()
    for _ in range(SWEEPS):
        position += _pushes(position, radius, walls, 0.5 * at_rest)
        if _deepest(position, radius, walls) <= at_rest:
            break
    return position


@dataclass(frozen=True)
class Walls:
    """Edges (k, 2, 2) m, in space of the section of a `solid`."""

    edges: np.ndarray
    solid: Solid | None = None

    def overlaps(self, position: np.ndarray, radius: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """For each, the grains' directions (n, axes) away from its nearest point, and their overlaps (n,) m with it."""
        if self.solid is None:
            return overlaps(position, radius, self.edges)
        return self.solid.overlaps(position, radius, self.edges)

    @property
    def period(self) -> float | None:
        """The length (m) along x after which they repeat themselves."""
        return self.solid.period if self.solid else None


def relaxed_start(scene, position: np.ndarray) -> np.ndarray:
    """Positions (n, axes) m of the first world's grains of a `solvers.scene.Scene`, without excessive overlaps."""
    grains, hold = scene.grains, scene.tanks[scene.hold]
    outline = hold.outline
    edges = np.stack([outline, np.roll(outline, -1, axis=0)], axis=1)
    edges = np.delete(edges, list(hold.open_edges), axis=0)
    lightest = grains.sizes[0], float(grains.density.min()), grains.interfaces[0].young_modulus, scene.gravity
    overlaps = (lifting_overlap(share, *lightest) for share in (BURSTING, AT_REST))
    return relaxed(position, grains.radius[0], edges, *overlaps, scene.solid)


def lifting_overlap(share: float, radius: float, density: float, young_modulus: float, gravity: float) -> float:
    """Overlap ξ (m) of two grains whose elastic energy (2/5) k ξ^(5/2) is a share of that to lift one by its diameter.

    `radius` (m) and `density` (kg/m³) of the grains, effective `young_modulus` (Pa), `gravity` (m/s²).
    """
    weight = 4.0 / 3.0 * np.pi * radius**3 * density * gravity
    stiffness = hertz_stiffness(young_modulus, 0.5 * radius)
    return float((2.5 * share * weight * 2.0 * radius / stiffness) ** 0.4)


def _deepest(position: np.ndarray, radius: np.ndarray, walls: Walls) -> float:
    """The largest overlap (m) of two grains, or of a grain and a wall."""
    pairs, away = _pairs(position, radius, walls.period)
    overlap = (radius[pairs].sum(axis=1) - np.linalg.norm(away, axis=1)).max(initial=0.0)
    return float(max(overlap, *(depth.max(initial=0.0) for _, depth in walls.overlaps(position, radius))))


def _pushes(position: np.ndarray, radius: np.ndarray, walls: Walls, kept: float) -> np.ndarray:
    """Displacements (n, axes) m: the mean of those that leave each of a grain's contacts an overlap `kept` (m)."""
    pairs, away = _pairs(position, radius, walls.period)
    apart = np.maximum(np.linalg.norm(away, axis=1), 1e-12)
    overlap = radius[pairs].sum(axis=1) - apart - kept
    touching = overlap > 0.0
    pairs, push = pairs[touching], (0.5 * overlap / apart)[touching, None] * away[touching]
    total, count = np.zeros_like(position), np.zeros(len(radius))
    for side, sign in ((0, 1.0), (1, -1.0)):
        np.add.at(total, pairs[:, side], sign * push)
        np.add.at(count, pairs[:, side], 1.0)
    for inwards, depth in walls.overlaps(position, radius):
        asked = np.maximum(depth - kept, 0.0)
        total += asked[:, None] * inwards
        count += asked > 0.0
    return total / np.maximum(count, 1.0)[:, None]


def _pairs(position: np.ndarray, radius: np.ndarray, period: float | None) -> tuple[np.ndarray, np.ndarray]:
    """Pairs (k, 2) of grains that may overlap, and the ways (k, axes) m from the second to the first."""
    from scipy.spatial import cKDTree  # slow to import

    folded = np.column_stack([position[:, :-1], position[:, -1] % period]) if period else position
    tree = cKDTree(folded, boxsize=[0.0, 0.0, period] if period else None)
    pairs = tree.query_pairs(2.0 * radius.max(), output_type="ndarray")
    away = position[pairs[:, 0]] - position[pairs[:, 1]]
    if period:
        away[:, -1] -= period * np.round(away[:, -1] / period)
    return pairs, away
