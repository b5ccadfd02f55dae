"""The scene: everything the solver needs to know about an experiment, in SI units."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Self, TypeVar

import numpy as np

from solvers.fluid.given import Fluid
from solvers.grains.given import Grains
from solvers.grains.timestep import SLOWEST
from solvers.machine.limit import Limit
from solvers.machine.marks import EachWorld, NotOfBed, in_one_launch, shared
from solvers.machine.quantity import PLANE
from solvers.matters import limits_of
from solvers.mixture.given import Mixture
from solvers.motion.axle import Axle
from solvers.motion.carrier import limits_of_carrier, shares_of_loads
from solvers.motion.contact_pairs import limits_of_contacts
from solvers.motion.frame import OF_SPACE, is_turn
from solvers.ship.vessel import Vessel
from solvers.tank.given import Given
from solvers.tank.parts import Part
from solvers.tank.solids.solid import Solid
from solvers.tank.tank import BARE_THICKNESS, Tank

Matter = TypeVar("Matter", bound=Given)


@dataclass
class Scene:
    """A batch of W equal worlds: tanks, what moves them, and the matters in them.

    - `outline` (m, 2) m of the tank, counter-clockwise; `open_edges`: its edges without a wall, by their first corners;
      `parts`: plates that move in the tank.
    - `thickness` (m) of the tank, by default the mean grain diameter, without grains 1 m, in space its own length;
      `length` (m) along a ship, by default all; `more_tanks` stand beside it, or are rooms of a part that floats free
      (`Tank`). Grains are in the first tank, or in such rooms if there are any.
    - `solid`: what the outline stands for in space; None: the scene is plane.
    - `mixture`: that grains and water are in one tank; None: they do not meet.
    - `matters`: what the tanks hold, at most one of each kind of `solvers.matters`.
    - `motions[w]`: the tank's motions in world w, of the same kinds in every world; or `vessels` (W,): the ships whose
      holds the tanks are in, or `axles` (W,), about which they roll. `interval` (s) between updates of sea forces.
    - `step` Δt in s, None: derived.

    The fields' marks say which may differ between the worlds of a launch, and from which a settled bed follows.
    """

    outline: np.ndarray
    matters: tuple[Given, ...] = ()
    gravity: float = 9.81
    motions: Annotated[Sequence[Sequence], EachWorld(lambda scene: scene.kinds_of_motions), NotOfBed()] = ()
    soft_start: Annotated[float, NotOfBed()] = 0.0
    step: Annotated[float | None, NotOfBed()] = None
    open_edges: tuple[int, ...] = ()
    parts: tuple[Part, ...] = ()
    vessels: Annotated[Sequence[Vessel], EachWorld(lambda scene: bool(scene.vessels)), NotOfBed()] = ()
    axles: Annotated[
        Sequence[Axle], EachWorld(lambda scene: bool(scene.axles) and scene.axles[0].kind), NotOfBed()
    ] = ()
    interval: Annotated[float | None, NotOfBed()] = None
    thickness: float | None = None
    length: float | None = None
    more_tanks: tuple[Tank, ...] = ()
    solid: Solid | None = None
    mixture: Mixture | None = None
    precision: str = "f64"
    schedule: str = "auto"

    def __post_init__(self):
        self.outline = np.asarray(self.outline, dtype=np.float64)
        self.motions = self.motions if len(self.motions) else [()] * self._told_worlds()

    def _told_worlds(self) -> int:
        """Number of worlds by what there is one of in each; 1 where nothing tells it."""
        each = [len(self.vessels), len(self.axles), *(matter.worlds for matter in self.matters)]
        return max(1, *each)

    def of(self, kind: type[Matter]) -> Matter | None:
        """The matter of a kind; None if there is none."""
        return next((matter for matter in self.matters if isinstance(matter, kind)), None)

    def holding(self, *matters: Given, **changes: object) -> Self:
        """The scene with these matters in place of those of their kinds, and with other fields changed."""
        own = {type(matter): matter for matter in (*self.matters, *matters)}
        return replace(self, matters=tuple(own.values()), **changes)

    @property
    def grains(self) -> Grains | None:
        """The grains."""
        return self.of(Grains)

    @property
    def fluid(self) -> Fluid | None:
        """The fluid."""
        return self.of(Fluid)

    @property
    def axes(self) -> int:
        """Number of axes: two, those of the plane, or three."""
        return self.solid.axes if self.solid else PLANE

    @property
    def tanks(self) -> tuple[Tank, ...]:
        """All tanks of a world, the first one included."""
        found = (one.thickness for one in (self.solid, *self.matters) if one and one.thickness)
        suited = next(found, BARE_THICKNESS)
        thickness = self.thickness or suited
        return (Tank(self.outline, thickness, tuple(self.open_edges), self.length), *self.more_tanks)

    @property
    def is_long(self) -> bool:
        """Whether the kernel of a step is long: of grains in a floating hull or in water, or of inflow into a ship."""
        return bool(self.hold or self.mixture or (self.flows and self.fluid.inlets))

    @property
    def flows(self) -> bool:
        """Whether there are particles of a fluid that are moved one by one."""
        return self.fluid is not None and self.fluid.moved > 0

    @property
    def fills(self) -> tuple[int, ...]:
        """How many particles that never leave their tank are in each of the tanks."""
        each = [matter.fills(len(self.tanks)) for matter in self.matters]
        return tuple(map(sum, zip(*each, strict=True))) if each else (0,) * len(self.tanks)

    @property
    def hold(self) -> int:
        """The tank that grains fill, by its number: the first, or the first of those aboard a body."""
        return next((number for number, tank in enumerate(self.tanks) if tank.aboard is not None), 0)

    def poured(self, outline: np.ndarray) -> Self:
        """The scene with its grains in a closed tank of another outline (m, 2) m that stands still.

        Those in a room of a body are alone there, with what stands in the room.
        """
        solid = self.solid and self.solid.over(outline)
        poured = replace(self, outline=outline, open_edges=(), motions=(), solid=solid)
        if self.hold:
            inner = tuple(replace(part, tank=0) for part in self.parts if part.tank == self.hold)
            poured = replace(poured, matters=(self.grains,), parts=inner, more_tanks=())
        return replace(poured, matters=(self.grains,), mixture=None) if self.mixture else poured

    @property
    def apart(self) -> list[int]:
        """The tanks of water, by their numbers, beside others of grains, which do not feel their walls.

        Grains aboard a body feel the walls of no tank that is not.
        """
        if self.hold:
            return [number for number, tank in enumerate(self.tanks) if tank.aboard is None]
        beside = [
            number for number, fill in enumerate(self.fills) if fill and not (self.mixture and number == self.hold)
        ]
        return beside if self.grains else []

    @property
    def faces(self) -> int:
        """How many faces of the tank bear loads of their own: in space each wall, else none."""
        return len(self.solid.faces(np.asarray(self.outline))) if self.solid else 0

    @property
    def wall_pieces(self) -> int:
        """How many of the pieces are the walls of tanks: of each tank or, in space, its faces."""
        return self.faces or len(self.tanks)

    @property
    def pieces(self) -> int:
        """How many pieces bear loads: the walls of each tank, in space its faces, the parts, any fixed grains."""
        return self.wall_pieces + len(self.parts) + sum(matter.pieces for matter in self.matters)

    @property
    def shares(self) -> np.ndarray | None:
        """Factors (W, pieces) from each piece's load to that which the tanks' carrier responds to; None if none does.

        They are zero of parts that move freely, since each responds to the load on itself.
        """
        more = [0] * max(0, self.faces - 1) + [part.tank for part in self.parts]
        more += [0] * sum(matter.pieces for matter in self.matters)
        found = shares_of_loads(self.tanks, self.vessels, self.axles, more)
        if found is None and self.responds:
            return np.zeros((self.worlds, self.pieces))
        free = [self.wall_pieces + k for k, part in enumerate(self.parts) if part.free]
        if free:
            found[:, free] = 0.0
        return found

    @property
    def responds(self) -> bool:
        """Whether the tanks, or parts in them, move as the load of what is in the tanks says."""
        return bool(self.vessels or self.axles) or any(part.free for part in self.parts)

    @property
    def worlds(self) -> int:
        """Number of worlds, W."""
        return len(self.motions)

    @property
    def particles(self) -> int:
        """Number of particles of water in a world."""
        return self.fluid.count if self.fluid else 0

    @property
    def span(self) -> float:
        """Largest distance (m) of a corner of a tank from the tank's origin."""
        farthest = float(max(np.linalg.norm(tank.outline, axis=1).max() for tank in self.tanks))
        return float(np.hypot(farthest, self.solid.half(self.outline))) if self.solid else farthest

    def credible_speed(self) -> float:
        """Highest closing speed (m/s) to be expected: of a fall through the tank, or the tank's or a part's own.

        In a room of a body that may roll over it is that of a fall along its larger side.
        """
        height = np.ptp(np.concatenate([tank.outline for tank in self.tanks])[:, 1])
        if self.hold:
            height = np.ptp(self.tanks[self.hold].outline, axis=0).max()
        starts = (matter.start_speed for matter in self.matters)
        return max(*starts, float(np.sqrt(2.0 * self.gravity * height)), self.driven_speed(), 0.0)

    def driven_speed(self) -> float:
        """Highest speed (m/s) of the tank's or a part's own, where motions prescribe it."""
        corners = np.concatenate([tank.outline for tank in self.tanks])
        speed = max((part.fastest() for part in self.parts), default=0.0)
        for motion in (m for world in self.motions for m in world):
            fastest, lever = motion.fastest(self.soft_start), 1.0
            if is_turn(motion.coordinate):
                lever = self._lever(motion, corners)
            speed = max(speed, fastest * lever)
        return speed

    def _lever(self, motion, corners: np.ndarray) -> float:
        """Largest distance (m) of a tank's corner (n, 2) from the axis about which a motion turns."""
        if motion.coordinate not in OF_SPACE:
            return float(np.linalg.norm(corners - np.asarray(motion.centre), axis=1).max())
        across = corners[:, 1 if motion.coordinate == "pitch" else 0] - motion.centre[0]
        return float(np.hypot(np.abs(across).max(), self.solid.half(self.outline) + abs(motion.centre[1])))

    def step_limits(self, speed: float | None = None) -> list[Limit]:
        """Bounds on the step, the tightest first: those of the matters, without any those of ships or axles.

        In water those of free bodies' contacts are among them.

        Particles meet at up to `speed` (m/s), by default the credible one. Without matters and ships there are none:
        prescribed motions are exact at any time. With grains the ships need none of their own, since the forces of the
        sea are updated every few steps.
        """
        closing = max(self.credible_speed() if speed is None else speed, SLOWEST)
        bounds = limits_of(self, closing) or limits_of_carrier(self.vessels, self.axles, self.gravity)
        bounds = [*bounds, *limits_of_contacts(self, self.driven_speed())]
        return sorted(bounds, key=lambda limit: limit.step)

    def longest_step(self, longer: float) -> float:
        """The step (s) `longer` times the derived one, within the bounds that are `firm`; ∞ without bounds."""
        steps = (limit.step if limit.firm else longer * limit.step for limit in self.step_limits())
        return min(steps, default=np.inf)

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
