"""Filling: how many grains, of what size, and where they start before they settle."""

from math import pi

import numpy as np
from matplotlib.path import Path

# Share of the area that settled frictional discs cover: 0.82 (random close packing of discs, Berryman 1983) less the
# loose layers at walls and surface; used only to turn a depth into a count.
PACKING = 0.81
SPACING = 1.04


class DoesNotFit(ValueError):
    """The tank has no room for the grains; the message is one sentence."""


def count_for_depth(depth: float, width: float, diameter: float, spread: float) -> int:
    """Number of grains that fill a tank of this width to this depth (m), by area at the packing of a settled bed."""
    mean_square = diameter**2 * (1.0 + spread**2 / 3.0)
    return max(1, round(PACKING * width * depth / (0.25 * pi * mean_square)))


def radii(count: int, diameter: float, spread: float, random: np.random.Generator) -> np.ndarray:
    """Radii (n,) m, diameters uniform within ±spread of the mean."""
    return 0.5 * diameter * (1.0 + spread * random.uniform(-1.0, 1.0, count))


def start_positions(radius: np.ndarray, outline: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Positions (n, 2) m on a shaken square lattice from the floor up, no two touching, in columns.

    Raises DoesNotFit when the lattice has fewer places than there are grains.
    """
    reach = float(radius.max())
    pitch = 2.0 * SPACING * reach
    lower, upper = outline.min(axis=0), outline.max(axis=0)
    sites_y = np.arange(lower[0] + reach, upper[0] - reach + 1e-9 * pitch, pitch)
    sites_z = np.arange(lower[1] + reach, upper[1] - reach + 1e-9 * pitch, pitch)
    if len(sites_y):
        # Spread the columns over the width that is there.
        sites_y += 0.5 * (upper[0] - reach - sites_y[-1])
    sites = np.stack(np.meshgrid(sites_y, sites_z), axis=-1).reshape(-1, 2)
    sites = sites[_clear_of_walls(sites, outline, reach)] if len(sites) else sites
    if len(sites) < len(radius):
        raise DoesNotFit(
            f"{len(radius)} grains of up to {2e3 * reach:.3g} mm do not fit the tank, which has room for {len(sites)}."
        )
    chosen = sites[: len(radius)]
    shaken = chosen + random.uniform(-1.0, 1.0, chosen.shape) * (SPACING - 1.0) * reach * 0.7
    shaken = np.clip(shaken, lower + reach, upper - reach)
    shaken = np.where(_clear_of_walls(shaken, outline, reach)[:, None], shaken, chosen)
    # Column by column, neighbours in space are neighbours in memory.
    return shaken[np.lexsort((chosen[:, 1], chosen[:, 0]))]


def _clear_of_walls(sites: np.ndarray, outline: np.ndarray, reach: float) -> np.ndarray:
    """Which sites lie inside the outline and at least `reach` from every segment of it."""
    clear = Path(outline).contains_points(sites)
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        edge = b - a
        share = np.clip((sites - a) @ edge / (edge @ edge), 0.0, 1.0)
        distance = np.linalg.norm(sites - (a + share[:, None] * edge), axis=1)
        clear &= distance >= reach * (1.0 - 1e-9)
    return clear
