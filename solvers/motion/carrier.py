"""The choice of the carrier that moves the tanks of a scene, and what follows from it."""

from collections.abc import Sequence

import numpy as np

from solvers.machine.limit import Limit
from solvers.machine.state import State
from solvers.motion.axle import Axle, OnAxle
from solvers.motion.floating_ships import FloatingShips
from solvers.motion.frame import OF_SPACE
from solvers.motion.prescribed import Prescribed
from solvers.motion.prescribed_in_space import PrescribedInSpace
from solvers.motion.staggered_ships import StaggeredShips
from solvers.ship.vessel import Vessel
from solvers.tank.tank import Tank


def steps_an_interval(vessels: Sequence[Vessel], interval: float | None, dt: float) -> int:
    """Number of steps of dt (s) in an interval H, which is the given one (s) or the shortest that any ship needs."""
    return max(1, round((interval or min(vessel.interval for vessel in vessels)) / dt))


def make_carrier(
    arrays: State, scene, dt: float
) -> Prescribed | PrescribedInSpace | FloatingShips | StaggeredShips | OnAxle:
    """The carrier of a scene (`solvers.scene.Scene`) with steps of dt (s)."""
    if scene.vessels:
        every = steps_an_interval(scene.vessels, scene.interval, dt)
        kind = StaggeredShips if scene.vessels[0].handover else FloatingShips
        return kind(arrays, scene.vessels, scene.gravity, every, scene.fluid is not None)
    if scene.axles:
        return OnAxle(arrays, scene.axles, scene.gravity, scene.tanks[0].thickness)
    of_space = any(motion.coordinate in OF_SPACE for motion in scene.motions[0])
    kind = PrescribedInSpace if of_space else Prescribed
    return kind(arrays, scene.motions, scene.soft_start, scene.gravity)


def shares_of_loads(
    tanks: Sequence[Tank], vessels: Sequence[Vessel], axles: Sequence[Axle], more: Sequence[int]
) -> np.ndarray | None:
    """Factors (W, pieces) from each piece's load to what the carrier responds to; None for prescribed motions.

    That is the load per metre of a ship, or that on the whole tank of an axle. `more`: the tanks of further pieces.
    """
    rows = [[tank.share(vessel.length) for tank in tanks] for vessel in vessels]
    rows = rows or [[axle.share(tank.thickness) for tank in tanks] for axle in axles]
    return np.array([[*row, *(row[tank] for tank in more)] for row in rows]) if rows else None


def limits_of_carrier(vessels: Sequence[Vessel], axles: Sequence[Axle], gravity: float) -> list[Limit]:
    """Bounds on the step of carriers alone, for each reason that of the one with the shortest."""
    of_ships = zip(*(vessel.step_limits for vessel in vessels), strict=True)
    bounds = [Limit(*min(bounds, key=lambda bound: bound[0]), firm=True) for bounds in of_ships]
    of_axles = [axle.step_limit(gravity) for axle in axles]
    return [*bounds, *sorted(of_axles, key=lambda limit: limit.step)[:1]]


def per_metre(scene, position: np.ndarray) -> np.ndarray:
    """Factors (W, n), 1/m, from masses at `position` (W, n, 2) m to masses per metre of ship, by their tanks."""
    factor = np.empty(position.shape[:2])
    for w, vessel in enumerate(scene.vessels):
        factor[w] = scene.tanks[0].share(vessel.length)
        for tank in scene.more_tanks:
            factor[w][tank.holds(position[w])] = tank.share(vessel.length)
    return factor


def per_slab(scene) -> np.ndarray:
    """Factors (W, n) from masses of particles per metre of slab to those per metre of ship, by their tanks."""
    rows = [[tank.thickness * tank.share(ship.length) for tank in scene.tanks] for ship in scene.vessels]
    return np.repeat(np.array(rows), scene.fills, axis=1)
