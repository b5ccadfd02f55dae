"""How many entries the neighbour lists of a unit have room for: by a formula in the plane, counted in space."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from solvers.fluid.lists.grid import Grid
from solvers.fluid.state import FAR, Particles, snug
from solvers.machine.quantity import PLANE
from solvers.machine.units import Units

SKIN = (0.3, 1.2)  # spacings: the skin in a still tank, and in a violent one
CROWDED = 1.6  # times the neighbours of a square block at rest: room for those of long blocks and of dense impacts
SAMPLE = 2000  # blocks of which the entries are counted, an even choice from all: to a hundredth of the whole or so
# Times the entries at the start, with the skin of a still tank: room for water that climbs walls and whose blocks get
# long; where it does not do, lists have the least skin, and then twice the room
MORE = {"near": 1.4, "beside": 2.0, "facing": 1.5}
USUAL, FINE = 2**18, 32  # entries for which there is room at least; by one of how many parts lists may be too long


@dataclass(frozen=True, eq=False)
class Laid:
    """What is known of water when its lists are made: `places` (W, n, D) m at the start, and `room`, a factor.

    `walls` (blocks, lanes, D) m are the blocks of wall particles, unused lanes far off.
    """

    room: int
    places: np.ndarray
    walls: np.ndarray


def capacities(laid: Laid, grid: Grid, units: Units, particles: Particles, smoothing: float) -> dict[str, int]:
    """Entries of a unit's lists: of water near water, of walls beside water, and of water that walls face."""
    if particles.axes > PLANE and not units.single:
        far = (2.0 * smoothing + SKIN[0]) * grid.spacing
        found = counted(laid, grid, units.a_world, far)
        return {name: snug(int(laid.room * MORE[name] * count), USUAL, FINE) for name, count in found.items()}
    wet, dry = (-(-blocks // units.a_world) for blocks in (particles.fluid_blocks, max(particles.wall_blocks, 1)))
    crowd = laid.room * crowd_of(grid.lanes, smoothing, particles.axes)
    few = 4 * particles.wall_blocks * particles.lanes // units.a_world + wet  # blocks beside walls
    beside = max(laid.room * (8 * few + 64), crowd if particles.axes > PLANE else 0)  # a corner sees mostly walls
    return {"near": crowd * wet, "beside": beside, "facing": crowd * dry}


def crowd_of(lanes: int, smoothing: float, axes: int) -> int:
    """Usual number of neighbours of a full block: what is within reach of its square or cube, with the widest skin.

    By Steiner's formula for what is within a distance of a convex body.
    """
    side, far = lanes ** (1.0 / axes) if lanes > 1 else 0.0, 2.0 * smoothing + SKIN[1]
    of_plane = side**2 + 4.0 * side * far + np.pi * far**2
    of_space = side**3 + 6.0 * side**2 * far + 3.0 * np.pi * side * far**2 + 4.0 / 3.0 * np.pi * far**3
    return int(CROWDED * (of_plane if axes == PLANE else of_space))


def counted(laid: Laid, grid: Grid, units: int, far: float) -> dict[str, int]:
    """Entries of the fullest of so many `units` of a world at the start, with everything within `far` (m) of blocks."""
    most = {"near": 0, "beside": 0, "facing": 0}
    lower, upper = boxes_round(laid.walls.reshape(-1, grid.axes), np.arange(len(laid.walls)).repeat(grid.lanes))
    wall = laid.walls[laid.walls[..., 0] < 0.5 * FAR]
    for water in laid.places:
        box = boxes_round(*in_blocks(water, grid))
        for name, blocks, points in (("near", box, water), ("beside", box, wall), ("facing", (lower, upper), water)):
            if len(points) and len(blocks[0]):
                most[name] = max(most[name], fullest(*blocks, images_of(points, grid), units, far))
    return most


def in_blocks(points: np.ndarray, grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, D) in the order of the grid, and the number (n,) of each one's block: each strip begins a new one."""
    key = grid.key(points)
    order = np.argsort(key, kind="stable")
    _, begin, size = np.unique(key[order] // grid.bins, return_index=True, return_counts=True)
    within = np.arange(len(points)) - begin.repeat(size)
    before = np.concatenate([[0], np.cumsum(-(-size // grid.lanes))[:-1]])
    return points[order], before.repeat(size) + within // grid.lanes


def boxes_round(points: np.ndarray, block: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corners (blocks, D) m of the boxes round points (n, D) by their blocks (n,), which rise."""
    used = points[:, 0] < 0.5 * FAR
    points, block = points[used], block[used]
    begin = np.unique(block, return_index=True)[1]
    if not len(begin):
        return points, points
    return np.minimum.reduceat(points, begin), np.maximum.reduceat(points, begin)


def images_of(points: np.ndarray, grid: Grid) -> np.ndarray:
    """Points (n, D) and, where space repeats itself, their images beside it."""
    steps = product(*((-1, 0, 1) if period else (0,) for period in grid.periods[: grid.axes]))
    return np.concatenate([points + np.array(step) * grid.periods[: grid.axes] for step in steps])


def fullest(lower: np.ndarray, upper: np.ndarray, points: np.ndarray, units: int, far: float) -> int:
    """How many points (n, D) m are within `far` (m) of the boxes of the fullest of so many units, by some of these."""
    from scipy.spatial import cKDTree  # here, so that runs in the plane do not wait for it

    size, tree, most = -(-len(lower) // units), cKDTree(points), 0
    for u in range(units):
        blocks = np.arange(u * size, min(len(lower), (u + 1) * size))
        chosen = blocks[np.linspace(0, len(blocks) - 1, min(len(blocks), SAMPLE)).astype(int)]
        total = 0
        for low, high in zip(lower[chosen], upper[chosen], strict=True):
            around = tree.query_ball_point(0.5 * (low + high), 0.5 * np.linalg.norm(high - low) + far)
            off = points[around] - np.clip(points[around], low, high)
            total += int(np.count_nonzero((off**2).sum(axis=1) < far**2))
        most = max(most, -(-total * len(blocks) // max(1, len(chosen))))
    return most
