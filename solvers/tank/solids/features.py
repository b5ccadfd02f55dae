"""What of a mesh grains may touch: its faces, and those of its edges and corners that stand out towards the grains.

A grain touches a face only where its centre is over it, an edge only between its ends and beside both faces, and a
corner only beyond all edges there. So no contact counts twice, as in the plane.
"""

from dataclasses import dataclass

import numpy as np

from solvers.tank.solids.mesh import Mesh

FLAT = 4e-7  # of the mesh's size, that a triangle's corner may leave its neighbour's plane: files have 32-bit numbers
SMOOTH = np.cos(np.radians(30.0))  # faces that meet at a smaller angle are parts of one round surface
SIDES = (0, 1), (1, 2), (2, 0)

# Columns of a face's row: its normal, then for each side its start (m), the direction from it into the face, and 0, or
# BARELY (m) where a point right above the side is the other face's.
NORMAL, SIDE, INTO, OTHERS = 0, 3, 3, 6
BARELY = 1e-37
A_SIDE = 7
A_FACE = SIDE + 3 * A_SIDE
# Columns of an edge's row: start (m), direction, end (m), and the directions into both faces.
ALONG, END, ONE, TWO = 3, 6, 9, 12
AN_EDGE = 15
# Columns of a corner's row: its place (m), and which of the spokes are its edges, from and before.
FIRST, LAST = 3, 4
A_CORNER = 5


@dataclass(frozen=True)
class Features:
    """Rows of `faces`, `edges` and `corners`; `spokes` (k, 3): directions of the edges at corners.

    `group`: of all features, in this order, the smooth surface that each is of; others have one of their own.
    """

    faces: np.ndarray
    edges: np.ndarray
    corners: np.ndarray
    spokes: np.ndarray
    group: np.ndarray


def features_of(mesh: Mesh) -> Features:
    """The features of a mesh, whose walls act on both sides if it is open."""
    ends, beside, sides = _topology(mesh)
    into, others, flat = _directions(mesh, ends, beside)
    normals, rim = mesh.normals, beside[:, 1] < 0
    starts, directions = mesh.corners[ends[:, 0]], mesh.corners[ends[:, 1]] - mesh.corners[ends[:, 0]]
    directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    standing = ~flat
    if not mesh.open:
        out = -(into[:, 0] + into[:, 1])  # where it stands out, and whether that is towards the grains
        standing &= (out * (normals[beside[:, 0]] + normals[beside[:, 1]])).sum(axis=1) > 0.0
    faces = np.zeros((len(normals), A_FACE))
    faces[:, NORMAL : NORMAL + 3] = normals
    for k, number in enumerate(sides.T):
        second = (beside[number, 1] == np.arange(len(faces))).astype(int)
        column = SIDE + k * A_SIDE
        faces[:, column : column + 3] = starts[number]
        faces[:, column + INTO : column + INTO + 3] = into[number, second]
        faces[:, column + OTHERS] = others[number, second]
    edges = np.column_stack([starts, directions, mesh.corners[ends[:, 1]], into[:, 0], into[:, 1]])[standing]
    which = np.unique(ends[standing])
    spokes, corners = _corners(mesh, which, ends, directions)
    surface = _surfaces(normals, beside)
    alike = rim | (surface[beside[:, 0]] == surface[beside[:, 1]])
    own_group = surface.max() + 1 + np.arange(len(ends) + len(which))
    of_edges = np.where(alike, surface[beside[:, 0]], own_group[: len(ends)])[standing]
    return Features(faces, edges, corners, spokes, _groups(mesh, surface, of_edges, which, own_group[len(ends) :]))


def _topology(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners (e, 2) of the edges, the faces (e, 2) beside each, −1 for none, and the edges (m, 3) of each face."""
    count = len(mesh.triangles)
    sides = np.stack([mesh.triangles[:, side] for side in SIDES], axis=1).reshape(-1, 2)
    ends, which = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    which = which.reshape(count, 3)
    beside = np.full((len(ends), 2), -1)
    for face, edges in enumerate(which):
        for edge in edges:
            beside[edge, int(beside[edge, 0] >= 0)] = face
    return ends, beside, which


def _directions(mesh: Mesh, ends: np.ndarray, beside: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of each edge the directions (e, 2, 3) into its faces, how far (e, 2) m into each a point counts, and whether it
    is flat (e,).

    The two directions at a flat edge are opposite to the last bit, and what is right above it is one face's: so any
    point is over just one.
    """
    along = mesh.corners[ends[:, 1]] - mesh.corners[ends[:, 0]]
    inside, middle = mesh.points.mean(axis=1), mesh.corners[ends[:, 0]]
    into = np.zeros((len(ends), 2, 3))
    for k in (0, 1):
        face = np.where(beside[:, k] < 0, beside[:, 0], beside[:, k])
        across = np.cross(mesh.normals[face], along)
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        into[:, k] = across * np.sign(((inside[face] - middle) * across).sum(axis=1))[:, None]
    rim = beside[:, 1] < 0
    slack = FLAT * float(np.ptp(mesh.corners, axis=0).max())
    off = [
        np.abs(((mesh.points[beside[:, k]] - middle[:, None]) * mesh.normals[beside[:, 1 - k], None]).sum(axis=2))
        for k in (0, 1)
    ]
    opposite = (into[:, 0] * into[:, 1]).sum(axis=1) < 0.0
    flat = ~rim & opposite & (np.maximum(*off).max(axis=1) <= slack)
    into[flat, 1] = -into[flat, 0]
    others = np.zeros((len(ends), 2))
    others[flat, 1] = BARELY
    return into, others, flat


def _corners(mesh: Mesh, which: np.ndarray, ends: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The spokes of some corners, one corner after the other, and the corners' rows."""
    hub = np.concatenate([ends[:, 0], ends[:, 1]])
    away = np.concatenate([directions, -directions])
    order = np.argsort(hub, kind="stable")
    first, last = (np.searchsorted(hub[order], which, side=side) for side in ("left", "right"))
    return away[order], np.column_stack([mesh.corners[which], first, last]).astype(float)


def _surfaces(normals: np.ndarray, beside: np.ndarray) -> np.ndarray:
    """The smooth surface, by its number, that each face (m,) is of."""
    from scipy.sparse import coo_array  # slow to import
    from scipy.sparse.csgraph import connected_components

    inner = beside[beside[:, 1] >= 0]
    one, two = inner[(normals[inner[:, 0]] * normals[inner[:, 1]]).sum(axis=1) > SMOOTH].T
    links = coo_array((np.ones(len(one)), (one, two)), shape=(len(normals), len(normals)))
    return connected_components(links, directed=False)[1]


def _groups(mesh: Mesh, surface: np.ndarray, of_edges: np.ndarray, which: np.ndarray, own: np.ndarray) -> np.ndarray:
    """The groups of faces, edges and of some corners, which are of a surface if all their faces are."""
    low, high = np.full(len(mesh.corners), len(surface)), np.full(len(mesh.corners), -1)
    for side in range(3):
        np.minimum.at(low, mesh.triangles[:, side], surface)
        np.maximum.at(high, mesh.triangles[:, side], surface)
    of_corners = np.where(low[which] == high[which], low[which], own)
    return np.concatenate([surface, of_edges, of_corners]).astype(np.int32)
