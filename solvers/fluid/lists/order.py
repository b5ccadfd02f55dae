"""The particles' order in memory: a counting sort into strips, in whole blocks, before lists are rebuilt.

Neighbours lie in one block or in few, so that a block's lanes need nearly the same neighbours.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import taichi as ti

from solvers.fluid.lists.grid import Grid
from solvers.fluid.state import COUNT, FAR, FLUID, ROOM, UNUSED, Particles, snug
from solvers.machine.quantity import PLANE
from solvers.machine.state import Axis, State, roomy
from solvers.space.axes import UP

CHUNK = 256  # keys that one thread sums up
STRIPS, BINS, LONGEST, KEYS, ROWS, ABREAST = range(6)  # what of the grid is kept in `sizes`


@dataclass(frozen=True)
class Tanks:
    """The tanks of a world: how many particles are in each (`fills`), and its length over that of the first with water.

    `standing` is the tank (wall blocks,) of each block of wall particles.
    """

    fills: Sequence[int]
    weights: np.ndarray
    standing: np.ndarray

    @classmethod
    def of(cls, scene, particles: Particles, slots: np.ndarray, tanks: np.ndarray, parts: np.ndarray) -> "Tanks":
        """Those of a scene, whose wall particles are in these slots of the wall blocks, of these `tanks`.

        Blocks of parts come last: `parts` are the tanks in which these stand.
        """
        first = next(number for number, fill in enumerate(scene.fills) if fill)
        lengths = np.array([tank.along for tank in scene.tanks])
        standing = np.zeros(max(1, particles.wall_blocks), dtype=int)
        standing[slots // particles.lanes] = tanks
        standing[particles.walls - len(parts) : particles.walls] = parts
        return cls(scene.fills, lengths / lengths[first], standing)


@ti.data_oriented
class Order:
    """Sorts the particles of a world. `first` (W, keys) are the keys' first slots; slot = lanes · block + lane.

    Each tank is a layer of the grid, with strips and so with blocks of its own.
    """

    def __init__(self, arrays: State, particles: Particles, grid: Grid, tanks: Tanks):
        self.particles, self.grid = particles, grid
        self.inflow, self.leaks = None, False  # what lets particles enter before they are sorted
        self.layers = grid.layers
        sizes = grid.strips, grid.bins, grid.longest, grid.strips * grid.bins, grid.rows, grid.rows // grid.ranks[0]
        self.axes, self.per_metre, self.period, self.origin = grid.axes, *grid.places
        # A particle of a full tank takes two keys, and there is room for twice as many; in space for those there are
        usual, fitted = (2 * particles.fluid_blocks * particles.lanes, roomy) if self.axes == PLANE else (ROOM, snug)
        self.keys = fitted(sizes[KEYS] + 1, usual)
        self.chunks = -(-self.keys // CHUNK)
        own = arrays.under("water.order")
        self.sizes = own.holding("sizes", np.array(sizes), "size", ti.i32)
        self.numbers = own.holding("numbers", grid.numbers, "number", own.place)
        if self.layers > 1:
            self.ends = own.holding("ends", np.cumsum(tanks.fills), "layer", ti.i32)
            self.standing = own.holding("standing", tanks.standing, "block", ti.i32)
            self.weights = own.holding("weights", tanks.weights, "layer", own.exact)
        world = Axis("world", particles.worlds)
        keys = world, Axis("key", self.chunks * CHUNK)
        (self.first,) = own.integers(keys, "first", below=particles.fluid_blocks * particles.lanes + 1)
        (self.cursor,) = own.integers(keys, "cursor", kept=False)
        (self.chunk_first,) = own.integers((world, Axis("chunk", self.chunks)), "chunk_first", kept=False)
        each, names = particles.of_water, ("key", "source", "aside_number")
        self.key, self.source, self.aside_number = own.wide(each, *names, kind=ti.i32, kept=False)
        (self.aside,) = own.wide(each, "aside", kept=False)
        (self.aside_place,) = own.wide(each, "aside_place", kind=own.place, kept=False)

    @ti.func
    def bin_of(self, y):
        """The bin of a place along y (m)."""
        along = (y - self.numbers[0]) * self.numbers[self.per_metre]
        return ti.max(0, ti.min(self.sizes[BINS] - 1, ti.cast(along, ti.i32)))

    @ti.func
    def rank_of(self, place, axis: ti.template()):
        """Which of the strips along an axis, not the first, a place (m) on it is in."""
        most = self.sizes[ABREAST]
        if ti.static(axis == UP):
            most = self.sizes[ROWS] // self.sizes[ABREAST]
        rank = ti.cast((place - self.numbers[axis]) * self.numbers[self.per_metre + 1], ti.i32)
        return ti.max(0, ti.min(most - 1, rank))

    @ti.func
    def strip_of(self, z):
        """The strip of a height z (m) in the plane."""
        return self.rank_of(z, UP)

    @ti.func
    def find(self, b, lane):
        """The key of a particle."""
        p = self.particles
        strip = self.rank_of(p.place[1][b, lane], UP)
        if ti.static(self.axes > PLANE):
            strip = strip * self.sizes[ABREAST] + self.rank_of(p.place[2][b, lane], 2)
        if ti.static(self.layers > 1):
            strip += self.layer_of(p.number[b, lane]) * self.sizes[ROWS]
        return strip * self.sizes[BINS] + self.bin_of(p.place[0][b, lane])

    @ti.func
    def layer_of(self, number):
        """The tank of a particle, by its number."""
        layer = 0
        for k in range(self.layers - 1):
            layer += ti.select(number >= self.ends[k], 1, 0)
        return layer

    @ti.func
    def layer(self, b):
        """The tank that a block is in: one of water that is in use, or one of wall particles."""
        found = 0
        if ti.static(self.layers > 1):
            row = b % self.particles.stride
            if row < self.particles.fluid_blocks:
                found = self.layer_of(self.particles.number[b, 0])
            else:
                found = self.standing[row - self.particles.fluid_blocks]
        return found

    @ti.func
    def weight(self, b):
        """The length of the tank that a block is in, over that of the first with water."""
        weight = ti.cast(1.0, self.particles.exact)
        if ti.static(self.layers > 1):
            weight = self.weights[self.layer(b)]
        return weight

    @ti.func
    def wrap(self, b, lane):
        """Bring a particle that has left periodic space on one side back on the other."""
        p = self.particles
        for a in ti.static(range(p.axes)):
            if ti.static(self.grid.periods[a] > 0.0):
                period = self.numbers[self.period + a]
                beyond = ti.floor((p.place[a][b, lane] - self.numbers[self.origin + a]) / period)
                p.place[a][b, lane] = p.place[a][b, lane] - beyond * period

    def let_in(self, inflow) -> None:
        """Let particles enter by an `inflow` (`solvers.fluid.inflow.inflow.Inflow`) whenever they are sorted."""
        self.inflow, self.leaks = inflow, True

    @ti.func
    def sort_world(self, w):
        """Sort the particles of one world, on one thread, with those that enter it now."""
        if ti.static(self.leaks):
            self.inflow.admit(w)
        start, lanes = w * self.particles.stride, self.particles.lanes
        for k in range(self.sizes[KEYS]):
            self.cursor[w, k] = 0
        for b in range(start, start + self.particles.used[w]):
            for lane in range(lanes):
                if self.particles.number[b, lane] != UNUSED:
                    self.wrap(b, lane)
                    self.key[b, lane] = self.find(b, lane)
                    self.count_up(w, self.key[b, lane])
        slots = self.lay_out(w)
        used = (slots + lanes - 1) // lanes
        end = start + ti.max(used, self.particles.used[w])  # blocks that are in use no more are emptied
        for b in range(start, end):
            for lane in range(lanes):
                self.source[b, lane] = UNUSED
        for b in range(start, start + self.particles.used[w]):
            for lane in range(lanes):
                if self.particles.number[b, lane] != UNUSED:
                    k = self.key[b, lane]
                    slot = self.cursor[w, k]
                    self.count_up(w, k)
                    self.source[start + slot // lanes, slot % lanes] = b * lanes + lane
        for k in ti.static(range(len(self.particles.moved))):
            self.move_world(self.particles.moved[k], start, end)
        self.particles.used[w] = used

    @ti.func
    def count_up(self, w, k):
        """Add one to a key's cursor; no atomic is needed, since one thread has the whole world."""
        self.cursor[w, k] = self.cursor[w, k] + 1

    @ti.func
    def lay_out(self, w):
        """From the counts in `cursor` to the first slots of the keys, in `first` and `cursor`; returns the slots used.

        A block ends with its strip, or where it would get too long while blocks can be spared, so that the
        neighbourhood of a block stays small where there is little water.
        """
        lanes = self.particles.lanes
        strips, bins, longest = self.sizes[STRIPS], self.sizes[BINS], self.sizes[LONGEST]
        spare = self.particles.sizes[FLUID] - (self.particles.sizes[COUNT] + lanes - 1) // lanes - strips
        slot, begin, k = 0, 0, 0
        for _ in range(strips):
            slot = (slot + lanes - 1) // lanes * lanes
            for along in range(bins):
                count = self.cursor[w, k]
                if count > 0:
                    if slot % lanes == 0:
                        begin = along
                    elif along - begin >= longest and spare > 0:
                        slot = (slot + lanes - 1) // lanes * lanes
                        begin = along
                        spare -= 1
                self.first[w, k], self.cursor[w, k] = slot, slot
                if slot // lanes != (slot + count) // lanes:
                    begin = along
                slot += count
                k += 1
        self.first[w, k] = slot
        return slot

    @ti.func
    def move_world(self, field: ti.template(), start, end):
        """Carry an array to the new order."""
        lanes = self.particles.lanes
        aside = ti.static(self.buffer(field))
        fill = ti.static(self.filling(field))
        for b in range(start, end):
            for lane in range(lanes):
                source = self.source[b, lane]
                aside[b, lane] = fill
                if source != UNUSED:
                    aside[b, lane] = field[source // lanes, source % lanes]
        for b in range(start, end):
            for lane in range(lanes):
                field[b, lane] = aside[b, lane]

    def buffer(self, field: ti.Field) -> ti.Field:
        """The array in which a field of this type is put aside."""
        if field.dtype == ti.i32:
            return self.aside_number
        return self.aside_place if any(field is one for one in self.particles.place) else self.aside

    def filling(self, field: ti.Field) -> float | int:
        """What unused lanes have in a field."""
        if field.dtype == ti.i32:
            return UNUSED
        if self.particles.porous and field is self.particles.porosity:
            return 1.0
        return FAR if any(field is one for one in self.particles.place) else 0.0

    @ti.kernel
    def sort_all(self):
        """Sort all worlds, with one particle a block, on all threads; the result is that of `sort_world`."""
        for w, k in self.cursor:
            self.cursor[w, k] = 0
        for w, i in ti.ndrange(self.particles.worlds, self.particles.sizes[COUNT]):
            b = w * self.particles.stride + i
            self.wrap(b, 0)
            self.key[b, 0] = self.find(b, 0)
            ti.atomic_add(self.cursor[w, self.key[b, 0]], 1)
        for w, c in self.chunk_first:
            total = 0
            for k in range(c * CHUNK, (c + 1) * CHUNK):
                count = self.cursor[w, k]
                self.first[w, k] = total
                total += count
            self.chunk_first[w, c] = total
        for w in range(self.particles.worlds):
            total = 0
            for c in range(self.chunks):
                here = self.chunk_first[w, c]
                self.chunk_first[w, c] = total
                total += here
        for w, k in self.first:
            self.first[w, k] = self.first[w, k] + self.chunk_first[w, k // CHUNK]
            self.cursor[w, k] = self.first[w, k]
        for w, i in ti.ndrange(self.particles.worlds, self.particles.sizes[COUNT]):
            b = w * self.particles.stride + i
            slot = ti.atomic_add(self.cursor[w, self.key[b, 0]], 1)
            self.source[w * self.particles.stride + slot, 0] = b
        for w, k in self.first:
            if k < self.sizes[KEYS]:
                self.order_bin(w, k)
        for field in ti.static(self.particles.moved):
            for w, i in ti.ndrange(self.particles.worlds, self.particles.sizes[COUNT]):
                b = w * self.particles.stride + i
                ti.static(self.buffer(field))[b, 0] = field[self.source[b, 0], 0]
            for w, i in ti.ndrange(self.particles.worlds, self.particles.sizes[COUNT]):
                b = w * self.particles.stride + i
                field[b, 0] = ti.static(self.buffer(field))[b, 0]

    @ti.func
    def order_bin(self, w, k):
        """Order the sources of a key by their slots before, since the threads' order is arbitrary."""
        start = w * self.particles.stride
        for at in range(self.first[w, k] + 1, self.first[w, k + 1]):
            moved, hole = self.source[start + at, 0], at
            while hole > self.first[w, k] and self.source[start + hole - 1, 0] > moved:
                self.source[start + hole, 0] = self.source[start + hole - 1, 0]
                hole -= 1
            self.source[start + hole, 0] = moved
