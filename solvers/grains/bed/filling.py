"""Filling: the number of grains, and their start positions before they settle.

Three surfaces, in the words of Spandonidis (2016), section 5.3.1. Undisturbed: "compacted to an extent that void
spaces are minimized as much as possible and also the free surface is almost completely flat". Slightly disturbed: "an
in-between case", "the reasonably smoothed surface requested by the regulations". Disturbed: "a somehow naturally
occurring free surface: the particles are thrown uniformly from a height and they are left to arrange themselves".
Here the first settles without friction and is then levelled (`levelled`); the second settles from a level lattice; the
third from heaps thrown at random over the width (`start_positions(..., thrown=True)`).
"""

from collections.abc import Sequence
from itertools import product
from math import ceil, pi, sqrt

import numpy as np

from solvers.grains.bed.sizes import Sizes
from solvers.space.axes import UP
from solvers.tank.outline import NONE_FIXED, clear_of_walls, free_area, inside
from solvers.tank.solids.solid import Solid

# Area fraction of settled frictional discs: 0.82 (random close packing of discs, Berryman 1983) less the loose layers
# at walls and surface; used only to convert a depth to a count.
PACKING = 0.81
# Volume fraction of settled frictional spheres, between random loose and random close packing, 0.55 and 0.64 (Silbert,
# arXiv:1108.0012), less the loose layers at walls and surface
PACKING_OF_SPHERES = 0.57
SPACING = 1.04
HANDFUL = 3  # grains across and upwards in a heap that is thrown at once
PROUD = 0.125  # of a diameter: the least descent for which levelling moves a grain
LAYERS = 6  # diameters below the highest grain in which levelling searches for hollows


class DoesNotFit(ValueError):
    """The tank has no room for the grains; the message is one sentence."""


def count_for_depth(
    depth: float, outline: np.ndarray, sizes: Sizes, fixed: np.ndarray = NONE_FIXED, solid: Solid | None = None
) -> int:
    """Number of grains that fill a tank with `fixed` grains to a depth (m), at the packing of a settled bed.

    In space the outline stands for a `solid`.
    """
    if solid is None:
        return max(1, round(PACKING * free_area(outline, depth, fixed) / (0.25 * pi * sizes.mean_square)))
    return max(1, round(PACKING_OF_SPHERES * solid.volume(outline, depth) / (pi / 6.0 * sizes.mean_cube)))


def radii(count: int, diameter: float, spread: float, random: np.random.Generator) -> np.ndarray:
    """Radii (n,) m, with diameters uniform within ±`spread` times the mean."""
    return Sizes(((diameter, 1.0),), spread).draw(count, random)


def headroom(count: int, largest: float, *widths: float) -> float:
    """Height (m) in which `count` grains of radii up to `largest` (m) start over these widths, thrown or not.

    A column with n grains on average gets room for more, by four standard deviations of the number of handfuls that are
    thrown on it; the few grains beyond that may go elsewhere.
    """
    pitch = 2.0 * SPACING * largest
    rows = count
    for width in widths:
        rows /= max(1.0, width / pitch - 1.0)
    return pitch * (ceil(rows + 4.0 * HANDFUL * sqrt(rows)) + 2)


def start_positions(
    radius: np.ndarray,
    outline: np.ndarray,
    random: np.random.Generator,
    fixed: np.ndarray = NONE_FIXED,
    plates: Sequence[np.ndarray] = (),
    thrown: bool = False,
    region: np.ndarray | None = None,
    solid: Solid | None = None,
    above: float = -np.inf,
) -> np.ndarray:
    """Positions (n, axes) m on a randomly perturbed square lattice from the floor up, no two touching, by columns.

    They keep clear of the outline, of the `fixed` grains (k, 3) and of `plates`, polylines (m, 2), and within the
    polygon `region` (m, 2) if there is one, and `above` a height (m). In space the outline stands for a `solid`. If
    `thrown`, heaps of 3 grains along each axis are dropped on one another, uniformly over the width. Raises DoesNotFit
    if the lattice has fewer sites than there are grains.
    """
    reach = float(radius.max())
    lower, upper = outline.min(axis=0), outline.max(axis=0)
    sites = lattice(reach, outline, fixed, plates, solid)
    sites = sites[sites[:, UP] >= above + SPACING * reach]
    if region is not None:
        sites = sites[inside(sites if solid is None else solid.section(sites), region)]
    if solid is not None:
        half = solid.half(outline)
        lower, upper = np.append(lower, -half), np.append(upper, half)
    if len(sites) < len(radius):
        room = "tank" if region is None else "region"
        size = f"{2e3 * reach:.3g} mm"
        raise DoesNotFit(
            f"{len(radius)} grains of up to {size} do not fit the {room}, which has room for {len(sites)}."
        )
    if thrown:
        chosen = sites[_thrown(np.delete(sites, UP, axis=1), len(radius), random)]
    else:
        chosen = sites[: len(radius)] if solid is None else sites[_level(sites[:, UP], len(radius), random)]
    shaken = chosen + random.uniform(-1.0, 1.0, chosen.shape) * (SPACING - 1.0) * reach * 0.7
    inner = np.full(len(lower), reach)
    if solid is not None and solid.period:
        inner[-1] = 0.0  # no wall is there
    shaken = np.clip(shaken, lower + inner, upper - inner)
    clear = _clear(shaken, outline, reach, fixed, plates, solid)
    shaken = np.where(clear[:, None], shaken, chosen)
    # By columns, so that neighbours in space are neighbours in memory.
    return shaken[np.lexsort((chosen[:, UP], *np.delete(chosen, UP, axis=1).T[::-1]))]


def layered(kind: np.ndarray, radius: np.ndarray, *filling: object) -> np.ndarray:
    """Positions (n, axes) m of grains of each `kind` (n,) in a layer above the one before it, by `start_positions`."""
    place, above = None, -np.inf
    for number in range(int(kind.max()) + 1):
        mine = np.flatnonzero(kind == number)
        if not len(mine):
            continue
        found = start_positions(radius[mine], *filling, above)
        place = np.empty((len(kind), found.shape[1])) if place is None else place
        place[mine], above = found, float((found[:, UP] + radius[mine]).max())
    return place


def lattice(
    reach: float,
    outline: np.ndarray,
    fixed: np.ndarray = NONE_FIXED,
    plates: Sequence[np.ndarray] = (),
    solid: Solid | None = None,
) -> np.ndarray:
    """Lattice sites (k, axes) m for grains of radii up to `reach` (m), row by row from the floor up.

    In space the outline stands for a `solid`.
    """
    pitch = 2.0 * SPACING * reach
    lower, upper = outline.min(axis=0), outline.max(axis=0)
    sites_y = np.arange(lower[0] + reach, upper[0] - reach + 1e-9 * pitch, pitch)
    sites_z = np.arange(lower[1] + reach, upper[1] - reach + 1e-9 * pitch, pitch)
    if len(sites_y):
        # Centre the columns in the width.
        sites_y += 0.5 * (upper[0] - reach - sites_y[-1])
    sites = np.stack(np.meshgrid(sites_y, sites_z), axis=-1).reshape(-1, 2)
    if solid is not None:
        sites = _drawn_out(sites, pitch, solid, solid.half(outline) - reach)
    return sites[_clear(sites, outline, reach, fixed, plates, solid)] if len(sites) else sites


def _clear(sites, outline, reach, fixed, plates, solid: Solid | None) -> np.ndarray:
    """Which sites (n, axes) m lie inside, at least `reach` (m) from what else is there."""
    if solid is None:
        return clear_of_walls(sites, outline, reach, fixed, plates)
    return solid.clear(sites, outline, reach, fixed, plates)


def _drawn_out(sites: np.ndarray, pitch: float, solid: Solid, half: float) -> np.ndarray:
    """Sites (k, 3) m in space of a lattice in the plane, row by row from the floor up, up to `half` (m) along x."""
    count = int(2.0 * half / pitch + 1e-9) + 1 if half >= 0.0 else 0
    if solid.period:  # all round, evenly
        count = int(solid.period / pitch)
        pitch = solid.period / max(1, count)
    x = pitch * (np.arange(count) - 0.5 * (count - 1))
    return np.column_stack([np.repeat(sites, count, axis=0), np.tile(x, len(sites))])


def _level(height: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """Indices of so many sites of a lattice from the floor up, of `height` (n,) m; in the last row any of them.

    In space a row is a layer: filled from one side its slope would be that of the bed.
    """
    last = np.isclose(height, height[count - 1], rtol=0.0, atol=1e-9 * np.ptp(height))
    below, top = np.flatnonzero(~last[:count]), np.flatnonzero(last)
    return np.concatenate([below, np.sort(random.permutation(top)[: count - len(below)])])


def _thrown(columns: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """Indices of the sites that randomly thrown heaps fill, of `columns` (n, 1 or 2) m with sites from the floor up."""
    places = [np.unique(across, return_inverse=True) for across in columns.T]
    shape, at = [len(values) for values, _ in places], np.stack([index for _, index in places], axis=1)
    free: dict[tuple[int, ...], list[int]] = {}
    for site in range(len(at) - 1, -1, -1):
        free.setdefault(tuple(at[site]), []).append(site)
    filled: list[int] = []
    while len(filled) < count:
        heap = [range(first, first + HANDFUL) for first in (int(random.integers(1 - HANDFUL, size)) for size in shape)]
        for column in product(*heap):
            sites = free.get(column, [])
            filled += [sites.pop() for _ in range(min(HANDFUL, len(sites)))]
    return np.array(filled[:count])


def levelled(
    position: np.ndarray, radius: np.ndarray, outline: np.ndarray, fixed: np.ndarray = NONE_FIXED
) -> np.ndarray:
    """Positions (n, 2) m of a settled bed after moving its highest grains, one by one, into its lowest hollows.

    A grain is dropped vertically onto the first grain or fixed grain below, where it is clear of the walls. Levelling
    ends when the highest grain would not descend by an eighth of its diameter.
    """
    position = position.copy()
    across = np.linspace(*_sides(outline), 1 + ceil(8.0 * np.ptp(outline[:, 0]) / (2.0 * radius.mean())))
    for _ in range(len(radius)):
        highest = int(np.argmax(position[:, 1] + radius))
        place = _hollow(highest, position, radius, across, outline, fixed)
        if place is None or place[1] > position[highest, 1] - 2.0 * PROUD * radius[highest]:
            break
        position[highest] = place
    return position


def _sides(outline: np.ndarray) -> tuple[float, float]:
    return float(outline[:, 0].min()), float(outline[:, 0].max())


def _hollow(grain, position, radius, across, outline, fixed) -> np.ndarray | None:
    """The lowest position (2,) at which the grain would land, slightly above contact; None if there is none."""
    reach = radius[grain]
    bottom = position[grain, 1] - LAYERS * 2.0 * radius.max()
    near = position[:, 1] > bottom
    near[grain] = False
    below = np.concatenate([np.column_stack([position, radius])[near], fixed])
    square = (reach + below[:, 2]) ** 2 - (across[:, None] - below[:, 0]) ** 2
    floor = outline[:, 1].min()
    nothing = floor + reach if bottom < floor else -np.inf  # without a grain below; deep ones are left out
    lands = np.where(square > 0.0, below[:, 1] + np.sqrt(np.maximum(square, 0.0)), -np.inf).max(axis=1, initial=nothing)
    places = np.column_stack([across, lands + 1e-3 * reach])[np.isfinite(lands)]
    places = places[clear_of_walls(places, outline, reach)]
    return places[places[:, 1].argmin()] if len(places) else None
