"""Walls in space: flat faces that are seen from inside, and the lines along their edges.

A face is drawn where the camera is on its inner side, so the floor and the far walls are behind the cargo; of the near
walls only the edges are drawn, as of glass.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

MANY = 200  # corners
SAME = 1e-6  # of the size of all: corners that are closer are one


@dataclass(frozen=True, eq=False)
class Walls:
    """Flat faces, their corners counter-clockwise as seen from the inner side.

    points (n, 3) m: the corners of all faces, one face after the other; first (m + 1,): where each begins;
    both (m,): whether a face is seen from both sides, as a plate is.
    """

    points: np.ndarray
    first: np.ndarray
    both: np.ndarray

    @classmethod
    def of(cls, faces: Sequence[np.ndarray], both: bool = False) -> "Walls":
        """Walls of these polygons, each (k, 3) m."""
        first = np.cumsum([0, *(len(face) for face in faces)]).astype(np.int32)
        points = np.concatenate([np.zeros((0, 3)), *faces])
        return cls(points, first, np.full(len(faces), both))

    @classmethod
    def joined(cls, several: Iterable["Walls"]) -> "Walls":
        """All these walls in one."""
        found = list(several)
        starts = np.cumsum([0, *(len(one.points) for one in found)])
        first = [start + one.first[:-1] for start, one in zip(starts, found, strict=False)]
        points = np.concatenate([np.zeros((0, 3)), *(one.points for one in found)])
        both = np.concatenate([np.zeros(0, dtype=bool), *(one.both for one in found)])
        return cls(points, np.concatenate([*first, [len(points)]]).astype(np.int32), both)

    @cached_property
    def outmost(self) -> np.ndarray:
        """Corners (k, 3) m between which all others lie, of many those of their convex hull."""
        if len(self.points) < MANY:
            return np.unique(self.points, axis=0)
        from scipy.spatial import ConvexHull, QhullError  # takes a moment, and boxes need none

        try:
            return self.points[ConvexHull(self.points).vertices]
        except QhullError:  # all in one plane
            return np.unique(self.points, axis=0)

    @cached_property
    def after(self) -> np.ndarray:
        """The number (n,) of the corner after each corner of a face."""
        found = np.arange(1, len(self.points) + 1)
        found[self.first[1:] - 1] = self.first[:-1]
        return found

    @cached_property
    def normals(self) -> np.ndarray:
        """Unit normals (m, 3) towards the inside, by the area vector of each polygon: ½ Σ r_k × r_(k+1)."""
        if not len(self.both):
            return np.zeros((0, 3))
        off = self.points - np.repeat(self.points[self.first[:-1]], np.diff(self.first), axis=0)
        area = np.add.reduceat(np.cross(off, off[self.after]), self.first[:-1], axis=0)
        return area / np.maximum(np.linalg.norm(area, axis=1, keepdims=True), 1e-300)

    @cached_property
    def edges(self) -> tuple[np.ndarray, np.ndarray]:
        """Ends (e, 2, 3) m of all edges and the two faces (e, 2) at each; −1 where there is only one."""
        if not len(self.both):
            return np.zeros((0, 2, 3)), np.zeros((0, 2), dtype=int)
        size = max(float(np.ptp(self.points, axis=0).max()), 1e-300)
        _, corner = np.unique(np.round(self.points / (SAME * size)).astype(np.int64), axis=0, return_inverse=True)
        pairs = np.sort(np.column_stack([corner.ravel(), corner.ravel()[self.after]]), axis=1)
        face = np.repeat(np.arange(len(self.both)), np.diff(self.first))
        order = np.lexsort((face, pairs[:, 1], pairs[:, 0]))
        order = order[pairs[order, 0] != pairs[order, 1]]
        new = np.append(True, (np.diff(pairs[order], axis=0) != 0).any(axis=1))
        one = order[new]
        two = np.full(len(one), -1)
        second = np.flatnonzero(~new & np.append(False, new[:-1]))
        two[np.cumsum(new)[second] - 1] = face[order[second]]
        ends = np.stack([self.points[one], self.points[self.after[one]]], axis=1)
        return ends, np.column_stack([face[one], two])

    def carried(self, place: np.ndarray, turned: np.ndarray) -> "Walls":
        """These walls after a rotation (3, 3) about the origin and a displacement (3,), m."""
        found = Walls(place + self.points @ turned.T, self.first, self.both)
        ends, faces = self.edges
        found.__dict__.update(edges=(place + ends @ turned.T, faces), normals=self.normals @ turned.T, after=self.after)
        return found

    def facing(self, eye: np.ndarray) -> np.ndarray:
        """Whether (m,) each face is drawn for a camera at this place (3,), m."""
        return (((eye - self.points[self.first[:-1]]) * self.normals).sum(axis=1) > 0.0) | self.both


def drawn_out(line: np.ndarray, along: float) -> Walls:
    """A plate with a cross-section (m, 2) y, z in m, as long in x as `along` (m), seen from both sides."""
    ends = [np.column_stack([line, np.full(len(line), end)]) for end in (0.5 * along, -0.5 * along)]
    pieces = [np.array([ends[1][k + 1], ends[1][k], ends[0][k], ends[0][k + 1]]) for k in range(len(line) - 1)]
    return Walls.of(pieces, both=True)


def prism(outline: np.ndarray, along: float, open_edges: Sequence[int] = ()) -> Walls:
    """The walls of a tank with a cross-section (m, 2) y, z in m and a length (m) in x, its middle at x = 0.

    open_edges: edges k of the cross-section, from corner k to the next, without a wall.
    """
    count = len(outline)
    near, far = (np.column_stack([outline, np.full(count, end)]) for end in (0.5 * along, -0.5 * along))
    after = np.roll(outline, -1, axis=0)
    mathematical = (outline[:, 0] * after[:, 1] - outline[:, 1] * after[:, 0]).sum() > 0.0
    sides = []
    for k in range(count):
        if k not in open_edges:
            beside = (k + 1) % count
            side = np.array([far[beside], far[k], near[k], near[beside]])
            sides.append(side if mathematical else side[::-1])
    ends = (far, near[::-1]) if mathematical else (far[::-1], near)
    return Walls.of([*sides, *ends])
