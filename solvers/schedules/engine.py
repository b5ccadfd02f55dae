"""What a step is made of, for any schedule."""

from dataclasses import dataclass

import taichi as ti

from solvers.clock import Clock
from solvers.contacts import Contacts
from solvers.frame import Frame
from solvers.grains import Grains
from solvers.mover import Mover
from solvers.neighbours import Neighbours
from solvers.units import Units
from solvers.walls import Walls

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
