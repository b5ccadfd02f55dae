"""Hulls with rooms: which water is in which room, and which of it meets through the openings."""

import numpy as np
import taichi as ti

from solvers.fluid.bodies.solids import Solids, rooms_of
from solvers.fluid.given import Water
from solvers.fluid.state import UNUSED, Particles
from solvers.machine.state import Axis, State, padded, roomy
from solvers.motion.poses import Poses
from solvers.space.axes import dot
from solvers.tank.parts import Hull, Opening
from solvers.tank.pieces import COSINE, RATE, SINE, V_Y, V_Z, Pieces, Y, Z
from solvers.tank.tank import Tank

A_Y, A_Z, WAY_Y, WAY_Z, SLANT = range(5)  # an edge of a room: where it begins (m), the way to its end, dy/dz
CENTRE_Y, CENTRE_Z, RADIUS, HALF = range(4)  # of a room: a circle that holds it and its wall (m), half its wall
# Of an opening: time (s), its line (m), half the blend of χ, one over the length (m) over which its ends fade
OPENS, START_Y, START_Z, ALONG_Y, ALONG_Z, LENGTH, BLEND, SHARP = range(8)


@ti.data_oriented
class Hulls:
    """χ_r = S(½ − s_r/2b): in which room r a particle of water is, 1 within and 0 without, S(x) = x² (3 − 2x).

    s_r is the signed distance of the middle of the wall, negative in the room, b half the wall: no χ is in between but
    in an opening, where water passes from one room to another. A pair of particles i and j counts with the share
    1 − ½ Σ |χ_ri − χ_rj|, summed over the rooms and what is outside of all. Wall particles stand in two families, one
    behind each face of a wall and each with the χ of the room before it, and go on through the wall and beyond: so the
    wall may be thinner than the kernel's reach (own derivation). Water that sees water through an opening counts
    wholly, and within a smoothing length of its ends in part; so much less count there the wall particles that stand
    beyond the wall, so that all shares are 1 together. All sums have the same shares, and pairs of forces stay equal
    and opposite. Where an opening is, wall particles stand for its cover until it opens.

    Limits: walls of half a spacing at least; the rim of an opening is rounded over the wall's thickness, as each family
    sees there half of the water.
    """

    def __init__(self, arrays: State, pieces: Pieces, solids: Solids, water: Water, spared: int):
        parts = pieces.parts
        self.pieces, self.solids, self.lanes = pieces, solids, solids.places.shape[1]
        rooms = [(k, corners) for k in range(len(parts)) for _, corners in rooms_of(parts, k)]
        self.owners, self.count = [k for k, _ in rooms], len(rooms)
        holes = [(k, *opening) for k, of_part in enumerate(solids.openings) for opening in of_part]
        self.hole_owners, self.openings = [k for k, *_ in holes], len(holes)
        if not rooms:
            return
        self.exact, own = arrays.exact, arrays.under("hulls")
        self.ends = np.cumsum([0, *(len(corners) for _, corners in rooms)]).tolist()
        self.edges = own.holding("edges", np.concatenate([edges(corners) for _, corners in rooms]), "edge number")
        circles = [circle(corners, parts[k].hull.wall) for k, corners in rooms]
        self.circles = own.holding("rooms", np.array(circles), "room number")
        self.rows = roomy(len(solids.places), spared)
        self.used = own.holding("used", np.array([len(solids.places)]), "one", ti.i32)
        self.hole = own.holding("hole", padded(solids.holes, self.rows), "row lane", ti.i32)
        self.beyond = own.holding("beyond", padded(solids.beyond.astype(float), self.rows), "row lane")
        if holes:
            lines = np.array([line(opening, parts[k].hull, water.length) for k, _, opening, _ in holes])
            self.lines = own.holding("openings", lines, "opening number", own.exact)
            (self.open,) = own.integers((Axis("world", pieces.worlds), Axis("opening", len(holes))), "open")

    def join(self, arrays: State, particles: Particles, poses: Poses, first: ti.Field) -> None:
        """Take the `particles` of water, and the tank's `poses`; the wall blocks of parts are those from `first` on."""
        self.particles, self.of_tank, self.first = particles, poses, first
        if self.count:
            p, own = particles, arrays.under("hulls")
            each = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
            self.within = own.wide(each, *(f"within_{r}" for r in range(self.count)))
            sums = Axis("world", p.worlds), Axis("number", self.count + max(1, self.openings))
            (self.sums,) = own.reals(sums, "sums", kind=own.exact, kept=False)

    def place(self) -> None:
        """Say which room each wall particle is seen from, and close all openings."""
        if not self.count:
            return
        p, rows = self.particles, len(self.solids.places)
        begin = p.fluid_blocks + p.walls - rows
        for r, field in enumerate(self.within):
            whole = np.zeros((p.worlds, p.stride, p.lanes))
            whole[:, begin : begin + rows] = self.solids.rooms == r + 1
            field.from_numpy(whole.reshape(-1, p.lanes).astype(np.float64 if p.real is ti.f64 else np.float32))
        if self.openings:
            self.open.fill(0)

    @ti.func
    def note(self, w, t):
        """Take the covers off the openings of a world whose time it is at t (s)."""
        p = self.particles
        for n in range(self.openings):
            if self.open[w, n] == 0:  # noqa: SIM102 (Taichi evaluates both sides of `and`)
                if t >= self.lines[n, OPENS]:
                    self.open[w, n] = 1
                    for row in range(self.used[0]):
                        b = w * p.stride + p.fluid_blocks + self.first[0] + row
                        for lane in range(p.lanes):
                            if self.hole[row, lane] == n + 1:
                                p.volume[b, lane] = 0.0

    @ti.func
    def note_block(self, b):
        """Note in which rooms the water of a block is."""
        p, w = self.particles, b // self.particles.stride
        for r in ti.static(range(self.count)):
            k = ti.static(self.owners[r])
            cos, sin = self.pieces.poses[w, k, COSINE], self.pieces.poses[w, k, SINE]
            o_y, o_z = self.pieces.poses[w, k, Y], self.pieces.poses[w, k, Z]
            y, z = p.offset(b, ti.cast(o_y, p.where), 0), p.offset(b, ti.cast(o_z, p.where), 1)
            c, s = ti.cast(cos, p.real), ti.cast(sin, p.real)
            drawn = [c * y + s * z, c * z - s * y]
            off = [drawn[0] - self.circles[r, CENTRE_Y], drawn[1] - self.circles[r, CENTRE_Z]]
            far, near = self.circles[r, RADIUS], p.zeros()
            near = ti.select(dot(off, off) < far * far, p.ones(), near)
            found = p.zeros()
            if near.sum() > 0.5:
                away = self.distance(r, drawn) - self.circles[r, HALF]
                x = ti.max(0.0, ti.min(1.0, 0.5 - away * (0.5 / self.circles[r, HALF])))
                found = near * (x * x * (3.0 - 2.0 * x))
            p.store(self.within[r], b, found)

    @ti.func
    def distance(self, r: ti.template(), place: ti.template()):
        """The signed distances (m) of places, as drawn, from a room, negative in it."""
        p = self.particles
        square, inside = p.ones() * 1e30, p.zeros()
        for e in range(self.ends[r], self.ends[r + 1]):
            way = [self.edges[e, WAY_Y], self.edges[e, WAY_Z]]
            off = [place[0] - self.edges[e, A_Y], place[1] - self.edges[e, A_Z]]
            share = ti.max(0.0, ti.min(1.0, dot(off, way) * (1.0 / dot(way, way))))
            apart = [off[a] - share * way[a] for a in ti.static(range(p.axes))]
            square = ti.min(square, dot(apart, apart))
            # By the even–odd rule: how often the line from a place to the left crosses an edge.
            ends = ti.select(off[1] > 0.0, p.ones(), p.zeros()) - ti.select(off[1] > way[1], p.ones(), p.zeros())
            crosses = ends * ends * ti.select(off[0] < off[1] * self.edges[e, SLANT], p.ones(), p.zeros())
            inside = inside + crosses - 2.0 * inside * crosses
        return ti.sqrt(square) * (1.0 - 2.0 * inside)

    @ti.func
    def share(self, b, jb, lane, place: ti.template(), apart: ti.template()):
        """With which share the particle at `place` in a lane of block jb meets each of a block b, `apart` from it."""
        p = self.particles
        off, outside = p.zeros(), p.zeros()
        for r in ti.static(range(self.count)):
            other = p.load(self.within[r], b) - self.within[r][jb, lane]
            off += ti.max(other, 0.0 - other)
            outside += other
        hidden = 0.5 * (off + ti.max(outside, 0.0 - outside))
        share = 1.0 - hidden
        if ti.static(self.openings > 0):
            own, other = self.row(b), self.row(jb)
            behind = p.zeros()  # 1 for what stands beyond the wall
            if own >= 0:
                behind += p.load(self.beyond, own)
            if other >= 0:
                behind += self.beyond[other, lane]
            if own >= 0 or other >= 0:
                hidden = behind
            if hidden.sum() > 0.0:
                closed = p.ones()
                for n in ti.static(range(self.openings)):
                    closed *= 1.0 - self.through(n, b // p.stride, place, apart, p.zeros(), p.ones())
                if own >= 0 or other >= 0:
                    share *= 1.0 - behind * (1.0 - closed)
                else:
                    share = 1.0 - hidden * closed
        return share

    @ti.func
    def row(self, b):
        """The row of a block among the bodies' wall blocks; below zero for any other block."""
        p = self.particles
        return b % p.stride - (p.fluid_blocks + self.first[0])

    @ti.func
    def through(self, n: ti.template(), w, place: ti.template(), apart: ti.template(), none, all_of):
        """Whether lines from a place to others, `apart` from it, lead through the wall in an opening, 0 to 1.

        It is 1 within, and fades over a smoothing length from the ends of the opening on, in the wall. A line that
        comes no nearer to the middle of the wall than half the wall does not lead through it here. `none` and `all_of`
        are 0 and 1 for each of the others.
        """
        p, k = self.particles, ti.static(self.hole_owners[n])
        found = none
        if self.open[w, n] == 1:
            c = ti.cast(self.pieces.poses[w, k, COSINE], p.real)
            s = ti.cast(self.pieces.poses[w, k, SINE], p.real)
            t = [ti.cast(self.lines[n, ALONG_Y], p.real), ti.cast(self.lines[n, ALONG_Z], p.real)]
            along = [c * t[0] - s * t[1], s * t[0] + c * t[1]]
            o = [ti.cast(self.pieces.poses[w, k, Y + a], p.real) for a in ti.static(range(2))]
            start = [ti.cast(self.lines[n, START_Y], p.real), ti.cast(self.lines[n, START_Z], p.real)]
            off = [place[0] - o[0] - (c * start[0] - s * start[1]), place[1] - o[1] - (s * start[0] + c * start[1])]
            beyond = apart[1] * along[0] - apart[0] * along[1]
            across = off[1] * along[0] - off[0] * along[1]
            least = ti.select(beyond * beyond > 1e-30, beyond, all_of)
            share = ti.max(0.0, ti.min(1.0, (0.0 - across) / least))
            way = dot(off, along) + share * dot(apart, along)
            sharp, length = ti.cast(self.lines[n, SHARP], p.real), ti.cast(self.lines[n, LENGTH], p.real)
            deep = ti.max(0.0, ti.min(1.0, ti.min(way, length - way) * sharp + 1.0))
            off_middle, half = across + share * beyond, ti.cast(self.lines[n, BLEND], p.real)
            near = ti.select(off_middle * off_middle < half * half, all_of, none)
            found = near * (deep * deep * (3.0 - 2.0 * deep))
        return found

    @ti.kernel
    def sum_up(self, time: ti.f64):
        """Sum the mass (kg/m) of water in each room, and what flows (kg/(m s)) through each opening into its room."""
        for w in range(self.particles.worlds):
            self.pieces.note(w, time, 0.0)
            self.sum_world(w)

    @ti.func
    def sum_world(self, w):
        p = self.particles
        total = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(self.count + max(1, self.openings)))])
        for b in range(w * p.stride, w * p.stride + p.used[w]):
            self.note_block(b)
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED:
                    mass = ti.cast(p.mass[b, lane], self.exact)
                    for r in ti.static(range(self.count)):
                        total[r] += mass * ti.cast(self.within[r][b, lane], self.exact)
                    for n in ti.static(range(self.openings)):
                        total[self.count + n] += mass * self.flow(w, n, b, lane)
        for k in ti.static(range(self.count + max(1, self.openings))):
            self.sums[w, k] = total[k]

    @ti.func
    def flow(self, w, n: ti.template(), b, lane):
        """The speed (m/s) of a particle through an opening, over the length (m) of the passage; 0 outside of it."""
        p, k = self.particles, ti.static(self.hole_owners[n])
        cos, sin = self.pieces.poses[w, k, COSINE], self.pieces.poses[w, k, SINE]
        y = ti.cast(p.place[0][b, lane], self.exact) - self.pieces.poses[w, k, Y]
        z = ti.cast(p.place[1][b, lane], self.exact) - self.pieces.poses[w, k, Z]
        off = [cos * y + sin * z - self.lines[n, START_Y], cos * z - sin * y - self.lines[n, START_Z]]
        along = [self.lines[n, ALONG_Y], self.lines[n, ALONG_Z]]
        way, across = dot(off, along), off[1] * along[0] - off[0] * along[1]
        found = ti.cast(0.0, self.exact)
        if 0.0 < way < self.lines[n, LENGTH] and -self.lines[n, BLEND] < across < self.lines[n, BLEND]:
            tank = self.tank_speed(w, y + self.pieces.poses[w, k, Y], z + self.pieces.poses[w, k, Z])
            rate = self.pieces.poses[w, k, RATE]
            u_y = ti.cast(p.velocity[0][b, lane], self.exact) - tank[0] - (self.pieces.poses[w, k, V_Y] - rate * z)
            u_z = ti.cast(p.velocity[1][b, lane], self.exact) - tank[1] - (self.pieces.poses[w, k, V_Z] + rate * y)
            own = [cos * u_y + sin * u_z, cos * u_z - sin * u_y]
            found = (own[1] * along[0] - own[0] * along[1]) / (2.0 * self.lines[n, BLEND])
        return found

    @ti.func
    def tank_speed(self, w, y, z):
        """The velocity (m/s) of the tank's wall at a place, in its axes."""
        found = [ti.cast(0.0, self.exact), ti.cast(0.0, self.exact)]
        if ti.static(self.of_tank.moving):
            rate = self.of_tank.walls[5][w]
            found[0] += self.of_tank.walls[3][w] - rate * z
            found[1] += self.of_tank.walls[4][w] + rate * y
        return found

    def observe(self, time: float, thickness: float) -> dict[str, np.ndarray]:
        """The mass (W, rooms) kg of water in each room of a slab, and the flow (W, openings) kg/s into each opening."""
        if not self.count:
            return {}
        self.sum_up(time)
        sums = thickness * self.sums.to_numpy().astype(float)
        flows = {"opening_flow": sums[:, self.count :]} if self.openings else {}
        return {"room_water": sums[:, : self.count], **flows}


def edges(corners: np.ndarray) -> np.ndarray:
    """The edges (m, 5) of a room."""
    way = np.roll(corners, -1, axis=0) - corners
    level = way[:, 1] == 0.0
    slant = np.where(level, 0.0, way[:, 0] / np.where(level, 1.0, way[:, 1]))
    return np.column_stack([corners, way, slant])


def circle(corners: np.ndarray, wall: float) -> list[float]:
    """The numbers of a room: a circle that holds it and its wall, and half of that."""
    centre = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    radius = float(np.linalg.norm(corners - centre, axis=1).max()) + wall
    return [*centre.tolist(), radius, 0.5 * wall]


def line(opening: Opening, hull: Hull, fades: float) -> list[float]:
    """The numbers of an opening. Its line runs so that the room behind it, the later one of two, is on the left."""
    start, end = np.array(opening.ends)
    length = float(np.hypot(*(end - start)))
    along = (end - start) / length
    middle, across = 0.5 * (start + end), hull.wall * np.array([-along[1], along[0]])
    left, right = (
        max((k for k, room in enumerate(hull.rooms) if Tank(np.array(room), 1.0).holds(side[None])[0]), default=-1)
        for side in (middle + across, middle - across)
    )
    if left < right:
        start, along = end, -along
    return [opening.opens, *start.tolist(), *along.tolist(), length, 0.5 * hull.wall, 1.0 / fades]
