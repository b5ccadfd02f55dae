"""A hull from a surface of triangles: an STL file, cut by planes across the ship.

x forward, y to starboard, z up. The surface must be closed: each edge belongs to two triangles. Points that are the
same are one corner of the mesh, so the pieces of a cut join by the mesh's own edges, without a tolerance.
"""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.section import ROUNDING, Section

HEADER, RECORD = 84, 50  # bytes of a binary file: its head, and each triangle
INSIDE = 1e-7  # of the length: how far inside its ends the hull is cut there, and beside the mesh's corners
WELD = 1e-6  # of a cut's size: points this close are one; ten times as far as edges that meet lie apart at INSIDE
MOST = 2_000_000  # triangles


def read_surface(path: Path, stations: int, scale: float = 1.0) -> Form:
    """The hull of an STL file cut at so many equal distances; `scale`: metres in its unit.

    Raises LabError for a file that is none, a surface with holes, or a cut in several pieces.
    """
    corners, triangles = _mesh(_triangles(path) * scale, path.name)
    begin, end = corners[:, 0].min(), corners[:, 0].max()
    corners[:, 2] -= corners[:, 2].min()
    x = np.linspace(begin, end, stations)
    inner = INSIDE * (end - begin)
    cuts = np.clip(x + 0.37 * inner, begin + inner, end - inner)
    try:
        sections = tuple(_section(corners, triangles, cut, path.name) for cut in cuts)
        return Form(x - begin, sections)
    except Unavailable as error:
        raise LabError(f"{path.name}: {error}") from None


def _triangles(path: Path) -> np.ndarray:
    """Triangles (n, 3, 3) of a binary or a text file."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise LabError(f"{path} cannot be read ({error.strerror}); look at its name.") from None
    count = int.from_bytes(data[HEADER - 4 : HEADER], "little") if len(data) >= HEADER else -1
    if count > 0 and len(data) == HEADER + RECORD * count:
        if count > MOST:
            raise LabError(f"{path.name}: {count} triangles are too many; at most {MOST} are read.")
        kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("mark", "<u2")])
        return np.frombuffer(data, kind, count, HEADER)["corners"].astype(float)
    words = data.decode("ascii", "replace").split()
    places = [k for k, word in enumerate(words) if word == "vertex"]
    try:
        found = np.array([[float(words[k + j]) for j in (1, 2, 3)] for k in places]).reshape(-1, 3, 3)
    except (ValueError, IndexError):
        found = np.zeros((0, 3, 3))
    if not len(found) or not np.isfinite(found).all():
        raise LabError(f"{path.name}: is no STL file of triangles; export the hull as binary or ASCII STL.")
    return found


def _mesh(triangles: np.ndarray, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Corners (m, 3), and triangles (n, 3) of their numbers. Raises LabError for a surface with holes."""
    points = triangles.reshape(-1, 3)
    grain = 1e-6 * float(np.ptp(points, axis=0).max())
    _, first, number = np.unique(np.round(points / grain), axis=0, return_index=True, return_inverse=True)
    faces = number.reshape(-1, 3)
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    faces = faces[whole]
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    _, times = np.unique(edges, axis=0, return_counts=True)
    loose = int((times != 2).sum())
    if loose:
        raise LabError(f"{name}: the surface has holes, {loose} of its edges are not of two triangles; close it first.")
    return points[first], faces


def _section(corners: np.ndarray, faces: np.ndarray, x: float, name: str) -> Section | None:
    """The outline of the cut at x (m); None where nothing is cut."""
    ahead = corners[:, 0] > x
    cut = faces[ahead[faces].any(axis=1) & ~ahead[faces].all(axis=1)]
    if not len(cut):
        return None
    joins: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for face in cut.tolist():
        ends = [tuple(sorted((a, b))) for a, b in zip(face, face[1:] + face[:1], strict=True) if ahead[a] != ahead[b]]
        for one, other in (ends, ends[::-1]):
            joins.setdefault(one, []).append(other)
    loop, last = [next(iter(joins))], None
    while len(loop) == 1 or loop[-1] != loop[0]:
        here = loop[-1]
        after = joins[here][0] if joins[here][0] != last else joins[here][1]
        loop.append(after)
        last = here
    if len(loop) - 1 < len(joins):
        raise LabError(f"{name}: the cut at {x:.4g} m has several pieces; give the hull alone, a single body.")
    a, b = corners[[edge[0] for edge in loop[:-1]]], corners[[edge[1] for edge in loop[:-1]]]
    share = (x - a[:, :1]) / (b[:, :1] - a[:, :1])
    return _closed((a + share * (b - a))[:, 1:])


def _closed(loop: np.ndarray) -> Section | None:
    """A section of a loop's points (m, 2), without those that say nothing of its shape; None without an area."""
    size = float(np.ptp(loop, axis=0).max())
    outline = _simplified(loop, size)
    area = 0.5 * float(outline[:, 0] @ np.roll(outline[:, 1], -1) - outline[:, 1] @ np.roll(outline[:, 0], -1))
    if len(outline) < 3 or abs(area) <= ROUNDING * size**2:
        return None
    return Section(outline if area > 0.0 else outline[::-1])


def _simplified(loop: np.ndarray, size: float) -> np.ndarray:
    """A loop's points without those at the place of the point before, or in line with their neighbours that are left.

    One is dropped at a time, as what its neighbours are changes with it: a corner and the crossing of a triangle's
    edge beside it are both in line with the other, and only one of them may go.
    """
    weld, turn = WELD * size, ROUNDING * size**2
    ring = [(float(y), float(z)) for y, z in loop]
    k = still = 0  # the point in hand; how many before it stay
    while len(ring) > 2 and still < len(ring) + 2:  # once round, and the two beside the last that was dropped
        k %= len(ring)
        (y0, z0), (y1, z1), (y2, z2) = ring[k - 1], ring[k], ring[(k + 1) % len(ring)]
        same = abs(y1 - y0) <= weld and abs(z1 - z0) <= weld
        if same or abs((y1 - y0) * (z2 - z1) - (z1 - z0) * (y2 - y1)) <= turn:
            del ring[k]
            k, still = k - 1, max(still - 1, 0)
        else:
            k, still = k + 1, still + 1
    return np.array(ring)
