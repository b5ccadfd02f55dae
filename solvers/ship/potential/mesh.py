"""A mesh of flat panels on a whole hull below calm water, for potential flow in space.

Axes as in `potential.strips`: x aft from the hull's centre of buoyancy, y to starboard, z up from the calm surface.
Only the starboard half is meshed. Around each station panels have about equal lengths between its knuckles, where
they are denser; along the hull they are denser at ends that are cut off. Those ends are closed.

Limits: roll's moment is a small difference of large pressures. The error of its damping falls with the square of the
number of panels around her; shorter ones along her hardly change it.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.potential.strips import LEAST, reference
from solvers.ship.section import Section

KNUCKLE = np.radians(30.0)  # a sharper turn of the outline is kept as an edge between panels
BETWEEN = 12  # panels from one knuckle to the next, and twice as many in a right angle of a round bilge
SHORT, LEAST_PANELS = 0.1, 4  # of the half girth: a shorter side has fewer, but no less than so many
STANDING = 1.24  # k T of the shortest standing waves within a box up to 1.2 √(g/T): k T coth k T = (ω² T/g) (John 1950)
INNER = 2.0  # points within the hull, along and across, per half length of those
SYMMETRIC = 1e-6  # of the hull's breadth


@dataclass(frozen=True, eq=False)
class HullMesh:
    """Corners (m, 3) m and panels (n, 4) of their numbers, normals into the water, of the starboard half, y ≥ 0.

    `stations` (k,) m and `rings` (k, m, 2) m, y and z, are the lines across the hull that the panels lie between.
    """

    corners: np.ndarray
    panels: np.ndarray
    stations: np.ndarray
    rings: np.ndarray

    def inner(self) -> np.ndarray:
        """Points (k, 3) m of the starboard half of the waterplane, within the hull.

        Gauss–Legendre points: their spacing matches no standing wave inside the hull. How many they are follows from
        these waves, not from the panels: a point nearer to the sides than a panel is long tells of the panel alone.
        """
        low, high = self.stations.min(), self.stations.max()
        per_length = INNER * STANDING / (np.pi * -self.rings[..., 1].min())
        along = np.polynomial.legendre.leggauss(max(3, round(per_length * (high - low))))[0]
        across = np.polynomial.legendre.leggauss(2 * max(2, round(per_length * self.rings[:, -1, 0].max())))[0]
        order, x = np.argsort(self.stations), 0.5 * (low + high) + 0.5 * (high - low) * along
        half = np.interp(x, self.stations[order], self.rings[order, -1, 0])
        y = half[:, None] * across[across > 0.0]
        return np.stack([np.broadcast_to(x[:, None], y.shape), y, 0.0 * y], axis=-1).reshape(-1, 3)


def hull_mesh(form: Form, draught: float, size: float, between: int = BETWEEN) -> HullMesh:
    """The mesh with panels of about a `size` (m) at an even draught (m), and so many between two knuckles.

    Raises `Unavailable` for a hull that is dry, or not alike on both sides.
    """
    x, halves = _wet_halves(form, draught)
    middle, widest = reference(form, draught), int(np.argmax([half[-1, 0] for half in halves]))
    shares = _shares(halves[widest], size, between)
    rings = np.array([_at(half, shares) for half in halves])
    along = _along(x, halves, size)
    sides = np.stack([[np.interp(along, x, rings[:, k, j]) for k in range(len(shares))] for j in (0, 1)], axis=-1)
    rings = sides.transpose(1, 0, 2)  # station, point, (y, z)
    rings[..., 1] -= draught
    across = max(2, round(rings[:, -1, 0].max() / size))
    place = middle - along
    surfaces = [_sheet(place, rings)]
    for end, turned in ((0, True), (-1, False)):
        if _area(rings[end]) > LEAST * max(map(_area, rings)):
            surfaces.append(_cap(float(place[end]), rings[end], across, turned))
    return HullMesh(*_joined(surfaces), place, rings)


def _wet_halves(form: Form, draught: float) -> tuple[np.ndarray, list[np.ndarray]]:
    """Stations x (k,) m of the wet hull, and the starboard outline (m, 2) m of each from keel to waterline."""
    found = [(x, _half(section, draught)) for x, section in zip(form.x, form.sections, strict=True)]
    wet = [k for k, (_, half) in enumerate(found) if half is not None]
    if not wet:
        raise Unavailable(f"at a draught of {draught:.4g} m the hull is dry.")
    x, halves = [], []
    for k in range(max(wet[0] - 1, 0), min(wet[-1] + 2, len(found))):
        place, half = found[k]
        if half is None:  # the hull has run out into a line
            half = found[wet[0] if k < wet[0] else wet[-1]][1] * [0.0, 1.0]
        x.append(place)
        halves.append(half)
    return np.array(x), halves


def _half(section: Section | None, draught: float) -> np.ndarray | None:
    """The outline to starboard from the keel to the waterline (m, 2) m; None where it is dry."""
    if section is None or section.outline[:, 1].min() >= draught:
        return None
    outline = section.outline
    if np.abs(np.sort(outline[:, 0]) + np.sort(outline[:, 0])[::-1]).max() > SYMMETRIC * section.size:
        raise Unavailable("the hull must be alike on both sides.")
    low = int(np.argmin(outline[:, 1] - 1e-9 * outline[:, 0]))  # of a flat bottom its starboard end
    rolled = np.roll(outline, -low, axis=0)
    above = np.flatnonzero(rolled[:, 1] >= draught)
    side = rolled[: above[0] + 1]
    (y0, z0), (y1, z1) = side[-2], side[-1]
    side[-1] = y0 + (draught - z0) / (z1 - z0) * (y1 - y0), draught
    return side if side[0, 0] <= SYMMETRIC * section.size else np.vstack([[0.0, side[0, 1]], side])


def _girth(half: np.ndarray) -> np.ndarray:
    """Length along an outline (m, 2) to each of its points, as a share of the whole."""
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(half, axis=0).T))])
    return lengths / max(lengths[-1], 1e-300)


def _shares(half: np.ndarray, size: float, between: int) -> np.ndarray:
    """Shares of the girth at which panels of about a size meet, knuckles among them, denser beside these."""
    step = np.diff(half, axis=0)
    turn = np.abs(np.diff(np.unwrap(np.arctan2(step[:, 1], step[:, 0]))))
    girth, whole = _girth(half), float(np.hypot(*step.T).sum())
    edges = np.concatenate([[0.0], girth[1:-1][turn > KNUCKLE], [1.0]])
    parts = []
    for k, (begin, end) in enumerate(pairwise(edges)):
        inside = (girth[1:-1] > begin) & (girth[1:-1] < end)
        bent = 2.0 * turn[inside].sum() / (0.5 * np.pi)
        wanted = between * max(bent, min(1.0, (end - begin) / SHORT))
        count = max(LEAST_PANELS, round(wanted), round((end - begin) * whole / size))
        parts.append(begin + (end - begin) * _spaced(count, k > 0, k < len(edges) - 2)[:-1])
    return np.concatenate([*parts, [1.0]])


def _spaced(count: int, first: bool, last: bool) -> np.ndarray:
    """Numbers from 0 to 1 in so many steps, with cosine spacing towards those ends that ask for it."""
    t = np.arange(count + 1) / count
    if first and last:
        return 0.5 * (1.0 - np.cos(np.pi * t))
    if first:
        return 1.0 - np.cos(0.5 * np.pi * t)
    return np.sin(0.5 * np.pi * t) if last else t


def _at(half: np.ndarray, shares: np.ndarray) -> np.ndarray:
    girth = _girth(half)
    return np.column_stack([np.interp(shares, girth, half[:, j]) for j in (0, 1)])


def _along(x: np.ndarray, halves: list[np.ndarray], size: float) -> np.ndarray:
    """Stations (n,) m between which panels lie, denser at ends that are cut off."""
    blunt = [bool(half[-1, 0] > 0.0 or half[:, 0].max() > 0.0) for half in (halves[0], halves[-1])]
    count = max(4, round((x[-1] - x[0]) / size))
    return x[0] + (x[-1] - x[0]) * _spaced(count, *blunt)


def _area(ring: np.ndarray) -> float:
    return float(np.trapezoid(ring[:, 0], ring[:, 1]))


def _grid(corners: np.ndarray, turned: bool) -> tuple[np.ndarray, np.ndarray]:
    """A sheet of corners (a, b, 3) as a list of corners and panels, those without an area left out."""
    number = np.arange(corners.shape[0] * corners.shape[1]).reshape(corners.shape[:2])
    panels = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1).reshape(-1, 4)
    flat = corners.reshape(-1, 3)
    one, other = flat[panels[:, 2]] - flat[panels[:, 0]], flat[panels[:, 3]] - flat[panels[:, 1]]
    size = np.linalg.norm(np.cross(one, other), axis=1)
    panels = panels[size > 1e-9 * size.max()]
    return flat, panels[:, ::-1] if turned else panels


def _sheet(x: np.ndarray, rings: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The side and bottom: rings (n, m, 2) of y, z at places x (n,)."""
    corners = np.concatenate([np.broadcast_to(x[:, None, None], (*rings.shape[:2], 1)), rings], axis=2)
    return _grid(corners, True)


def _cap(x: float, ring: np.ndarray, across: int, turned: bool) -> tuple[np.ndarray, np.ndarray]:
    """An end that is cut off: from the middle line to the outline."""
    share = _spaced(across, False, True)
    y, z = share[:, None] * ring[:, 0], np.broadcast_to(ring[:, 1], (len(share), len(ring)))
    return _grid(np.stack([np.full(y.shape, x), y, z], axis=-1), turned)


def _joined(sheets: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Several sheets as one list of corners and panels."""
    offsets = np.cumsum([0, *(len(corners) for corners, _ in sheets)])
    panels = [panels + offset for (_, panels), offset in zip(sheets, offsets, strict=False)]
    return np.concatenate([corners for corners, _ in sheets]), np.concatenate(panels)
