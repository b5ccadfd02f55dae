"""The settled beds whose steps are timed: acetate grains at rest in a tank, and copies of them side by side.

Those of spheres are of equal grains in a square tank twelve diameters wide, some thirteen deep.
"""

from dataclasses import dataclass
from math import isqrt
from pathlib import Path

import numpy as np

from benchmarks.remembered import remembered
from lab.preset.outline import rectangle
from solvers.grains.bed.filling import radii, start_positions
from solvers.grains.given import Grains
from solvers.grains.materials import Material
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.solids.solid import Prism

DIAMETER, SPREAD = 3e-3, 0.1  # m; share of it
HEIGHT = 0.2  # m
SCALE = 1e-3  # on Young's modulus
WIDTHS = {500: 48e-3, 2000: 192e-3}  # m, of the tanks of the usual beds by their grains: some 30 diameters deep
SPHERES, SIDE = 2000, 36e-3  # of the usual bed in space, and the width and length (m) of its tank
REST, LIMIT = 1e-8, 5.0  # of m g d; s of settling
# Spandonidis (2016), table 5.2; the restitution is our choice.
ACETATE = Material(density=1319.0, young=3.2e9, poisson=0.28, friction=0.25, restitution=0.6)


@dataclass(frozen=True)
class Bed:
    """Grains at rest: `radius` (n,) and `position` (n, axes), m, in a closed tank `width` (m) wide and HEIGHT high.

    Spheres are in space, in a tank `along` (m) long.
    """

    radius: np.ndarray
    position: np.ndarray
    width: float
    along: float | None = None

    @property
    def count(self) -> int:
        """Number of grains."""
        return len(self.radius)

    def scene(self, worlds: int = 1, material: Material = ACETATE, **changes: object) -> Scene:
        """The scene of the bed in as many equal worlds, softened by SCALE; friction with history unless changed."""
        radius = np.tile(self.radius, (worlds, 1))
        laws = {name: changes.pop(name) for name in list(changes) if name in Grains.__dataclass_fields__}
        laws = {"tangential": "mindlin", "stiffness_scale": SCALE, **laws}
        solid = None if self.along is None else Prism(self.along)
        return Scene(tank(self.width), (Grains(radius, material, material, **laws),), solid=solid, **changes)

    def places(self, worlds: int = 1) -> np.ndarray:
        """Positions (W, n, axes) m in as many worlds."""
        return np.tile(self.position, (worlds, 1, 1))

    def times(self, number: int) -> "Bed":
        """A bed of `number` copies of this one side by side in one tank, of spheres in a rectangle near a square.

        All worlds made from one bed have the same number of contacts per grain; where two copies meet, the force is
        nearly that of the walls that they replace.
        """
        rows = 1 if self.along is None else max(n for n in range(1, isqrt(number) + 1) if number % n == 0)
        across = self.width * _centred(number // rows)
        if self.along is None:
            shifts = np.column_stack([across, 0.0 * across])
        else:
            y, x = np.meshgrid(across, self.along * _centred(rows), indexing="ij")
            shifts = np.column_stack([y.ravel(), 0.0 * y.ravel(), x.ravel()])
        position = np.concatenate([self.position + shift for shift in shifts])
        along = None if self.along is None else self.along * rows
        return Bed(np.tile(self.radius, number), position, self.width * (number // rows), along)


def _centred(number: int) -> np.ndarray:
    return np.arange(number) - 0.5 * (number - 1)


def tank(width: float) -> np.ndarray:
    """Outline (4, 2) m of a closed tank, its floor centred on the origin."""
    return np.array(rectangle(width, HEIGHT))


def usual_bed(work: Path, count: int) -> Bed:
    """The settled bed of `count` grains, a key of WIDTHS."""
    return settled_bed(work, count, WIDTHS[count])


def bed_of_spheres(work: Path, count: int = SPHERES) -> Bed:
    """The settled bed of spheres, kept in the folder `work`; with fewer of them it is less deep."""
    return settled_bed(work, count, SIDE, along=SIDE)


def settled_bed(work: Path, count: int, width: float, seed: int = 1, along: float | None = None) -> Bed:
    """A bed of `count` grains at rest in a tank `width` (m) wide, from the folder `work`, where it is kept.

    In space the tank is `along` (m) long and its spheres are equal.
    """
    name = "bed" if along is None else "spheres"
    path = work / f"{name}-{count}-{1e3 * width:g}-{seed}.npz"
    found = remembered(path, f"settling {count} grains", lambda: _settled(count, width, seed, along))
    return Bed(found["radius"], found["position"], width, along)


def _settled(count: int, width: float, seed: int, along: float | None) -> dict[str, np.ndarray]:
    random = np.random.default_rng(seed)
    radius = radii(count, DIAMETER, SPREAD if along is None else 0.0, random)
    solid = None if along is None else Prism(along)
    bed = Bed(radius, start_positions(radius, tank(width), random, solid=solid), width, along)
    run = Simulation(bed.scene(), bed.places(), threads=1, arch="cpu")
    run.settle(REST, LIMIT)
    position = run.snapshot()["position"][0]
    run.close()
    # Column by column, as the solver orders large worlds itself.
    columns = np.floor(np.delete(position, 1, axis=1) / DIAMETER)
    order = np.lexsort((position[:, 1], *columns.T[::-1]))
    return {"radius": radius[order], "position": position[order]}
