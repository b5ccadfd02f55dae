"""Where each world stands: steps done, and the status of the watch."""

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.time.watch import RUNNING


@ti.data_oriented
class Clock:
    """`step`, the base steps done, and `status`, a word of `solvers.time.watch`, each (W,).

    A step of a world is `stride` base steps long, and the one before was `before`, 0 where there was none since the
    particles were launched.

    `says` (units,) and `arrived` (W,) are what bands tell each other, `fastest` and `farthest` (W,) what the
    per-grain schedule looks up now and then: the highest speed (m/s), the longest way since the lists were built (m);
    `pushed` (W,) is the largest acceleration (m/s²) by the frame to come, `frame` what the carrier says of a step.
    """

    def __init__(self, arrays: State, units: Units):
        self.units, self.worlds, self.real = units, units.worlds, arrays.real
        own, world = arrays.under("clock"), (Axis("world", units.worlds),)
        self.step, self.status, self.arrived = own.integers(world, "step", "status", "arrived")
        self.stride, self.before = own.integers(world, "stride", "before")
        (self.says,) = own.integers((units.axis,), "says", kept=False)
        self.fastest, self.farthest, self.pushed = own.reals(world, "fastest", "farthest", "pushed", kept=False)
        self.frame = own.reals(world, *(f"frame.{k}" for k in range(4)), kept=False)

    def launch(self) -> None:
        """The particles have been put somewhere or launched: their next step is the first."""
        self.before.fill(0)
        self.stride.fill(1)

    def running(self) -> np.ndarray:
        """Which worlds run (W,)."""
        return self.status.to_numpy() == RUNNING

    @ti.func
    def world(self, u):
        """The world of unit u."""
        return self.units.world(u)
