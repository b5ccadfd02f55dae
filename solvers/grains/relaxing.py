"""Grains that were put on top of each other are moved apart before they can burst."""

import numpy as np
from scipy.spatial import cKDTree

from solvers.grains.materials import hertz_stiffness
from solvers.scene import Scene

# Of the energy that lifts the smallest grain by its diameter: what a contact may hold at the start, and may keep.
BURSTING, AT_REST = 1.0, 0.01
SWEEPS = 2000


def relaxed(scene: Scene, position: np.ndarray) -> np.ndarray:
    """Places (n, 2) m of a world's grains, moved apart where a contact of two would make them jump by a diameter.

    Overlaps are halved between the two grains, and grains pushed off walls, again and again (projection of
    constraints, Müller, Heidelberger, Hennix and Ratcliff 2007) until no contact holds more than a hundredth of that
    energy, (2/5) k ξ^(5/2), or after SWEEPS sweeps. Beds with the overlaps of their weight stay as they are.
    """
    radius = scene.radius[0]
    bursting, at_rest = (_overlap(scene, share) for share in (BURSTING, AT_REST))
    if _deepest(scene, position, radius) <= bursting:
        return position
    position = position.copy()
    for _ in range(SWEEPS):
        position += _pushes(scene, position, radius, 0.5 * at_rest)
        if _deepest(scene, position, radius) <= at_rest:
            break
    return position


def _overlap(scene: Scene, share: float) -> float:
    """The overlap ξ (m) of the smallest grains that holds a share of what lifts one by its diameter."""
    smallest, between = scene.sizes[0], scene.interfaces[0]
    weight = 4.0 / 3.0 * np.pi * smallest**3 * float(scene.density.min()) * scene.gravity
    stiffness = hertz_stiffness(between.young_modulus, 0.5 * smallest)
    return float((2.5 * share * weight * 2.0 * smallest / stiffness) ** 0.4)


def _deepest(scene: Scene, position: np.ndarray, radius: np.ndarray) -> float:
    """The deepest overlap (m) of two grains, or of a grain and a wall."""
    pairs = _pairs(position, radius)
    apart = np.linalg.norm(position[pairs[:, 0]] - position[pairs[:, 1]], axis=1)
    overlap = (radius[pairs].sum(axis=1) - apart).max(initial=0.0)
    return float(max(overlap, *(depth.max(initial=0.0) for _, depth in _walls(scene, position, radius))))


def _pushes(scene: Scene, position: np.ndarray, radius: np.ndarray, kept: float) -> np.ndarray:
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
    for inwards, depth in _walls(scene, position, radius):
        asked = np.maximum(depth - kept, 0.0)
        total += asked[:, None] * inwards
        count += asked > 0.0
    return total / np.maximum(count, 1.0)[:, None]


def _pairs(position: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Grains (k, 2) that may overlap."""
    return cKDTree(position).query_pairs(2.0 * radius.max(), output_type="ndarray")


def _walls(scene: Scene, position: np.ndarray, radius: np.ndarray):
    """Of each wall the direction (n, 2) away from its nearest point and the depth (n,) m of the grains in it."""
    corners = scene.outline
    for number, (a, b) in enumerate(zip(corners, np.roll(corners, -1, axis=0), strict=True)):
        if number in scene.open_edges:
            continue
        along = np.clip((position - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        away = position - (a + along[:, None] * (b - a))
        apart = np.maximum(np.linalg.norm(away, axis=1), 1e-12)
        yield away / apart[:, None], radius - apart
