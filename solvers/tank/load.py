"""The load of a matter on the tank: a force (N) and its moment (N m) about the tank's origin, in the tank's axes.

Each matter has a load of its own. A contact with a piece of the tank books its reaction on that piece when it computes
the force. The load is never rebuilt from the forces on the cargo, since drag and buoyancy are not forces on a wall.
Pieces are the walls of each tank, the parts, and the lining of fixed grains.
"""

import numpy as np
import taichi as ti

from solvers.machine.quantity import PLANE, directions, in_plane
from solvers.machine.state import Axis, Scope
from solvers.machine.units import APART, Units
from solvers.space.axes import named_turns


@ti.data_oriented
class Load:
    """The load of each unit on each of `pieces` pieces, as impulse (N s, N m s) since it was last read.

    It has a number for each of the `freedoms` of a body: forces along the axes, then moments about those about which
    it can turn. A matrix has as many rows and columns, and `entries` in all, row by row.

    With `shares` (W, pieces) the present load is kept as well; summed over the pieces with these factors it is what a
    carrier responds to. None: no carrier responds. The load of a matter that acts `every` few steps stands in between:
    F + ½ (F − F′), F′ that of its step before, which is the load in the middle of its step to second order. F alone
    would lag by half a step and drive the sound in water. The impulses so told and those of F differ by ½ (F − F′)
    times the step, which does not add up.

    A matter that `adds_mass` responds to an acceleration a of the tank's origin (y, z, roll; tank's axes) at once, by
    the load F − A a. Its present load is F, that of a tank that is not accelerated, and A (about the origin) its
    `added_mass`. One that responds to the acceleration of the last step has a `lagged_mass`, a matrix of each world,
    which is zero if none is known; the carrier takes it on its own side, under-relaxed, if the load is `relaxed`.
    """

    adds_mass = relaxed = False
    lagged_mass = None

    def __init__(
        self,
        arrays: Scope,
        units: Units,
        pieces: int,
        shares: np.ndarray | None = None,
        every: int = 1,
        axes: int = PLANE,
    ):
        self.units, self.pieces, self.carried = units, pieces, shares is not None
        names = *directions(axes), *named_turns("moment", axes)
        self.freedoms, self.entries, self.in_plane = len(names), len(names) ** 2, in_plane(axes)
        room = pieces if units.single else -(-pieces // APART) * APART  # no two units write to one cache line
        self.exact = arrays.exact
        own, each = arrays.under("load"), (units.axis, Axis("piece", room))

        def declared(what: str, kept: bool) -> list[ti.Field]:
            return own.reals(each, *(f"{what}_{name}" for name in names), kind=own.exact, kept=kept)

        self.impulse, self.noted = declared("impulse", True), declared("noted", False)
        if self.carried:
            self.stands = every > 1
            self.instant = declared("instant", self.stands)
            if self.stands:
                self.former = declared("former", True)
                (self.known,) = own.integers((units.axis,), "known")  # loads since they were forgotten
            self.shares = own.holding("shares", shares, "world piece", own.exact)

    def add_mass(self, arrays: Scope) -> None:
        """Declare an added mass of each piece as well."""
        self.adds_mass = True
        piece = Axis("piece", self.pieces), Axis("entry", self.entries)
        (self.added_mass,) = arrays.under("load").reals(
            (self.units.axis, *piece), "added_mass", kind=self.exact, kept=False
        )

    def lag(self, mass: np.ndarray, relaxed: bool) -> None:
        """Have a lagged added mass (W, freedoms, freedoms) about the tank's origin, a metre of the carrier's length."""
        self.lagged_mass, self.relaxed = mass, relaxed and len(mass) > 0

    @ti.func
    def sum_added_mass(self, w, matrix: ti.template()):
        """Add the matrix A of a world to a row of `matrix`, summed over units and pieces with the shares."""
        for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
            for piece in range(self.pieces):
                for k in ti.static(range(self.entries)):
                    matrix[w, k] = matrix[w, k] + self.shares[w, piece] * self.added_mass[u, piece, k]

    def forget(self) -> None:
        """Set all loads to zero."""
        for field in (*self.impulse, *self.noted, *(self.instant if self.carried else ())):
            field.fill(0.0)
        if self.carried and self.stands:
            self.known.fill(0)

    @ti.func
    def begin(self, u):
        """Set a unit's present load to zero, before its matter computes a new one."""
        if ti.static(self.carried):
            if ti.static(self.stands):
                self.known[u] = ti.min(self.known[u] + 1, 2)
            for piece in range(self.pieces):
                for k in ti.static(range(self.freedoms)):
                    if ti.static(self.stands):
                        self.former[k][u, piece] = self.instant[k][u, piece]
                    self.instant[k][u, piece] = 0.0

    @ti.func
    def book(self, u, piece, load, dt):
        """Add a unit's load on a piece, forces and moments, during a step of dt (s).

        Called once per step and piece, since a running sum over single contacts would lose digits.
        """
        for k in ti.static(range(self.freedoms)):
            pushed = ti.cast(load[k], self.exact)
            self.impulse[k][u, piece] = self.impulse[k][u, piece] + pushed * dt
            if ti.static(self.carried):
                self.instant[k][u, piece] = self.instant[k][u, piece] + pushed

    @ti.func
    def book_reaction(self, u, piece, gains, dt):
        """Add the reaction −A a of a unit's added mass on a piece, for an acceleration a of the tank's origin."""
        for i in ti.static(range(self.freedoms)):
            pushed = ti.cast(0.0, self.exact)
            for j in ti.static(range(self.freedoms)):
                pushed += self.added_mass[u, piece, self.freedoms * i + j] * gains[j]
            self.impulse[i][u, piece] = self.impulse[i][u, piece] - pushed * dt

    @ti.func
    def note(self, u, piece, load):
        """Add the load of one contact of a unit on a piece, for `book_noted`."""
        for k in ti.static(range(self.freedoms)):
            self.noted[k][u, piece] = self.noted[k][u, piece] + ti.cast(load[k], self.exact)

    @ti.func
    def book_noted(self, u, dt):
        """Book all that has been noted for a unit, and clear it."""
        for piece in range(self.pieces):
            self.book(u, piece, ti.Vector([self.noted[k][u, piece] for k in ti.static(range(self.freedoms))]), dt)
            for k in ti.static(range(self.freedoms)):
                self.noted[k][u, piece] = 0.0

    @ti.func
    def on_piece(self, w, piece):
        """The present load of a world on a piece, summed over units in their order."""
        load = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(self.freedoms))])
        for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
            for k in ti.static(range(self.freedoms)):
                load[k] += self.instant[k][u, piece]
        return load

    @ti.func
    def of_world(self, w):
        """The load that a world's carrier responds to, summed over units and pieces in their order."""
        load = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(self.freedoms))])
        for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
            for piece in range(self.pieces):
                for k in ti.static(range(self.freedoms)):
                    pushed = self.instant[k][u, piece]
                    if ti.static(self.stands):  # noqa: SIM102 (compiled only where it stands)
                        if self.known[u] > 1:
                            pushed += 0.5 * (pushed - self.former[k][u, piece])
                    load[k] += self.shares[w, piece] * pushed
        return load

    @ti.func
    def read_and_reset(self, u, piece):
        """The impulse of a unit on a piece since it was last read, and set it to zero."""
        found = ti.Vector([self.impulse[k][u, piece] for k in ti.static(range(self.freedoms))])
        for k in ti.static(range(self.freedoms)):
            self.impulse[k][u, piece] = 0.0
        return found
