"""Hulls with rooms: which water is in which room, and which of it meets through the openings."""

import numpy as np
import taichi as ti

from solvers.fluid.bodies.hull_tables import (
    A_Y,
    A_Z,
    BLEND,
    CENTRE,
    HALF,
    OPENS,
    PLACE,
    RADIUS,
    SHARP,
    SLANT,
    WAY_Y,
    WAY_Z,
    WIDE,
    circle,
    edges,
    hole,
)
from solvers.fluid.bodies.solids import Solids, rooms_of
from solvers.fluid.given import Water
from solvers.fluid.state import UNUSED, Particles
from solvers.machine.quantity import PLANE
from solvers.machine.state import Axis, State, padded, roomy
from solvers.motion.poses import Poses
from solvers.space.axes import dot, swing, turns
from solvers.tank.pieces import Pieces
from solvers.tank.pose import AT_START, rotated, turned_back
from solvers.tank.shapes import PrismShape


@ti.data_oriented
class Hulls:
    """χ_r = S(½ − s_r/2b): in which room r a particle of water is, 1 within and 0 without, S(x) = x² (3 − 2x).

    s_r is the signed distance of the middle of the wall, negative in the room, b half the wall: no χ is in between but
    in an opening, where water passes from one room to another. A pair of particles i and j counts with the share
    1 − ½ Σ |χ_ri − χ_rj|, summed over the rooms and what is outside of all. Wall particles stand in two families, one
    behind each face of a wall and each with the χ of the room before it, and go on through the wall and beyond: so the
    wall may be thinner than the kernel's reach (own derivation). Water that sees water through an opening counts
    wholly, and within a smoothing length of its rim in part; so much less count there the wall particles that stand
    beyond the wall, so that all shares are 1 together. All sums have the same shares, and pairs of forces stay equal
    and opposite. Where an opening is, wall particles stand for its cover until it opens. In space rooms are prisms
    along x, and openings are round.

    Limits: walls of half a spacing at least; the rim of an opening is rounded over the wall's thickness, as each family
    sees there half of the water.
    """

    def __init__(self, arrays: State, pieces: Pieces, solids: Solids, water: Water, spared: int):
        parts = pieces.parts
        self.pieces, self.solids, self.lanes, self.axes = pieces, solids, solids.places.shape[1], pieces.axes
        rooms = [(k, room) for k in range(len(parts)) for _, room in rooms_of(parts, k)]
        self.owners, self.count = [k for k, _ in rooms], len(rooms)
        holes = [(k, *opening) for k, of_part in enumerate(solids.openings) for opening in of_part]
        self.hole_owners, self.openings = [k for k, *_ in holes], len(holes)
        if not rooms:
            return
        self.exact, own = arrays.exact, arrays.under("hulls")
        sections = [room.polygon if isinstance(room, PrismShape) else room for _, room in rooms]
        self.ends = np.cumsum([0, *(len(corners) for corners in sections)]).tolist()
        self.edges = own.holding("edges", np.concatenate([edges(corners) for corners in sections]), "edge number")
        circles = [circle(room, parts[k].hull.wall) for k, room in rooms]
        self.circles = own.holding("rooms", np.array(circles), "room number")
        self.rows = roomy(len(solids.places), spared)
        self.used = own.holding("used", np.array([len(solids.places)]), "one", ti.i32)
        self.hole = own.holding("hole", padded(solids.holes, self.rows), "row lane", ti.i32)
        self.beyond = own.holding("beyond", padded(solids.beyond.astype(float), self.rows), "row lane")
        if holes:
            numbers = [hole(opening, parts[k].hull, water.length, self.axes) for k, _, opening, _ in holes]
            self.holes = own.holding("openings", np.array(numbers), "opening number", own.exact)
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
                if t >= self.holes[n, OPENS]:
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
            drawn = self.drawn(w, k, b)
            off = [drawn[a] - self.circles[r, CENTRE + a] for a in ti.static(range(self.axes))]
            far, near = self.circles[r, RADIUS], p.zeros()
            near = ti.select(dot(off, off) < far * far, p.ones(), near)
            found = p.zeros()
            if near.sum() > 0.5:
                away = self.distance(r, drawn) - self.circles[r, HALF]
                x = ti.max(0.0, ti.min(1.0, 0.5 - away * (0.5 / self.circles[r, HALF])))
                found = near * (x * x * (3.0 - 2.0 * x))
            p.store(self.within[r], b, found)

    @ti.func
    def drawn(self, w, k: ti.template(), b):
        """Where the particles of a block are (m), as part k is drawn."""
        p, origin = self.particles, self.pieces.pose.origin(w, k, AT_START)
        off = [p.offset(b, ti.cast(origin[a], p.where), a) for a in ti.static(range(self.axes))]
        return turned_back(self.rotation(w, k), off)

    @ti.func
    def rotation(self, w, k: ti.template()):
        """How part k is turned as the step begins, in the numbers of the particles."""
        found = self.pieces.pose.rotation(w, k, AT_START)
        return [ti.cast(found[n], self.particles.real) for n in ti.static(range(len(found)))]

    @ti.func
    def distance(self, r: ti.template(), place: ti.template()):
        """The signed distances (m) of places, as drawn, from a room, negative in it."""
        p = self.particles
        square, inside = p.ones() * 1e30, p.zeros()
        for e in range(self.ends[r], self.ends[r + 1]):
            way = [self.edges[e, WAY_Y], self.edges[e, WAY_Z]]
            off = [place[0] - self.edges[e, A_Y], place[1] - self.edges[e, A_Z]]
            share = ti.max(0.0, ti.min(1.0, dot(off, way) * (1.0 / dot(way, way))))
            apart = [off[a] - share * way[a] for a in ti.static(range(PLANE))]
            square = ti.min(square, dot(apart, apart))
            # By the even–odd rule: how often the line from a place to the left crosses an edge.
            ends = ti.select(off[1] > 0.0, p.ones(), p.zeros()) - ti.select(off[1] > way[1], p.ones(), p.zeros())
            crosses = ends * ends * ti.select(off[0] < off[1] * self.edges[e, SLANT], p.ones(), p.zeros())
            inside = inside + crosses - 2.0 * inside * crosses
        found = ti.sqrt(square) * (1.0 - 2.0 * inside)
        if ti.static(self.axes > PLANE):  # a prism's, of that of its section and of its ends
            off = place[PLANE] - self.circles[r, CENTRE + self.axes + 1]
            beyond = ti.max(off, 0.0 - off) - self.circles[r, CENTRE + self.axes]
            out = [ti.max(found, 0.0), ti.max(beyond, 0.0)]
            found = ti.sqrt(dot(out, out)) + ti.min(ti.max(found, beyond), 0.0)
        return found

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
            rotation, origin = self.rotation(w, k), self.pieces.pose.origin(w, k, AT_START)
            normal, middle = rotated(rotation, self.of_hole(n, self.axes)), rotated(rotation, self.of_hole(n, 0))
            off = [place[a] - ti.cast(origin[a], p.real) - middle[a] for a in ti.static(range(self.axes))]
            beyond, across = dot(apart, normal), dot(off, normal)
            least = ti.select(beyond * beyond > 1e-30, beyond, all_of)
            share = ti.max(0.0, ti.min(1.0, (0.0 - across) / least))
            off_middle = across + share * beyond
            aside = [off[a] + share * apart[a] - off_middle * normal[a] for a in ti.static(range(self.axes))]
            inside = ti.cast(self.holes[n, WIDE], p.real) - ti.sqrt(dot(aside, aside))  # of the rim
            deep = ti.max(0.0, ti.min(1.0, inside * ti.cast(self.holes[n, SHARP], p.real) + 1.0))
            half = ti.cast(self.holes[n, BLEND], p.real)
            near = ti.select(off_middle * off_middle < half * half, all_of, none)
            found = near * (deep * deep * (3.0 - 2.0 * deep))
        return found

    @ti.func
    def of_hole(self, n: ti.template(), first: ti.template()):
        """The middle (m) of an opening as drawn (first: 0), or the normal of the wall there (first: the axes)."""
        return [ti.cast(self.holes[n, PLACE + first + a], self.particles.real) for a in ti.static(range(self.axes))]

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
        p, k, pose = self.particles, ti.static(self.hole_owners[n]), self.pieces.pose
        rotation, origin = pose.rotation(w, k, AT_START), pose.origin(w, k, AT_START)
        at = [ti.cast(p.place[a][b, lane], self.exact) for a in ti.static(range(self.axes))]
        arm = [at[a] - origin[a] for a in ti.static(range(self.axes))]
        drawn, found = turned_back(rotation, arm), ti.cast(0.0, self.exact)
        off = [drawn[a] - self.holes[n, PLACE + a] for a in ti.static(range(self.axes))]
        normal = [self.holes[n, PLACE + self.axes + a] for a in ti.static(range(self.axes))]
        across = dot(off, normal)
        aside = [off[a] - across * normal[a] for a in ti.static(range(self.axes))]
        inside = dot(aside, aside) < self.holes[n, WIDE] * self.holes[n, WIDE]
        if inside and -self.holes[n, BLEND] < across < self.holes[n, BLEND]:
            speed, tank = pose.velocity(w, k, AT_START), self.tank_speed(w, at)
            swing(pose.rate(w, k, AT_START), arm, speed)
            u = [ti.cast(p.velocity[a][b, lane], self.exact) - tank[a] - speed[a] for a in ti.static(range(self.axes))]
            found = dot(turned_back(rotation, u), normal) / (2.0 * self.holes[n, BLEND])
        return found

    @ti.func
    def tank_speed(self, w, at: ti.template()):
        """The velocity (m/s) of the tank's wall at a place, in its axes."""
        found = [ti.cast(0.0, self.exact) for _ in ti.static(range(self.axes))]
        if ti.static(self.of_tank.moving):
            walls = self.of_tank.of_walls(w, AT_START)
            for a in ti.static(range(self.axes)):
                found[a] += walls[a]
            swing([walls[self.axes + k] for k in ti.static(range(turns(self.axes)))], at, found)
        return found

    def observe(self, time: float, thickness: float) -> dict[str, np.ndarray]:
        """The mass (W, rooms) kg of water in each room of a slab, and the flow (W, openings) kg/s into each opening."""
        if not self.count:
            return {}
        self.sum_up(time)
        sums = thickness * self.sums.to_numpy().astype(float)
        flows = {"opening_flow": sums[:, self.count :]} if self.openings else {}
        return {"room_water": sums[:, : self.count], **flows}
