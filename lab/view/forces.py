"""Forces between round grains as a picture shows them, from how deep they overlap."""

import numpy as np


def pressed_pairs(place: np.ndarray, radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs (k, 2) of discs that overlap, and their elastic force in units of their own (k,).

    place (n, 2) m; radius (n,) m. Hertz (1882): ξ^(3/2) √R_eff, but for the moduli, which are the same for all; what
    damping adds is left out.
    """
    from scipy.spatial import cKDTree

    kept = np.flatnonzero(np.isfinite(place).all(axis=1))
    tree = cKDTree(place[kept])
    pairs = kept[tree.query_pairs(2.0 * radius.max(), output_type="ndarray")]
    i, j = pairs.T
    overlap = radius[i] + radius[j] - np.hypot(*(place[i] - place[j]).T)
    touching = overlap > 0.0
    effective = radius[i] * radius[j] / (radius[i] + radius[j])
    return pairs[touching], (overlap[touching] ** 1.5) * np.sqrt(effective[touching])
