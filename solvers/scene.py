"""The scene: everything the solver needs to know about an experiment, in SI units."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Annotated

import numpy as np

from solvers.fluid.given import Fluid
from solvers.fluid.timestep import limits_of_water
from solvers.grains.bed.relaxing import AT_REST, BURSTING, lifting_overlap, relaxed
from solvers.grains.laws import COHESION, NORMAL, ROLLING, TANGENTIAL
from solvers.grains.materials import Interface, Material, interface, touching
from solvers.grains.shapes.given import Shapes
from solvers.grains.timestep import SLOWEST, limits_of_grains
from solvers.machine.limit import Limit
from solvers.machine.marks import EachWorld, LargestOfWorlds, NotOfBed, in_one_launch, shared
from solvers.motion.axle import Axle
from solvers.motion.carrier import answered_shares, limits_of_carrier
from solvers.ship.vessel import Vessel
from solvers.tank.parts import Part
from solvers.tank.tank import BARE_THICKNESS, Tank


@dataclass
class Scene:
    """A batch of W worlds of n grains in equal tanks; n may be 0, for tanks without grains.

    - `radius` (W, n) m; `sizes`: smallest and largest radius (m) a world may hold, by default the range of `radius`.
      What is derived for all worlds follows from `sizes`, so that a world does not depend on the others in its batch.
    - `outline` (m, 2) m of the tank, counter-clockwise; `open_edges`: its edges without a wall, by their first corners;
      `parts`: plates that move in the tank; `fixed` (k, 3): y, z and radius in m of grains that never move.
    - `thickness` (m) of the tank, by default the mean grain diameter, without grains 1 m; `length` (m) along a ship,
      by default all; `more_tanks` stand beside it. Parts and fixed grains belong to the first tank.
    - `grain`, `wall`: materials, one or one per world, none without grains. `kind` (W, n) is 0 for grains of `grain`
      and counts on through `others`, None if there is one kind; `unlike`: the contact materials of pairs of kinds.
    - `motions[w]`: the tank's motions in world w, of the same kinds in every world; or `vessels` (W,): the ships whose
      holds the tanks are in, or `axles` (W,), about which they roll. `interval` (s) between updates of sea forces.
    - `step` Δt in s, None: derived; `base_share`: see `share_to_lengthen`. At the start: `start_speed` (m/s), highest
      closing speed of grains and walls; `velocity` (W, n, 2) m/s, `spin` (W, n) rad/s, None: at rest.
    - `fluid`: the water and air in them.
    - `shapes` of irregular grains, whose `radius` and `sizes` are those of discs of equal area; None for discs.

    The fields' marks say which may differ between the worlds of a launch, and from which a settled bed follows.
    """

    radius: Annotated[np.ndarray, EachWorld(lambda scene: scene.radius.shape[1])]
    outline: np.ndarray
    grain: Annotated[Material | Sequence[Material], EachWorld(lambda scene: scene.longest_bridge)] = ()
    wall: Annotated[Material | Sequence[Material], EachWorld()] = ()
    normal: str = "hertz-viscoelastic"
    tangential: str = "haff-werner"
    rolling: str = "none"
    cohesion: str = "none"
    stiffness_scale: float = 1.0
    gravity: float = 9.81
    motions: Annotated[Sequence[Sequence], EachWorld(lambda scene: scene.kinds_of_motions), NotOfBed()] = ()
    soft_start: Annotated[float, NotOfBed()] = 0.0
    step: Annotated[float | None, NotOfBed()] = None
    base_share: Annotated[float, LargestOfWorlds(), NotOfBed()] = 1.0
    start_speed: Annotated[float, LargestOfWorlds(), NotOfBed()] = 0.0
    sizes: tuple[float, float] | None = None
    velocity: Annotated[np.ndarray | None, EachWorld(lambda scene: scene.velocity is None)] = None
    spin: Annotated[np.ndarray | None, EachWorld(lambda scene: scene.spin is None)] = None
    kind: Annotated[np.ndarray | None, EachWorld(lambda scene: scene.kind is None)] = None
    others: tuple[Material, ...] = ()
    unlike: tuple[tuple[tuple[int, int], Material], ...] = ()
    fixed: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    open_edges: tuple[int, ...] = ()
    parts: tuple[Part, ...] = ()
    shapes: Annotated[Shapes | None, EachWorld(lambda scene: scene.shapes and scene.shapes.alike)] = None
    vessels: Annotated[Sequence[Vessel], EachWorld(lambda scene: bool(scene.vessels)), NotOfBed()] = ()
    axles: Annotated[
        Sequence[Axle], EachWorld(lambda scene: bool(scene.axles) and scene.axles[0].kind), NotOfBed()
    ] = ()
    interval: Annotated[float | None, NotOfBed()] = None
    thickness: float | None = None
    length: float | None = None
    more_tanks: tuple[Tank, ...] = ()
    fluid: Fluid | None = None
    integrator: str = "verlet"
    precision: str = "f64"
    schedule: str = "auto"
    interfaces_of: list[tuple[Interface, ...]] = field(init=False)  # per world, in the row order of `ChosenLaws`

    def __post_init__(self):
        self.radius = np.atleast_2d(np.asarray(self.radius, dtype=np.float64))
        self.outline = np.asarray(self.outline, dtype=np.float64)
        self.fixed = np.asarray(self.fixed, dtype=np.float64).reshape(-1, 3)
        self.grain, self.wall = self._a_world(self.grain), self._a_world(self.wall)
        self.motions = self.motions if len(self.motions) else [()] * self.worlds
        if self.sizes is None:
            self.sizes = (float(self.radius.min()), float(self.radius.max())) if self.radius.size else (0.0, 0.0)
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
    def tanks(self) -> tuple[Tank, ...]:
        """All tanks of a world, the first one included."""
        thickness = self.thickness or 2.0 * self.mean_radius or BARE_THICKNESS
        return (Tank(self.outline, thickness, tuple(self.open_edges), self.length), *self.more_tanks)

    @property
    def fills(self) -> tuple[int, ...]:
        """How many particles of water are in each tank."""
        return self.fluid.fills(len(self.tanks)) if self.fluid else (0,) * len(self.tanks)

    @property
    def apart(self) -> list[int]:
        """The tanks of water, by their numbers, beside others of grains, which do not feel their walls."""
        return [number for number, fill in enumerate(self.fills) if fill] if self.radius.size else []

    @property
    def shares(self) -> np.ndarray | None:
        """Factors (W, pieces) from each piece's load to that which a carrier answers to; None if none does."""
        more = len(self.parts) + bool(len(self.fixed))
        return answered_shares(self.tanks, self.vessels, self.axles, more)

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
        density = np.repeat(first[:, None], self.radius.shape[1], axis=1)
        for number, material in enumerate(self.others, start=1):
            density[self.kind == number] = material.density
        return density

    @property
    def answers(self) -> bool:
        """Whether the tanks' motion answers to the load of what is in them."""
        return bool(self.vessels or self.axles)

    @property
    def worlds(self) -> int:
        """Number of worlds, W."""
        return len(self.radius)

    @property
    def particles(self) -> int:
        """Number of particles of water in a world."""
        return self.fluid.count if self.fluid else 0

    @property
    def span(self) -> float:
        """Largest distance (m) of a corner of a tank from the tank's origin."""
        return float(max(np.linalg.norm(tank.outline, axis=1).max() for tank in self.tanks))

    @property
    def mean_radius(self) -> float:
        """Middle of the range of radii (m)."""
        return 0.5 * sum(self.sizes)

    @property
    def farthest_reach(self) -> float:
        """Largest distance (m) from any grain's centre to its outline."""
        reach = self.shapes.reach if self.shapes else 1.0
        return max(self.sizes[1] * reach, self.fixed[:, 2].max(initial=0.0))

    @property
    def laws(self) -> tuple:
        """The normal, tangential, rolling and cohesion laws."""
        return NORMAL[self.normal](), TANGENTIAL[self.tangential](), ROLLING[self.rolling](), COHESION[self.cohesion]()

    @property
    def longest_bridge(self) -> float:
        """The longest gap (m) of a liquid bridge, rounded up to a micrometre.

        Worlds whose bridges differ by nanometres then have equal lists and may run in one launch.
        """
        law = COHESION[self.cohesion]()
        longest = max((law.range(between) for world in self.interfaces_of for between in world), default=0.0)
        return 1e-6 * float(np.ceil(1e6 * longest))

    def credible_speed(self) -> float:
        """Highest closing speed (m/s) to be expected: of a fall through the tank, or the tank's or a part's own."""
        corners = np.concatenate([tank.outline for tank in self.tanks])
        height = np.ptp(corners[:, 1])
        speed = max(self.start_speed, float(np.sqrt(2.0 * self.gravity * height)))
        speed = max([speed, *(part.fastest() for part in self.parts)])
        for motion in (m for world in self.motions for m in world):
            fastest, lever = motion.fastest(self.soft_start), 1.0
            if motion.coordinate == "turn":
                lever = float(np.linalg.norm(corners - np.asarray(motion.centre), axis=1).max())
            speed = max(speed, fastest * lever)
        return speed

    def calm_speed(self, times: float) -> float:
        """The highest closing speed (m/s) at which the step may be so many `times` as long, by its bounds; 0: never.

        A collision lasts as v^(−1/5); other bounds do not depend on the speed."""
        wanted = times * self.base_share * self.step_limits()[0].step
        speeds = np.geomspace(SLOWEST, max(self.credible_speed(), SLOWEST), 60)
        allowed = [self.step_limits(speed)[0].step >= wanted for speed in speeds]
        return float(speeds[allowed].max(initial=0.0))

    def step_limits(self, speed: float | None = None) -> list[Limit]:
        """Bounds on the step, the tightest first: those of the matters, without any those of ships or axles.

        Grains meet at up to `speed` (m/s), by default the credible one. Without matters and ships there are none:
        prescribed motions are exact at any time. With grains the ships need none of their own, since the forces of the
        sea are updated every few steps.
        """
        closing = max(self.credible_speed() if speed is None else speed, SLOWEST)
        bounds = limits_of_grains(self, closing) if self.radius.size else []
        bounds = [*bounds, *(limits_of_water(self) if self.fluid else ())] or (
            limits_of_carrier(self.vessels, self.axles, self.gravity)
        )
        return sorted(bounds, key=lambda limit: limit.step)

    def longest_step(self, longer: float) -> float:
        """The step (s) `longer` times the derived one, within the bounds that are `firm`; ∞ without bounds."""
        steps = (limit.step if limit.firm else longer * limit.step for limit in self.step_limits())
        return min(steps, default=np.inf)

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

    def relaxed(self, position: np.ndarray) -> np.ndarray:
        """Positions (n, 2) m of the first world's grains, with excessive overlaps removed; see `relaxing`."""
        edges = np.stack([self.outline, np.roll(self.outline, -1, axis=0)], axis=1)
        edges = np.delete(edges, list(self.open_edges), axis=0)
        lightest = self.sizes[0], float(self.density.min()), self.interfaces[0].young_modulus, self.gravity
        overlaps = (lifting_overlap(share, *lightest) for share in (BURSTING, AT_REST))
        return relaxed(position, self.radius[0], edges, *overlaps)

    def time_step(self) -> float:
        """The step Δt (s) in use. Raises ValueError if none is given and nothing bounds it."""
        step = self.step or self.longest_step(1.0)
        if step == np.inf:
            raise ValueError("nothing in this scene sets the step: give one")
        return step

    @property
    def kinds_of_motions(self) -> tuple:
        """What selects the compiled motion of the tank: kind, number of parameters and coordinate of each."""
        return tuple(
            (type(motion), len(motion.parameters(self.soft_start)), motion.coordinate) for motion in self.motions[0]
        )

    def shared(self) -> tuple:
        """Everything that must be equal for worlds of two scenes to run in one launch; the steps must be set."""
        return shared(self)

    @classmethod
    def joined(cls, scenes: "Sequence[Scene]") -> "Scene":
        """One scene with the worlds of all `scenes`; raises ValueError unless their `shared()` are equal."""
        if any(scene.shared() != scenes[0].shared() for scene in scenes):
            raise ValueError("these scenes cannot run in one launch")
        return in_one_launch(list(scenes))
