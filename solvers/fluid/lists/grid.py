"""The grid that orders particles: strips along y, cut into bins. Its key numbers strip by strip, bin by bin.

In the plane strips lie one over the other, in space side by side as well.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod

import numpy as np

from solvers.fluid.given import Water
from solvers.fluid.state import FAR
from solvers.machine.quantity import DIRECTIONS, PLANE
from solvers.tank.tank import Tank

BIN = 0.5  # length of a bin, in spacings
ROOM = 2.0  # supports of the kernel by which the grid reaches beyond the tank's box


@dataclass(frozen=True)
class Grid:
    """Strips of the height lanes^(1/D) Δx and bins of half a spacing over a box from `lower` to `upper` (m).

    A block of particles at rest in a strip is about a square, or a cube; D is the number of axes. Points outside the
    box belong to its outermost cells. Space may repeat itself along an axis with a period (m), from the `origin` on; 0:
    it does not. Tanks may overlap in the plane, as they stand one behind the other in a ship: each of `layers` has
    strips of its own. Of tanks that are open, `watched` are the corners of the box beyond which a particle has left and
    may fall as fast as it will.
    """

    lower: tuple[float, ...]
    upper: tuple[float, ...]
    spacing: float
    lanes: int
    periods: tuple[float, ...] = (0.0, 0.0)
    origin: tuple[float, ...] = (0.0, 0.0)
    layers: int = 1
    watched: tuple[np.ndarray, np.ndarray] | None = None

    @property
    def axes(self) -> int:
        """Number of axes."""
        return len(self.lower)

    @property
    def height(self) -> float:
        """Height (m) of a strip, and in space its width."""
        return max(2.0, self.lanes ** (1.0 / self.axes)) * self.spacing

    @property
    def bin(self) -> float:
        """Length (m) of a bin."""
        return BIN * self.spacing

    @property
    def rows(self) -> int:
        """Number of strips of a layer."""
        return prod(self.ranks)

    @property
    def ranks(self) -> tuple[int, ...]:
        """How many strips there are along each axis but the first: one over the other, and side by side."""
        return tuple(int((self.upper[a] - self.lower[a]) / self.height) + 1 for a in range(1, self.axes))

    @property
    def strips(self) -> int:
        """Number of strips of all layers."""
        return self.layers * self.rows

    @property
    def bins(self) -> int:
        """Number of bins in a strip."""
        return int((self.upper[0] - self.lower[0]) / self.bin) + 1

    @property
    def longest(self) -> int:
        """Bins after which a block ends early: twice the length of a full block at rest."""
        square = self.height ** (self.axes - 1)
        return max(4, round(2.0 * self.lanes * self.spacing**self.axes / (square * self.bin)))

    @property
    def numbers(self) -> np.ndarray:
        """What `Order` computes keys from: lower corner (m), bins and strips per metre, periods, their origin (m)."""
        return np.array([*self.lower, 1.0 / self.bin, 1.0 / self.height, *self.periods, *self.origin])

    @property
    def places(self) -> tuple[int, int, int]:
        """Where in `numbers` bins per metre, the first period and the first origin are."""
        return self.axes, self.axes + 2, 2 * self.axes + 2

    def key(self, points: np.ndarray, layer: np.ndarray | int = 0) -> np.ndarray:
        """Keys (n,) of points (n, D) m, each in its layer."""
        along = np.clip(((points[:, 0] - self.lower[0]) / self.bin).astype(int), 0, self.bins - 1)
        strip = 0
        for a, rank in enumerate(self.ranks, start=1):
            own = np.clip(((points[:, a] - self.lower[a]) / self.height).astype(int), 0, rank - 1)
            strip = strip * rank + own
        return (layer * self.rows + strip) * self.bins + along

    def arranged(self, points: np.ndarray, layer: np.ndarray | int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Points (n, D) that do not move, in blocks: slot of each (n,), lanes (blocks, lanes, D), first slots by key.

        Each strip begins a new block, and in space what lies farther on than a block gets long: walls on both sides of
        a tank are in one strip. The slots of key k are from first[k] to first[k + 1] − 1, some of them unused.
        """
        key = self.key(points, layer)
        order = np.argsort(key, kind="stable")
        counts = np.bincount(key, minlength=self.strips * self.bins)
        first = np.zeros(len(counts) + 1, dtype=np.int32)
        slot = begin = 0
        for k, count in enumerate(counts):
            if count and slot % self.lanes == 0:
                begin = k
            if k % self.bins == 0 or (count and self.axes > PLANE and k - begin >= self.longest):
                slot, begin = -(-slot // self.lanes) * self.lanes, k
            first[k] = slot
            slot += count
            if slot // self.lanes != first[k] // self.lanes:
                begin = k
        first[-1] = slot
        blocks = -(-slot // self.lanes)
        slots = np.empty(len(points), dtype=int)
        within = np.arange(len(points)) - np.concatenate([[0], np.cumsum(counts)[:-1]])[key[order]]
        slots[order] = first[key[order]] + within
        lanes = np.full((blocks * self.lanes, self.axes), FAR)
        lanes[slots] = points
        return slots, lanes.reshape(blocks, self.lanes, self.axes), first


def grid_round(
    water: Water,
    position: np.ndarray,
    tanks: Sequence[Tank],
    bounds: tuple[np.ndarray, np.ndarray],
    lanes: int,
    along: float = 0.0,
) -> Grid:
    """The grid round `tanks`, in which water stays within `bounds`; in space they are `along` (m) long.

    Where it has no walls, the grid is round the water itself, with as much space on all sides.
    """
    lower, upper = bounds
    margin = ROOM * water.reach
    if not water.walls and not water.periodic:
        place = position.reshape(-1, position.shape[-1])
        lower, upper = place.min(axis=0), place.max(axis=0)
        margin = float(np.ptp(place, axis=0).max())
    outline = tanks[0].outline
    axes = position.shape[-1]
    sides = zip(DIRECTIONS[:axes], (*np.ptp(outline, axis=0), along), strict=False)
    periods = tuple(float(side) if name in water.periodic else 0.0 for name, side in sides)
    corners, origin = (tuple(lower - margin), tuple(upper + margin)), (*outline.min(axis=0), -0.5 * along)[:axes]
    return Grid(*corners, water.spacing, lanes, periods, origin, len(tanks), watched_box(water, tanks))


def watched_box(water: Water, tanks: Sequence[Tank]) -> tuple[np.ndarray, np.ndarray] | None:
    """Corners (m) of the box round all `tanks` and what their walls reach; None where no water may leave them."""
    if not water.walls or not any(tank.open_edges for tank in tanks):
        return None
    corners = np.concatenate([tank.outline for tank in tanks])
    return corners.min(axis=0) - water.reach, corners.max(axis=0) + water.reach
