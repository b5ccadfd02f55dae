"""What the cargo does to the tank: a force (N) and its moment (N m) about the tank's origin, in the tank's axes."""

import taichi as ti

from solvers.machine.runtime import Arrays
from solvers.machine.units import APART, Units


@ti.data_oriented
class Load:
    """The load of each unit: its impulse (N s, N m s) since it was last looked at, and what it is at this instant.

    The instant is kept only where a carrier answers to it.
    """

    def __init__(self, arrays: Arrays, units: Units, answered: bool):
        self.units, self.answered = units, answered
        self.impulse = arrays.reals(3, (units.count,), arrays.exact)
        if answered:
            self.instant = arrays.reals(3, (APART * units.count,), arrays.exact, kept=False)

    def forget(self) -> None:
        """Nothing has pushed yet."""
        for field in self.impulse:
            field.fill(0.0)

    @ti.func
    def book(self, u, force_y, force_z, moment, dt):
        """Note what a unit does to the tank during a step of dt (s)."""
        load = ti.Vector([force_y, force_z, moment])
        for k in ti.static(range(3)):
            self.impulse[k][u] = self.impulse[k][u] + load[k] * dt
            if ti.static(self.answered):
                self.instant[k][APART * u] = load[k]

    @ti.func
    def of_world(self, w):
        """The load of all units of a world at this instant, added up in their order."""
        first = w * self.units.a_world
        load = ti.Vector([self.instant[k][APART * first] for k in ti.static(range(3))])
        for u in range(first + 1, first + self.units.a_world):
            for k in ti.static(range(3)):
                load[k] += self.instant[k][APART * u]
        return load

    @ti.func
    def take(self, u):
        """The impulse of a unit since the last look, which starts anew."""
        found = ti.Vector([self.impulse[k][u] for k in ti.static(range(3))])
        for k in ti.static(range(3)):
            self.impulse[k][u] = 0.0
        return found
