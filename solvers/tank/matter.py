"""A matter: what a tank holds. What a time step asks of it, and what a simulation does."""

from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np
import taichi as ti

from solvers.machine.phase import Phase
from solvers.machine.state import Axes
from solvers.machine.units import Units
from solvers.ship.body import Body
from solvers.tank.load import Load


@ti.data_oriented
class Matter:
    """The interface of all matters, with the answers of one that has no lists and nothing to say.

    A matter has a `name`, `units`, a `load` on the tank, and the phases of a step: `before` the carrier responds to the
    load, `between` that and the motion of the particles, and `after`, when these move. If it `has_multiples`, its steps
    may be longer than the base step, by as many as its `allowed_multiple` says. If it has neighbour lists, it says when
    these are `invalid`, `may_be_invalid` or `asked` for in part, and rebuilds them (`sort`, `make_lists`).
    `of_contacts` are those of its quantities that are known only after a step. If it `mixes`, its particles are
    renumbered now and then. If its kernels work on real vectors (`machine.wide`), it is `wide`. `extent` (m) is how far
    from the tank's origin a particle may be, `nearing` (m/s) how fast parts of the tank come at particles, `changes`
    the base step of the clock before which it is to `change`.
    """

    name: str
    units: Units
    load: Load
    before: tuple[Phase, ...] = ()
    between: tuple[Phase, ...] = ()
    after: tuple[Phase, ...] = ()
    has_multiples = False
    mixes = False
    wide = False
    of_contacts: ClassVar[Sequence[str]] = ()
    extent = 0.0
    nearing = 0.0
    changes = 2**31 - 1  # never

    def observe(self, time: float) -> dict[str, np.ndarray]:
        """The quantities of every world at its time (s): (W, *shape) of each by name."""
        return {}

    def check(self, rows: Mapping[str, np.ndarray], time: float) -> None:
        """Raise BadState if the quantities at `time` (s) show an unphysical state."""

    def refuse(self, world: int, time: float, dt: float) -> None:
        """Raise BadState if its particles made the watch stop a world at `time` (s): too fast for steps of dt (s)."""

    def restlessness(self, rows: Mapping[str, np.ndarray]) -> np.ndarray:
        """How far from rest each world is by its quantities, (W,): `Simulation.settle` waits until it is small."""
        return np.zeros(self.units.worlds)

    def as_rigid(self) -> list[Body]:
        """The matter of each world as one rigid body, per metre of the ship's length, in the tank's frame."""
        raise NotImplementedError

    def keep_order(self) -> None:
        """Renumber the particles of worlds where they have mixed."""

    def ease(self, settles: bool) -> None:
        """Leave out, while it `settles`, what only makes it come to rest more slowly."""

    def start_clock(self) -> None:
        """Note that the clock starts now."""

    def place(self, position: np.ndarray | None) -> None:
        """Place the particles, at rest: those of grains at `position` (W, n, axes) m, others as the scene says."""

    def launch(self, velocity: np.ndarray | None, spin: np.ndarray | None) -> None:
        """Set the velocities (W, n, axes) m/s and spins (W, n) rad/s of grains; None: at rest."""

    def bear(self, scene) -> None:
        """Raise Unavailable if its arrays do not suit the materials of a scene that else equals the present one."""

    def alter(self, scene) -> None:
        """Go on with the materials of a scene that equals the present one in everything else."""

    def change(self) -> None:
        """Go on with other numbers from now on; `changes` is never then."""

    def pressing(self, world: int, time: float):
        """The elastic contact forces in a world at its time (s), `grains.pressing.Pressing`; None: there are none."""
        return None

    def snapshot(self, time: float) -> dict[str, np.ndarray]:
        """What is known of each particle at `time` (s), which is now, in the tank's frame: (W, n, …) by name."""
        return {}

    def fields(self) -> list[ti.Field]:
        """The arrays that a step changes, lists aside."""
        return []

    def state(self) -> dict[str, np.ndarray]:
        """What `restore` continues from, beside the arrays."""
        return {}

    def axes(self) -> dict[str, Axes]:
        """The axes of the arrays of `state`, by name."""
        return {}

    def restore(self, state: Mapping[str, np.ndarray]) -> None:
        """Restore what `state` returned."""

    def slack(self) -> float:
        """How far (m) two particles may near each other before the lists are no good."""
        return np.inf

    def sort_all(self) -> None:
        """Sort the particles of all worlds into cells."""

    @ti.func
    def speed(self, u):
        """The speed (m/s) of a unit that is a single particle."""
        return 0.0

    @ti.func
    def is_sound(self, u, speed, dt):
        """Whether a unit's speed (m/s) is one that steps of dt (s) bear."""
        return True

    @ti.func
    def way(self, u, t):
        """How far (m) any particle of a unit has moved since the lists were built; huge where there are none."""
        return 0.0

    @ti.func
    def allowed_multiple(self, w):
        """The largest multiple of the base step that a world allows."""
        return 1

    @ti.func
    def invalid(self, u, t):
        """Whether two particles may be in reach of each other unlisted at time t (s)."""
        return False

    @ti.func
    def may_be_invalid(self, u, t):
        """Whether that may be so by cheap bounds on the displacements."""
        return False

    @ti.func
    def asked(self, u):
        """Whether some entries must be searched for again although the lists are valid."""
        return False

    @ti.func
    def sort(self, w):
        """Sort the particles of a world into cells."""

    @ti.func
    def make_lists(self, u, t, dt, whole):
        """Rebuild the lists of a unit, or with `whole` false only what is asked for; returns whether they fit."""
        return True
