"""Layers of wall particles behind the walls of a polygon."""

from collections.abc import Sequence

import numpy as np

NEARER = 0.25  # spacings by which a wall particle may be nearer to a wall than its layer is
FAR = 1.5  # kernels' reaches from a corner: there no wall particle sees water that another wall ends
SHARP = np.pi / 6.0  # by which a face turns away at an end: round a smoother one water slides
FIRM = 1  # the layer that holds what has come through the face; the layer before it has gaps there


def layers(
    outline: np.ndarray, spacing: float, rows: int, open_edges: Sequence[int] = ()
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Wall particles in `rows` layers outside a counter-clockwise polygon (m, 2) m.

    Their places (n, 2) m, volumes (n,) m², and how far (n,) m their layers lie behind the face.

    Layer k lies (k + 1/2) `spacing` outside, on the offset polygon with mitred corners, in equal steps of about a
    spacing along each edge (after Adami, Hu & Adams 2012, for any angle). A wall particle's volume is its share of its
    layer, so that together they fill the layer's area. Behind a re-entrant corner, and in a thin wall, wall particles
    that are nearer to another edge than their layer is deep are left out. Edges of `open_edges` have none.
    """
    corners = np.asarray(outline, dtype=float)
    edges = np.roll(corners, -1, axis=0) - corners
    along = edges / np.linalg.norm(edges, axis=1)[:, None]
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1)  # outwards
    before = np.roll(normal, 1, axis=0)
    mitre = (before + normal) / (1.0 + (before * normal).sum(axis=1))[:, None]
    places, volumes, depths = [], [], []
    for row in range(rows):
        depth = (row + 0.5) * spacing
        points, shares, of_edge = _round(corners + depth * mitre, along, spacing)
        kept = ~np.isin(of_edge, list(open_edges)) & (distance(points, corners) > depth - NEARER * spacing)
        places.append(points[kept])
        volumes.append(spacing * shares[kept])
        depths.append(np.full(kept.sum(), depth))
    return np.concatenate(places), np.concatenate(volumes), np.concatenate(depths)


def firm(depths: np.ndarray, spacing: float) -> np.ndarray:
    """Distances (n,) m within which layers at these depths (n,) m push water back; 0 where they do not."""
    return np.where(np.round(depths / spacing - 0.5) == FIRM, depths, 0.0)


def _round(corners: np.ndarray, along: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points in equal steps along each edge of a polygon, their shares (m) of its length, and their edges' numbers."""
    ends = np.roll(corners, -1, axis=0)
    lengths = ((ends - corners) * along).sum(axis=1)  # negative where the offset has turned an edge round
    counts = np.where(lengths > 0.0, np.maximum(1, np.round(lengths / spacing).astype(int)), 0)
    steps = np.where(counts > 0, lengths / np.maximum(counts, 1), 0.0)
    points, shares, of_edge = [], [], []
    for k, count in enumerate(counts):
        points.append(corners[k] + along[k] * steps[k] * np.arange(count)[:, None])
        share = np.full(count, steps[k])
        if count:
            share[0] = 0.5 * (steps[k] + steps[k - 1])
        shares.append(share)
        of_edge.append(np.full(count, k))
    return np.concatenate(points), np.concatenate(shares), np.concatenate(of_edge)


def distance(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Distances (n,) m of points (n, 2) from the nearest edge of a polygon (m, 2)."""
    edges = np.roll(corners, -1, axis=0) - corners
    nearest = np.full(len(points), np.inf)
    for corner, edge in zip(corners, edges, strict=True):
        apart = points - corner
        share = np.clip(apart @ edge / (edge @ edge), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(apart - share[:, None] * edge, axis=1))
    return nearest


def faces(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Unit vectors (n, 2) along a polygon (m, 2) where it is nearest to points (n, 2) m off it.

    They are square to the shortest line from there to the point, at a corner as well.
    """
    away = offset_from(points, corners)
    return np.stack([-away[:, 1], away[:, 0]], axis=1) / np.linalg.norm(away, axis=1)[:, None]


def offset_from(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """From where a polygon, or a line to and fro, (m, 2) m is nearest to points (n, 2) m, to these: (n, 2) m."""
    edges = np.roll(corners, -1, axis=0) - corners
    nearest = edge_of(points, corners)
    along, away = edges[nearest], points - corners[nearest]
    share = (away * along).sum(axis=1) / (along**2).sum(axis=1)
    return away - np.clip(share, 0.0, 1.0)[:, None] * along


def deep(points: np.ndarray, along: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """How far (n,) m the points are off the face `along` (n, 2) before them: its right is positive."""
    away = offset_from(points, corners)
    return away[:, 0] * along[:, 1] - away[:, 1] * along[:, 0]


def straight(points: np.ndarray, along: np.ndarray, corners: np.ndarray, reach: float) -> np.ndarray:
    """`along` (n, 2) of particles at `points` (n, 2) m, zero near the `corners` (m, 2) m; `reach` (m): the kernel's."""
    away = np.linalg.norm(points[:, None] - corners, axis=2).min(axis=1, initial=np.inf)
    return along * (away > FAR * reach)[:, None]


def sharp(corners: np.ndarray) -> np.ndarray:
    """Those corners (k, 2) of a counter-clockwise polygon (m, 2) m where it turns right by more than SHARP."""
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    turns = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], (before * after).sum(axis=1))
    return corners[turns < -SHARP]


def edge_of(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """The edge (n,) of a polygon (m, 2) that is nearest to each point (n, 2) m, by its first corner."""
    edges = np.roll(corners, -1, axis=0) - corners
    apart = points[:, None] - corners
    shares = np.clip((apart * edges).sum(axis=2) / (edges**2).sum(axis=1), 0.0, 1.0)
    return np.linalg.norm(apart - shares[..., None] * edges, axis=2).argmin(axis=1)
