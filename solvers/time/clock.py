"""Where each world stands: steps done, and the status of the watch."""

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.time.watch import RUNNING


@ti.data_oriented
class Clock:
    """`step`, the steps of Δt done, and `status`, a word of `solvers.time.watch`, each (W,).

    `says` (units,) and `arrived` (W,) are what bands tell each other, `fastest` and `farthest` (W,) what the
    per-grain schedule looks up now and then: the highest speed (m/s), the longest way since the lists were built (m);
    `pushed` (W,) is the largest acceleration (m/s²) by the frame to come.
    """

    def __init__(self, arrays: State, units: Units):
        own, world = arrays.under("clock"), (Axis("world", units.worlds),)
        self.step, self.status, self.arrived = own.integers(world, "step", "status", "arrived")
        (self.says,) = own.integers((units.axis,), "says", kept=False)
        self.fastest, self.farthest, self.pushed = own.reals(world, "fastest", "farthest", "pushed", kept=False)
        self.body = own.reals(world, *(f"body.{k}" for k in range(4)), kept=False)

    def running(self) -> np.ndarray:
        """Which worlds run (W,)."""
        return self.status.to_numpy() == RUNNING
