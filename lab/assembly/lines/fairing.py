"""Fair curves through the offsets of a station, in place of straight lines between them.

The half-breadth over height is the spline of Akima (1970), which keeps to the nearest points: what is straight over
three intervals stays straight, and a parabola through equal distances is exact. Where a station has two half-breadths
at one height, as at a flat bottom or a deck, the curve has a corner.
"""

import numpy as np

PIECES = 8  # straight pieces in place of one


def fair(z: np.ndarray, half: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Heights that rise and half-breadths (n,) m with further points between them, on the curve."""
    corners = np.flatnonzero(np.diff(z) <= 0.0) + 1
    runs = zip(np.split(z, corners), np.split(half, corners), strict=True)
    found = [_run(*run) for run in runs]
    return np.concatenate([one[0] for one in found]), np.concatenate([one[1] for one in found])


def _run(z: np.ndarray, half: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    from scipy.interpolate import Akima1DInterpolator  # slow to import

    if len(z) < 3:
        return z, half
    share = np.arange(PIECES) / PIECES
    fine = np.append((z[:-1, None] + np.diff(z)[:, None] * share).ravel(), z[-1])
    return fine, np.maximum(Akima1DInterpolator(z, half)(fine), 0.0)
