"""What a matter is made in: the tank, and how its lists and steps are to be."""

from dataclasses import dataclass

from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.tank.load import Load
from solvers.tank.walls import Walls


@dataclass(frozen=True)
class Setting:
    """The arrays of a simulation, its units, the walls of its tanks and the load on them.

    `rotating` tells whether the tank turns. Lists have a `skin` (m) and `room` times the usual length. No particle may
    go farther than `way_a_step` (m) in a step; steps are up to `stretch` base steps long.
    """

    arrays: State
    units: Units
    walls: Walls
    load: Load
    rotating: bool
    skin: float
    room: int = 1
    way_a_step: float = 1.0
    stretch: int = 1
