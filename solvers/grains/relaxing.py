"""Grains that were put on top of each other are moved apart before they can burst."""

from collections.abc import Iterator

import numpy as np
from scipy.spatial import cKDTree

from solvers.grains.materials import hertz_stiffness

# Of the energy that lifts the smallest grain by its diameter: what a contact may hold at the start, and may keep.
BURSTING, AT_REST = 1.0, 0.01
SWEEPS = 2000


def relaxed(position: np.ndarray, radius: np.ndarray, edges: np.ndarray, bursting: float, at_rest: float) -> np.ndarray:
    """Places (n, 2) m of a world's grains, moved apart where a contact of two would make them jump by a diameter.

    `radius` (n,) m; `edges` (k, 2, 2) m, the two ends of each wall; `bursting` and `at_rest` (m) are the overlaps that
    a contact may have at the start and may keep. Overlaps are halved between the two grains, and grains pushed off
    walls, again and again (projection of constraints, Müller, Heidelberger, Hennix and Ratcliff 2007) until none is
    deeper than `at_rest`, or after SWEEPS sweeps. Beds with the overlaps of their weight stay as they are.
    """
    if _deepest(position, radius, edges) <= bursting:
        return position
    position = position.copy()
    for _ in range(SWEEPS):
        position += _pushes(position, radius, edges, 0.5 * at_rest)
        if _deepest(position, radius, edges) <= at_rest:
            break
    return position


def lifting_overlap(share: float, radius: float, density: float, young_modulus: float, gravity: float) -> float:
    """The overlap ξ (m) of two grains that holds a share of what lifts one by its diameter: (2/5) k ξ^(5/2).

    `radius` (m) and `density` (kg/m³) of the grains, `young_modulus` (Pa) between them, `gravity` (m/s²).
    """
    weight = 4.0 / 3.0 * np.pi * radius**3 * density * gravity
    stiffness = hertz_stiffness(young_modulus, 0.5 * radius)
    return float((2.5 * share * weight * 2.0 * radius / stiffness) ** 0.4)


def _deepest(position: np.ndarray, radius: np.ndarray, edges: np.ndarray) -> float:
    """The deepest overlap (m) of two grains, or of a grain and a wall."""
    pairs = _pairs(position, radius)
    apart = np.linalg.norm(position[pairs[:, 0]] - position[pairs[:, 1]], axis=1)
    overlap = (radius[pairs].sum(axis=1) - apart).max(initial=0.0)
    return float(max(overlap, *(depth.max(initial=0.0) for _, depth in _walls(position, radius, edges))))


def _pushes(position: np.ndarray, radius: np.ndarray, edges: np.ndarray, kept: float) -> np.ndarray:
    """How far (n, 2) m grains move: the mean of what their contacts ask for, which keep an overlap of `kept` (m)."""
    pairs = _pairs(position, radius)
    away = position[pairs[:, 0]] - position[pairs[:, 1]]
    apart = np.maximum(np.linalg.norm(away, axis=1), 1e-12)
    overlap = radius[pairs].sum(axis=1) - apart - kept
    touching = overlap > 0.0
    pairs, push = pairs[touching], (0.5 * overlap / apart)[touching, None] * away[touching]
    total, count = np.zeros_like(position), np.zeros(len(radius))
    for side, sign in ((0, 1.0), (1, -1.0)):
        np.add.at(total, pairs[:, side], sign * push)
        np.add.at(count, pairs[:, side], 1.0)
    for inwards, depth in _walls(position, radius, edges):
        asked = np.maximum(depth - kept, 0.0)
        total += asked[:, None] * inwards
        count += asked > 0.0
    return total / np.maximum(count, 1.0)[:, None]


def _pairs(position: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Grains (k, 2) that may overlap."""
    return cKDTree(position).query_pairs(2.0 * radius.max(), output_type="ndarray")


def _walls(position: np.ndarray, radius: np.ndarray, edges: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Of each wall the direction (n, 2) away from its nearest point and the depth (n,) m of the grains in it."""
    for a, b in edges:
        along = np.clip((position - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        away = position - (a + along[:, None] * (b - a))
        apart = np.maximum(np.linalg.norm(away, axis=1), 1e-12)
        yield away / apart[:, None], radius - apart
