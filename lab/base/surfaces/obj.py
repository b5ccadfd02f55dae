"""Triangles of a Wavefront OBJ file: its corners `v x y z` and its faces `f a b c …`, whatever else it says aside.

Corners are counted from 1 in their order, from the last one backwards if negative; what stands behind a stroke in a
face, texture and normal, is left out. A face of more than three corners becomes a fan of triangles about its first one,
which is right for those that are convex and flat.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.surfaces.stl import MOST

LONGEST = 400_000_000  # bytes


def triangles_of(path: Path) -> np.ndarray:
    """Corners (n, 3, 3) of a file's triangles, in its own unit. Raises LabError for a file that is none."""
    try:
        data = path.read_bytes() if path.stat().st_size <= LONGEST else b""
    except OSError as error:
        raise LabError(f"{path} cannot be read ({error.strerror}); look at its name.") from None
    corners, triangles = [], []
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines(), start=1):
        words = line.split()
        if not words or words[0] not in ("v", "f"):
            continue
        try:
            if words[0] == "v":
                corners.append([float(word) for word in words[1:4]])
            else:
                triangles += _fan([_number(word, len(corners)) for word in words[1:]])
        except (ValueError, IndexError):
            raise LabError(
                f"{path.name}: line {number}: is no {_what(words[0])} of an OBJ file; export it anew."
            ) from None
        if len(triangles) > MOST:
            raise LabError(f"{path.name}: has too many triangles; at most {MOST} are read.")
    if not triangles or any(len(corner) != 3 for corner in corners) or not np.isfinite(corners).all():
        raise LabError(f"{path.name}: is no OBJ file of faces; export the hull as a mesh of polygons.")
    return np.array(corners)[np.array(triangles)]


def _number(word: str, count: int) -> int:
    """The number, from 0, of a corner in a face. Raises IndexError for one that is not there."""
    given = int(word.partition("/")[0])
    found = given - 1 if given > 0 else count + given
    if given == 0 or not 0 <= found < count:
        raise IndexError
    return found


def _fan(corners: list[int]) -> list[tuple[int, int, int]]:
    """The triangles of a face. Raises ValueError for one with fewer than three corners."""
    if len(corners) < 3:
        raise ValueError
    return [(corners[0], one, other) for one, other in pairwise(corners[1:])]


def _what(word: str) -> str:
    return "corner" if word == "v" else "face of corners above it"
