"""Surfaces of triangles (n, 3, 3) that tests of hulls share, normals outward, and the files that hold them."""

import struct
from itertools import pairwise
from math import pi
from pathlib import Path

import numpy as np


def box(diagonals: tuple[int, ...] = (0,) * 6, low=(0.0, -13.5, 0.0), high=(130.0, 13.5, 14.0)) -> np.ndarray:
    """A box of 12 triangles, two a face; `diagonals` says for each face (aft, forward, …) which of its two is cut."""
    ends, found = np.array([low, high], dtype=float), []
    for face, diagonal in enumerate(diagonals):
        axis, end = divmod(face, 2)
        a, b = (axis + 1) % 3, (axis + 2) % 3
        square = np.empty((4, 3))
        square[:, axis] = ends[end, axis]
        square[:, a], square[:, b] = ends[[0, 1, 1, 0], a], ends[[0, 0, 1, 1], b]
        pair = np.roll(square, diagonal, axis=0)[[[0, 1, 2], [0, 2, 3]]]
        found.append(pair if end else pair[:, ::-1])
    return np.concatenate(found)


def tube(rings: np.ndarray, alternate: bool = False) -> np.ndarray:
    """The closed surface through rings of points (stations, k, 3), counter-clockwise in the plane of y and z.

    `alternate`: the diagonals of neighbouring panels run the other way.
    """
    found = []
    for i, (behind, ahead) in enumerate(pairwise(rings)):
        for j in range(rings.shape[1]):
            n = (j + 1) % rings.shape[1]
            a, b, c, d = behind[j], behind[n], ahead[n], ahead[j]
            found += [(a, b, d), (b, c, d)] if alternate and (i + j) % 2 else [(a, b, c), (a, c, d)]
    return np.concatenate([np.array(found), _fan(rings[0])[:, ::-1], _fan(rings[-1])])


def _fan(ring: np.ndarray) -> np.ndarray:
    middle = np.broadcast_to(ring.mean(axis=0), ring.shape)
    return np.stack([ring, np.roll(ring, -1, axis=0), middle], axis=1)


def prism(section: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Rings (len(x), k, 3) of a section (k, 2) of y and z at the stations x."""
    return np.array([np.column_stack([np.full(len(section), place), section]) for place in x])


def cylinder(corners: int) -> np.ndarray:
    """Rings (21, k, 3) of a round barge of 5 m radius, 40 m long."""
    angle = 2.0 * pi * (np.arange(corners) + 0.5) / corners
    return prism(np.column_stack([5.0 * np.cos(angle), 5.0 + 5.0 * np.sin(angle)]), np.linspace(0.0, 40.0, 21))


def moved(triangles: np.ndarray, *way: float) -> np.ndarray:
    """Triangles that are moved (m) along x, y and z."""
    return triangles + np.array(way)


def stl(path: Path, triangles: np.ndarray) -> Path:
    """A binary STL file."""
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *map(float, t.ravel()), 0) for t in triangles)
    path.write_bytes(b" " * 80 + struct.pack("<I", len(triangles)) + body)
    return path


def volume(triangles: np.ndarray) -> float:
    """What a closed surface holds (m³), a sixth of the triple products of its triangles."""
    return float(np.einsum("ni,ni->", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2]))) / 6.0
