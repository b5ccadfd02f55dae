"""The context that a matter is made in: the tank, the carrier that moves it, and the settings of lists and steps."""

from dataclasses import dataclass

import numpy as np

from solvers.machine.state import Scope, State
from solvers.machine.units import Units
from solvers.tank.load import Load
from solvers.tank.pieces import Pieces
from solvers.tank.solids.making import AnyWalls


@dataclass(frozen=True)
class Context:
    """The arrays of a simulation of W `worlds` of so many `axes`, its tanks' walls, the `parts` in them, the `carrier`.

    A world is cut into `bands`, or with `per_particle` into single particles. `pieces` things bear loads; `shares` (W,
    pieces) are the factors with which the carrier responds to the load on each (`Load`). Lists of grains have the
    `skin` (m), if one is given. All lists have `room` times the usual length, and what is usual of water is shared
    `among` so many worlds. Steps are up to `largest_multiple` base steps long. `vectors`: lanes of a block of pairs of
    grains on real vectors, 0 without these. `wide`: whether all matters made before are on real vectors. Kernels hold
    all matters, and one that is on real vectors can hold no scalars of particles: Taichi then aborts.
    """

    arrays: State
    worlds: int
    axes: int
    bands: int
    per_particle: bool
    walls: AnyWalls
    parts: Pieces
    pieces: int
    shares: np.ndarray | None
    carrier: object
    skin: float | None
    room: int = 1
    largest_multiple: int = 1
    vectors: int = 0
    among: int = 0
    wide: bool = True

    def units(self, count: int, more: int = 0, own: Scope | None = None) -> Units:
        """The units of a matter of `count` particles in each world, and `more` that do not move (`Units`)."""
        return Units(self.worlds, count, max(1, count) if self.per_particle else self.bands, more, own)

    def load(self, own: Scope, units: Units, every: int = 1) -> Load:
        """The load of a matter that acts `every` few steps; its arrays are declared in the matter's `own` scope."""
        return Load(own, units, self.pieces, self.shares, every, self.axes)
