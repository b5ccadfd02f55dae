"""Linear sloshing in a tank of any shape by finite elements: free frequencies and their flow, without the solver.

∇²φ = 0 in the water, ∂φ/∂n = 0 on the walls, ∂φ/∂n = (ω²/g) φ on the level surface (Lamb 1932, §228). With linear
triangles K φ = (ω²/g) M φ, where M has only the surface's nodes; those within are eliminated (Ibrahim 2005, ch. 2).
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import LinearNDInterpolator
from scipy.linalg import eigh
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

G = 9.81  # m/s²


@dataclass(frozen=True)
class Mode:
    """A free oscillation: its rate ω (1/s), and the potential (n,) at nodes (n, 2) m of triangles (t, 3)."""

    rate: float
    nodes: np.ndarray
    triangles: np.ndarray
    potential: np.ndarray

    def flow(self, place: np.ndarray) -> np.ndarray:
        """Its velocities at places (m, 2), the largest at any node taken as 1."""
        slope, area = gradients(self.nodes, self.triangles)
        within = np.einsum("tka,tk->ta", slope, self.potential[self.triangles])
        at_nodes, weight = np.zeros_like(self.nodes), np.zeros(len(self.nodes))
        for corner in self.triangles.T:  # the mean of the triangles round each node
            np.add.at(at_nodes, corner, within * area[:, None])
            np.add.at(weight, corner, area)
        at_nodes /= weight[:, None]
        at_nodes /= np.linalg.norm(at_nodes, axis=1).max()
        return LinearNDInterpolator(self.nodes, at_nodes)(place)


def sides(outline: np.ndarray, height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where a tank's left and right walls are, y (m) at heights (m); each wall must rise all the way."""
    middle, found = outline[:, 0].mean(), []
    for wall in (outline[outline[:, 0] < middle], outline[outline[:, 0] > middle]):
        wall = wall[np.argsort(wall[:, 1])]
        found.append(np.interp(height, wall[:, 1], wall[:, 0]))
    return found[0], found[1]


def mesh(outline: np.ndarray, depth: float, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (n, 2) m, row by row from the floor, and triangles (t, 3) of the water up to a depth (m).

    Rows are spread between the heights of the outline's corners, so that no wall bends within one.
    """
    heights = np.unique([*(z for z in outline[:, 1] if z < depth), depth])
    parts = [
        np.linspace(low, high, max(2, round(rows * (high - low) / depth)), endpoint=False)
        for low, high in pairwise(heights)
    ]
    z = np.append(np.concatenate(parts), depth)
    left, right = sides(outline, z)
    share = np.linspace(0.0, 1.0, columns + 1)
    y = left[:, None] + (right - left)[:, None] * share
    nodes = np.stack([y, np.broadcast_to(z[:, None], y.shape)], axis=-1).reshape(-1, 2)
    corner = (np.arange(len(z) - 1)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    above = corner + columns + 1
    triangles = [[corner, corner + 1, above], [corner + 1, above + 1, above]]
    return nodes, np.concatenate([np.stack(one, axis=1) for one in triangles])


def gradients(nodes: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Gradients (t, 3, 2) 1/m of the three linear functions of each triangle, and its area (t,) m²."""
    corner = nodes[triangles]
    edge = np.roll(corner, 1, axis=1) - np.roll(corner, -1, axis=1)  # opposite each corner, clockwise
    area = 0.5 * np.abs(edge[:, 0, 0] * edge[:, 1, 1] - edge[:, 0, 1] * edge[:, 1, 0])
    inward = np.stack([edge[..., 1], -edge[..., 0]], axis=-1)
    return inward / (2.0 * area)[:, None, None], area


def first_mode(outline: np.ndarray, depth: float, columns: int = 80, rows: int = 50) -> Mode:
    """The slowest free oscillation of water of a depth (m) in a tank; with columns × rows of pairs of triangles.

    The error of ω falls with the square of the mesh's size.
    """
    nodes, triangles = mesh(outline, depth, columns, rows)
    slope, area = gradients(nodes, triangles)
    element = np.einsum("tia,tja,t->tij", slope, slope, area)
    row, column = np.repeat(triangles, 3, axis=1), np.tile(triangles, 3)
    stiffness = coo_matrix((element.ravel(), (row.ravel(), column.ravel())), shape=(len(nodes),) * 2).tocsc()
    inside = np.arange(len(nodes) - columns - 1)
    surface = np.arange(len(inside), len(nodes))
    coupling = stiffness[inside][:, surface].toarray()
    within = -splu(stiffness[inside][:, inside].tocsc()).solve(coupling)
    condensed = stiffness[surface][:, surface].toarray() + coupling.T @ within
    size = np.diff(nodes[surface, 0])
    mass = np.diag(np.append(size, 0.0) / 3.0 + np.append(0.0, size) / 3.0)
    mass += np.diag(size / 6.0, 1) + np.diag(size / 6.0, -1)
    values, vectors = eigh(0.5 * (condensed + condensed.T), mass, subset_by_index=[0, 1])  # the first is at rest
    potential = np.append(within @ vectors[:, 1], vectors[:, 1])
    return Mode(float(np.sqrt(G * values[1])), nodes, triangles, potential)
