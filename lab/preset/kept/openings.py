"""Where the openings of hulls lead."""

import numpy as np

from solvers.tank.outline import inside


def beside(ends: object, wall: float) -> np.ndarray:
    """The points (2, 2) m on both sides of an opening between two `ends` (m), as far off as its wall is thick."""
    start, end = np.array(ends, dtype=float)
    along = (end - start) / np.hypot(*(end - start))
    across = wall * np.array([-along[1], along[0]])
    return 0.5 * (start + end) + np.stack([across, -across])


def leads_into(ends: object, wall: float, room: object) -> bool:
    """Whether an opening between two `ends` (m) in a wall (m) leads into a room with these corners (m)."""
    return bool(inside(beside(ends, wall), np.array(room, dtype=float)).any())
