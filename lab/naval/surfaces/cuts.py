"""Sections of a closed mesh, cut by planes across the ship.

Points that are the same are one corner of the mesh, so the pieces of a cut join by the mesh's own edges, without a
tolerance.
"""

import numpy as np

from lab.base.errors import LabError
from lab.naval.surfaces.mesh import Mesh
from solvers.machine.errors import Unavailable
from solvers.ship.section import ROUNDING, Section

INSIDE = 1e-7  # of the length: how far inside its ends the hull is cut there, and beside the mesh's corners
WELD = 1e-6  # of a cut's size: points this close are one; ten times as far as edges that meet lie apart at INSIDE

Edge = tuple[int, int]


def section_at(mesh: Mesh, x: float) -> Section | None:
    """The outline of the cut at x (m), or just inside of the mesh's ends; None where it has no area.

    Raises LabError for a cut in several pieces, or one that crosses itself.
    """
    inner = INSIDE * float(mesh.extent[0])
    cut = float(np.clip(x + 0.37 * inner, mesh.low[0] + inner, mesh.high[0] - inner))
    loops = _loops(_joins(mesh, cut))
    outlines = [_points(mesh.corners, loop, cut) for loop in loops]
    if len(outlines) > 1:
        pieces = " and ".join(f"{one[:, 1].min():.4g} to {one[:, 1].max():.4g}" for one in outlines[:4])
        raise LabError(
            f"{mesh.name}: the cut at x {x:.5g} m has {len(outlines)} pieces, z {pieces} m, and a station is one; "
            "leave out what stands apart there, as a rudder or a second hull."
        )
    try:
        return _closed(outlines[0]) if outlines else None
    except Unavailable as error:
        raise LabError(f"{mesh.name}: the cut at x {x:.5g} m is no section: {error}") from None


def _joins(mesh: Mesh, x: float) -> dict[Edge, list[Edge]]:
    """The edges that a plane cuts, and for each the two to which triangles join it."""
    ahead = mesh.corners[:, 0] > x
    of_faces = ahead[mesh.faces]
    joins: dict[Edge, list[Edge]] = {}
    for face in mesh.faces[of_faces.any(axis=1) & ~of_faces.all(axis=1)].tolist():
        sides = zip(face, face[1:] + face[:1], strict=True)
        one, other = ((min(a, b), max(a, b)) for a, b in sides if ahead[a] != ahead[b])
        joins.setdefault(one, []).append(other)
        joins.setdefault(other, []).append(one)
    return joins


def _loops(joins: dict[Edge, list[Edge]]) -> list[list[Edge]]:
    """The edges in their order round each piece of a cut."""
    loops, left = [], dict(joins)
    while left:
        loop, here = [], next(iter(left))
        while here is not None:
            loop.append(here)
            here = next((one for one in left.pop(here) if one in left), None)
        loops.append(loop)
    return loops


def _points(corners: np.ndarray, loop: list[Edge], x: float) -> np.ndarray:
    """Where a plane cuts the edges of a loop (m, 2), y and z in m."""
    a, b = (corners[list(ends)] for ends in zip(*loop, strict=True))
    share = (x - a[:, :1]) / (b[:, :1] - a[:, :1])
    return (a + share * (b - a))[:, 1:]


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
