"""Who sees whom past the plates in the water: plates have no thickness, and hide what is behind them."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.given import Water
from solvers.fluid.state import UNUSED, Particles
from solvers.fluid.walls.layers import FAR
from solvers.fluid.walls.solids import TOUCHES, is_solid, line_of, prolonging, sides_of
from solvers.machine.state import Axis, State
from solvers.motion.poses import AT_MIDDLE, AT_START
from solvers.space.axes import dot
from solvers.tank.parts import Part
from solvers.tank.tank import Tank

Y, Z, COSINE, SINE, V_Y, V_Z, RATE = range(7)  # a pose in the tank: its origin (m), its turn, its velocities
# A plate: a point (m), its direction, how far (m) from there it hides, and how sharply (1/m) that begins and ends.
LINE_Y, LINE_Z, ALONG_Y, ALONG_Z, LOW, HIGH, SHARP_LOW, SHARP_HIGH = range(8)
OF_LINE = 8  # numbers
REACH, TOUCH, BLUR = range(3)  # of `lengths`
SHARP = 1e6  # over h: how sharply a plate ends at a wall or a part


@ti.data_oriented
class Sight:
    """Two particles see each other if no plate crosses the line between them.

    A plate's own dummies, which lie behind it, are seen just by those whose line of sight it crosses. So what is seen
    past the end of a plate and what is seen through it never overlap: their shares are 1 together. An end that touches
    the tank's wall reaches on into it. One that touches another part reaches half the way there, so that no water
    passes. Plates in one line that touch and move alike are one plate, with one row of dummies. `plates` are the
    numbers of the parts of each plate.

    Over the last smoothing length h before a free end, which touches nothing, a plate becomes transparent, by χ = x² (3
    − 2x) at the distance x h from the end: a pair that it parts there counts with 1 − χ, a dummy with χ. Else pairs
    come and go at once as the line between them passes the end, with forces of many weights, and still water stirs
    itself for ever: beside a baffle of half its depth, 15 layers, to 0.2 m/s (r.m.s.), where it rests now. Over half of
    h it begins to move after 3 s, over three halves it rests as well. After the transparent tips of cracks of Organ,
    Fleming, Terry & Belytschko (1996), Comput. Mech. 18, 225, who lengthen distances there instead.

    Limits: so a plate is shorter by some h/2 at a free end, at once when the end leaves a wall, as a gate's does. What
    lies behind two plates that meet at an angle, past both, is seen by nobody.
    """

    def __init__(self, arrays: State, parts: Sequence[Part], water: Water, tank: Tank, worlds: int):
        self.exact, self.worlds = arrays.exact, worlds
        alike = prolonging(parts, water.spacing)
        firsts = [k for k, part in enumerate(parts) if not is_solid(part) and not alike[k, :k].any()]
        self.plates, self.count = [np.flatnonzero(alike[k]) for k in firsts], len(firsts)
        if self.plates:
            own = arrays.under("sight")
            lines = np.array([line_of(parts, members).ravel() for members in self.plates])
            lengths = np.array([water.reach, TOUCHES * water.spacing, water.length])
            self.lengths = own.holding("lengths", lengths, "length", own.exact)
            self.drawn = own.holding("drawn", lines, "plate number", own.exact)
            self.parts = own.holding("parts", np.array(firsts), "plate", ti.i32)
            edges = np.column_stack([tank.outline, np.roll(tank.outline, -1, axis=0)])
            self.edges, self.outline = len(edges), own.holding("outline", edges, "edge number", own.exact)
            sides = [sides_of(part.points, is_solid(part)) for part in parts]
            each_side = np.repeat(np.arange(len(parts)), [len(of_one) for of_one in sides])
            self.sides = own.holding("sides", np.concatenate(sides), "side number", own.exact)
            self.of_part, self.borders = own.holding("of_part", each_side, "side", ti.i32), len(each_side)
            self.of_plate = own.holding("of_plate", self.number_of(each_side), "side", ti.i32)
            each = Axis("world", worlds), Axis("plate", len(self.plates)), Axis("number", 2 * OF_LINE)
            (self.line,) = own.reals(each, "line", kept=False)

    def join(self, arrays: State, particles: Particles, owner: np.ndarray, first: ti.Field) -> None:
        """Take the `particles`, of whose dry blocks those from `first` (1,) on belong to the parts `owner`."""
        self.particles, self.first = particles, first
        if self.plates:
            self.plate = arrays.under("sight").holding("plate", self.number_of(owner), "row", ti.i32)

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
        """Note where a plate is, and whether its ends touch the tank's wall or another part."""
        first, at, k = OF_LINE * part, 7 * part, self.parts[q]
        cos, sin = poses[w, k, at + COSINE], poses[w, k, at + SINE]
        y = [poses[w, k, at + Y] + cos * self.drawn[q, n] - sin * self.drawn[q, n + 1] for n in ti.static((0, 2))]
        z = [poses[w, k, at + Z] + sin * self.drawn[q, n] + cos * self.drawn[q, n + 1] for n in ti.static((0, 2))]
        length = ti.sqrt((y[1] - y[0]) ** 2 + (z[1] - z[0]) ** 2)
        values = [y[0], z[0], (y[1] - y[0]) / length, (z[1] - z[0]) / length]
        for n in ti.static(range(4)):
            self.line[w, q, first + n] = ti.cast(values[n], self.particles.real)
        for n in ti.static(range(2)):
            end = self.ended(w, q, y[n], z[n], poses, at)
            far = length + end[0] if ti.static(n) else 0.0 - end[0]
            self.line[w, q, first + LOW + n] = ti.cast(far, self.particles.real)
            self.line[w, q, first + SHARP_LOW + n] = ti.cast(end[1] / self.lengths[BLUR], self.particles.real)

    @ti.func
    def ended(self, w, q, y, z, poses: ti.template(), at):
        """How far (m) plate q hides beyond its end there, and how sharply that ends, over 1/h."""
        further, sharp = ti.cast(0.0, self.exact), ti.cast(1.0, self.exact)
        gap = self.gap(w, q, y, z, poses, at)
        if gap < self.lengths[TOUCH]:
            further, sharp = 0.5 * gap, SHARP
        if self.touching(y, z):
            further, sharp = self.lengths[REACH], SHARP
        return ti.Vector([further, sharp])

    @ti.func
    def gap(self, w, q, y, z, poses: ti.template(), at):
        """How far (m) a point of plate q is from the nearest side of another part, by `poses` from a column on."""
        nearest = ti.cast(1e30, self.exact)
        for side in range(self.borders):
            other = self.of_part[side]
            if self.of_plate[side] != q:
                cos, sin = poses[w, other, at + COSINE], poses[w, other, at + SINE]
                o_y, o_z, d_y, d_z = [self.sides[side, n] for n in ti.static(range(4))]
                way = [cos * d_y - sin * d_z, sin * d_y + cos * d_z]
                off = [
                    y - poses[w, other, at + Y] - cos * o_y + sin * o_z,
                    z - poses[w, other, at + Z] - sin * o_y - cos * o_z,
                ]
                share = ti.max(0.0, ti.min(1.0, dot(off, way) / dot(way, way)))
                left = [off[a] - share * way[a] for a in ti.static(range(2))]
                nearest = ti.min(nearest, ti.sqrt(dot(left, left)))
        return nearest

    @ti.func
    def touching(self, y, z):
        """Whether a point is at the tank's outline, or outside it."""
        near, inside = False, False
        for k in range(self.edges):
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
        before = p.wet + self.first[0]
        w, own, other = b // p.stride, b % p.stride - before, jb % p.stride - before
        share, reach = p.ones(), ti.cast(self.lengths[REACH], p.real)
        for q in range(self.count):
            first = ti.static(OF_LINE * part)
            t_y, t_z = self.line[w, q, first + ALONG_Y], self.line[w, q, first + ALONG_Z]
            y, z = place[0] - self.line[w, q, first + LINE_Y], place[1] - self.line[w, q, first + LINE_Z]
            across = t_y * z - t_z * y
            if across * across < 4.0 * reach * reach:
                its = ti.cast(0.0, p.real)  # 1 where one of the two is a dummy of this plate
                if own >= 0:
                    its = ti.select(self.plate[own] == q, 1.0, its)
                if other >= 0:
                    its = ti.select(self.plate[other] == q, 1.0, its)
                beyond = t_y * apart[1] - t_z * apart[0]
                least = ti.select(beyond * beyond > 1e-30, beyond, p.ones())
                through = t_y * y + t_z * z + (t_y * apart[0] + t_z * apart[1]) * ((0.0 - across) / least)
                low = (through - self.line[w, q, first + LOW]) * self.line[w, q, first + SHARP_LOW]
                high = (self.line[w, q, first + HIGH] - through) * self.line[w, q, first + SHARP_HIGH]
                deep = ti.max(0.0, ti.min(1.0, ti.min(low, high)))
                hidden = ti.select((beyond + across) * across < 0.0, deep * deep * (3.0 - 2.0 * deep), p.zeros())
                share *= its * hidden + (1.0 - its) * (1.0 - hidden)
        return share

    @ti.func
    def off_ends(self, b, part: ti.template()):
        """1 for the particles of a block that are farther than FAR from all free ends of plates, else 0."""
        p = self.particles
        w, off = b // p.stride, p.ones()
        far = ti.cast(FAR * self.lengths[REACH], p.real)
        for q in range(self.count):
            first = ti.static(OF_LINE * part)
            for n in range(2):
                if self.line[w, q, first + SHARP_LOW + n] * self.lengths[BLUR] < 2.0:
                    way = self.line[w, q, first + LOW + n]
                    y = self.line[w, q, first + LINE_Y] + way * self.line[w, q, first + ALONG_Y]
                    z = self.line[w, q, first + LINE_Z] + way * self.line[w, q, first + ALONG_Z]
                    apart = [p.offset(b, ti.cast(y, p.where), 0), p.offset(b, ti.cast(z, p.where), 1)]
                    off = ti.select(dot(apart, apart) > far * far, off, p.zeros())
        return off
