"""Elastic contact forces of a world, for display and analysis."""

from dataclasses import dataclass, field

import numpy as np
import taichi as ti

from solvers.grains.contacts import Contacts, is_some
from solvers.grains.lists.neighbours import Neighbours
from solvers.grains.state import GrainState
from solvers.machine.units import Units
from solvers.tank.walls import Walls

NOBODY = -1
NO_PIECE = -1

Offsets = ti.types.ndarray(dtype=ti.i32, ndim=1)
Names = ti.types.ndarray(dtype=ti.i32, ndim=2)
Rows = ti.types.ndarray(dtype=ti.f32, ndim=2)


@dataclass(frozen=True)
class Pressing:
    """The k contacts of a world with a nonzero elastic force, in the tank's frame.

    `grains` (k, 2): numbers of the two grains, the second NOBODY for a wall, a part or a fixed grain; `place` (k, 2) m
    of the contact; `force` (k, 2) N, elastic and along the normal, on the first grain; `overlap` (k,) m; `piece` (k,):
    the piece of the tank that is touched, as `Walls.piece` numbers them, NO_PIECE for a grain.
    """

    grains: np.ndarray
    place: np.ndarray
    force: np.ndarray
    overlap: np.ndarray = field(default_factory=lambda: np.zeros(0))
    piece: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=int))


UNTOUCHED = Pressing(np.zeros((0, 2), dtype=int), np.zeros((0, 2)), np.zeros((0, 2)))
"""No contacts: the grains do not touch, or have not been read."""


@ti.data_oriented
class Presser:
    """Reads the contact lists without changing the contact history."""

    def __init__(self, units: Units, grains: GrainState, walls: Walls, neighbours: Neighbours, contacts: Contacts):
        self.units, self.grains, self.walls = units, grains, walls
        self.neighbours, self.contacts = neighbours, contacts

    def read(self, world: int, time: float, number: np.ndarray) -> Pressing:
        """The contact forces in a world at its time (s); `number` (n,): the grains' own numbers in solver order."""
        units = slice(world * self.units.a_world, (world + 1) * self.units.a_world)
        listed = [kind.length.to_numpy()[units] for kind in (self.neighbours.pairs, self.neighbours.contacts)]
        first = np.concatenate([[0], np.cumsum(sum(listed))]).astype(np.int32)
        names = np.full((max(1, first[-1]), 3), NOBODY, dtype=np.int32)
        axes = self.grains.axes
        rows = np.zeros((len(names), 2 * axes + 1), dtype=np.float32)
        self.read_world(world, time, first, names, rows)
        pressing = names[:, 0] != NOBODY
        names, piece, rows = names[pressing, :2], names[pressing, 2], rows[pressing]
        grains = np.where(names == NOBODY, NOBODY, number[names])
        return Pressing(grains, rows[:, :axes], rows[:, axes:-1], rows[:, -1], piece)

    @ti.kernel
    def read_world(self, w: ti.i32, t: ti.f64, first: Offsets, names: Names, rows: Rows):
        """Fill the rows of each unit, from `first` on, with its contact forces."""
        for k in range(self.units.a_world):
            u = w * self.units.a_world + k
            self.read_pairs(self.grains, self.neighbours.pairs, w, u, first[k], names, rows)
            after = first[k] + self.neighbours.pairs.length[u]
            self.read_walls(self.grains, self.neighbours.contacts, w, u, t, after, names, rows)

    @ti.func
    def read_pairs(
        self, g: ti.template(), pairs: ti.template(), w, u, first, names: ti.template(), rows: ti.template()
    ):
        """One row per pair; a pair listed by two units goes to the unit of its lower-numbered grain."""
        start, end = self.units.first(u), self.units.end(u)
        for p in range(pairs.length[u]):
            listed, mate = pairs.first_of(u, p), pairs.second_of(u, p)
            if start <= mate < end or listed < mate:
                i, j = ti.min(listed, mate), ti.max(listed, mate)
                press = self.contacts.pair_press(g, pairs, w, i, j, u, p)
                self.write(first + p, i, j, NO_PIECE, press, names, rows)

    @ti.func
    def read_walls(
        self, g: ti.template(), contacts: ti.template(), w, u, t, first, names: ti.template(), rows: ti.template()
    ):
        """One row per contact with a wall or a part."""
        shift = self.walls.shift(w, t)
        for p in range(contacts.length[u]):
            i, feature = contacts.first_of(u, p), contacts.second_of(u, p)
            press = self.contacts.wall_press(g, contacts, w, i, feature, shift, u, p)
            self.write(first + p, i, self.units.moving(), self.walls.piece(feature), press, names, rows)

    @ti.func
    def write(self, row, i, j, piece, press, names: ti.template(), rows: ti.template()):
        """Write a contact's place, force and overlap from `press` to a row, left empty if the force is zero."""
        force = [press[self.grains.axes + a] for a in ti.static(range(self.grains.axes))]
        if is_some(force):
            names[row, 0], names[row, 2] = i, piece
            if j < self.units.moving():
                names[row, 1] = j
            for k in ti.static(range(2 * self.grains.axes + 1)):
                rows[row, k] = ti.cast(press[k], ti.f32)
