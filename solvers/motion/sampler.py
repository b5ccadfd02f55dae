"""The sampler: what is recorded of a tank as it moves, its pose and the load of all matters on it."""

from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
import taichi as ti

from solvers.machine.quantity import PLANE, freedoms, in_plane, parted, places
from solvers.machine.state import Axis, State
from solvers.motion.free import NOT_FREE
from solvers.tank import quantities as tank
from solvers.tank.load import Load
from solvers.tank.pieces import Pieces


@ti.data_oriented
class Sampler:
    """One row of numbers per world: pose and velocity of the tank, and the mean force on it since the last sample.

    The force includes that on fixed grains and on `parts`, as they are when it is read, but for those that move freely:
    what these bear, and what is aboard of them, moves them. Its moment is about the tank's origin. `loads` are the
    loads of all matters and of contacts, each on `pieces`, of what is aboard of a body in its axes; without any the
    force is zero. `quantities` are the numbers' declarations, and `at` has the column in which each begins. Of a tank
    in space the first `faces` pieces are its faces. Forces on these, and on parts, which come after the `walls`, are
    told one by one, too.
    """

    def __init__(
        self,
        arrays: State,
        worlds: int,
        pieces: int,
        carrier,
        parts: Pieces,
        loads: Sequence[Load],
        axes: int = PLANE,
        faces: int = 0,
        walls: int = 1,
    ):
        self.worlds, self.carrier, self.parts, self.loads = worlds, carrier, parts, tuple(loads)
        self.exact, self.pieces = arrays.exact, pieces
        told = {"face": slice(0, faces), "part": slice(walls, walls + parts.count)}
        self.told = {one.name: told[one.per] for one in (*tank.OF_FACES, *tank.OF_PARTS)}
        self.told = {name: own for name, own in self.told.items() if own.stop > own.start}
        self.freedoms, self.moved = len(freedoms(axes)), in_plane(axes)  # all, and those in which carriers move
        self.quantities = tuple(one.within(axes) for one in tank.SERIES)
        self.at = SimpleNamespace(**places(self.quantities))
        columns = sum(quantity.width for quantity in self.quantities)
        own, world = arrays.under("sampler"), Axis("world", worlds)
        (self.rows,) = own.reals((world, Axis("quantity", columns)), "rows", kind=arrays.exact, kept=False)
        if parts.bodies.carries:
            hold = parts.bodies.hold
            self.carrying = parts.bodies.parts[hold.body]
            self.aboard = own.holding("aboard", hold.of_pieces, "piece", ti.i32)  # of the part with that number
        each = world, Axis("piece", self.pieces), Axis("component", self.freedoms)
        (self.on_pieces,) = own.reals(each, "on_pieces", kind=arrays.exact, kept=False)

    def read_and_reset(self, time: float, since: float) -> dict[str, np.ndarray]:
        """The quantities at `time` (s), `since` (s) after the last sample: (W, *shape) of each by name."""
        self.sample(time, since)
        found = parted(self.rows.to_numpy().astype(float), self.quantities)
        on_pieces = self.on_pieces.to_numpy() if self.told else None
        return found | {name: on_pieces[:, own].copy() for name, own in self.told.items()}

    @property
    def means(self) -> dict[str, np.ndarray]:
        """Of each quantity that is a mean over time, a zero (W, *shape)."""
        found = {one.name: np.zeros((self.worlds, *one.shape)) for one in self.quantities if one.mean}
        sizes = {name: own.stop - own.start for name, own in self.told.items()}
        return found | {name: np.zeros((self.worlds, size, self.freedoms)) for name, size in sizes.items()}

    @ti.kernel
    def sample(self, time: ti.f64, since: ti.f64):
        """Fill the rows, and set the loads' sums to zero."""
        for w in range(self.worlds):
            self.sample_world(w, time, since)

    @ti.func
    def sample_world(self, w, time, since):
        for piece in range(self.pieces):
            for k in ti.static(range(self.freedoms)):
                self.on_pieces[w, piece, k] = 0.0
        total = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(self.freedoms))])
        for m in ti.static(range(len(self.loads))):
            for u in range(w * self.loads[m].units.a_world, (w + 1) * self.loads[m].units.a_world):
                for piece in range(self.pieces):
                    impulse = self.loads[m].read_and_reset(u, piece)
                    for k in ti.static(range(self.freedoms)):
                        mean = impulse[k] / ti.cast(since, self.exact)
                        self.on_pieces[w, piece, k] = self.on_pieces[w, piece, k] + mean
                    if self.bears(w, piece):
                        total += impulse
        for k in ti.static(range(self.freedoms)):
            self.rows[w, self.at.pose + k], self.rows[w, self.at.pose_rate + k] = 0.0, 0.0
            self.rows[w, self.at.wall_force + k] = total[k] / ti.cast(since, self.exact)
        if ti.static(self.carrier.spatial):
            stands = self.carrier.stands(w, time)
            for k in ti.static(range(self.freedoms)):
                self.rows[w, self.at.pose + k] = stands[k]
                self.rows[w, self.at.pose_rate + k] = stands[self.freedoms + k]
        else:
            self.sample_pose(w, time)

    @ti.func
    def sample_pose(self, w, time):
        """Fill in pose and velocity of a tank that moves in the plane."""
        pose = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(9))])
        if ti.static(self.carrier.moving):
            pose = self.carrier.kinematics(w, time)
        for k, own in ti.static(enumerate(self.moved)):
            self.rows[w, self.at.pose + own] = pose[k]
            self.rows[w, self.at.pose_rate + own] = pose[3 + k]

    @ti.func
    def bears(self, w, piece):
        """Whether the tank bears the load on a piece, now."""
        found = True
        if ti.static(self.parts.floats):
            part = piece - self.parts.bodies.first
            if ti.static(self.parts.bodies.carries):  # noqa: SIM102
                if self.aboard[piece] == 1:
                    part = self.carrying
            if 0 <= part < self.parts.count:
                found = self.parts.bodies.loose(w, part) == NOT_FREE
        return found
