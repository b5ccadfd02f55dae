"""Straight panels on the wetted outline of a section, and points inside it on the waterline."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.section import Section

INTERIOR = 0.15  # points on the interior waterline per panel
LEAST_INTERIOR = 8


@dataclass(frozen=True, eq=False)
class Panels:
    """Panels from `start` to `end` (n,), complex y + i z in m, with the water to their right."""

    start: np.ndarray
    end: np.ndarray

    @cached_property
    def length(self) -> np.ndarray:
        """Lengths (n,) m."""
        return np.abs(self.end - self.start)

    @cached_property
    def tangent(self) -> np.ndarray:
        """Unit tangents (n,), complex."""
        return (self.end - self.start) / self.length

    @property
    def normal(self) -> np.ndarray:
        """Unit normals into the water (n,), complex."""
        return -1j * self.tangent

    @property
    def middle(self) -> np.ndarray:
        """Middles (n,), complex."""
        return 0.5 * (self.start + self.end)


def wet_panels(section: Section, heave: float, roll: float, count: int, halved: int = 0) -> Panels:
    """About `count` panels on the outline below calm water, distributed by length, with at least one per edge.

    On each edge they have cosine spacing, densest at its ends, since the flow is singular at a sharp corner. `halved`
    is how often each of them is then cut in two, so that errors can be extrapolated. Raises `Unavailable` if the hull
    is dry.
    """
    edges = section.wet_edges(heave, roll)
    if not len(edges):
        raise Unavailable("the hull does not touch the water: lower its heave.")
    ends = edges[..., 0] + 1j * edges[..., 1]
    length = np.abs(ends[:, 1] - ends[:, 0])
    each = np.maximum(1, np.rint(count * length / length.sum())).astype(int) << halved
    start, end = [], []
    for (first, last), n in zip(ends, each, strict=True):
        nodes = first + (last - first) * 0.5 * (1.0 - np.cos(np.pi * np.arange(n + 1) / n))
        start.append(nodes[:-1])
        end.append(nodes[1:])
    return Panels(np.concatenate(start), np.concatenate(end))


def interior_points(section: Section, heave: float, roll: float, panels: int) -> np.ndarray:
    """Points (m,) y + 0i inside the hull on the calm waterline, denser towards its ends."""
    lines = section.waterlines(heave, roll)[:, :, 0]
    count = max(LEAST_INTERIOR, round(INTERIOR * panels))
    # Gauss–Legendre points: their spacing matches no standing wave inside the hull.
    places = np.polynomial.legendre.leggauss(count)[0]
    points = [0.5 * (a + b) + 0.5 * (b - a) * places for a, b in lines]
    return np.concatenate([*points, np.empty(0)]).astype(complex)
