"""A mesh of triangles: its corners, what it holds, and how much of that lies below a plane.

Volumes are by the divergence theorem: of a closed surface V = ∮ x n_x dA, each triangle with the mean of x over it and
its area as seen along x. A level cut adds nothing to that, so what lies below a level needs no lid there.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lab.base.surfaces import stl


@dataclass(frozen=True, eq=False)
class Mesh:
    """Corners (m, 3) in m, and triangles `faces` (n, 3) by the numbers of their corners; `name` is the file's."""

    corners: np.ndarray
    faces: np.ndarray
    name: str

    @cached_property
    def low(self) -> np.ndarray:
        """Least coordinates (3,) m."""
        return self.corners.min(axis=0)

    @cached_property
    def high(self) -> np.ndarray:
        """Largest coordinates (3,) m."""
        return self.corners.max(axis=0)

    @property
    def extent(self) -> np.ndarray:
        """Length, breadth and depth (3,) m of the box about it."""
        return self.high - self.low

    @property
    def triangles(self) -> np.ndarray:
        """Corners (n, 3, 3) m of the triangles."""
        return self.corners[self.faces]

    @cached_property
    def volume(self) -> float:
        """What it holds (m³), if it is closed and its triangles are all turned outward."""
        return _held(self.triangles - self.low)

    @cached_property
    def centre(self) -> np.ndarray:
        """Centre (3,) m of what it holds: V c_i = ∮ x_i²/2 n_i dA."""
        triangles = self.triangles - self.low
        squares = 0.5 * (triangles.sum(axis=1) ** 2 + (triangles**2).sum(axis=1)) / 12.0  # means of x²/2 over each
        return self.low + (squares * _areas(triangles)).sum(axis=0) / self.volume

    def below(self, level: float, slope: float = 0.0) -> float:
        """Volume (m³) under the plane z = level + slope × x."""
        return _held(self._clipped(level, slope) - self.low)

    def along(self, places: np.ndarray, level: float = np.inf, slope: float = 0.0) -> np.ndarray:
        """Volumes (k,) m³ aft of the places x (k,) m, all of it or only what is under a plane."""
        triangles = self.triangles if level == np.inf else self._clipped(level, slope)
        return np.array([_held(clipped(triangles, 0, x) - [x, 0.0, 0.0]) for x in places])

    def _clipped(self, level: float, slope: float) -> np.ndarray:
        """Triangles (k, 3, 3) of the surface under a plane; z is sheared by the slope, which keeps volumes."""
        sheared = self.triangles - slope * self.triangles[..., :1] * [0.0, 0.0, 1.0]
        return clipped(sheared, 2, level)


def welded(triangles: np.ndarray, name: str) -> Mesh:
    """The mesh of triangles (n, 3, 3) m, in which corners at the same place are one; those without an area go."""
    return with_faces(*stl.welded(triangles), name)


def with_faces(corners: np.ndarray, faces: np.ndarray, name: str) -> Mesh:
    """A mesh of those faces (n, 3) that have three different corners, and of no other corners."""
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    used, faces = np.unique(faces, return_inverse=True)
    return Mesh(corners[used], faces.reshape(-1, 3), name)


def clipped(triangles: np.ndarray, axis: int, level: float) -> np.ndarray:
    """The parts (k, 3, 3) of triangles (n, 3, 3) m whose coordinate along an axis is less than a level (m)."""
    height = triangles[..., axis] - level
    under = (height < 0.0).sum(axis=1)
    found = [triangles[under == 3]]
    for count in (1, 2):  # turned so that the corner alone on its side is the first
        chosen, high = triangles[under == count], height[under == count]
        alone = np.argmin(high, axis=1) if count == 1 else np.argmax(high, axis=1)
        turn = (alone[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(chosen, turn[..., None], axis=1), 1, 0)
        ha, hb, hc = np.take_along_axis(high, turn, axis=1).T[..., None]
        ab, ac = a + ha / (ha - hb) * (b - a), a + ha / (ha - hc) * (c - a)
        parts = [(a, ab, ac)] if count == 1 else [(ab, b, c), (ab, c, ac)]
        found += [np.stack(part, axis=1) for part in parts]
    return np.concatenate(found)


def _areas(triangles: np.ndarray) -> np.ndarray:
    """Areas (n, 3) m² as seen along each axis, positive where the triangle looks along it."""
    return 0.5 * np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])


def _held(triangles: np.ndarray) -> float:
    """∮ x n_x dA (m³) over triangles (n, 3, 3) m."""
    return float(triangles[..., 0].mean(axis=1) @ _areas(triangles)[:, 0])
