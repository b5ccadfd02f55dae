"""Walls in space: flat faces that are seen from inside, and the lines along their edges.

A face is drawn where the camera is on its inner side, so the floor and the far walls are behind the cargo; of the near
walls only the edges are drawn. Panes are seen from both sides, and through.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from solvers.tank.shapes import PrismShape, SphereShape

FACETS = 96  # of a surface turned about an axis
LEVEL = 1e-6  # slope below which a plate is level
MANY = 200  # corners
SAME = 1e-6  # of the size of all: corners that are closer are one


@dataclass(frozen=True, eq=False)
class Walls:
    """Flat faces, their corners counter-clockwise as seen from the inner side.

    points (n, 3) m: the corners of all faces, one face after the other; first (m + 1,): where each begins;
    pane (m,): whether a face is a pane, as plates in a tank are.
    """

    points: np.ndarray
    first: np.ndarray
    pane: np.ndarray

    @classmethod
    def of(cls, faces: Sequence[np.ndarray], pane: bool = False) -> "Walls":
        """Walls of these polygons, each (k, 3) m."""
        first = np.cumsum([0, *(len(face) for face in faces)]).astype(np.int32)
        points = np.concatenate([np.zeros((0, 3)), *faces])
        return cls(points, first, np.full(len(faces), pane))

    @classmethod
    def joined(cls, several: Iterable["Walls"]) -> "Walls":
        """All these walls in one."""
        found = list(several)
        starts = np.cumsum([0, *(len(one.points) for one in found)])
        first = [start + one.first[:-1] for start, one in zip(starts, found, strict=False)]
        points = np.concatenate([np.zeros((0, 3)), *(one.points for one in found)])
        pane = np.concatenate([np.zeros(0, dtype=bool), *(one.pane for one in found)])
        return cls(points, np.concatenate([*first, [len(points)]]).astype(np.int32), pane)

    @classmethod
    def apart(cls, several: Sequence["Walls"]) -> "Walls":
        """All these walls in one, which have no edges in common, and whose edges need not be found again."""
        found, edges = cls.joined(several), [one.edges for one in several]
        starts = np.cumsum([0, *(len(one.pane) for one in several)])
        faces = [np.where(beside < 0, -1, start + beside) for start, (_, beside) in zip(starts, edges, strict=False)]
        known = {"edges": (np.concatenate([ends for ends, _ in edges]), np.concatenate(faces))}
        found.__dict__.update(known, normals=np.concatenate([one.normals for one in several]))
        return found

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
        if not len(self.pane):
            return np.zeros((0, 3))
        off = self.points - np.repeat(self.points[self.first[:-1]], np.diff(self.first), axis=0)
        area = np.add.reduceat(np.cross(off, off[self.after]), self.first[:-1], axis=0)
        return area / np.maximum(np.linalg.norm(area, axis=1, keepdims=True), 1e-300)

    @cached_property
    def edges(self) -> tuple[np.ndarray, np.ndarray]:
        """Ends (e, 2, 3) m of all edges and the two faces (e, 2) at each; −1 where there is only one."""
        if not len(self.pane):
            return np.zeros((0, 2, 3)), np.zeros((0, 2), dtype=int)
        size = max(float(np.ptp(self.points, axis=0).max()), 1e-300)
        _, corner = np.unique(np.round(self.points / (SAME * size)).astype(np.int64), axis=0, return_inverse=True)
        pairs = np.sort(np.column_stack([corner.ravel(), corner.ravel()[self.after]]), axis=1)
        face = np.repeat(np.arange(len(self.pane)), np.diff(self.first))
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
        found = Walls(place + self.points @ turned.T, self.first, self.pane)
        ends, faces = self.edges
        found.__dict__.update(edges=(place + ends @ turned.T, faces), normals=self.normals @ turned.T, after=self.after)
        return found

    def facing(self, eye: np.ndarray) -> np.ndarray:
        """Whether (m,) each face is seen by a camera at this place (3,), m."""
        return (((eye - self.points[self.first[:-1]]) * self.normals).sum(axis=1) > 0.0) | self.pane


def drawn_out(line: np.ndarray, along: float) -> Walls:
    """A plate with a cross-section (m, 2) y, z in m, as long in x as `along` (m)."""
    ends = [np.column_stack([line, np.full(len(line), end)]) for end in (0.5 * along, -0.5 * along)]
    pieces = [np.array([ends[1][k + 1], ends[1][k], ends[0][k], ends[0][k + 1]]) for k in range(len(line) - 1)]
    return Walls.of(pieces, pane=True)


def turned_plate(line: np.ndarray) -> Walls:
    """A plate with a section (m, 2) y, z in m, turned about z: seen from the axis, where it is level a pane.

    What is drawn left of the axis is the same again, and is left out.
    """
    pieces = [Walls.of([])]
    for start, end in pairwise(line):
        level = abs(end[1] - start[1]) < LEVEL * abs(end[0] - start[0])
        pieces.append(_turned(*((start, end) if end[1] > start[1] else (end, start)), pane=level))
    return Walls.joined(pieces)


def turned_tank(outline: np.ndarray, open_edges: Sequence[int] = ()) -> Walls:
    """The walls of a tank with a section (m, 2) y, z in m, the same on both sides of y = 0, turned about z."""
    pairs = [(outline[k], outline[(k + 1) % len(outline)]) for k in range(len(outline)) if k not in open_edges]
    pairs = pairs if _counter_clockwise(outline) else [(end, start) for start, end in pairs]
    return Walls.joined([_turned(start, end) for start, end in pairs])


def lying_tank(profile: np.ndarray) -> Walls:
    """The walls of a tank with a section (m, 2) across the axis x and along it, alike on both sides, turned about x."""
    standing = turned_tank(profile)  # z and x are exchanged, which turns the way round a face
    faces = [standing.points[a:b][::-1, [0, 2, 1]] for a, b in pairwise(standing.first)]
    return Walls.of(faces)


def _turned(start: np.ndarray, end: np.ndarray, pane: bool = False) -> Walls:
    """A straight piece of a section, as far as it is right of the axis, turned; its inner side is on its left."""
    if max(start[0], end[0]) <= 0.0:
        return Walls.of([])
    low, high = sorted((start, end), key=lambda point: point[0])
    axis = low + max(-low[0], 0.0) / (high[0] - low[0]) * (high - low) if low[0] < 0.0 else low
    start, end = (axis, high) if low is start else (high, axis)
    angle = 2.0 * np.pi / FACETS * np.arange(FACETS + 1)
    one, two = (
        np.column_stack([r * np.cos(angle), np.full(FACETS + 1, z), r * np.sin(angle)]) for r, z in (start, end)
    )
    return Walls.of([np.array([two[k], one[k], one[k + 1], two[k + 1]]) for k in range(FACETS)], pane)


def _counter_clockwise(outline: np.ndarray) -> bool:
    after = np.roll(outline, -1, axis=0)
    return bool((outline[:, 0] * after[:, 1] - outline[:, 1] * after[:, 0]).sum() > 0.0)


def prism(outline: np.ndarray, along: float, open_edges: Sequence[int] = ()) -> Walls:
    """The walls of a tank with a cross-section (m, 2) y, z in m and a length (m) in x, its middle at x = 0.

    open_edges: edges k of the cross-section, from corner k to the next, without a wall.
    """
    count = len(outline)
    near, far = (np.column_stack([outline, np.full(count, end)]) for end in (0.5 * along, -0.5 * along))
    inward, sides = _counter_clockwise(outline), []
    for k in range(count):
        if k not in open_edges:
            beside = (k + 1) % count
            side = np.array([far[beside], far[k], near[k], near[beside]])
            sides.append(side if inward else side[::-1])
    ends = (far, near[::-1]) if inward else (far[::-1], near)
    return Walls.of([*sides, *ends])


def solid_walls(shape: SphereShape | PrismShape) -> Walls:
    """The faces of a solid body, which is seen from outside."""
    if isinstance(shape, SphereShape):
        y, z, x = shape.middle
        angle = np.pi * np.arange(FACETS // 2 + 1) / (FACETS // 2)
        outline = np.column_stack([shape.radius * np.sin(angle), -shape.radius * np.cos(angle)])
        pairs = pairwise(outline)
        found, offset = Walls.joined([_turned(end, start) for start, end in pairs]), np.array([y, z, x])
    else:
        inner, offset = prism(shape.polygon, shape.along), np.array([0.0, 0.0, shape.middle])
        found = Walls.of([inner.points[a:b][::-1] for a, b in pairwise(inner.first)])
    return Walls(found.points + offset, found.first, found.pane)
