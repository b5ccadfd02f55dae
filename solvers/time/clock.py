"""The clock of each world: steps done, and its status."""

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.time.watch import RUNNING


@ti.data_oriented
class Clock:
    """Base steps done, `step`, and `status`, a constant of `solvers.time.watch`, each (W,).

    A world's step is a `multiple` of the base step, and its previous one was `before`, 0 if there was none since the
    particles were launched.

    Bands synchronise by `says` (units,) and `arrived` (W,). The per-grain schedule reads `fastest` (W,) m/s, the
    highest speed, and `farthest` (W,) m, the largest displacement since the lists were built, now and then. `pushed`
    (W,) m/s² is the largest frame acceleration to come, and `frame` holds the carrier's frame, so many
    `numbers`, during a step.
    """

    def __init__(self, arrays: State, units: Units, numbers: int = 4):
        self.units, self.worlds, self.real = units, units.worlds, arrays.real
        own, world = arrays.under("clock"), (Axis("world", units.worlds),)
        self.step, self.status, self.arrived = own.integers(world, "step", "status", "arrived")
        self.multiple, self.before = own.integers(world, "multiple", "before")
        (self.says,) = own.integers((units.axis,), "says", kept=False)
        self.fastest, self.farthest, self.pushed = own.reals(world, "fastest", "farthest", "pushed", kept=False)
        self.frame = own.reals(world, *(f"frame.{k}" for k in range(numbers)), kept=False)

    def launch(self) -> None:
        """Note that the particles were placed or launched, so that their next step is the first."""
        self.before.fill(0)
        self.multiple.fill(1)

    def running(self) -> np.ndarray:
        """Which worlds are running, (W,)."""
        return self.status.to_numpy() == RUNNING

    @ti.func
    def world(self, u):
        """The world of unit u."""
        return self.units.world(u)
