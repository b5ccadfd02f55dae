"""What a step is made of, for any schedule."""

from dataclasses import dataclass

import taichi as ti

from solvers.grains.contacts import Contacts
from solvers.grains.mover import Mover
from solvers.grains.neighbours import Neighbours
from solvers.grains.state import Grains
from solvers.machine.units import Units
from solvers.motion.frame import Frame
from solvers.tank.walls import Walls
from solvers.time.clock import Clock

# A parallel loop of Taichi's CPU backend gives each thread at least this many iterations.
ITERATIONS_A_THREAD = 512
# A speed (m/s) whose 16th power is no number in 32 bits any more.
UNSEEN = 5e-3


@dataclass(frozen=True)
class Engine:
    """The parts that a schedule sets to work."""

    units: Units
    grains: Grains
    walls: Walls
    neighbours: Neighbours
    contacts: Contacts
    mover: Mover
    frame: Frame
    clock: Clock

    @property
    def unseen(self) -> float:
        """Speed (m/s) below which the mover's bound may miss grains; it is added to the bound."""
        return UNSEEN if self.grains.real is ti.f32 else 0.0
