"""Where a tank or a part of it stands in space: six numbers, its displacement y, z, x (m) and its turn, a vector (rad).

That vector lies along the axis of the turn and is as long as its angle. Six numbers grow alike along a way.
"""

from functools import reduce

import numpy as np
from scipy.spatial.transform import Rotation

ROLL = 5  # the turn about x
OF_PLANE = (0, 1, ROLL)  # sway, heave and roll


def stances(pose: np.ndarray) -> np.ndarray:
    """Stances (..., 6) of poses (..., 6), whose angles are pitch, yaw and roll, or of those in a plane (..., 3)."""
    found = np.zeros((*pose.shape[:-1], 6))
    if pose.shape[-1] == 3:
        found[..., OF_PLANE] = pose
        return found
    found[...] = pose
    if found[..., 3:ROLL].any():
        angles = found[..., [4, 3, 5]].reshape(-1, 3)  # yaw, pitch, roll; the axes y, z, x are scipy's X, Y, Z
        found[..., 3:] = Rotation.from_euler("YXZ", angles).as_rotvec().reshape(found[..., 3:].shape)
    return found


def lengths(vectors: np.ndarray) -> np.ndarray:
    """Lengths (n,) of vectors (n, 2) or (n, 3)."""
    return reduce(np.hypot, vectors.T)


def rotation(vector: np.ndarray) -> np.ndarray:
    """The matrix (3, 3) of a turn: 1 + sin φ K + (1 − cos φ) K², K the cross product with its axis (Rodrigues 1840)."""
    angle = float(np.linalg.norm(vector))
    if angle < 1e-12:
        return np.eye(3)
    a, b, c = np.asarray(vector) / angle
    cross = np.array([(0.0, -c, b), (c, 0.0, -a), (-b, a, 0.0)])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def carried(points: np.ndarray, stance: np.ndarray) -> np.ndarray:
    """Points (n, 3) m of a body that stands so (6,)."""
    return stance[:3] + points @ rotation(stance[3:]).T


def turned_axes(axes: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Unit vectors (n, 3), each turned by its own vector (n, 3) rad."""
    angle = np.linalg.norm(vectors, axis=1, keepdims=True)
    along = vectors / np.maximum(angle, 1e-300)
    level = np.cross(along, axes)
    return axes + np.sin(angle) * level + (1.0 - np.cos(angle)) * np.cross(along, level)
