"""A scene: everything the solver has to know of an experiment, in SI units."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from solvers.laws import NORMAL, TANGENTIAL
from solvers.materials import Interface, Material, interface
from solvers.timestep import Limit, limits


@dataclass
class Scene:
    """A batch of W worlds of n grains in equal tanks.

    `radius` (W, n) m; `outline` (m, 2) m, counter-clockwise; `motions[w]` the tank's motions in world w, the same
    kinds in every world; `step` Δt in s, or None for the derived one; `start_speed` (m/s) of the fastest grain at the
    start; `sizes` the smallest and largest radius (m) a world may hold. What is derived for all worlds follows from
    `sizes`, so that a world does not depend on its company; it defaults to the range of `radius`.
    """

    radius: np.ndarray
    outline: np.ndarray
    grain: Material
    wall: Material
    normal: str = "hertz-viscoelastic"
    tangential: str = "haff-werner"
    stiffness_scale: float = 1.0
    gravity: float = 9.81
    motions: Sequence[Sequence] = ()
    soft_start: float = 0.0
    step: float | None = None
    start_speed: float = 0.0
    sizes: tuple[float, float] | None = None
    interfaces: tuple[Interface, Interface] = field(init=False)

    def __post_init__(self):
        self.radius = np.atleast_2d(np.asarray(self.radius, dtype=np.float64))
        self.outline = np.asarray(self.outline, dtype=np.float64)
        if not len(self.motions):
            self.motions = [()] * len(self.radius)
        if self.sizes is None:
            self.sizes = float(self.radius.min()), float(self.radius.max())
        mean = self.mean_radius
        mass = 4.0 / 3.0 * np.pi * mean**3 * self.grain.density
        self.interfaces = (
            interface(self.grain, self.grain, mass / 2.0, mean / 2.0, self.stiffness_scale),
            interface(self.grain, self.wall, mass, mean, self.stiffness_scale),
        )

    @property
    def mean_radius(self) -> float:
        """Middle of the range of radii (m)."""
        return 0.5 * sum(self.sizes)

    @property
    def laws(self) -> tuple:
        """The normal and the tangential law."""
        return NORMAL[self.normal](), TANGENTIAL[self.tangential]()

    def credible_speed(self) -> float:
        """Highest speed (m/s) at which grains may be expected to meet: a fall through the tank, and the tank's own."""
        height = np.ptp(self.outline[:, 1])
        speed = max(self.start_speed, float(np.sqrt(2.0 * self.gravity * height)))
        for motion in (m for world in self.motions for m in world):
            fastest = motion.fastest(self.soft_start)
            lever = 1.0
            if motion.coordinate == "turn":
                lever = float(np.linalg.norm(self.outline - np.asarray(motion.centre), axis=1).max())
            speed = max(speed, fastest * lever)
        return speed

    def step_limits(self) -> list[Limit]:
        """Bounds on the step, the tightest first."""
        speed = max(self.credible_speed(), 1e-3)
        return limits(self.sizes[0], self.grain, self.interfaces, self.stiffness_scale, speed)

    def time_step(self) -> float:
        """The step Δt (s) in use."""
        return self.step or self.step_limits()[0].step
