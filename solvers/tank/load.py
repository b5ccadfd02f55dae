"""What the cargo does to the tank: a force (N) and its moment (N m) about the tank's origin, in the tank's axes.

Whoever pushes off a piece of the tank books it there, at that moment: it is never rebuilt from what the cargo felt,
since a drag or a buoyancy is no force on a wall. Pieces are the walls of each tank, the parts, and the lining of fixed
grains.
"""

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, State
from solvers.machine.units import APART, Units

NAMES = ("y", "z", "moment")


@ti.data_oriented
class Load:
    """The load of each unit on each piece: its impulse (N s, N m s) since it was last looked at, and what it is now.

    `pieces` are how many. What a carrier answers to is kept as well, added up over the pieces with `shares` (W, pieces)
    of them; without, None, nothing answers.
    """

    def __init__(self, arrays: State, units: Units, pieces: int, shares: np.ndarray | None = None):
        self.units, self.pieces, self.answered = units, pieces, shares is not None
        room = pieces if units.single else -(-pieces // APART) * APART  # no two units write to one cache line
        self.exact = arrays.exact
        own, axes = arrays.under("load"), (units.axis, Axis("piece", room))

        def declared(what: str, kept: bool) -> list[ti.Field]:
            return own.reals(axes, *(f"{what}_{name}" for name in NAMES), kind=own.exact, kept=kept)

        self.impulse, self.noted = declared("impulse", True), declared("noted", False)
        if self.answered:
            self.instant = declared("instant", False)
            self.shares = own.holding("shares", shares, "world piece", own.exact)

    def forget(self) -> None:
        """Nothing has pushed yet."""
        for field in (*self.impulse, *self.noted, *(self.instant if self.answered else ())):
            field.fill(0.0)

    @ti.func
    def book(self, u, piece, load, dt):
        """Add what a unit does to a piece, force (y, z) and moment, during a step of dt (s).

        Once a step: a running sum of so many small numbers loses digits.
        """
        for k in ti.static(range(3)):
            pushed = ti.cast(load[k], self.exact)
            self.impulse[k][u, piece] = self.impulse[k][u, piece] + pushed * dt
            if ti.static(self.answered):
                self.instant[k][u, piece] = self.instant[k][u, piece] + pushed

    @ti.func
    def note(self, u, piece, load):
        """Add what one contact of a unit does to a piece, for `book_noted`."""
        for k in ti.static(range(3)):
            self.noted[k][u, piece] = self.noted[k][u, piece] + ti.cast(load[k], self.exact)

    @ti.func
    def book_noted(self, u, dt):
        """Book what has been noted of a unit."""
        for piece in range(self.pieces):
            self.book(u, piece, ti.Vector([self.noted[k][u, piece] for k in ti.static(range(3))]), dt)
            for k in ti.static(range(3)):
                self.noted[k][u, piece] = 0.0

    @ti.func
    def of_world(self, w):
        """What a world's carrier answers to: the shares of all pieces and units, in their order; booked anew then."""
        load = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
            for piece in range(self.pieces):
                for k in ti.static(range(3)):
                    load[k] += self.shares[w, piece] * self.instant[k][u, piece]
                    self.instant[k][u, piece] = 0.0
        return load

    @ti.func
    def take(self, u, piece):
        """The impulse of a unit on a piece since the last look; it starts anew."""
        found = ti.Vector([self.impulse[k][u, piece] for k in ti.static(range(3))])
        for k in ti.static(range(3)):
            self.impulse[k][u, piece] = 0.0
        return found
