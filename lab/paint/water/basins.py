"""The tanks of a recording as they are drawn: where each is, and which particles of water or points are in it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lab.preset.schema import Preset
from lab.preset.sections.bulk.beds import beds_of, slices
from lab.preset.sections.water.tanks import further_tanks
from lab.recording import Recording
from solvers.fluid.start.packing import area_of, below

GAP = 0.08  # of a tank's height, between tanks that are drawn one above the other


@dataclass(frozen=True, eq=False)
class Basin:
    """A tank with an `outline` (m, 2) m and `open_edges`, whose water or bulk has the numbers of the slice `drops`.

    Tanks that stand one behind the other are drawn one above the other: each is lifted by `lift` (m).
    """

    outline: np.ndarray
    open_edges: Sequence[int]
    drops: slice
    lift: float = 0.0

    @property
    def drawn(self) -> np.ndarray:
        """The outline (m, 2) m where it is drawn."""
        return self.outline + np.array([0.0, self.lift])


def basins_of(preset: Preset, outline: np.ndarray, open_edges: Sequence[int], volume: np.ndarray) -> list[Basin]:
    """The tanks of a preset, the first with its own `outline`; volume (W, n): of the particles or points, m²."""
    further = further_tanks(preset, 1.0) if preset.ship else ()
    shapes = [(outline, open_edges), *((tank.outline, tank.open_edges) for tank in further)]
    drops, found = _drops(preset, volume), []
    for number, (shape, gaps) in enumerate(shapes):
        top, (low, high) = 0.0, (shape.min(axis=0), shape.max(axis=0))
        for other in found:
            start, end = other.drawn.min(axis=0), other.drawn.max(axis=0)
            if (low[0] < end[0]) and (start[0] < high[0]) and (low[1] + top < end[1]) and (start[1] < high[1] + top):
                top = end[1] - low[1] + GAP * (high[1] - low[1])
        found.append(Basin(shape, gaps, drops.get(number, slice(0, 0)), top))
    return found


def basins_in(recording: Recording) -> list[Basin]:
    """The tanks of a recording."""
    held = recording.bulk_volume if recording.preset.bulk else recording.volume
    return basins_of(recording.preset, recording.outline, recording.open_edges, held)


def breadth(basins: Sequence[Basin]) -> float:
    """How far (m) tanks reach across, all in one."""
    return float(np.ptp(np.concatenate([basin.outline for basin in basins])[:, 0]))


def _drops(preset: Preset, volume: np.ndarray) -> dict[int, slice]:
    """The numbers of the particles in each tank with water, or bulk: their volumes add up to the area that it fills."""
    if preset.bulk:
        return dict(enumerate(slices(beds_of(preset), volume[0])))
    if preset.water is None:
        return {}
    if not preset.tanks:
        return {0: slice(0, volume.shape[1])}
    filled = preset.pools
    size = preset.liquid.spacing
    areas = [area_of(below(pool.polygon, pool.level)) if pool.depth else 0.0 for pool in filled]
    areas = np.cumsum([area + pool.places(size) * size**2 for area, pool in zip(areas, filled, strict=True)])
    share = np.cumsum(volume[0]) / volume[0].sum() * areas[-1]
    ends = np.searchsorted(share, areas * (1.0 - 1e-9)) + 1
    starts = [0, *ends[:-1]]
    return {pool.number: slice(int(a), int(b)) for pool, a, b in zip(filled, starts, ends, strict=True)}
