"""A piece of a step: what acts, and on what at a time."""

from collections.abc import Callable
from dataclasses import dataclass

from solvers.machine.units import Units


@dataclass(frozen=True)
class Phase:
    """A Taichi function that a step calls once for each unit of a matter, or once for each world.

    Before the particles move, `act(u, t, kick, dt)`: what follows from where they are at time t (s). Afterwards
    `act(u, frame, kick, dt)`, in a tank that moves as `frame` says (`Prescribed.frame`), and returns whether all is
    sound. dt (s) is the step, and `kick` (s) from the middle of the last to the middle of this one, for velocities that
    are kept half a step behind: half a step since the particles were launched. What acts on a unit writes to nothing
    that others read in the same phase: schedules run units side by side, and phases one after
    another. `units` is None where it acts on whole worlds.
    """

    act: Callable
    units: Units | None = None

    @property
    def of_worlds(self) -> bool:
        """Whether it acts on whole worlds."""
        return self.units is None
