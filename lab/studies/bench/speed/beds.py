"""The settled beds whose steps are timed: acetate grains at rest in a tank, and copies of them side by side."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lab.preset.outline import rectangle
from lab.studies.bench.remembered import remembered
from solvers.grains.bed.filling import radii, start_positions
from solvers.grains.given import Grains
from solvers.grains.materials import Material
from solvers.scene import Scene
from solvers.simulation import Simulation

DIAMETER, SPREAD = 3e-3, 0.1  # m; share of it
HEIGHT = 0.2  # m
SCALE = 1e-3  # on Young's modulus
WIDTHS = {500: 48e-3, 2000: 192e-3}  # m, of the tanks of the usual beds by their grains: some 30 diameters deep
REST, LIMIT = 1e-8, 5.0  # of m g d; s of settling
# Spandonidis (2016), table 5.2; the restitution is our choice.
ACETATE = Material(density=1319.0, young=3.2e9, poisson=0.28, friction=0.25, restitution=0.6)


@dataclass(frozen=True)
class Bed:
    """Grains at rest: `radius` (n,) and `position` (n, 2), m, in a closed tank `width` (m) wide and HEIGHT high."""

    radius: np.ndarray
    position: np.ndarray
    width: float

    @property
    def count(self) -> int:
        """Number of grains."""
        return len(self.radius)

    def scene(self, worlds: int = 1, material: Material = ACETATE, **changes: object) -> Scene:
        """The scene of the bed in as many equal worlds, softened by SCALE; friction with history unless changed."""
        radius = np.tile(self.radius, (worlds, 1))
        laws = {name: changes.pop(name) for name in list(changes) if name in Grains.__dataclass_fields__}
        laws = {"tangential": "mindlin", "stiffness_scale": SCALE, **laws}
        return Scene(tank(self.width), (Grains(radius, material, material, **laws),), **changes)

    def places(self, worlds: int = 1) -> np.ndarray:
        """Positions (W, n, 2) m in as many worlds."""
        return np.tile(self.position, (worlds, 1, 1))

    def times(self, number: int) -> "Bed":
        """A bed of `number` copies of this one side by side in one tank.

        All worlds made from one bed have the same number of contacts per grain; where two copies meet, the force is
        nearly that of the walls that they replace.
        """
        shifts = self.width * (np.arange(number) - 0.5 * (number - 1))
        position = np.concatenate([self.position + np.array([shift, 0.0]) for shift in shifts])
        return Bed(np.tile(self.radius, number), position, self.width * number)


def tank(width: float) -> np.ndarray:
    """Outline (4, 2) m of a closed tank, its floor centred on the origin."""
    return np.array(rectangle(width, HEIGHT))


def usual_bed(work: Path, count: int) -> Bed:
    """The settled bed of `count` grains, a key of WIDTHS."""
    return settled_bed(work, count, WIDTHS[count])


def settled_bed(work: Path, count: int, width: float, seed: int = 1) -> Bed:
    """A bed of `count` grains at rest in a tank `width` (m) wide, from the folder `work`, where it is kept."""
    path = work / f"bed-{count}-{1e3 * width:g}-{seed}.npz"
    found = remembered(path, f"settling {count} grains", lambda: _settled(count, width, seed))
    return Bed(found["radius"], found["position"], width)


def _settled(count: int, width: float, seed: int) -> dict[str, np.ndarray]:
    random = np.random.default_rng(seed)
    radius = radii(count, DIAMETER, SPREAD, random)
    bed = Bed(radius, start_positions(radius, tank(width), random), width)
    run = Simulation(bed.scene(), bed.places(), threads=1, arch="cpu")
    run.settle(REST, LIMIT)
    position = run.snapshot()["position"][0]
    run.close()
    # Column by column, as the solver orders large worlds itself.
    order = np.lexsort((position[:, 1], np.floor(position[:, 0] / DIAMETER)))
    return {"radius": radius[order], "position": position[order]}
