"""A tank from an STL file: how it is read, and what is refused."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.surfaces.stl import triangles_of, welded
from lab.preset.units import show, shown_path
from solvers.tank.solids.mesh import UP, Mesh

MOST = 20_000  # triangles
COLUMNS = tuple(f"{axis}{corner}" for corner in "abc" for axis in "yzx")
UNITS = {"m": 1.0, "dm": 0.1, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}
LEVEL = 1e-5  # of the largest extent: by so much the rim of a mouth may leave the level of the top
THIN = 1e-9  # of the largest extent, times its longest side: a triangle with less area has none
SMALLEST, LARGEST = 1e-3, 1e3  # m, of the largest extent


def read_mesh(path: str, key: str) -> dict[str, np.ndarray]:
    """The corners of an STL file's triangles by COLUMNS, in the file's unit. Raises LabError."""
    try:
        triangles = triangles_of(Path(path))
    except LabError as error:
        raise LabError(f"{key}: {error}") from None
    except ValueError:  # characters that a file name cannot have
        raise LabError(f"{key}: {shown_path(path)}: is not a file name.") from None
    if len(triangles) > MOST:
        raise LabError(f"{key}: {Path(path).name}: {len(triangles)} triangles are too many; at most {MOST} are read.")
    return dict(zip(COLUMNS, triangles[..., [1, 2, 0]].reshape(-1, 9).T, strict=True))


def mesh_of(name: str, columns: dict[str, tuple[float, ...]], unit: float) -> Mesh:
    """The mesh of a file's triangles, in m. Raises LabError, without a key, for a surface that no tank has."""
    corners, triangles = welded(unit * np.array([columns[one] for one in COLUMNS]).T.reshape(-1, 3, 3))
    for fault in _faults(corners, triangles):
        raise LabError(f"{name}: {fault}.")
    found = Mesh(corners, triangles)
    for fault in _faults_of_mouth(found):
        raise LabError(f"{name}: {fault}.")
    inward = found.volume(found.front, float(np.ptp(corners[:, UP]))) > 0.0
    return found if inward else Mesh(corners, triangles[:, ::-1].copy())


def _faults(corners: np.ndarray, triangles: np.ndarray) -> Iterator[str]:
    """What is wrong with triangles, in whose order they are turned, and with the edges between them."""
    size = float(np.ptp(corners, axis=0).max())
    if not SMALLEST < size < LARGEST:
        yield f"is {show(size, 'm')} large; look at tank.unit, the unit of the file's numbers"
    sides = corners[triangles] - corners[np.roll(triangles, -1, axis=1)]
    area = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    thin = np.flatnonzero(area <= THIN * size * np.linalg.norm(sides, axis=2).max(axis=1))
    if len(thin):
        place = _point(corners[triangles[thin[0]]].mean(axis=0))
        yield f"{_many(len(thin), 'triangle has', 'triangles have')} no area, as at {place}; merge close corners"
    ways = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    ends, times = np.unique(np.sort(ways, axis=1), axis=0, return_counts=True)
    if (times > 2).any():
        place = _edge(corners[ends[np.argmax(times > 2)]])
        count = _many(int((times > 2).sum()), "edge is", "edges are")
        yield f"{count} of more than two triangles, as that {place}; delete double triangles and walls inside"
    twice, times = np.unique(ways, axis=0, return_counts=True)
    if (times > 1).any():
        place = _edge(corners[twice[np.argmax(times > 1)]])
        yield f"normals differ across the edge {place}; turn all triangles the same way round"
    from scipy.sparse import coo_array  # slow to import
    from scipy.sparse.csgraph import connected_components

    links = coo_array((np.ones(len(ends)), ends.T), shape=(len(corners), len(corners)))
    bodies, _ = connected_components(links, directed=False)
    if bodies > 1:
        yield f"holds {bodies} surfaces that do not hang together; leave one"


def _faults_of_mouth(mesh: Mesh) -> Iterator[str]:
    """What is wrong with the holes of a surface: only one, level and on top, is a mouth."""
    rim = mesh.rim
    if not len(rim):
        return
    after = dict(rim.tolist())
    loops, left = [], set(after)
    while left:
        loop, here = [], next(iter(left))
        while here in left:
            left.remove(here)
            loop.append(here)
            here = after[here]
        loops.append(loop)
    top, slack = mesh.box[1][UP], LEVEL * float(np.ptp(mesh.corners, axis=0).max())
    low = [loop for loop in loops if top - mesh.corners[loop, UP].min() > slack]
    remedy = "close it, for only one level opening at the very top is the mouth of a tank"
    if len(after) < len(rim):
        yield f"holes touch each other at a corner; {remedy.replace('it', 'them', 1)}"
    elif low:
        yield f"has a hole of {len(low[0])} edges, {_edge(mesh.corners[low[0][:2]])} and on; {remedy}"
    elif len(loops) > 1:
        yield f"has {len(loops)} holes on top; close all but one"


def _point(point: np.ndarray) -> str:
    """A place in the file's order."""
    return "({:.4g}, {:.4g}, {:.4g}) m".format(*(np.round(point[[2, 0, 1]], 9) + 0.0))


def _edge(ends: np.ndarray) -> str:
    return f"from {_point(ends[0])} to {_point(ends[1])}"


def _many(count: int, one: str, several: str) -> str:
    return f"{count} {one if count == 1 else several}"
