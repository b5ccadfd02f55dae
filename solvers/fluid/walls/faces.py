"""The faces of a prism: on which of them a point lies, and how much room there is around it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.fluid.walls.layers import distance
from solvers.tank.outline import inside


@dataclass(frozen=True, eq=False)
class Spot:
    """The point of a face of a prism that is nearest to a given point, y, z and x.

    `face`: the number of the face, of the edges and then of the ends at −x and x; `foot` (3,) m; `along` (2, 3) unit
    vectors along the face, `normal` (3,) that out of the tank; `away` (m), how far the given point is off; `room` (m)
    from the foot to the nearest edge of the face.
    """

    face: int
    foot: np.ndarray
    along: np.ndarray
    normal: np.ndarray
    away: float
    room: float

    def disc(self, radius: float, spacing: float) -> np.ndarray:
        """Points (n, 3) m for the mean over a disc in the face, at most half a spacing (m) or so apart.

        Each of n rings has three points for each of its shares of the area, n² in all, at the radius with the mean
        square distance of its ring: the mean of these points is exact for quadratic functions.
        """
        rings = np.arange(int(np.ceil(2.0 * radius / spacing))) if radius else np.zeros(0)
        found = [self.foot[None]] if not len(rings) else []
        for ring in rings:
            count = 3 * (2 * int(ring) + 1)
            turn = 2.0 * np.pi * (np.arange(count) + 0.5) / count
            out = radius * np.sqrt(0.5 * (ring**2 + (ring + 1.0) ** 2)) / len(rings)
            found.append(self.foot + out * (np.column_stack([np.cos(turn), np.sin(turn)]) @ self.along))
        return np.concatenate(found)


def spot_on(
    point: np.ndarray, outline: np.ndarray, half: float, ends: bool = True, open_edges: Sequence[int] = ()
) -> Spot:
    """Where a point (3,) m is on a prism over an outline (m, 2) m, from −`half` to `half` (m); `ends`: it has ends."""
    point = np.asarray(point, dtype=float)
    section, x = point[:2], float(np.clip(point[2], -half, half))
    edges = np.roll(outline, -1, axis=0) - outline
    lengths = np.linalg.norm(edges, axis=1)
    shares = np.clip(((section - outline) * edges).sum(axis=1) / lengths**2, 0.0, 1.0)
    feet = outline + shares[:, None] * edges
    apart = np.linalg.norm(feet - section, axis=1)
    apart[list(open_edges)] = np.inf
    k = int(apart.argmin())
    foot, ahead = np.array([*feet[k], x]), edges[k] / lengths[k]
    room = min(shares[k] * lengths[k], (1.0 - shares[k]) * lengths[k], half - abs(x))
    along = np.array([[*ahead, 0.0], [0.0, 0.0, 1.0]])
    normal = np.array([ahead[1], -ahead[0], 0.0])
    found = Spot(k, foot, along, normal, float(np.linalg.norm(foot - point)), float(room))
    if not (ends and inside(section[None], outline)[0]) or half - abs(x) >= found.away:
        return found
    side = -1.0 if point[2] < 0.0 else 1.0
    foot, normal, along = np.array([*section, side * half]), np.array([0.0, 0.0, side]), np.eye(3)[:2]
    room = float(distance(section[None], outline)[0])
    return Spot(len(outline) + (side > 0.0), foot, along, normal, float(np.linalg.norm(foot - point)), room)
