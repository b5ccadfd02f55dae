"""Compressed packings in equilibrium: six grains round a seventh in the plane, a block of a cubic crystal in space.

Without friction and losses each is at rest, and its highest frequency follows from its contacts.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, pi, sqrt

import numpy as np

from benchmarks.speed.beds import ACETATE
from lab.preset.outline import rectangle
from solvers.grains.materials import Material, effective_young, hertz_stiffness
from solvers.machine.quantity import PLANE
from solvers.tank.solids.solid import Prism

RADIUS = 1.5e-3  # m
SPEED = 1.0  # m/s, of the impact, and that at which the linear spring is as deep as Hertz's contact
STUCK = 100.0  # a friction coefficient that no disturbance overcomes
HALF_CELLS = 4  # of the block along each axis: 63 grains, of which 13 touch no wall
NEWTON, RESTS = 50, 1e-12  # most iterations, and the force left, of that of a contact


def material(restitution: float) -> Material:
    """Acetate with a restitution and so much friction that nothing slides."""
    return replace(ACETATE, restitution=restitution, restitution_speed=SPEED, friction=STUCK)


MASS = 4.0 / 3.0 * pi * RADIUS**3 * ACETATE.density  # kg


@dataclass(frozen=True)
class Springs:
    """Normal forces without losses, of two grains and of a grain and a wall: k ξ^power, and the `overlap` (m) of two.

    Two grains overlap as in Hertz's collision at SPEED, ξ = ((5/4) m_eff v²/k)^(2/5). A linear spring is as deep at
    that speed, k_l = (4/5)^(4/5) (k⁴ m_eff v²)^(1/5).
    """

    pair: float
    wall: float
    power: float
    overlap: float

    @classmethod
    def of(cls, normal: str) -> "Springs":
        """Those of a normal law."""
        grain = material(1.0)
        young = effective_young(grain, grain)
        pair, wall = hertz_stiffness(young, 0.5 * RADIUS), hertz_stiffness(young, RADIUS)
        overlap = (0.625 * MASS * SPEED**2 / pair) ** 0.4
        if normal.startswith("hertz"):
            return cls(pair, wall, 1.5, overlap)
        pair, wall = (0.8**0.8 * (k**4 * m * SPEED**2) ** 0.2 for k, m in ((pair, 0.5 * MASS), (wall, MASS)))
        return cls(pair, wall, 1.0, overlap)

    def pressed(self, force: float) -> float:
        """The overlap (m) of a grain and a wall under a force (N)."""
        return (force / self.wall) ** (1.0 / self.power)

    @property
    def force(self) -> float:
        """Force (N) between two grains."""
        return self.pair * self.overlap**self.power


@dataclass(frozen=True)
class Packing:
    """Grains of RADIUS at `places` (n, axes) m in a tank whose outline stands for a `solid` in space.

    `walls`: a point (m) of each and its normal into the tank.
    """

    places: np.ndarray
    outline: np.ndarray
    walls: tuple[tuple[np.ndarray, np.ndarray], ...]
    springs: Springs
    solid: Prism | None = None

    def exact_limit(self) -> float:
        """2/ω (s) with the highest frequency ω without friction and losses.

        m ω² is the largest eigenvalue of the sum over contacts of s n nᵀ − (F/d)(1 − n nᵀ), slope s, force F, normal n
        and distance d, as in lattice dynamics; a wall is flat and has only the first term.
        """
        _, matrix = self._pressed()
        return 2.0 / sqrt(np.linalg.eigvalsh(matrix).max() / MASS)

    def relaxed(self) -> "Packing":
        """In equilibrium, by Newton's iteration. Raises RuntimeError where that does not converge."""
        packing = self
        for _ in range(NEWTON):
            force, matrix = packing._pressed()
            if np.abs(force).max() < RESTS * self.springs.force:
                return packing
            step = np.linalg.solve(matrix, force.ravel()).reshape(force.shape)
            packing = replace(packing, places=packing.places + step)
        raise RuntimeError("the packing does not come to rest")

    def _pressed(self) -> tuple[np.ndarray, np.ndarray]:
        """Forces (n, axes) N on the grains, and the matrix (n axes, n axes) N/m of their slopes."""
        count, axes = self.places.shape
        force, matrix = np.zeros((count, axes)), np.zeros((count, axes, count, axes))
        one = np.eye(axes)
        for i, j, normal, distance, pushed, slope in self._pairs():
            force[i] += pushed * normal
            force[j] -= pushed * normal
            along = np.outer(normal, normal)
            block = slope * along - pushed / distance * (one - along)
            for a, b, sign in ((i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)):
                matrix[a, :, b, :] += sign * block
        for point, inwards in self.walls:
            overlap = np.maximum(RADIUS - (self.places - point) @ inwards, 0.0)
            for i in np.flatnonzero(overlap):
                force[i] += self.springs.wall * overlap[i] ** self.springs.power * inwards
                slope = self.springs.power * self.springs.wall * overlap[i] ** (self.springs.power - 1.0)
                matrix[i, :, i, :] += slope * np.outer(inwards, inwards)
        return force, matrix.reshape(count * axes, count * axes)

    def _pairs(self) -> Iterator[tuple[int, int, np.ndarray, float, float, float]]:
        """Of two grains that touch: both, the normal towards the first, distance (m), force (N) and slope (N/m)."""
        for i, place in enumerate(self.places):
            away = place - self.places[:i]
            distance = np.linalg.norm(away, axis=1)
            for j in np.flatnonzero(distance < 2.0 * RADIUS):
                overlap = 2.0 * RADIUS - distance[j]
                pushed = self.springs.pair * overlap**self.springs.power
                yield i, j, away[j] / distance[j], distance[j], pushed, self.springs.power * pushed / overlap


def packing(normal: str, axes: int = PLANE) -> Packing:
    """The compressed packing under a normal law, in the plane or in space."""
    return hexagon(normal) if axes == PLANE else block(normal)


def hexagon(normal: str) -> Packing:
    """Six grains round a seventh in a hexagonal tank, every contact of two as deep as the impact.

    An outer grain bears the force F of the middle one and of two neighbours, 2 F outwards in sum, and so F/cos 30° at
    each of its two walls.
    """
    springs = Springs.of(normal)
    deep, apart = springs.pressed(springs.force / cos(pi / 6.0)), 2.0 * RADIUS - springs.overlap
    corner = apart + (RADIUS - deep) / cos(pi / 6.0)
    around = _around(pi / 3.0 * np.arange(6))
    outline = corner * around
    walls = tuple(zip(outline, -_around(pi / 3.0 * np.arange(6) + pi / 6.0), strict=True))
    return Packing(np.vstack([[0.0, 0.0], apart * around]), outline, walls, springs)


def block(normal: str) -> Packing:
    """A face-centred cubic crystal in a box: grains inside have twelve contacts, each as deep as the impact.

    A grain in the middle of a face bears four forces F at 45°, √8 F in sum; the walls stand where they press it so.
    Those at edges and corners bear other forces and move a little until all are at rest.
    """
    springs = Springs.of(normal)
    pitch = (2.0 * RADIUS - springs.overlap) / sqrt(2.0)
    half = 0.5 * HALF_CELLS * pitch + RADIUS - springs.pressed(sqrt(8.0) * springs.force)
    sites = np.stack(np.meshgrid(*[np.arange(HALF_CELLS + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    places = pitch * (sites[sites.sum(axis=1) % 2 == 0] - 0.5 * HALF_CELLS)
    places[:, 1] += half  # the floor is at z = 0
    middle, normals = np.array([0.0, half, 0.0]), np.vstack([np.eye(3), -np.eye(3)])
    walls = tuple((middle - half * inwards, inwards) for inwards in normals)
    outline = np.array(rectangle(2.0 * half, 2.0 * half))
    return Packing(places, outline, walls, springs, Prism(2.0 * half)).relaxed()


def _around(angle: np.ndarray) -> np.ndarray:
    """Unit vectors (n, 2)."""
    return np.column_stack([np.cos(angle), np.sin(angle)])
