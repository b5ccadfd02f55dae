"""What a scene says of its grains: sizes, materials, laws, and how they start."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Annotated

import numpy as np

from solvers.grains.laws import COHESION, NORMAL, ROLLING, TANGENTIAL, TWISTING
from solvers.grains.materials import Interface, Material, interface, touching
from solvers.grains.shapes.given import Shapes
from solvers.machine import wide
from solvers.machine.marks import EachWorld, LargestOfWorlds, NotOfBed
from solvers.tank.given import Given


@dataclass
class Grains(Given):
    """W worlds of n grains.

    - `radius` (W, n) m; `sizes`: smallest and largest radius (m) a world may hold, by default the range of `radius`.
      What is derived for all worlds follows from `sizes`, so that a world does not depend on the others in its batch.
    - `grain`, `wall`: materials, one or one per world. `kind` (W, n) is 0 for grains of `grain` and counts on through
      `others`, None if there is one kind; `unlike`: the contact materials of pairs of kinds.
    - `normal`, `tangential`, `rolling`, `cohesion`, `twisting`: names of the laws; `stiffness_scale`: the
      factor on Young's moduli.
    - `shapes` of irregular grains, whose `radius` and `sizes` are those of discs of equal area; None for discs.
    - `fixed` (k, axes + 1): place and radius in m of grains that never move.
    - At the start: `start_speed` (m/s), highest closing speed of grains and walls; `velocity` (W, n, axes) m/s, `spin`
      (W, n) rad/s, in space (W, n, 3), None: at rest.
    - `integrator`: its name; `base_share`: see `share_to_lengthen`.
    """

    radius: Annotated[np.ndarray, EachWorld(lambda grains: grains.count)]
    grain: Annotated[Material | Sequence[Material], EachWorld(lambda grains: grains.longest_bridge)]
    wall: Annotated[Material | Sequence[Material], EachWorld()]
    normal: str = "hertz-viscoelastic"
    tangential: str = "haff-werner"
    rolling: str = "none"
    cohesion: str = "none"
    twisting: str = "none"
    stiffness_scale: float = 1.0
    base_share: Annotated[float, LargestOfWorlds(), NotOfBed()] = 1.0
    start_speed: Annotated[float, LargestOfWorlds(), NotOfBed()] = 0.0
    sizes: tuple[float, float] | None = None
    velocity: Annotated[np.ndarray | None, EachWorld(lambda grains: grains.velocity is None)] = None
    spin: Annotated[np.ndarray | None, EachWorld(lambda grains: grains.spin is None)] = None
    kind: Annotated[np.ndarray | None, EachWorld(lambda grains: grains.kind is None)] = None
    others: tuple[Material, ...] = ()
    unlike: tuple[tuple[tuple[int, int], Material], ...] = ()
    fixed: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    shapes: Annotated[Shapes | None, EachWorld(lambda grains: grains.shapes and grains.shapes.alike)] = None
    integrator: str = "verlet"
    interfaces_of: list[tuple[Interface, ...]] = field(init=False)  # per world, in the row order of `ChosenLaws`

    def __post_init__(self):
        self.radius = np.atleast_2d(np.asarray(self.radius, dtype=np.float64))
        self.fixed = np.asarray(self.fixed, dtype=np.float64)
        if self.fixed.ndim < 2:
            self.fixed = self.fixed.reshape(-1, 3)
        self.grain, self.wall = self._a_world(self.grain), self._a_world(self.wall)
        if self.sizes is None:
            self.sizes = float(self.radius.min()), float(self.radius.max())
        self.interfaces_of = [self._interfaces(*materials) for materials in zip(self.grain, self.wall, strict=True)]

    def _a_world(self, material: Material | Sequence[Material]) -> tuple[Material, ...]:
        return (material,) * self.worlds if isinstance(material, Material) else tuple(material)

    def _interfaces(self, grain: Material, wall: Material) -> tuple[Interface, ...]:
        """Interfaces between all pairs of kinds of grains, then between each kind and a wall."""
        mean, scale, kinds = self.mean_radius, self.stiffness_scale, (grain, *self.others)
        mass = [4.0 / 3.0 * np.pi * mean**3 * kind.density for kind in kinds]
        unlike = {tuple(sorted(pair)): material for pair, material in self.unlike}
        rows = []
        for a, b in product(range(len(kinds)), repeat=2):
            low, high = sorted((a, b))
            other = kinds[b] if a == b else touching(kinds[low], kinds[high], unlike.get((low, high)))
            rows.append(interface(kinds[low], other, mass[a] * mass[b] / (mass[a] + mass[b]), mean / 2.0, scale))
        return (*rows, *(interface(kind, wall, m, mean, scale) for kind, m in zip(kinds, mass, strict=True)))

    @property
    def worlds(self) -> int:
        """Number of worlds, W."""
        return len(self.radius)

    @property
    def count(self) -> int:
        """Number of grains in a world, n."""
        return self.radius.shape[1]

    @property
    def moved(self) -> int:
        """How many of them are moved one by one: all."""
        return self.count

    @property
    def in_bands(self) -> int:
        """How many of them the bands of a world are cut by: all."""
        return self.count

    @property
    def start(self) -> tuple:
        """Velocities and spins at the start."""
        return self.velocity, self.spin

    @property
    def pieces(self) -> int:
        """The fixed grains bear loads together."""
        return int(len(self.fixed) > 0)

    @property
    def thickness(self) -> float:
        """Thickness (m) of a tank with one layer of them: their mean diameter."""
        return 2.0 * self.mean_radius

    @property
    def simple(self) -> bool:
        """Whether their kernels are short."""
        return self.shapes is None

    def lanes(self, precision: str) -> int:
        """Lanes of a block of pairs on real vectors, 0 for none."""
        return wide.lanes_of_outlines(precision) if self.shapes else wide.lanes()

    @property
    def bears_vectors(self) -> bool:
        """Whether blocks of pairs can be on real vectors.

        Of outlines only convex ones have blocks of several contacts. The rule `area` is not written for vectors.
        """
        return self.shapes is None or (self.shapes.convex and self.shapes.contact != "area")

    @property
    def kinds(self) -> int:
        """Number of kinds of grains."""
        return 1 + len(self.others)

    @property
    def interfaces(self) -> tuple[Interface, Interface]:
        """Interfaces of the first world between two grains of the first kind, and between one and a wall."""
        return self.interfaces_of[0][0], self.interfaces_of[0][self.kinds**2]

    @property
    def density(self) -> np.ndarray:
        """Densities (W, n) of the grains, kg/m³."""
        first = np.array([material.density for material in self.grain])
        density = np.repeat(first[:, None], self.count, axis=1)
        for number, material in enumerate(self.others, start=1):
            density[self.kind == number] = material.density
        return density

    @property
    def solid(self) -> np.ndarray:
        """Volume (W,) m³ of the grains of each world, as spheres."""
        return (4.0 / 3.0 * np.pi * self.radius**3).sum(axis=1)

    @property
    def mean_radius(self) -> float:
        """Middle of the range of radii (m)."""
        return 0.5 * sum(self.sizes)

    @property
    def farthest_reach(self) -> float:
        """Largest distance (m) from any grain's centre to its outline."""
        reach = self.shapes.reach if self.shapes else 1.0
        return max(self.sizes[1] * reach, self.fixed[:, -1].max(initial=0.0))

    @property
    def laws(self) -> tuple:
        """The normal, tangential, rolling and cohesion laws."""
        return NORMAL[self.normal](), TANGENTIAL[self.tangential](), ROLLING[self.rolling](), COHESION[self.cohesion]()

    @property
    def twist_law(self):
        """The law against twisting, in space."""
        return TWISTING[self.twisting]()

    @property
    def longest_bridge(self) -> float:
        """The longest gap (m) of a liquid bridge, rounded up to a micrometre.

        Worlds whose bridges differ by nanometres then have equal lists and may run in one launch.
        """
        law = COHESION[self.cohesion]()
        longest = max((law.range(between) for world in self.interfaces_of for between in world), default=0.0)
        return 1e-6 * float(np.ceil(1e6 * longest))

    def deepest_overlap(self, speed: float) -> float:
        """Largest overlap, in radii of the smallest grain, as it hits the largest grain or a wall at a speed (m/s).

        Losses are ignored. Between equal grains it is less, and in radii it is the same for grains of any size.
        """
        law, (radius, largest), found = self.laws[0], self.sizes, 0.0
        of_mass, of_radius = 1.0 / (1.0 + (radius / largest) ** 3), 1.0 / (1.0 + radius / largest)
        for grain, rows in zip(self.grain, self.interfaces_of, strict=True):
            mass = 4.0 / 3.0 * np.pi * radius**3 * max(kind.density for kind in (grain, *self.others))
            for k, between in enumerate(rows):
                shares = (of_mass, of_radius) if k < self.kinds**2 else (1.0, 1.0)
                found = max(found, law.deepest(between, shares[0] * mass, shares[1] * radius, speed) / radius)
        return found
