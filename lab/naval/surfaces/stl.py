"""Triangles of an STL file, binary or text."""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError

HEADER, RECORD = 84, 50  # bytes of a binary file: its head, and each triangle
MOST = 2_000_000  # triangles
LONGEST = 400 * MOST  # bytes: a triangle as text takes some 250


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
        raise LabError(f"{path.name}: is no STL file of triangles; export the hull as binary or ASCII STL.")
    if len(found) > MOST:
        raise LabError(f"{path.name}: {len(found)} triangles are too many; at most {MOST} are read.")
    return found


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
