"""Bodies and plates that move in the water: where their wall particles are, and what they do to it."""

import numpy as np
import taichi as ti

from solvers.fluid.bodies.hulls import Hulls
from solvers.fluid.bodies.solids import Solids
from solvers.fluid.bodies.visibility import Visibility
from solvers.fluid.given import Water
from solvers.fluid.lists.order import Order
from solvers.fluid.lists.work_ranges import WorkRanges
from solvers.fluid.state import UNUSED, Particles
from solvers.machine.quantity import freedoms
from solvers.machine.state import Axis, State, padded, roomy
from solvers.motion.poses import AT_START, Poses
from solvers.space.axes import dot
from solvers.tank.pieces import COSINE, NUMBERS, RATE, SINE, V_Y, V_Z, Pieces, Y, Z

USUAL = 4096  # wall particles of bodies for which there is room at least


@ti.data_oriented
class Bodies:
    """The parts in the water of each world: rigid bodies whose motion in the tank is prescribed, or free.

    At a pose (O, θ) in the tank's axes a point that is drawn at p is at O + R(θ) p; it moves at V + ω × R p and is
    accelerated by A + ω' × R p − ω² R p, to which −2 Ω × v comes where the tank itself rolls at Ω. Wall particles of
    bodies follow those of the tank in memory.

    Water that slides freely (`slip`) is accelerated by the part of it across the face before a wall particle alone. A
    free body is taken as one without acceleration over the earth: `FreeBodyCoupling` adds what it has.

    `impulse` (units, parts; N s/m, N s) is what the water did to each part since it was last taken, `work` (units,
    parts; J/m) what the parts have done on the water by the last kick, `power` (units, parts; W/m) in it.
    """

    def __init__(self, arrays: State, pieces: Pieces, water: Water, scene, lanes: int):
        parts = pieces.parts
        self.pieces, self.count, self.lanes, self.worlds = pieces, len(parts), lanes, scene.worlds
        self.exact, self.tanks = arrays.exact, [part.tank for part in parts]
        wet = [scene.fills[part.tank] > 0 and not part.sieve for part in parts]  # others meet grains alone
        self.solids, self.reach = Solids(parts, water, lanes, wet), water.reach
        self.rows = len(self.solids.places)
        self.visibility = Visibility(arrays, parts, water, scene, wet)
        self.hulls = Hulls(arrays, pieces, self.solids, water, USUAL // lanes)
        self.hide = len(self.visibility.plates) + self.hulls.count > 0  # whether they hide particles from each other
        self.fastest, self.moving, self.floats = pieces.fastest, pieces.moving, pieces.floats
        self.slips = water.slip
        if parts:
            self.poses, self.pull, self.way = pieces.poses, pieces.pull, pieces.way
            self._declare(arrays.under("bodies"))

    def _declare(self, own: State) -> None:
        """Make the arrays."""
        places, self.room = self.solids.places, roomy(self.rows, USUAL // self.lanes)
        room = self.room
        self.rest = [
            own.holding(f"rest_{n}", padded(places[..., a], room), "row lane", own.place) for a, n in enumerate("yz")
        ]
        self.along = [
            own.holding(f"along_{n}", padded(self.solids.along[..., a], room), "row lane") for a, n in enumerate("yz")
        ]
        self.radius = own.holding("radius", padded(self.solids.radius, room), "row")
        self.owner = own.holding("owner", padded(self.solids.owner, room), "row", ti.i32)
        self.ends = own.holding("ends", self.solids.ends, "end", ti.i32)
        self.tank = own.holding("tank", np.array(self.tanks), "part", ti.i32)

    def join(self, arrays: State, particles: Particles, order: Order, ranges: WorkRanges, poses: Poses, units) -> None:
        """Take the `particles` among which the wall particles are, and the tank's `poses`; count for these `units`."""
        self.particles, self.order, self.ranges, self.of_tank, self.units = particles, order, ranges, poses, units
        if self.count:
            first = np.array([particles.walls - self.rows])  # of the wall blocks
            self.first = arrays.under("bodies").holding("first", first, "one", ti.i32)
            self.visibility.join(arrays, particles, padded(self.solids.owner, self.room), self.first, order)
            self.hulls.join(arrays, particles, poses, self.first)
            own, each = arrays.under("bodies"), (units.axis, Axis("part", self.count))
            names = "impulse_y", "impulse_z", "impulse_turn", "work", "power"
            *self.impulse, self.work, self.power = own.reals(each, *names, kind=own.exact)
            self.force = own.reals(each, "force_y", "force_z", "moment", kind=own.exact, kept=False)
            (self.elapsed,) = own.reals((units.axis,), "elapsed", kind=own.exact)

    @ti.func
    def row(self, b):
        """The row of a block among the bodies' ones; below zero for any other block."""
        return b % self.particles.stride - (self.particles.fluid_blocks + self.first[0])

    @ti.func
    def note(self, w, t, dt):
        """Note how the parts of a world move in the step of dt (s) from time t (s), unless contacts did."""
        if ti.static(not self.floats):
            self.pieces.note(w, t, dt)
        if ti.static(len(self.visibility.plates) > 0):
            self.visibility.note(w, self.poses)
        if ti.static(self.hulls.openings > 0):
            self.hulls.note(w, t)

    @ti.func
    def place(self, u, part: ti.template()):
        """Place a unit's wall particles of moving parts as they are at a `part` of the step, with their velocities."""
        p, at = self.particles, ti.static(NUMBERS * part)
        w = self.units.world(u)
        first, end = self.ranges.walls(u)
        for b in range(ti.max(first, w * p.stride + p.fluid_blocks + self.first[0]), end):
            row = self.row(b)
            k = self.owner[row]
            cos, sin = self.poses[w, k, at + COSINE], self.poses[w, k, at + SINE]
            rate = self.poses[w, k, at + RATE]
            v_y, v_z, turn = self.poses[w, k, at + V_Y], self.poses[w, k, at + V_Z], ti.cast(0.0, self.exact)
            o_y, o_z = self.poses[w, k, at + Y], self.poses[w, k, at + Z]
            if ti.static(self.of_tank.moving):
                v_y, v_z = v_y + self.of_tank.walls[0][w], v_z + self.of_tank.walls[1][w]
                turn = self.of_tank.walls[2][w]
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED:
                    y, z = ti.cast(self.rest[0][row, lane], self.exact), ti.cast(self.rest[1][row, lane], self.exact)
                    arm_y, arm_z = cos * y - sin * z, sin * y + cos * z
                    p.place[0][b, lane] = ti.cast(o_y + arm_y, p.where)
                    p.place[1][b, lane] = ti.cast(o_z + arm_z, p.where)
                    p.velocity[0][b, lane] = ti.cast(v_y - rate * arm_z - turn * (o_z + arm_z), p.real)
                    p.velocity[1][b, lane] = ti.cast(v_z + rate * arm_y + turn * (o_y + arm_y), p.real)

    @ti.func
    def turn(self, b, vector: ti.template(), part: ti.template()):
        """Turn the vectors of a block of wall particles, as their part is drawn, as it is at a `part` of the step."""
        row = self.row(b)
        if row >= 0:
            w, k, at = b // self.particles.stride, self.owner[row], ti.static(NUMBERS * part)
            cos = ti.cast(self.poses[w, k, at + COSINE], self.particles.real)
            sin = ti.cast(self.poses[w, k, at + SINE], self.particles.real)
            y, z = vector[0], vector[1]
            vector[0], vector[1] = cos * y - sin * z, sin * y + cos * z

    @ti.func
    def hold_back(self, w, b, felt: ti.template()):
        """Take the acceleration of its part in the tank (m/s²) from what its particles in a block feel at the start."""
        p, row = self.particles, self.row(b)
        zero = ti.cast(0.0, self.exact)
        a_y, a_z, up, rate, v_y, v_z, turn, o_y, o_z = zero, zero, zero, zero, zero, zero, zero, zero, zero
        loose = ti.cast(0.0, p.real)  # 1 of a free body
        if row >= 0:
            k = self.owner[row]
            a_y, a_z, up = self.pull[0][w, k], self.pull[1][w, k], self.pull[2][w, k]
            v_y, v_z, rate = self.poses[w, k, V_Y], self.poses[w, k, V_Z], self.poses[w, k, RATE]
            o_y, o_z = self.poses[w, k, Y], self.poses[w, k, Z]
            if ti.static(self.of_tank.rotating):
                turn = 2.0 * self.of_tank.felt[4][w]
            if ti.static(self.floats):
                i = self.pieces.bodies.loose(w, k)
                if i >= 0:
                    loose, turn, rate = 1.0, zero, self.pieces.bodies.rate_over_earth(w, i)
                    o_y, o_z = self.pieces.bodies.place[0][w, i], self.pieces.bodies.place[1][w, i]
                    a_y, a_z = 0.0 - self.of_tank.felt[0][w], 0.0 - self.of_tank.felt[1][w]
        y, z = p.offset(b, ti.cast(o_y, p.where), 0), p.offset(b, ti.cast(o_z, p.where), 1)
        # Variables keep their type, and whole vectors cannot be cast: the factors have the vectors' own.
        of_square, of_up = ti.cast(rate * rate, p.real), ti.cast(up, p.real)
        of_turn, spin = ti.cast(turn, p.real), ti.cast(turn * rate, p.real)
        even_y, even_z = ti.cast(a_y, p.real), ti.cast(a_z, p.real)
        drift_y, drift_z = ti.cast(v_y, p.real), ti.cast(v_z, p.real)
        back = [
            of_up * z + (of_square + spin) * y + (of_turn * drift_z - even_y),
            (of_square + spin) * z - of_up * y - (of_turn * drift_y + even_z),
        ]
        if ti.static(self.floats):
            for a in ti.static(range(p.axes)):
                back[a] = back[a] - loose * felt[a]
        if ti.static(self.slips):
            along = [p.load(self.along[a], ti.max(row, 0)) for a in ti.static(range(p.axes))]
            self.turn(b, along, AT_START)
            slid = dot(back, along)
            for a in ti.static(range(p.axes)):
                back[a] = back[a] - slid * along[a]
        for a in ti.static(range(p.axes)):
            felt[a] += back[a]

    @ti.func
    def note_built(self, u):
        """Note where a unit's wall particles of parts are as its lists are built."""
        p = self.particles
        first, end = self.ranges.walls(u)
        for b in range(ti.max(first, self.units.world(u) * p.stride + p.fluid_blocks + self.first[0]), end):
            for lane in range(p.lanes):
                for a in ti.static(range(p.axes)):
                    p.built[a][b, lane] = p.place[a][b, lane]

    @ti.func
    def gone(self, u):
        """The square (m²) of how far any of a unit's wall particles of parts has gone since then."""
        p = self.particles
        first, end = self.ranges.walls(u)
        farthest = ti.cast(0.0, p.real)
        for b in range(ti.max(first, self.units.world(u) * p.stride + p.fluid_blocks + self.first[0]), end):
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED:
                    way = [ti.cast(p.place[a][b, lane] - p.built[a][b, lane], p.real) for a in ti.static(range(p.axes))]
                    farthest = ti.max(farthest, dot(way, way))
        return farthest

    @ti.func
    def bear(self, u, k, load: ti.template()):
        """Add the load of one block of a unit on a part: force (y, z; N/m) and moment (N) about the tank's origin."""
        for n in ti.static(range(3)):
            self.force[n][u, k] = self.force[n][u, k] + load[n]

    @ti.func
    def borne(self, u, tank):
        """What a unit's parts that stand in a tank bear in all: force (y, z; N/m), moment (N), and two zeros."""
        found = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(5))])
        if ti.static(self.count > 0):
            for k in range(self.count):
                if self.tank[k] == tank:
                    for n in ti.static(range(3)):
                        found[n] += self.force[n][u, k]
        return found

    @ti.func
    def share(self, b, jb, lane, place: ti.template(), apart: ti.template(), part: ti.template()):
        """The share of the particle at `place` in a lane of block jb that each of a block b sees, `apart` from it."""
        share = self.particles.ones()
        if ti.static(len(self.visibility.plates) > 0):
            share *= self.visibility.share(b, jb, place, apart, part)
        if ti.static(self.hulls.count > 0):
            share *= self.hulls.share(b, jb, lane, place, apart)
        return share

    @ti.func
    def end_in(self, part, b):
        """Where the rows of a part end for a block b of water; where they begin if it is in another tank."""
        end = self.ends[part + 1]
        if ti.static(self.order.layers > 1):  # noqa: SIM102 (compiled only where there are several tanks)
            if self.order.layer(b) != self.tank[part]:
                end = self.ends[part]
        return end

    @ti.func
    def book(self, u, kick, dt):
        """Book what a unit's parts bore in a step of dt (s), and the work of their motion in the tank; begin anew."""
        w = self.units.world(u)
        for k in range(self.count):
            load = [self.force[n][u, k] for n in ti.static(range(3))]
            if ti.static(self.moving):
                o_y, o_z, rate = self.poses[w, k, Y], self.poses[w, k, Z], self.poses[w, k, RATE]
                v_y, v_z = self.poses[w, k, V_Y] + rate * o_z, self.poses[w, k, V_Z] - rate * o_y
                self.power[u, k] = 0.0 - dot(load, [v_y, v_z, rate])
                self.work[u, k] = self.work[u, k] + self.power[u, k] * ti.cast(kick, self.exact)
            for n in ti.static(range(3)):
                self.impulse[n][u, k] = self.impulse[n][u, k] + load[n] * ti.cast(dt, self.exact)
                self.force[n][u, k] = 0.0
        self.elapsed[u] = self.elapsed[u] + ti.cast(dt, self.exact)

    def forget(self) -> None:
        """Forget all loads and work, and close the openings of hulls."""
        self.hulls.place()
        if self.count:
            for field in (*self.impulse, *self.force, self.work, self.power, self.elapsed):
                field.fill(0.0)

    def work_until(self, behind: np.ndarray) -> np.ndarray:
        """The work (W, parts) J/m of the parts on the water, by their motion in the tank, up to now.

        The last kick was `behind` (W,) s ago. Without its second half the account is late where a plate hits water: by
        half a step of a power that doubles within two.
        """
        if not self.count:
            return np.zeros((self.worlds, 0))
        return self._of_worlds(self.work) + behind[:, None] * self._of_worlds(self.power)

    def read_and_reset(self, time: float, thickness: float, work: np.ndarray) -> dict[str, np.ndarray]:
        """The mean loads on the parts (W, parts, 3) since they were last taken, which begin anew; their `work` up to a
        `time` (s), and the water in the rooms of hulls then."""
        if not self.count:
            none = np.zeros((self.worlds, 0, len(freedoms(self.particles.axes))))
            return {"part_force": none, "part_work": none[..., 0]}
        impulse = np.stack([self._of_worlds(field) for field in self.impulse], axis=-1)
        elapsed = self.elapsed.to_numpy().reshape(self.worlds, -1)[:, 0]
        for field in (*self.impulse, self.elapsed):
            field.fill(0.0)
        mean = thickness * impulse / np.where(elapsed > 0.0, elapsed, 1.0)[:, None, None]
        rooms = self.hulls.observe(time, thickness)
        return {"part_force": mean, "part_work": thickness * work} | rooms

    def _of_worlds(self, field: ti.Field) -> np.ndarray:
        """Sums over the units of each world (W, parts)."""
        return field.to_numpy().reshape(self.worlds, -1, self.count).sum(axis=1)
