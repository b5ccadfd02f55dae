"""Filling: how many grains, and where they start before they settle.

Three surfaces, in the words of Spandonidis (2016), section 5.3.1. Undisturbed: "compacted to an extent that void
spaces are minimized as much as possible and also the free surface is almost completely flat". Slightly disturbed: "an
in-between case", "the reasonably smoothed surface requested by the regulations". Disturbed: "a somehow naturally
occurring free surface: the particles are thrown uniformly from a height and they are left to arrange themselves".
Here they settle, in turn, without friction, and are levelled (`levelled`); from a level lattice; and from heaps
thrown at random over the width (`start_positions(..., thrown=True)`).
"""

from collections.abc import Sequence
from itertools import pairwise
from math import ceil, pi, sqrt

import numpy as np
from matplotlib.path import Path

from solvers.grains.sizes import Sizes
from solvers.tank.outline import free_area

# Share of the area that settled frictional discs cover: 0.82 (random close packing of discs, Berryman 1983) less the
# loose layers at walls and surface; used only to turn a depth into a count.
PACKING = 0.81
SPACING = 1.04
HANDFUL = 3  # grains across and upwards of a heap that is thrown at once
PROUD = 0.125  # of a diameter: how far a grain must come down to be moved by levelling
LAYERS = 6  # how many diameters below its highest grain a bed is looked at for hollows

NONE_FIXED = np.empty((0, 3))


class DoesNotFit(ValueError):
    """The tank has no room for the grains; the message is one sentence."""


def count_for_depth(depth: float, outline: np.ndarray, sizes: Sizes, fixed: np.ndarray = NONE_FIXED) -> int:
    """Number of grains that fill a tank to this depth (m) beside its `fixed` ones, at the packing of a settled bed."""
    return max(1, round(PACKING * free_area(outline, depth, fixed) / (0.25 * pi * sizes.mean_square)))


def radii(count: int, diameter: float, spread: float, random: np.random.Generator) -> np.ndarray:
    """Radii (n,) m, diameters uniform within ±spread of the mean."""
    return Sizes(((diameter, 1.0),), spread).draw(count, random)


def headroom(count: int, largest: float, width: float) -> float:
    """Height (m) in which `count` grains of radii up to `largest` (m) start over this width, thrown or not.

    A column of n places holds n grains on average; thrown, it gets more than n by four standard deviations of a
    number of handfuls so seldom that these may go elsewhere.
    """
    pitch = 2.0 * SPACING * largest
    rows = count / max(1.0, width / pitch - 1.0)
    return pitch * (ceil(rows + 4.0 * HANDFUL * sqrt(rows)) + 2)


def start_positions(
    radius: np.ndarray,
    outline: np.ndarray,
    random: np.random.Generator,
    fixed: np.ndarray = NONE_FIXED,
    plates: Sequence[np.ndarray] = (),
    thrown: bool = False,
    region: np.ndarray | None = None,
) -> np.ndarray:
    """Positions (n, 2) m on a shaken square lattice from the floor up, no two touching, in columns.

    They keep clear of the outline, of the `fixed` grains (k, 3) and of `plates`, polylines (m, 2), and within the
    polygon `region` (m, 2) if there is one. If `thrown`, heaps of 3 by 3 grains come down at places uniform over the
    width, one upon the other. Raises DoesNotFit when the lattice has fewer places than there are grains.
    """
    reach = float(radius.max())
    lower, upper = outline.min(axis=0), outline.max(axis=0)
    sites = lattice(reach, outline, fixed, plates)
    if region is not None:
        sites = sites[Path(region).contains_points(sites)]
    if len(sites) < len(radius):
        room = "tank" if region is None else "region"
        size = f"{2e3 * reach:.3g} mm"
        raise DoesNotFit(
            f"{len(radius)} grains of up to {size} do not fit the {room}, which has room for {len(sites)}."
        )
    chosen = sites[_thrown(sites[:, 0], len(radius), random)] if thrown else sites[: len(radius)]
    shaken = chosen + random.uniform(-1.0, 1.0, chosen.shape) * (SPACING - 1.0) * reach * 0.7
    shaken = np.clip(shaken, lower + reach, upper - reach)
    shaken = np.where(clear_of_walls(shaken, outline, reach, fixed, plates)[:, None], shaken, chosen)
    # Column by column, neighbours in space are neighbours in memory.
    return shaken[np.lexsort((chosen[:, 1], chosen[:, 0]))]


def lattice(
    reach: float, outline: np.ndarray, fixed: np.ndarray = NONE_FIXED, plates: Sequence[np.ndarray] = ()
) -> np.ndarray:
    """Places (k, 2) m for grains of radii up to `reach` (m), row by row from the floor up."""
    pitch = 2.0 * SPACING * reach
    lower, upper = outline.min(axis=0), outline.max(axis=0)
    sites_y = np.arange(lower[0] + reach, upper[0] - reach + 1e-9 * pitch, pitch)
    sites_z = np.arange(lower[1] + reach, upper[1] - reach + 1e-9 * pitch, pitch)
    if len(sites_y):
        # Spread the columns over the width that is there.
        sites_y += 0.5 * (upper[0] - reach - sites_y[-1])
    sites = np.stack(np.meshgrid(sites_y, sites_z), axis=-1).reshape(-1, 2)
    return sites[clear_of_walls(sites, outline, reach, fixed, plates)] if len(sites) else sites


def _thrown(columns: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """Which of the places, given by their column's y from the floor up, heaps thrown at random come to fill."""
    free = [list(np.flatnonzero(columns == y)[::-1]) for y in np.unique(columns)]
    filled: list[int] = []
    while len(filled) < count:
        first = int(random.integers(1 - HANDFUL, len(free)))
        for column in free[max(0, first) : first + HANDFUL]:
            filled += [column.pop() for _ in range(min(HANDFUL, len(column)))]
    return np.array(filled[:count])


def levelled(
    position: np.ndarray, radius: np.ndarray, outline: np.ndarray, fixed: np.ndarray = NONE_FIXED
) -> np.ndarray:
    """A settled bed's positions (n, 2) m with its highest grains put, one by one, into its lowest hollows.

    A grain comes straight down from above on what it meets first, grains or fixed grains, where it is clear of the
    walls. Ends when the highest would not come down by an eighth of its diameter.
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
    """The lowest place (2,) at which the grain would land, a hair above what it lands on; None where there is none."""
    reach = radius[grain]
    bottom = position[grain, 1] - LAYERS * 2.0 * radius.max()
    near = position[:, 1] > bottom
    near[grain] = False
    below = np.concatenate([np.column_stack([position, radius])[near], fixed])
    square = (reach + below[:, 2]) ** 2 - (across[:, None] - below[:, 0]) ** 2
    floor = outline[:, 1].min()
    nothing = floor + reach if bottom < floor else -np.inf  # below: the floor, or grains too deep to be looked at
    lands = np.where(square > 0.0, below[:, 1] + np.sqrt(np.maximum(square, 0.0)), -np.inf).max(axis=1, initial=nothing)
    places = np.column_stack([across, lands + 1e-3 * reach])[np.isfinite(lands)]
    places = places[clear_of_walls(places, outline, reach)]
    return places[places[:, 1].argmin()] if len(places) else None


def clear_of_walls(
    sites: np.ndarray,
    outline: np.ndarray,
    reach: float | np.ndarray,
    fixed: np.ndarray = NONE_FIXED,
    plates: Sequence[np.ndarray] = (),
) -> np.ndarray:
    """Which sites (n, 2) lie inside the outline, at least `reach` (m) from it, from plates and from fixed grains."""
    clear = Path(outline).contains_points(sites)
    edges = [(a, b) for line in (np.vstack([outline, outline[:1]]), *plates) for a, b in pairwise(line)]
    for a, b in edges:
        edge = b - a
        share = np.clip((sites - a) @ edge / (edge @ edge), 0.0, 1.0)
        distance = np.linalg.norm(sites - (a + share[:, None] * edge), axis=1)
        clear &= distance >= reach * (1.0 - 1e-9)
    for y, z, radius in fixed:
        clear &= np.hypot(sites[:, 0] - y, sites[:, 1] - z) >= (reach + radius) * (1.0 - 1e-9)
    return clear
