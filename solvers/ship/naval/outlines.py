"""The outlines of all stations at once, for the searches that ask for their areas and breadths many times."""

from collections.abc import Sequence

import numpy as np

from solvers.ship.section import Section, clipped, crossings


class Outlines:
    """Corners of sections in a row, each outline closed; the stations without a section have none."""

    def __init__(self, sections: Sequence[Section | None]):
        closed = [np.zeros((0, 2)) if one is None else one.outline[[*range(len(one.outline)), 0]] for one in sections]
        self.count = len(closed)
        self.corners = np.concatenate(closed)
        self.station = np.repeat(np.arange(self.count), [len(one) for one in closed])  # of each corner
        self.edge = self.station[1:] == self.station[:-1]  # whether a corner and the next are of one outline
        self.furthest = float(np.hypot(*self.corners.T).max())

    def wet(self, level: np.ndarray, roll: float) -> tuple[np.ndarray, np.ndarray]:
        """Areas below water (n,) m² and breadths of the waterline (n,) m at a roll; level (n,) m as in `Form`."""
        cos, sin = np.cos(roll), np.sin(roll)
        y = cos * self.corners[:, 0] - sin * self.corners[:, 1]
        depth = level[self.station] - sin * self.corners[:, 0] - cos * self.corners[:, 1]
        y0, d0, y1, d1 = clipped(y, depth)
        crossing, sign = crossings(y, depth)
        areas, breadths = 0.5 * (y1 - y0) * (d0 + d1), sign * crossing
        return self._summed(areas), self._summed(breadths)

    def _summed(self, values: np.ndarray) -> np.ndarray:
        """Sums (n,) over the edges of each station."""
        return np.bincount(self.station[:-1][self.edge], values[self.edge], self.count)
