"""Porosity: the share of its surroundings that grains leave to each particle of water."""

import numpy as np
import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.machine.state import Axis, State
from solvers.mixture.frame import InTank
from solvers.motion.poses import AT_START
from solvers.space.axes import dot, named
from solvers.space.cells import Cells

LEAST = 0.05  # of porosity
LEAST_OPEN = 0.1  # of the share of the kernel within walls: a particle that a wall has swallowed has less


@ti.data_oriented
class Porosity:
    """ε_i = 1 − Σ_g (V_g/b) W(r_ig)/Γ_i, Γ_i = 1 − Σ_w V_w W(r_iw): kernel's sums over grains and wall particles.

    The kernel is the water's own, over its smoothing length (Robinson, Ramaioli & Luding 2014, without walls).
    Each grain's volume V_g is smeared over the thickness b of the slab, so that a bed of φ = 0.84 in the plane has
    ε = 1 − ⅔ φ = 0.44. Where walls cut the kernel off, both sums miss the same share Γ (own derivation).

    The mass of a particle is ρ ε V. As ε changes it keeps its mass and its volume, so that the density takes up the
    change: ρ' ε' = ρ ε.

    Limits: ε is LEAST at least, Γ LEAST_OPEN; what the walls of a hull hide, `OnHull` says.

    Units: V_g m³, V_w m², W 1/m², b m.
    """

    def __init__(self, arrays: State, context: FluidContext, frame: InTank, bounds, thickness: float):
        self.units, self.particles, self.ranges = context.units, context.particles, context.ranges
        self.lists, self.constants = context.lists, context.constants
        self.frame, self.grains = frame, (grains := frame.grains)
        lower, upper = (np.asarray(corner)[: grains.axes] for corner in bounds)
        images = self.lists.images
        self.images, self.stride = len(images), images[1] - images[0] if len(images) > 1 else 0
        self.cells = Cells(arrays.under("mixture"), frame, lower, upper, 0.5 * self.lists.order.grid.spacing)
        own, each = arrays.under("mixture"), (Axis("world", grains.worlds), Axis("place", grains.room))
        self.place = own.reals(each, *named("place", grains.axes), kind=own.place, kept=False)
        (self.area,) = own.reals(each, "area", kept=False)
        p = context.particles
        lanes = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
        (self.whole,) = own.wide(lanes, "whole", kept=False)  # 1/m², the factor of W over Γ
        self.sphere = own.holding("sphere", np.array([4.0 / 3.0 * np.pi / thickness]), "one")

    @ti.func
    def sort(self, w, t, kick, dt):
        """Sort the grains of a world into cells, and copy their places and areas into this order."""
        self.cells.sort_world(w)
        for k in range(self.grains.units.all()):
            i = self.cells.sorted[w, k]
            for a in ti.static(range(self.grains.axes)):
                self.place[a][w, k] = self.frame.place[a][w, i]
            radius = self.grains.radius[w, i]
            self.area[w, k] = self.sphere[0] * radius * radius * radius

    @ti.func
    def find(self, u, t, kick, dt):
        """The porosity at a unit's particles, and the density that follows from it."""
        first, end = self.ranges.fluid(u)
        for b in range(first, end):
            self.find_in_block(u, b, b - first)

    @ti.func
    def find_in_block(self, u, b, listed):
        """As `find`, for a block."""
        p, c, lists = self.particles, self.constants, self.lists
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        shrink, crowd, walled = c.get("shrink"), p.zeros(), p.zeros()
        w = self.units.world(u)
        if ti.static(self.frame.aboard):
            self.lists.bodies.hulls.note_block(b)
        for n in range(self.images):
            image = self.image(n)
            lower, upper = lists.box(b)
            lists.seen_in(image, lower, upper)
            for row in range(self.row_of(lower[1], -1), self.row_of(upper[1], 1) + 1):
                for k in range(self.begin(w, row, lower[0]), self.end(w, row, upper[0])):
                    apart = [
                        own[a] - ti.cast(self.place[a][w, k] + self.shift(image, a) - origin[a], p.real)
                        for a in ti.static(range(p.axes))
                    ]
                    t = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * shrink, 0.0)
                    weight = c.kernel.value(t)
                    if ti.static(self.frame.aboard):
                        weight *= self.frame.share(w, b, self.place_of(w, k), apart)
                    crowd += self.area[w, k] * weight
        if ti.static(p.wall_blocks > 0):
            pieces = lists.pieces
            for k in range(lists.beside.first[u, listed * pieces], lists.beside.first[u, (listed + 1) * pieces]):
                j = lists.beside.slots[u, k]
                apart = lists.apart(own, origin, j)
                t = ti.max(1.0 - ti.sqrt(dot(apart, apart)) * shrink, 0.0)
                weight = c.kernel.value(t)
                if ti.static(self.frame.aboard):
                    weight *= lists.visible(b, j, apart, AT_START)
                walled += p.volume[lists.block_of(j), lists.lane_of(j)] * weight
        value = c.get("value")
        whole = value / ti.max(1.0 - value * walled, LEAST_OPEN)
        found = ti.max(1.0 - whole * crowd, LEAST)
        p.store(self.whole, b, whole)
        before, s = p.load(p.porosity, b), p.load(p.deviation, b)
        before = ti.select(before > 0.0, before, found)  # not known yet: they start with their densities
        p.store(p.deviation, b, (1.0 + s) * (before / found) - 1.0)
        p.store(p.porosity, b, found)

    @ti.func
    def place_of(self, w, k):
        """The place (m) of the k-th of the sorted grains, with the digits of what is in a block."""
        return [ti.cast(self.place[a][w, k], self.particles.real) for a in ti.static(range(self.grains.axes))]

    @ti.func
    def image(self, n):
        """The n-th image of periodic space; compiled as a loop, which takes far less time than one after the other."""
        return self.lists.images[0] + n * self.stride

    @ti.func
    def row_of(self, z, side: ti.template()):
        """The row of cells in which what a place at z (m) sees ends, below (`side` −1) or above it (1)."""
        cells = self.cells
        away = ti.cast(side * self.constants.get("reach"), self.particles.where)
        row = ti.cast((z + away - cells.lengths[1]) / cells.lengths[2], ti.i32)
        return ti.max(0, ti.min(cells.shape_along(1) - 1, row))

    @ti.func
    def column_of(self, y, side: ti.template()):
        """As `row_of`, along a row."""
        cells = self.cells
        away = ti.cast(side * self.constants.get("reach"), self.particles.where)
        column = ti.cast((y + away - cells.lengths[0]) / cells.lengths[2], ti.i32)
        return ti.max(0, ti.min(cells.shape_along(0) - 1, column))

    @ti.func
    def begin(self, w, row, y):
        """The first of the sorted grains in a row that a place at y (m) may see."""
        return self.cells.first[w, row * self.cells.stride(1) + self.column_of(y, -1)]

    @ti.func
    def end(self, w, row, y):
        """One past the last of the sorted grains in a row that a place at y (m) may see."""
        return self.cells.first[w, row * self.cells.stride(1) + self.column_of(y, 1) + 1]

    @ti.func
    def shift(self, image, axis: ti.template()):
        """By how much (m) grains are displaced in an image of periodic space."""
        if ti.static(len(self.lists.images) > 1):
            return self.lists.shift(image, axis)
        else:
            return ti.cast(0.0, self.particles.where)
