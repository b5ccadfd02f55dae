"""What all passes over the water work on."""

from dataclasses import dataclass

from solvers.fluid.constants import Constants
from solvers.fluid.lists.neighbours import Lists
from solvers.fluid.lists.work_ranges import WorkRanges
from solvers.fluid.state import Particles
from solvers.machine.units import Units
from solvers.motion.poses import Poses


@dataclass(frozen=True)
class FluidContext:
    """What all passes over the water work on."""

    units: Units
    particles: Particles
    ranges: WorkRanges
    lists: Lists
    constants: Constants
    poses: Poses
