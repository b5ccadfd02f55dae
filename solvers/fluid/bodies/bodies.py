"""Bodies and plates that move in the water: where their wall particles are, and what they do to it."""

import numpy as np
import taichi as ti

from solvers.fluid.bodies.acceleration import PartAcceleration
from solvers.fluid.bodies.hulls import Hulls
from solvers.fluid.bodies.solids import Solids
from solvers.fluid.bodies.solids_in_space import SolidsInSpace
from solvers.fluid.bodies.visibility import Visibility
from solvers.fluid.given import Water
from solvers.fluid.lists.order import Order
from solvers.fluid.lists.work_ranges import WorkRanges
from solvers.fluid.state import UNUSED, Particles
from solvers.machine.quantity import PLANE, freedoms
from solvers.machine.state import Axis, State, padded, roomy
from solvers.motion.poses import Poses
from solvers.space.axes import dot, named, named_turns, swing, turns
from solvers.tank.pieces import Pieces
from solvers.tank.pose import AT_MIDDLE, AT_START, rotated

USUAL = 4096  # wall particles of bodies for which there is room at least


@ti.data_oriented
class Bodies:
    """The parts in the water of each world: rigid bodies whose motion in the tank is prescribed, or free.

    At a pose (O, θ) in the tank's axes a point that is drawn at p is at O + R(θ) p; it moves at V + ω × R p and is
    accelerated by `PartAcceleration`. Wall particles of bodies follow those of the tank in memory.

    `impulse` (units, parts; N s/m, N s) is what the water did to each part since it was last taken, `work` (units,
    parts; J/m) what the parts have done on the water by the last kick, `power` (units, parts; W/m) in it.
    """

    def __init__(self, arrays: State, pieces: Pieces, water: Water, scene, lanes: int):
        parts = pieces.parts
        self.pieces, self.count, self.lanes, self.worlds = pieces, len(parts), lanes, scene.worlds
        self.exact, self.tanks = arrays.exact, [part.tank for part in parts]
        wet = [scene.fills[part.tank] > 0 and not part.sieve for part in parts]  # others meet grains alone
        self.axes, self.freedoms = scene.axes, len(freedoms(scene.axes))
        solids = Solids if scene.axes == PLANE else SolidsInSpace
        self.solids, self.reach = solids(parts, water, lanes, wet), water.reach
        self.rows = len(self.solids.places)
        self.visibility = Visibility(arrays, parts, water, scene, wet)
        self.hulls = Hulls(arrays, pieces, self.solids, water, USUAL // lanes)
        self.hide = len(self.visibility.plates) + self.hulls.count > 0  # whether they hide particles from each other
        self.fastest, self.moving, self.floats = pieces.fastest, pieces.moving, pieces.floats
        self.acceleration = PartAcceleration(self, water.slip)
        if parts:
            self.pose, self.pull, self.way = pieces.pose, pieces.pull, pieces.way
            self._declare(arrays.under("bodies"))

    def _declare(self, own: State) -> None:
        """Make the arrays."""
        places, self.room = self.solids.places, roomy(self.rows, USUAL // self.lanes)
        room = self.room
        self.rest = [
            own.holding(name, padded(places[..., a], room), "row lane", own.place)
            for a, name in enumerate(named("rest", self.axes))
        ]
        self.along = [
            own.holding(name, padded(self.solids.along[..., a], room), "row lane")
            for a, name in enumerate(named("along", self.axes))
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
            names = *named("impulse", self.axes), *named_turns("impulse_turn", self.axes), "work", "power"
            *self.impulse, self.work, self.power = own.reals(each, *names, kind=own.exact)
            names = *named("force", self.axes), *named_turns("moment", self.axes)
            self.force = own.reals(each, *names, kind=own.exact, kept=False)
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
            self.visibility.note(w, self.pieces.poses)
        if ti.static(self.hulls.openings > 0):
            self.hulls.note(w, t)

    @ti.func
    def place(self, u, part: ti.template()):
        """Place a unit's wall particles of moving parts as they are at a `part` of the step, with their velocities."""
        p = self.particles
        w = self.units.world(u)
        first, end = self.ranges.walls(u)
        for b in range(ti.max(first, w * p.stride + p.fluid_blocks + self.first[0]), end):
            row = self.row(b)
            k, turn = self.owner[row], [ti.cast(0.0, self.exact) for _ in ti.static(range(turns(p.axes)))]
            rotation, rate = self.pose.rotation(w, k, part), self.pose.rate(w, k, part)
            origin, speed = self.pose.origin(w, k, part), self.pose.velocity(w, k, part)
            if ti.static(self.of_tank.moving):
                found = self.of_tank.of_walls(w, AT_MIDDLE)
                for a in ti.static(range(p.axes)):
                    speed[a] = speed[a] + found[a]
                for a in ti.static(range(turns(p.axes))):
                    turn[a] = found[p.axes + a]
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED:
                    arm = rotated(
                        rotation, [ti.cast(self.rest[a][row, lane], self.exact) for a in ti.static(range(p.axes))]
                    )
                    at, v = (
                        [origin[a] + arm[a] for a in ti.static(range(p.axes))],
                        [speed[a] for a in ti.static(range(p.axes))],
                    )
                    swing(rate, arm, v)
                    swing(turn, at, v)
                    for a in ti.static(range(p.axes)):
                        p.place[a][b, lane] = ti.cast(at[a], p.where)
                        p.velocity[a][b, lane] = ti.cast(v[a], p.real)

    @ti.func
    def turn(self, b, vector: ti.template(), part: ti.template()):
        """Turn the vectors of a block of wall particles, as their part is drawn, as it is at a `part` of the step."""
        row = self.row(b)
        if row >= 0:
            found = self.pose.rotation(b // self.particles.stride, self.owner[row], part)
            rotation = [ti.cast(found[n], self.particles.real) for n in ti.static(range(len(found)))]
            turned = rotated(rotation, vector)
            for a in ti.static(range(self.particles.axes)):
                vector[a] = turned[a]

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
        """Add the load of one block of a unit on a part: force (N/m) and moment (N) about the tank's origin."""
        for n in ti.static(range(self.freedoms)):
            self.force[n][u, k] = self.force[n][u, k] + load[n]

    @ti.func
    def borne(self, u, tank):
        """What a unit's parts that stand in a tank bear in all: force (N/m), moment (N), and two zeros."""
        found = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(self.freedoms + 2))])
        if ti.static(self.count > 0):
            for k in range(self.count):
                if self.tank[k] == tank:
                    for n in ti.static(range(self.freedoms)):
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
            load = [self.force[n][u, k] for n in ti.static(range(self.freedoms))]
            if ti.static(self.moving):
                origin, rate = self.pose.origin(w, k, AT_START), self.pose.rate(w, k, AT_START)
                speed = self.pose.velocity(w, k, AT_START)
                swing([0.0 - rate[a] for a in ti.static(range(turns(self.axes)))], origin, speed)
                power = dot([load[a] for a in ti.static(range(self.axes))], speed)
                power += dot([load[self.axes + n] for n in ti.static(range(turns(self.axes)))], rate)
                self.power[u, k] = 0.0 - power
                self.work[u, k] = self.work[u, k] + self.power[u, k] * ti.cast(kick, self.exact)
            for n in ti.static(range(self.freedoms)):
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
