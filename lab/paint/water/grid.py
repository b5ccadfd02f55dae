"""Sums over particles at the nodes of a grid that is fixed in the tank.

The kernel is W = 4/(π R²) (1 − r²/R²)³ in the plane, of the form of Müller, Charypar & Gross (2003), eq. 20: it needs
no root. The sum Σ V W of the particles is one in the midst of the water and one half on its surface. Beside a wall a
part of the kernel lies behind the wall, where there is no water; the sum is divided by the part that lies in the tank.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import taichi as ti

from lab.paint.painter import BAND, PER_TASK, Index, Shares, Table, off_outline, sort_into_bands, whole

REACH = 2.1  # R over the distance of the particles; smaller, and their lattice shows, larger, and corners grow round
FINEST = 0.25  # distance of the nodes over that of the particles, where pixels are finer
REACH_IN_NODES = 2.2  # least R over the distance of the nodes, where pixels are coarser
HALF = 0.5  # the level on the surface
LEAST = 0.05  # of the kernel inside the tank: nodes behind walls, where the quotient is never looked at
BEYOND = 0.35  # how far the grid goes on beyond an open edge, over the tank's larger side


@dataclass(frozen=True)
class Grid:
    """Nodes at low + distance (column, row) in the tank's axes, m; reach: radius R of the kernel, m.

    `rows`, `columns`: their numbers. outline, open_edges: of the tank.
    """

    low: tuple[float, float]
    distance: float
    rows: int
    columns: int
    reach: float
    outline: np.ndarray
    open_edges: tuple[int, ...] = ()

    @classmethod
    def over(cls, outline: np.ndarray, open_edges: Sequence[int], spacing: float, pixel: float) -> "Grid":
        """The grid over a tank for particles `spacing` (m) apart and pixels of this size (m)."""
        distance = max(pixel, FINEST * spacing)
        reach = max(REACH * spacing, REACH_IN_NODES * distance)
        size = np.ptp(outline, axis=0)
        more = 2.0 * distance + (BEYOND * size.max() if len(open_edges) else 0.0)
        half = np.ceil((0.5 * size + more) / distance).astype(int)  # even about the middle, as a mirror image must be
        low = 0.5 * (outline.min(axis=0) + outline.max(axis=0)) - distance * half
        return cls(tuple(low), distance, 2 * half[1] + 1, 2 * half[0] + 1, reach, outline, tuple(open_edges))

    def nodes(self, places: np.ndarray) -> np.ndarray:
        """Places (n, 2) m in units of the nodes, column and row."""
        return (places - self.low) / self.distance

    def sums(self, places: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Σ weight W at the nodes (rows, columns) of particles at places (n, 2) m; weight (n,): m² times a value."""
        sums, reach = np.zeros((self.rows, self.columns), dtype=np.float32), self.reach / self.distance
        at = self.nodes(places)
        starts, members = sort_into_bands(at[:, 1], np.full(len(at), reach + 1.0), self.rows)
        if len(members):
            peak = 4.0 / (np.pi * self.reach**2)
            _add(sums, starts, members, np.column_stack([at, peak * weight]), reach)
        return sums

    def level(self, sums: np.ndarray) -> np.ndarray:
        """The share of the kernel inside the tank that the sums Σ V W fill, at the nodes."""
        return sums / self._inside

    def surface(self, level: np.ndarray, spacing: float) -> np.ndarray:
        """The uppermost places (k, 2) m where the level falls through one half, across the tank; NaN where it is dry.

        The median over a `spacing` (m) to either side leaves out drops.
        """
        inside = np.where(self.distances < 0.5 * self.distance, level, 0.0)
        wet = inside >= HALF
        top = self.rows - 1 - np.argmax(wet[::-1], axis=0)
        upper, columns = np.minimum(top + 1, self.rows - 1), np.arange(self.columns)
        here, above = inside[top, columns], level[upper, columns]
        share = np.clip((here - HALF) / np.maximum(here - above, 1e-6), 0.0, 1.0)
        height = np.where(wet.any(axis=0), top + share, np.nan)
        reach = max(1, round(spacing / self.distance))
        padded = np.pad(height, reach, mode="edge")
        known = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
        left, right = self.outline[:, 0].min(), self.outline[:, 0].max()
        y = self.low[0] + self.distance * columns
        smooth = np.where(np.isfinite(height), np.nanmedian(np.where(np.isfinite(known), known, -1.0), axis=1), np.nan)
        kept = (y >= left) & (y <= right)
        return np.column_stack([y, self.low[1] + self.distance * smooth])[kept]

    @cached_property
    def distances(self) -> np.ndarray:
        """Distance (m) of each node from the tank's outline, negative inside; far beyond an open edge it is, too."""
        found = _signed(self, self.outline)
        for sheet in self._beyond():
            found = np.minimum(found, _signed(self, sheet))
        return found

    @cached_property
    def _inside(self) -> np.ndarray:
        """The part of the kernel about each node that lies in the tank."""
        covered = np.clip(0.5 - self.distances / self.distance, 0.0, 1.0)
        wide = int(np.ceil(self.reach / self.distance))
        steps = np.arange(-wide, wide + 1) * self.distance / self.reach
        kernel = np.clip(1.0 - steps[:, None] ** 2 - steps**2, 0.0, None) ** 3
        from scipy.signal import fftconvolve  # slow to import

        inside = fftconvolve(covered, kernel / kernel.sum(), mode="same")
        return np.maximum(inside, LEAST).astype(np.float32)

    def _beyond(self) -> list[np.ndarray]:
        """The space (4, 2) m beyond each open edge, into which water may leave."""
        far = 2.0 * BEYOND * np.ptp(self.outline, axis=0).max()
        sheets = []
        for k in self.open_edges:
            first, second = self.outline[k], self.outline[(k + 1) % len(self.outline)]
            along = (second - first) / np.linalg.norm(second - first)
            outwards = far * np.array([along[1], -along[0]])
            sheets.append(np.array([first, first + outwards, second + outwards, second]))
        return sheets


def sampled(field: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Values (n,) of a field at the nodes (rows, columns), bilinear at places (n, 2) in units of the nodes."""
    column = np.clip(at[:, 0], 0.0, field.shape[1] - 1.001)
    row = np.clip(at[:, 1], 0.0, field.shape[0] - 1.001)
    left, low = column.astype(int), row.astype(int)
    x, y = column - left, row - low
    below = (1.0 - x) * field[low, left] + x * field[low, left + 1]
    above = (1.0 - x) * field[low + 1, left] + x * field[low + 1, left + 1]
    return (1.0 - y) * below + y * above


def _signed(grid: Grid, corners: np.ndarray) -> np.ndarray:
    """Distance (m) of each node from a polygon, negative inside."""
    found = np.zeros((grid.rows, grid.columns), dtype=np.float32)
    _measure(found, np.ascontiguousarray(grid.nodes(corners)))
    return found * grid.distance


@ti.kernel
def _measure(found: Shares, corners: Table):
    for row, column in ti.ndrange(found.shape[0], found.shape[1]):
        found[row, column] = ti.cast(off_outline(ti.cast(column, ti.f64), ti.cast(row, ti.f64), corners), ti.f32)


@ti.kernel
def _add(sums: Shares, starts: Index, members: Index, particles: Table, reach: ti.f64):
    """Add the particles band by band in the order of their numbers, so that threads change no digit."""
    inverse = ti.cast(1.0 / (reach * reach), ti.f32)
    for k in range((starts.shape[0] - 1) * PER_TASK):
        if k % PER_TASK == 0:
            band = k // PER_TASK
            top, bottom = band * BAND, ti.min((band + 1) * BAND, sums.shape[0])
            for entry in range(starts[band], starts[band + 1]):
                i = members[entry]
                x, y, weight = particles[i, 0], particles[i, 1], ti.cast(particles[i, 2], ti.f32)
                first = whole(y - reach + 1.0, top, bottom)
                last = whole(y + reach + 1.0, top, bottom)
                for row in range(first, last):
                    up = row - y
                    half = ti.sqrt(ti.max(reach * reach - up * up, 0.0))
                    left = whole(x - half + 1.0, 0, sums.shape[1])
                    right = whole(x + half + 1.0, 0, sums.shape[1])
                    offset, over = ti.cast(left - x, ti.f32), ti.cast(1.0 - up * up * inverse, ti.f32)
                    for column in range(left, right):
                        part = over - offset * offset * inverse
                        sums[row, column] += weight * part * part * part
                        offset += 1.0
