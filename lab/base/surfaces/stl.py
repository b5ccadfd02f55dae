"""Triangles of an STL file, binary or text, and the mesh that they make."""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError

HEADER, RECORD = 84, 50  # bytes of a binary file: its head, and each triangle
MOST = 2_000_000  # triangles
LONGEST = 400 * MOST  # bytes: a triangle as text takes some 250
GRAIN = 1e-6  # of the largest extent: corners this close are one


def triangles_of(path: Path) -> np.ndarray:
    """Corners (n, 3, 3) of a file's triangles, in its own unit. Raises LabError for a file that is none."""
    try:
        size = path.stat().st_size
        data = path.read_bytes() if size <= LONGEST else b""
    except OSError as error:
        raise LabError(f"{path} cannot be read ({error.strerror}); look at its name.") from None
    count = int.from_bytes(data[HEADER - 4 : HEADER], "little") if len(data) >= HEADER else -1
    binary = count > 0 and len(data) == HEADER + RECORD * count
    if size > LONGEST or (binary and count > MOST):
        raise LabError(f"{path.name}: has too many triangles; at most {MOST} are read.")
    found = _of_binary(data, count) if binary else _of_text(data)
    if not len(found) or not np.isfinite(found).all():
        raise LabError(f"{path.name}: is no STL file of triangles; export it as binary or ASCII STL.")
    if len(found) > MOST:
        raise LabError(f"{path.name}: {len(found)} triangles are too many; at most {MOST} are read.")
    return found


def welded(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners (m, 3), of which those at the same place are one, and triangles (n, 3) by their numbers."""
    from scipy.sparse import coo_array  # slow to import
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    points, number = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    near = cKDTree(points).query_pairs(GRAIN * float(np.ptp(points, axis=0).max()), output_type="ndarray")
    if len(near):
        links = coo_array((np.ones(len(near)), near.T), shape=(len(points), len(points)))
        _, group = connected_components(links, directed=False)
        _, first, group = np.unique(group, return_index=True, return_inverse=True)
        points, number = points[first], group[number.ravel()]
    return points, number.reshape(-1, 3)


def _of_binary(data: bytes, count: int) -> np.ndarray:
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("mark", "<u2")])
    return np.frombuffer(data, kind, count, HEADER)["corners"].astype(float)


def _of_text(data: bytes) -> np.ndarray:
    words = data.decode("ascii", "replace").split()
    places = [k for k, word in enumerate(words) if word.lower() == "vertex"]
    try:
        return np.array([[float(words[k + j]) for j in (1, 2, 3)] for k in places]).reshape(-1, 3, 3)
    except (ValueError, IndexError):
        return np.zeros((0, 3, 3))
