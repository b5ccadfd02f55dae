"""Water packed into a polygon of any shape: particles of equal volume, evenly spaced up to slanted walls and bodies."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from solvers.fluid.given import Water
from solvers.fluid.kernels.wendland_c2 import WendlandC2
from solvers.fluid.walls.layers import layers
from solvers.tank.outline import area_below, cut_off
from solvers.tank.tank import Tank

PLASTIC = 1.324717957244746  # the root of x³ = x + 1
EVEN = 5e-4  # largest Δx |Σ V ∇W| at the end; less even water rearranges itself as it moves, which damps waves
STEPS = 1500  # at most
PUSH = 1.5  # for h/Δx ≥ 2: a step's length, over the time in which a push Δx Σ V ∇W of 1 moves by a spacing
DRAG = 0.1  # of the velocity, lost in a step
FARTHEST = 0.1  # spacings that a particle may move in a step
SKIN = 0.2  # smoothing lengths by which pairs are looked for beyond the kernel's reach
STRIP = 4  # spacings: height of the strips along which particles are numbered, to be near in memory
KEPT = 8  # packings that are remembered: repeats, and runs of a sweep, start alike


@dataclass(frozen=True, eq=False)
class Packing:
    """Particles at `points` (n, 2) m, each of a `volume` (m²), and how even they are after so many `steps`.

    `push` (n, 2) is −Δx Σ V ∇W of each over the others and the wall particles, `cover` (n,) is Γ = Σ V W: 0 and 1 in a
    liquid without particles.
    """

    points: np.ndarray
    volume: float
    push: np.ndarray
    cover: np.ndarray
    steps: int


def packed(polygon: np.ndarray, level: float, water: Water, holes: Sequence[np.ndarray] = ()) -> Packing:
    """Particles that fill a polygon (m, 2) m up to a `level` (m), apart from `holes`, closed polygons (k, 2) m within.

    Damped relaxation under a pressure that is everywhere the same, du/dt = −2 p/ρ Σ V ∇W − ζ u, between wall particles
    on all sides, the surface included (after Colagrossi, Bouscasse, Antuono & Marrone 2012). Wall particles are those
    of the run, W is Wendland's C2 with the smoothing length of the run. The start is a sequence that fills the plane
    evenly along no axis, so that the particles end in no order: a lattice under pressure is elastic, water is not. The
    end is where Δx |Σ V ∇W| is below EVEN for all particles, or after STEPS.

    There are as many particles as spacings squared in the area, to the nearest; their volumes are equal and their sum
    is exactly the area. Polygons are counter-clockwise. The result is the same in every call. Raises ValueError if no
    particle fits in.
    """
    shapes = tuple((shape.tobytes(), shape.shape) for shape in (np.array(one, float) for one in (polygon, *holes)))
    return _packed(shapes, float(level), water.spacing, water.smoothing)


@lru_cache(maxsize=KEPT)
def _packed(shapes: tuple, level: float, spacing: float, smoothing: float) -> Packing:
    polygon, *holes = (np.frombuffer(data).reshape(shape) for data, shape in shapes)
    polygon, holes = below(polygon, level), [below(one, level) for one in holes if one[:, 1].min() < level]
    area = area_of(polygon) - sum(area_of(hole) for hole in holes)
    count = round(area / spacing**2)
    if count < 1:
        raise ValueError("no particle of this spacing fits in")
    rows = int(np.ceil(2.0 * smoothing - 1e-9))
    sides = [layers(polygon, spacing, rows), *(layers(hole[::-1], spacing, rows) for hole in holes)]
    walls, volumes, _ = (np.concatenate(parts) for parts in zip(*sides, strict=True))
    crowd = Crowd(scattered(polygon, holes, count), area / count, walls, volumes, smoothing * spacing)
    steps = relax(crowd, spacing, PUSH * min(1.0, smoothing / 2.0) ** 2)
    return Packing(crowd.points, area / count, spacing * crowd.pushes(), crowd.covers(), steps)


def below(polygon: np.ndarray, level: float) -> np.ndarray:
    """The part of a polygon (m, 2) m below a level (m)."""
    return cut_off(polygon, level - polygon[:, 1].min())


def area_of(polygon: np.ndarray) -> float:
    """Area (m²) of a polygon (m, 2) m."""
    return area_below(polygon, np.ptp(polygon[:, 1]))


def scattered(polygon: np.ndarray, holes: Sequence[np.ndarray], count: int) -> np.ndarray:
    """So many points (count, 2) m in a polygon but in none of the holes, by Roberts's sequence R2 (2018).

    The n-th point is the fractional part of n (1/φ, 1/φ²), φ³ = φ + 1: a Kronecker sequence of low discrepancy.
    """
    low, size, found, n = polygon.min(axis=0), np.ptp(polygon, axis=0), np.zeros((0, 2)), 1
    while len(found) < count:
        number = np.arange(n, n + count)[:, None]
        points = low + size * ((0.5 + number * np.array([1.0 / PLASTIC, 1.0 / PLASTIC**2])) % 1.0)
        inside = Tank(polygon, 1.0).holds(points)
        for hole in holes:
            inside &= ~Tank(hole, 1.0).holds(points)
        found, n = np.concatenate([found, points[inside]]), n + count
    found = found[:count]
    strip = np.floor((found[:, 1] - low[1]) * np.sqrt(count / size.prod()) / STRIP)
    return found[np.lexsort((found[:, 0], strip))]


def relax(crowd: "Crowd", spacing: float, pace: float, most: int = STEPS) -> int:
    """Let the particles of a crowd push each other apart until they are EVEN, by steps of a `pace`; returns how many.

    At `most` so many.
    Velocities begin anew where the forces work against them (as of quick min, Sheppard, Terrell & Henkelman 2008).
    """
    velocity = np.zeros_like(crowd.points)
    for step in range(most):
        push = spacing * crowd.pushes()
        if np.hypot.reduce(push.T).max() < EVEN:
            return step
        velocity = (1.0 - DRAG) * velocity + pace * push
        if (velocity * push).sum() < 0.0:
            velocity[:] = 0.0
        way = pace * velocity
        crowd.move(spacing * way * min(1.0, FARTHEST / max(np.hypot.reduce(way.T).max(), FARTHEST)))
    return most


class Crowd:
    """Particles at `points` (n, 2) m of one `volume` (m²) among fixed `walls` (k, 2) m of `volumes` (k,) m².

    In space they have three coordinates, and volumes are in m³.
    """

    def __init__(self, points: np.ndarray, volume: float, walls: np.ndarray, volumes: np.ndarray, length: float):
        self.points, self.volume, self.length, self.axes = points, volume, length, points.shape[1]
        from scipy.spatial import cKDTree  # here, so that runs without water do not wait for it

        self.make_tree = cKDTree
        self.walls, self.volumes = walls, volumes
        self.look(SKIN * length)

    def look(self, skin: float) -> None:
        """Find the pairs that are nearer than the kernel's reach and a `skin` (m)."""
        reach, self.skin, self.seen = 2.0 * self.length + skin, skin, self.points.copy()
        tree = self.make_tree(self.points)
        self.first, self.second = tree.query_pairs(reach, output_type="ndarray").T
        near = tree.sparse_distance_matrix(self.make_tree(self.walls), reach, output_type="ndarray")
        order = np.lexsort((near["j"], near["i"]))  # sums are taken in one order
        self.wet, self.dry = near["i"][order], near["j"][order]
        self.share = self.volumes[self.dry]

    def move(self, way: np.ndarray) -> None:
        """Move the particles by (n, 2) m."""
        self.points = self.points + way
        if 2.0 * np.hypot.reduce((self.points - self.seen).T).max() > self.skin:
            self.look(self.skin)

    def pairs(self) -> tuple[tuple[list[np.ndarray], np.ndarray], tuple[list[np.ndarray], np.ndarray]]:
        """r_i − r_j by axes (m) and t = 1 − r/2h ≥ 0, of two particles, and of a particle and a wall particle."""
        found = []
        for ours, theirs, others in ((self.first, self.second, self.points), (self.wet, self.dry, self.walls)):
            apart = [
                mine[ours] - their[theirs] for mine, their in zip(columns(self.points), columns(others), strict=True)
            ]
            distance = np.sqrt(sum(along * along for along in apart))
            found.append((apart, np.maximum(1.0 - distance * (0.5 / self.length), 0.0)))
        return found[0], found[1]

    def pushes(self) -> np.ndarray:
        """−Σ V ∇W (n, 2), 1/m, of each particle."""
        (inner, t), (outer, t_outer) = self.pairs()
        factor, count = WendlandC2.factors(self.length, self.axes)[1], len(self.points)
        weight, weight_outer = factor * self.volume * (t * t * t), self.share * (factor * (t_outer * t_outer * t_outer))
        weight, weight_outer = self.parted(weight, weight_outer)
        found = np.empty_like(self.points)
        for a in range(self.axes):
            push = weight * inner[a]
            found[:, a] = np.bincount(self.first, push, count) - np.bincount(self.second, push, count)
            found[:, a] += np.bincount(self.wet, weight_outer * outer[a], count)
        return found

    def covers(self) -> np.ndarray:
        """Γ = Σ V W (n,) of each particle, itself included."""
        inner, outer = (
            WendlandC2.printed(2.0 * self.length * (1.0 - t), self.length, self.axes) for _, t in self.pairs()
        )
        count, alone = len(self.points), WendlandC2.factors(self.length, self.axes)[0]
        inner, outer = self.parted(inner, self.share * outer)
        each = np.bincount(self.first, inner, count) + np.bincount(self.second, inner, count) + alone
        return self.volume * each + np.bincount(self.wet, outer, count)

    def parted(self, inner: np.ndarray, outer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Weights of pairs of particles, and of particles and wall particles, but for what is hidden: nothing here."""
        return inner, outer


def columns(points: np.ndarray) -> np.ndarray:
    """The coordinates (2, n) of points (n, 2), each in one piece."""
    return np.ascontiguousarray(points.T)
