"""Neighbour lists: for each block, the particles near its bounding box, and when they are rebuilt."""

from itertools import product

import numpy as np
import taichi as ti

from solvers.fluid.bodies.bodies import Bodies
from solvers.fluid.constants import Constants
from solvers.fluid.lists.capacity import SKIN, Laid, capacities
from solvers.fluid.lists.listing import Listing
from solvers.fluid.lists.order import ABREAST, BINS, ROWS, Order
from solvers.fluid.lists.work_ranges import WorkRanges
from solvers.fluid.state import UNUSED
from solvers.machine.quantity import PLANE, SPACE
from solvers.machine.state import State, padded
from solvers.machine.units import Units
from solvers.space.axes import UP, dot

NEVER = 1e30  # m, a displacement that makes the lists invalid
LASTING = 6  # steps for which a list should last: the skin follows from the speed at the last rebuild
FASTER = 1.25  # what particles may gain in speed until the next step
PLACES = {PLANE: 27, SPACE: 26}  # bits of an entry that number a slot; the others: the periodic image it is seen in


@ti.data_oriented
class Lists:
    """Neighbours of each block: `near`, of water in water; `beside`, walls beside water; `facing`, water before walls.

    An entry is a slot in all blocks of all worlds, and where space is periodic the image in which it is seen.
    `displacement` (units,) m bounds how far any particle of a unit has moved since the lists were built, `last` (m) how
    far in the last step; `skin` (units,) m was allowed for. `walls` are the wall particles' first slots by key. In
    `beside` those of the tank are followed by those of each part (`Bodies`), with a beginning for each of these pieces.
    """

    def __init__(
        self,
        arrays: State,
        units: Units,
        order: Order,
        ranges: WorkRanges,
        constants: Constants,
        walls: np.ndarray,
        bodies: Bodies,
        laid: Laid,
    ):
        self.units, self.particles, self.ranges = units, order.particles, ranges
        self.order, self.constants, self.bodies, self.pieces = order, constants, bodies, 1 + bodies.count
        own = arrays.under("water.lists")
        self.periods = own.holding("periods", np.array(order.grid.periods), "axis", own.place)
        wraps = [(-1, 0, 1) if period else (0,) for period in order.grid.periods]
        particles, self.axes, self.bits = order.particles, order.particles.axes, PLACES[order.particles.axes]
        self.images = tuple(sum(3**a * (step + 1) for a, step in enumerate(steps)) for steps in product(*wraps))
        self.wall_first = own.holding("wall_first", padded(walls, order.keys), "key", ti.i32)
        wet, dry = (-(-blocks // units.a_world) for blocks in (particles.fluid_blocks, max(particles.wall_blocks, 1)))
        slots = particles.stride * particles.lanes  # of a world
        ends = (
            particles.worlds * slots if len(self.images) == 1 else 3**self.axes << self.bits,
            slots,
        )  # an image stands in front
        room = capacities(laid, order.grid, units, particles, constants.smoothing)
        self.near = Listing(arrays, units, "near", wet, room["near"], *ends)
        self.beside = Listing(arrays, units, "beside", wet * self.pieces, room["beside"], *ends)
        self.facing = Listing(arrays, units, "facing", dry, room["facing"], *ends)
        self.fixed_skin = SKIN[1] * order.grid.spacing  # m, of particles that move one by one
        self.displacement = own.holding("travel", np.full(units.count, NEVER), "unit", kept=True)
        self.last, self.skin = own.reals((units.axis,), "last", "skin")

    def expire(self) -> None:
        """Have the lists rebuilt before the next step."""
        self.displacement.fill(NEVER)

    @ti.func
    def may_be_invalid(self, u):
        """Whether two particles may come within reach of each other unlisted in the coming step."""
        return self.displacement[u] + FASTER * self.last[u] > 0.5 * self.skin[u]

    @ti.func
    def invalid(self, u):
        """As `may_be_invalid`, by the particles' true displacements."""
        old = False
        if self.may_be_invalid(u):
            old = True
            if self.displacement[u] < 0.5 * NEVER:
                moved = self.moved(u)
                if moved + FASTER * self.last[u] <= 0.4 * self.skin[u]:
                    old = False
                    self.displacement[u] = moved
        return old

    @ti.func
    def moved(self, u):
        """Largest displacement (m) of a unit's particles since its lists were built."""
        p = self.particles
        first, end = self.ranges.fluid(u)
        farthest = ti.cast(0.0, p.real)
        for b in range(first, end):
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED:
                    gone = [
                        ti.cast(p.place[a][b, lane] - p.built[a][b, lane], p.real) for a in ti.static(range(p.axes))
                    ]
                    farthest = ti.max(farthest, dot(gone, gone))
        if ti.static(self.bodies.moving):
            farthest = ti.max(farthest, self.bodies.gone(u))
        return ti.sqrt(farthest)

    @ti.func
    def rebuild(self, u):
        """Rebuild the lists of a unit, after its world was sorted; returns whether they fit."""
        spacing = self.constants.get("spacing")
        skin = ti.max(SKIN[0] * spacing, ti.min(SKIN[1] * spacing, 2.0 * LASTING * self.last[u]))
        if ti.static(self.units.single):  # all worlds together are told one skin before they go on
            skin = SKIN[1] * spacing
        fits = True
        if ti.static(self.axes == PLANE or self.units.single):
            fits = self.fill(u, skin)
        else:
            fits = False
            for _ in range(2):
                if not fits:
                    fits = self.fill(u, skin)
                    skin = SKIN[0] * spacing  # lists that do not fit may do so with less, which does not last as long
        return fits

    @ti.func
    def fill(self, u, skin):
        """Fill the lists of a unit, with a skin (m); returns whether they fit."""
        p = self.particles
        reach, fits, found, walls = self.constants.get("reach") + skin, True, 0, 0
        first, end = self.ranges.fluid(u)
        for b in range(first, end):
            self.near.first[u, b - first], self.beside.first[u, (b - first) * self.pieces] = found, walls
            for image in ti.static(self.images):
                found = self.search(u, b, reach, found, self.near, image, False)
                if ti.static(p.wall_blocks > 0):
                    walls = self.search(u, b, reach, walls, self.beside, image, True)
            for part in range(self.bodies.count):
                self.beside.first[u, (b - first) * self.pieces + 1 + part] = walls
                for image in ti.static(self.images if self.bodies.count else ()):
                    walls = self.search_part(u, b, reach, walls, part, image)
            for lane in range(p.lanes):
                for a in ti.static(range(p.axes)):
                    p.built[a][b, lane] = p.place[a][b, lane]
        self.near.first[u, end - first], self.beside.first[u, (end - first) * self.pieces] = found, walls
        if found >= self.near.capacity or walls >= self.beside.capacity:  # the last place is written to in passing
            fits = False
        if ti.static(p.wall_blocks > 0):
            first, end = self.ranges.walls(u)
            found = 0
            for b in range(first, end):
                self.facing.first[u, b - first] = found
                for image in ti.static(self.images):
                    found = self.search(u, b, reach, found, self.facing, image, False)
            self.facing.first[u, end - first] = found
            fits = fits and found < self.facing.capacity
            if ti.static(self.bodies.moving):
                self.bodies.note_built(u)
        self.displacement[u], self.skin[u] = 0.0, skin
        if not fits:
            self.displacement[u] = NEVER
        return fits

    @ti.func
    def search(self, u, b, reach, found, listing: ti.template(), image: ti.template(), walls: ti.template()):
        """List the water, or the walls, within `reach` (m) of a block's box, as seen in an image of periodic space.

        Returns the number listed up to there. Each tank has strips of its own.
        """
        p, order = self.particles, self.order
        w = self.units.world(u)
        lower, upper = self.box(b)
        code = self.seen_in(image, lower, upper)
        far = ti.cast(reach, p.where)
        left, right = order.bin_of(lower[0] - far), order.bin_of(upper[0] + far)
        start = w * p.stride * p.lanes
        if ti.static(walls):
            start += p.fluid_blocks * p.lanes
        base, under, over = order.layer(b) * order.sizes[ROWS], lower[1] - far, upper[1] + far
        for rank in range(order.rank_of(under, UP), order.rank_of(over, UP) + 1):
            first, last = rank, rank
            if ti.static(self.axes > PLANE):
                first = rank * order.sizes[ABREAST] + order.rank_of(lower[2] - far, 2)
                last = rank * order.sizes[ABREAST] + order.rank_of(upper[2] + far, 2)
            for strip in range(base + first, base + last + 1):
                begin = self.at(w, strip * order.sizes[BINS] + left, walls)
                end = self.at(w, strip * order.sizes[BINS] + right + 1, walls)
                for k in range(start + begin, start + end):
                    listing.slots[u, ti.min(found, listing.capacity - 1)] = k + code  # without a branch
                    found += ti.select(self.outside(k, lower, upper) < reach * reach, 1, 0)
        return found

    @ti.func
    def search_part(self, u, b, reach, found, part, image: ti.template()):
        """As `search`, for the wall particles of a part beside a block of water, block by block."""
        p, bodies, listing = self.particles, self.bodies, self.beside
        lower, upper = self.box(b)
        code = self.seen_in(image, lower, upper)
        start = self.units.world(u) * p.stride + p.fluid_blocks + bodies.first[0]
        for row in range(bodies.ends[part], bodies.end_in(part, b)):
            k, far = (start + row) * p.lanes, reach + bodies.radius[row]
            if self.outside(k, lower, upper) < far * far:
                for lane in range(p.lanes):
                    listing.slots[u, ti.min(found, listing.capacity - 1)] = k + lane + code
                    found += ti.select(self.outside(k + lane, lower, upper) < reach * reach, 1, 0)
        return found

    @ti.func
    def seen_in(self, image: ti.template(), lower: ti.template(), upper: ti.template()):
        """Shift a box to where an image of periodic space sees it; returns what entries of that image have in front."""
        code = 0
        if ti.static(len(self.images) > 1):
            code = image * ti.static(1 << self.bits)
            for a in ti.static(range(self.particles.axes)):
                lower[a] -= self.shift(image, a)
                upper[a] -= self.shift(image, a)
        return code

    @ti.func
    def outside(self, slot, lower: ti.template(), upper: ti.template()):
        """The square (m²) of the distance of the particle in a slot from a box; 0 within."""
        p = self.particles
        square = ti.cast(0.0, p.real)
        for a in ti.static(range(p.axes)):
            place = p.place[a][slot // p.lanes, slot % p.lanes]
            outside = ti.cast(ti.max(lower[a] - place, place - upper[a]), p.real)
            outside = ti.max(outside, 0.0)
            square += outside * outside
        return square

    @ti.func
    def at(self, w, key, walls: ti.template()):
        """First slot of a key."""
        if ti.static(walls):
            return self.wall_first[key]
        else:
            return self.order.first[w, key]

    @ti.func
    def shift(self, image, axis: ti.template()):
        """By how much (m) an image of periodic space is displaced along an axis."""
        return ti.cast(image // ti.static(3**axis) % 3 - 1, self.particles.where) * self.periods[axis]

    @ti.func
    def block_of(self, entry):
        """The block of an entry."""
        return self.slot_of(entry) // self.particles.lanes

    @ti.func
    def lane_of(self, entry):
        """The lane of an entry."""
        return self.slot_of(entry) % self.particles.lanes

    @ti.func
    def slot_of(self, entry):
        """The slot of an entry."""
        if ti.static(len(self.images) > 1):
            return entry & ti.static((1 << self.bits) - 1)
        else:
            return entry

    @ti.func
    def apart(self, own: ti.template(), origin: ti.template(), entry):
        """The places of a block, `own` (m) from `origin`, less that of an entry's particle."""
        p, jb, lane = self.particles, self.block_of(entry), self.lane_of(entry)
        return [
            own[a] - ti.cast(p.place[a][jb, lane] + self.seen(entry, a) - origin[a], p.real)
            for a in ti.static(range(p.axes))
        ]

    @ti.func
    def visible(self, b, entry, apart: ti.template(), part: ti.template()):
        """The share of an entry's particle that a block b sees past plates and hulls, at a part of the step."""
        p, jb, lane = self.particles, self.block_of(entry), self.lane_of(entry)
        if ti.static(self.bodies.hide):
            place = [ti.cast(p.place[a][jb, lane] + self.seen(entry, a), p.real) for a in ti.static(range(p.axes))]
            return self.bodies.share(b, jb, lane, place, apart, part)
        else:
            return ti.cast(1.0, p.real)

    @ti.func
    def seen(self, entry, axis: ti.template()):
        """By how much (m) the image of an entry is displaced along an axis."""
        if ti.static(len(self.images) > 1):
            return self.shift(entry >> ti.static(self.bits), axis)
        else:
            return ti.cast(0.0, self.particles.where)

    @ti.func
    def box(self, b):
        """Lower and upper corner (m) of the box round the particles of a block."""
        p = self.particles
        lower = [ti.cast(1e9, p.where) for _ in ti.static(range(p.axes))]
        upper = [ti.cast(-1e9, p.where) for _ in ti.static(range(p.axes))]
        for lane in range(p.lanes):
            if p.number[b, lane] != UNUSED:
                for a in ti.static(range(p.axes)):
                    lower[a] = ti.min(lower[a], p.place[a][b, lane])
                    upper[a] = ti.max(upper[a], p.place[a][b, lane])
        return lower, upper
