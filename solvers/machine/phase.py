"""A phase of the time step: a function and the units of work it runs over."""

from collections.abc import Callable
from dataclasses import dataclass

from solvers.machine.units import Units


@dataclass(frozen=True)
class Phase:
    """A Taichi function that a step calls once for each unit of a matter, or once for each world.

    Before the particles move it is `act(u, t, kick, dt)`, which works from their positions at time t (s). Afterwards it
    is `act(u, frame, kick, dt)`, in a tank whose motion is `frame` (`Prescribed.frame`); it moves the particles and
    returns whether their state is sound. dt (s) is the step. `kick` (s) runs from the middle of the last step to the
    middle of this one, for velocities kept half a step behind; in the first step after a launch it is dt/2. Schedules
    run units side by side and phases one after another, so a phase acting on one unit must not write what other units
    read in the same phase. `units` is None for a phase that acts on whole worlds.

    A phase may be called once `every` few base steps, over as many times dt and `kick`: in the first of them, or
    with `last` in the last one.
    """

    act: Callable
    units: Units | None = None
    every: int = 1
    last: bool = False

    @property
    def turn(self) -> int:
        """The base step in which it is called, of `every` few."""
        return self.every - 1 if self.last else 0

    @property
    def of_worlds(self) -> bool:
        """Whether it acts on whole worlds."""
        return self.units is None
