"""A list of entries for each block of a unit."""

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, State
from solvers.machine.units import Units


@ti.data_oriented
class Listing:
    """One list for each block of a unit: `slots[u, first[u, b]]` to `slots[u, first[u, b + 1] - 1]`, b from 0.

    What is saved of a world is counted from its first slot, so that it may go on under another number.
    """

    def __init__(
        self, arrays: State, units: Units, name: str, blocks: int, capacity: int, below: int, slots_a_world: int
    ):
        self.capacity = capacity
        own = arrays.under(f"water.{name}")
        (self.first,) = own.integers((units.axis, Axis("begin", blocks + 1)), "first", below=capacity + 1)
        base = slots_a_world * (np.arange(units.axis.length) // units.a_world)
        (self.slots,) = own.integers((units.axis, Axis("entry", capacity)), "slots", below=below, base=base)
