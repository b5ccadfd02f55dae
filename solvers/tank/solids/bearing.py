"""Which face of a tank in space bears the load on a wall feature."""

import numpy as np

from solvers.tank.walls import ALONG_Y, ALONG_Z, LENGTH, PART, Walls, Y, Z


def faces_of(walls: Walls, outline: np.ndarray, faces: int) -> np.ndarray:
    """The piece (features,) that bears the load on each feature where the edges of one tank are told apart.

    A corner goes with the nearest edge that has a wall, the first of two. Parts come after all `faces`.
    """
    rows, segments = walls.rows, np.arange(len(walls.rows)) < walls.segments
    half = np.where(segments, 0.5 * rows[:, LENGTH], 0.0)[:, None]
    place = rows[:, [Y, Z]] + half * rows[:, [ALONG_Y, ALONG_Z]]
    ahead = np.roll(outline, -1, axis=0) - outline
    share = np.clip(((place[:, None] - outline) * ahead).sum(-1) / (ahead**2).sum(-1), 0.0, 1.0)
    away = np.linalg.norm(place[:, None] - outline - share[..., None] * ahead, axis=-1)
    away[:, list(walls.open_edges)] = np.inf
    part = rows[:, PART].astype(int)
    return np.where(part < 0, away.argmin(axis=1), faces + part)
