"""The visibility criterion: plates in the water have no thickness, and hide what is behind them."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.bodies.solids import TOUCHES, is_solid, line_of, prolonging
from solvers.fluid.given import Water
from solvers.fluid.lists.order import Order
from solvers.fluid.state import UNUSED, Particles
from solvers.fluid.walls.layers import FAR
from solvers.machine.state import Axis, State
from solvers.motion.poses import AT_MIDDLE, AT_START
from solvers.space.axes import dot
from solvers.tank.parts import Part
from solvers.tank.pieces import COSINE, NUMBERS, SINE, Y, Z

# A plate: a point (m), its direction, its ends (m) from there, how far (m) its ends reach on into walls.
LINE_Y, LINE_Z, ALONG_Y, ALONG_Z, LOW, HIGH, IN_LOW, IN_HIGH = range(8)
OF_LINE = 8  # numbers
REACH, TOUCH, BLUR = range(3)  # of `lengths`


@ti.data_oriented
class Visibility:
    """Two particles are neighbours only if they see each other: if no plate crosses the line between them.

    A plate's own wall particles, which lie behind it, are seen just by those whose line of sight it crosses. So what is
    seen past the end of a plate and what is seen through it never overlap: their shares are 1 together. An end that
    touches the tank's wall reaches on into it. Plates in one line that touch and move alike are one plate, with one row
    of wall particles, and no water passes between them. `plates` are the numbers of the parts of each plate.

    Over the last smoothing length h before a free end a plate becomes transparent, by χ = x² (3 − 2x) at the distance x
    h from the end: a pair that it parts there counts with 1 − χ, a wall particle with χ. Else pairs come and go at once
    as the line between them passes the end, with forces of many weights, and still water stirs itself for ever: beside
    a baffle of half its depth, 15 layers, to 0.2 m/s (r.m.s.), where it rests now. Over half of h it begins to move
    after 3 s, over three halves it rests as well. After the transparent tips of cracks of Organ, Fleming, Terry &
    Belytschko (1996), Comput. Mech. 18, 225, who lengthen distances there instead.

    Limits: so a plate is shorter by some h/2 at a free end, at once when the end leaves a wall, as a gate's does. Ends
    of plates that meet at an angle, or do not move alike, are free, and so let water pass.
    """

    def __init__(self, arrays: State, parts: Sequence[Part], water: Water, scene, wet: Sequence[bool]):
        self.exact, self.apart = arrays.exact, len(scene.tanks) > 1
        alike = prolonging(parts, water.spacing)
        firsts = [k for k, part in enumerate(parts) if wet[k] and not is_solid(part) and not alike[k, :k].any()]
        self.plates, self.count = [np.flatnonzero(alike[k]) for k in firsts], len(firsts)
        if self.plates:
            own = arrays.under("visibility")
            lines = np.array([line_of(parts, members).ravel() for members in self.plates])
            lengths = np.array([water.reach, TOUCHES * water.spacing, water.length])
            self.lengths = own.holding("lengths", lengths, "length", own.exact)
            self.drawn = own.holding("drawn", lines, "plate number", own.exact)
            self.parts = own.holding("parts", np.array(firsts), "plate", ti.i32)
            edges = [np.column_stack([tank.outline, np.roll(tank.outline, -1, axis=0)]) for tank in scene.tanks]
            self.outline = own.holding("outline", np.concatenate(edges), "edge number", own.exact)
            ends = np.cumsum([0, *map(len, edges)])
            self.tanks = [parts[k].tank for k in firsts]  # in which each plate stands
            rows = np.array([[ends[tank], ends[tank + 1], tank] for tank in self.tanks])
            self.edges = own.holding("edges", rows, "plate number", ti.i32)  # its tank's, from and to, and the tank
            each = Axis("world", scene.worlds), Axis("plate", len(self.plates)), Axis("number", 2 * OF_LINE)
            (self.line,) = own.reals(each, "line", kept=False)

    def join(self, arrays: State, particles: Particles, owner: np.ndarray, first: ti.Field, order: Order) -> None:
        """Take the `particles` and their `order`; the wall blocks from `first` (1,) on are of parts `owner`."""
        self.particles, self.first, self.order = particles, first, order
        if self.plates:
            self.plate = arrays.under("visibility").holding("plate", self.number_of(owner), "row", ti.i32)

    def number_of(self, parts: np.ndarray) -> np.ndarray:
        """The plates (n,) that these parts are, or parts of; UNUSED for solid bodies."""
        found = np.full(len(parts), UNUSED)
        for number, members in enumerate(self.plates):
            found[np.isin(parts, members)] = number
        return found

    @ti.func
    def note(self, w, poses: ti.template()):
        """Note where the plates of a world are at the start and in the middle of a step, by their bodies' `poses`."""
        for q in range(self.count):
            for part in range(AT_START, AT_MIDDLE + 1):
                self.note_line(w, q, poses, part)

    @ti.func
    def note_line(self, w, q, poses: ti.template(), part):
        """Note where a plate is, and whether its ends touch the tank's wall."""
        first, at, k = OF_LINE * part, NUMBERS * part, self.parts[q]
        cos, sin = poses[w, k, at + COSINE], poses[w, k, at + SINE]
        y = [poses[w, k, at + Y] + cos * self.drawn[q, n] - sin * self.drawn[q, n + 1] for n in ti.static((0, 2))]
        z = [poses[w, k, at + Z] + sin * self.drawn[q, n] + cos * self.drawn[q, n + 1] for n in ti.static((0, 2))]
        length = ti.sqrt((y[1] - y[0]) ** 2 + (z[1] - z[0]) ** 2)
        values = [y[0], z[0], (y[1] - y[0]) / length, (z[1] - z[0]) / length]
        for n in ti.static(range(4)):
            self.line[w, q, first + n] = ti.cast(values[n], self.particles.real)
        low = ti.select(self.touching(q, y[0], z[0]), self.lengths[REACH], 0.0)
        high = ti.select(self.touching(q, y[1], z[1]), self.lengths[REACH], 0.0)
        ends = [0.0 - low, length + high, low, high]
        for n in ti.static(range(4)):
            self.line[w, q, first + LOW + n] = ti.cast(ends[n], self.particles.real)

    @ti.func
    def touching(self, q, y, z):
        """Whether a point is at the outline of the tank of plate q, or outside it."""
        near, inside = False, False
        for k in range(self.edges[q, 0], self.edges[q, 1]):
            a_y, a_z, b_z = self.outline[k, 0], self.outline[k, 1], self.outline[k, 3]
            along, up, off_y, off_z = self.outline[k, 2] - a_y, b_z - a_z, y - a_y, z - a_z
            share = ti.max(0.0, ti.min(1.0, (off_y * along + off_z * up) / (along * along + up * up)))
            off = [off_y - share * along, off_z - share * up]
            if dot(off, off) < self.lengths[TOUCH] * self.lengths[TOUCH]:
                near = True
            if (a_z > z) != (b_z > z) and off_y < off_z * along / up:
                inside = not inside
        return near or not inside

    @ti.func
    def share(self, b, jb, place: ti.template(), apart: ti.template(), part: ti.template()):
        """The share of the particle at `place` in block jb that each particle of a block b sees, from 0 to 1.

        `apart` are the places of the block less the other one's.
        """
        p = self.particles
        before = p.fluid_blocks + self.first[0]
        w, own, other = b // p.stride, b % p.stride - before, jb % p.stride - before
        share, reach = p.ones(), ti.cast(self.lengths[REACH], p.real)
        sharp = ti.cast(1.0 / self.lengths[BLUR], p.real)
        for q in range(self.count):
            first = ti.static(OF_LINE * part)
            t_y, t_z = self.line[w, q, first + ALONG_Y], self.line[w, q, first + ALONG_Z]
            y, z = place[0] - self.line[w, q, first + LINE_Y], place[1] - self.line[w, q, first + LINE_Z]
            across = t_y * z - t_z * y
            if across * across < 4.0 * reach * reach and self.is_in(q, b):
                its = ti.cast(0.0, p.real)  # 1 where one of the two is a wall particle of this plate
                if own >= 0:
                    its = ti.select(self.plate[own] == q, 1.0, its)
                if other >= 0:
                    its = ti.select(self.plate[other] == q, 1.0, its)
                beyond = t_y * apart[1] - t_z * apart[0]
                least = ti.select(beyond * beyond > 1e-30, beyond, p.ones())
                through = t_y * y + t_z * z + (t_y * apart[0] + t_z * apart[1]) * ((0.0 - across) / least)
                low, high = self.line[w, q, first + LOW], self.line[w, q, first + HIGH]
                deep = ti.max(0.0, ti.min(1.0, ti.min(through - low, high - through) * sharp))
                hidden = ti.select((beyond + across) * across < 0.0, deep * deep * (3.0 - 2.0 * deep), p.zeros())
                share *= its * hidden + (1.0 - its) * (1.0 - hidden)
        return share

    @ti.func
    def is_in(self, q, b):
        """Whether a plate stands in the tank of a block."""
        found = True
        if ti.static(self.apart):
            found = self.edges[q, 2] == self.order.layer(b)
        return found

    @ti.func
    def off_ends(self, b, part: ti.template()):
        """1 for the particles of a block that are farther than FAR from all free ends of plates, else 0."""
        p = self.particles
        w, off = b // p.stride, p.ones()
        far = ti.cast(FAR * self.lengths[REACH], p.real)
        for q in range(self.count):
            first = ti.static(OF_LINE * part)
            for n in range(2):
                if self.line[w, q, first + IN_LOW + n] == 0.0 and self.is_in(q, b):
                    way = self.line[w, q, first + LOW + n]
                    y = self.line[w, q, first + LINE_Y] + way * self.line[w, q, first + ALONG_Y]
                    z = self.line[w, q, first + LINE_Z] + way * self.line[w, q, first + ALONG_Z]
                    apart = [p.offset(b, ti.cast(y, p.where), 0), p.offset(b, ti.cast(z, p.where), 1)]
                    off = ti.select(dot(apart, apart) > far * far, off, p.zeros())
        return off
