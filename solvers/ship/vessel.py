"""A ship that may carry cargo: what the solver must know of it before the cargo is in its hold."""

from dataclasses import dataclass, replace
from math import inf

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.body import NOTHING, Body, bolted
from solvers.ship.hydrostatics import SEARCH, balanced_heave, turned
from solvers.ship.linear import oscillations
from solvers.ship.motion import HEAVE, Ship, start

LONGEST_INTERVAL = 1e-3  # s
STEPS_A_PERIOD = 200  # of the ship's fastest oscillation, where no cargo asks for shorter steps
FAR_DOWN = 1e4  # m: where all of a hull is under water
NEAR = 1e-3  # of the search's step: where the search for an angle of loll begins
SHORTEST_MEMORY = 0.02  # of the memory's shortest time scale: the Runge–Kutta error per interval is then below 1e-10


@dataclass(frozen=True, eq=False)
class Vessel:
    """A hull in water (`ship`, its load a `Floating`) of `length` (m), with a hold.

    `hold` is the tank's origin in the hull's frame (m). With `laden` the ship's body is hull and cargo together at the
    release, and the hull is that body less the cargo; otherwise the body is the hull alone. The ship is released at
    `release` (s). Until then it is heeled smoothly to `heel` (rad) about its axis, which moves only in heave, and only
    if the ship is free to heave. In calm water it rests at a roll of `rest` (rad), cargo and all. The ship has capsized
    when its roll leaves `limits` (rad), and floods when one of its `openings` (m, hull's frame) is below the local
    water surface. One that `sinks` takes in water, and has sunk when that is more than her `reserve`. `height` (m) is
    that of the hull's origin when upright, None: as the ship floats in equilibrium. With a `handover` (s) she takes
    steps of that length with a load that is extrapolated (`motion.staggered_ships`); None: she responds to the load of
    each instant (`motion.floating_ships`).
    """

    ship: Ship
    hold: tuple[float, float]
    length: float = 1.0
    laden: bool = False
    heel: float = 0.0
    release: float = 0.0
    limits: tuple[float, float] = (-inf, inf)
    height: float | None = None
    handover: float | None = None
    openings: tuple[tuple[float, float], ...] = ()
    rest: float = 0.0
    sinks: bool = False

    @property
    def interval(self) -> float:
        """Longest interval (s) for the water's forces: set by the fastest state of the memory, at most 1 ms."""
        if self.handover:
            return self.handover
        memory = self.ship.radiation.memory
        fastest = 0.0 if memory is None else np.abs(np.linalg.eigvals(memory.matrix)).max()
        return min(LONGEST_INTERVAL, SHORTEST_MEMORY / max(fastest, 1e-9))

    @property
    def reserve(self) -> float:
        """Reserve buoyancy (kg/m): how much more mass she can take until she displaces all of her hull."""
        section, density = self.ship.load.section, self.ship.load.water.density
        return density * float(section.immersion(-FAR_DOWN, 0.0).area) - self.ship.body.mass

    @property
    def shortest_period(self) -> float:
        """The shortest period (s) of small motions about her rest in calm water, with whatever is fixed to her."""
        if not any(self.ship.free):
            return np.inf
        rest = start(self.ship, self.heave(NOTHING, self.rest), self.rest)
        return 2.0 * np.pi / np.abs(oscillations(self.ship, rest)).max(initial=1e-9)

    @property
    def step_limits(self) -> tuple[tuple[float, str], ...]:
        """Bounds (s) on the steps of a ship without cargo, each with its reason."""
        return (
            (self.shortest_period / STEPS_A_PERIOD, f"1/{STEPS_A_PERIOD} of the ship's shortest period"),
            (0.5 * self.interval, "half the interval between updates of the water's forces"),
        )

    def hull(self, cargo: Body) -> Body:
        """The hull alone. Raises Unavailable if the cargo (hull's frame) leaves it no mass or no inertia."""
        body = self.ship.body
        if not self.laden:
            return body
        mass = body.mass - cargo.mass
        if mass <= 0.0:
            raise Unavailable(
                f"the cargo of {cargo.mass:.4g} kg/m is heavier than the whole ship of {body.mass:.4g} kg/m."
            )
        centre = (body.mass * np.array(body.centre) - cargo.mass * np.array(cargo.centre)) / mass
        bare = Body(mass, (float(centre[0]), float(centre[1])), 0.0)
        inertia = body.inertia - bolted(bare, cargo).inertia
        if inertia <= 0.0:
            raise Unavailable("the cargo has more moment of inertia than the whole ship; give her a larger one.")
        return replace(bare, inertia=inertia)

    def refuse_light(self, hull: Body, late: np.ndarray) -> None:
        """Raise Unavailable if a `hull` and water with a lagged added mass (3, 3) would drive each other.

        Then an error of her acceleration grows from step to step, by the largest eigenvalue of M⁻¹ A.
        """
        free = np.array(self.ship.free)
        own = replace(self.ship, body=hull).inertia(0.0)
        way = np.eye(3)
        arm = np.subtract(self.hold, self.ship.about)
        way[0, 2], way[1, 2] = -arm[1], arm[0]
        answer = (way.T @ late @ way)[np.ix_(free, free)]
        growth = float(np.abs(np.linalg.eigvals(np.linalg.solve(own[np.ix_(free, free)], answer))).max(initial=0.0))
        if growth > 1.0:
            raise Unavailable(
                f"the layer of water before the walls of her tanks is {growth:.2g} times as heavy as she is without "
                'water, and the two would drive each other: take water.added_mass = "layer".'
            )

    def whole(self, cargo: Body) -> Body:
        """Hull and cargo as one body."""
        return self.ship.body if self.laden else bolted(self.ship.body, cargo)

    def aboard(self, cargo: Body) -> Body:
        """The cargo, whose centre is given from the tank's origin, in the hull's frame."""
        centre = np.add(cargo.centre, self.hold)
        return replace(cargo, centre=(float(centre[0]), float(centre[1])))

    def pose(self, cargo: Body, roll: float) -> list[float]:
        """Pose (y, z of the axis in m, roll in rad) at a roll before the release; `cargo` in the hull's frame."""
        axis = turned(self.ship.about, roll)
        return [self.ship.about[0], self.heave(cargo, roll) + float(axis[1]), roll]

    def heave(self, cargo: Body, roll: float) -> float:
        """Heave (m) of the hull's origin at a roll (rad) before the release, in equilibrium or with the axis fixed."""
        about, load = self.ship.about, self.ship.load
        if self.height is not None:
            return self.height + about[1] - float(turned(about, roll)[1])
        if self.ship.free[HEAVE]:
            return balanced_heave(load.section, self.whole(cargo).loading, load.water, roll)
        upright = balanced_heave(load.section, self.whole(cargo).loading, load.water, 0.0)
        return upright + about[1] - float(turned(about, roll)[1])

    def righting_moment(self, roll: float) -> float:
        """Moment (N, per metre) about her axis against a roll (rad), at rest in calm water with all that is fixed."""
        ship, pose = self.ship, np.array(self.pose(NOTHING, roll))
        weight = ship.body.mass * ship.gravity * float(ship.lever(roll)[0])
        return weight - float(ship.load.still.force(pose, 0.0)[2])

    def angle_of_loll(self, largest: float) -> float | None:
        """The roll (rad), to port, at which she comes to rest from upright in calm water; None: not up to `largest`.

        Of a wall-sided ship with G amidships GZ = sin φ (GM + ½ BM tan² φ) (Scribanti), which with a negative GM is
        zero, and rises, at tan φ = √(−2 GM/BM). Here it is where `righting_moment` is.
        """
        from scipy.optimize import brentq  # slow to import

        before = NEAR * SEARCH
        if self.righting_moment(before) >= 0.0:
            return 0.0
        for after in np.arange(SEARCH, largest + SEARCH, SEARCH):
            if self.righting_moment(after) > 0.0:
                found = float(brentq(self.righting_moment, before, after, xtol=1e-12))
                return found if found <= largest else None
            before = after
        return None
