"""The tank's outline for filling: its top edges, the area below a level, walls extended upwards, a rough lining.

An outline is a simple polygon (m, 2) in m, counter-clockwise; its edge k runs from corner k to corner k + 1.
"""

from collections.abc import Sequence
from itertools import pairwise
from math import pi

import numpy as np

# Grains of a lining: diameters uniform within ± this share, gaps up to this share of a diameter. On a regular row of
# equal grains a bed of the same size would crystallise.
UNEVEN = 0.1
NONE_FIXED = np.empty((0, 3))


def top_edges(outline: np.ndarray) -> tuple[int, ...]:
    """The edges with both ends at the outline's top, which a lid would cover."""
    outline = np.asarray(outline)
    at_top = outline[:, 1] > outline[:, 1].max() - 1e-9 * np.ptp(outline[:, 1])
    return tuple(int(k) for k in np.flatnonzero(at_top & np.roll(at_top, -1)))


def cut_off(outline: np.ndarray, depth: float) -> np.ndarray:
    """Corners (k, 2) of what is left of the tank when it is cut off at `depth` m above its lowest point."""
    corners = []
    floor = outline[:, 1].min()
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        below_a, below_b = a[1] - floor <= depth, b[1] - floor <= depth
        if below_a:
            corners.append(a)
        if below_a != below_b:
            corners.append(a + (b - a) * (floor + depth - a[1]) / (b[1] - a[1]))
    return np.array(corners)


def area_below(outline: np.ndarray, depth: float) -> float:
    """Area (m²) of the tank up to `depth` m above its lowest point, by the shoelace formula."""
    y, z = cut_off(outline, depth).T
    return float(0.5 * abs(y @ np.roll(z, -1) - z @ np.roll(y, -1)))


def moments(polygon: np.ndarray) -> tuple[float, tuple[float, float], float]:
    """Area (m²), centroid (m) and polar second moment of area about it (m⁴) of a polygon (m, 2), counter-clockwise.

    By Green's theorem, exactly.
    """
    y, z = (polygon - polygon.mean(axis=0)).T
    y1, z1 = np.roll(y, -1), np.roll(z, -1)
    cross = y * z1 - y1 * z
    area = 0.5 * cross.sum()
    centre = np.array([((y + y1) * cross).sum(), ((z + z1) * cross).sum()]) / (6.0 * area)
    polar = ((y * y + y * y1 + y1 * y1 + z * z + z * z1 + z1 * z1) * cross).sum() / 12.0
    place = polygon.mean(axis=0) + centre
    return float(area), (float(place[0]), float(place[1])), float(polar - area * (centre @ centre))


def free_area(outline: np.ndarray, depth: float, fixed: np.ndarray) -> float:
    """Area (m²) up to `depth` (m) that a lining of half-sunk grains `fixed` (k, 3) leaves free for the bed."""
    low = fixed[:, 1] - outline[:, 1].min() < depth
    return area_below(outline, depth) - 0.5 * pi * float((fixed[low, 2] ** 2).sum())


def raised(outline: np.ndarray, by: float) -> np.ndarray:
    """The outline with its top edges raised by `by` (m) on vertical walls.

    An outline that ends in a point at the top stays as it is.
    """
    lids = set(top_edges(outline))
    up = np.array([0.0, by])
    corners = []
    for k, corner in enumerate(outline):
        before, after = (k - 1) % len(outline) in lids, k in lids
        if after and not before:
            corners += [corner, corner + up]
        elif before and not after:
            corners += [corner + up, corner]
        else:
            corners.append(corner + up if before else corner)
    return np.array(corners)


def lining(outline: np.ndarray, diameter: float, random: np.random.Generator) -> np.ndarray:
    """Fixed grains (k, 3) y, z, radius in m, side by side along all edges but the top ones.

    Walls built of grains as in Spandonidis (2016), section 5.4, after Schäfer et al. (1996). The grains are half sunk
    into the wall, with their centres on the outline: the tank keeps its width, and no grain can get behind them.
    Diameters are uniform within ± 10 % and gaps up to a tenth of a diameter, so that no bed crystallises on them. Each
    corner has a grain, and the rest of an edge's length is spread over its gaps.
    """
    lids = set(top_edges(outline))
    count = len(outline)
    corner_radius = 0.5 * diameter * (1.0 + UNEVEN * random.uniform(-1.0, 1.0, count))
    grains = []
    for k in range(count):
        following = (k + 1) % count
        if k not in lids or (k - 1) % count not in lids:
            grains.append((*outline[k], corner_radius[k]))
        if k in lids:
            continue
        edge = outline[following] - outline[k]
        length = float(np.hypot(*edge))
        for place, radius in _row(length, diameter, corner_radius[k], corner_radius[following], random):
            grains.append((*(outline[k] + edge * (place / length)), radius))
    return np.array(grains)


def _row(length: float, diameter: float, first: float, last: float, random: np.random.Generator) -> list:
    """Places along an edge of `length` (m) and radii of the grains between those on its two corners."""
    row = []
    end = first  # where the previous grain ends
    while True:
        radius = 0.5 * diameter * (1.0 + UNEVEN * random.uniform(-1.0, 1.0))
        gap = diameter * UNEVEN * random.uniform()
        if end + gap + 2.0 * radius > length - last:
            break
        row.append((end + gap + radius, radius))
        end += gap + 2.0 * radius
    spare = max(0.0, length - last - end) / (len(row) + 1)
    return [(place + spare * (n + 1), radius) for n, (place, radius) in enumerate(row)]


def clear_of_walls(
    sites: np.ndarray,
    outline: np.ndarray,
    reach: float | np.ndarray,
    fixed: np.ndarray = NONE_FIXED,
    plates: Sequence[np.ndarray] = (),
) -> np.ndarray:
    """Which sites (n, 2) lie inside the outline, at least `reach` (m) from it, from plates and from fixed grains.

    A plate that ends where it begins is a body: none lie in it.
    """
    clear = inside(sites, outline)
    for line in plates:
        if np.array_equal(line[0], line[-1]):
            clear &= ~inside(sites, line)
    edges = [(a, b) for line in (np.vstack([outline, outline[:1]]), *plates) for a, b in pairwise(line)]
    for a, b in edges:
        edge = b - a
        share = np.clip((sites - a) @ edge / (edge @ edge), 0.0, 1.0)
        distance = np.linalg.norm(sites - (a + share[:, None] * edge), axis=1)
        clear &= distance >= reach * (1.0 - 1e-9)
    for y, z, radius in fixed:
        clear &= np.hypot(sites[:, 0] - y, sites[:, 1] - z) >= (reach + radius) * (1.0 - 1e-9)
    return clear


def inside(points: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Which points (n, 2) lie inside a polygon (m, 2): a ray from there crosses its edges an odd number of times."""
    y, z = points.T
    odd = np.zeros(len(points), dtype=bool)
    for (y0, z0), (y1, z1) in pairwise(np.vstack([polygon, polygon[:1]])):
        passes = (z0 > z) != (z1 > z)
        odd ^= passes & (((y1 - y0) * (z - z0) < (y - y0) * (z1 - z0)) == (z1 > z0))
    return odd
