"""Water that enters a ship: particles that wait, and enter a room as the flow through its opening asks for them."""

from itertools import accumulate

import numpy as np
import taichi as ti

from solvers.fluid.inflow.heads import Heads
from solvers.fluid.inflow.places import Places
from solvers.fluid.inflow.rooms import Rooms
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.lists.neighbours import NEVER
from solvers.fluid.state import FAR, UNUSED
from solvers.fluid.state import ROOM as USUAL
from solvers.machine.errors import Unavailable
from solvers.machine.state import Axis, State, roomy
from solvers.motion.frame import turned


@ti.data_oriented
class Inflow:
    """Water enters through openings of a ship's hull: Q dt of each is summed up, and a particle enters when it is due.

    The flow is that of `Heads`. Particles that wait are in no block; each room has a stack of their numbers, from which
    those that enter are taken and to which those that leave go back. They enter as the lists are rebuilt, which a
    particle that is due asks for: in the opening's mouth, half a spacing from the wall, spread over its length as the
    flow is, with the speed of the jet, √(2 g Δh), square to the wall and in the ship's axes. Where the room's level is
    over the mouth they are laid on the water, anywhere across the room, and move as it does: its level rises everywhere
    at once, and the jet under water, with its momentum, is left out. What finds no place waits for the next step and is
    not lost. Where the level in a room is higher than the sea's the particle nearest to the mouth leaves.

    In a hold of grains its level is that of water with all of them immersed.

    The weight and the impact of this water load the ship by her walls, as those of any water. Of the hull outside
    nothing changes: she is buoyant as if closed (added weight), and that the pressure is missing over an opening's area
    is left out. She has sunk when what has entered is more than her reserve buoyancy. Momentum and energy that
    particles bring are the sea's; the energy is accounted (`brought`, J on a slab 1 m thick).

    `due` (W, K) particles by each opening, `entered` (W, K) those that have entered less those that have left, `left`
    (W, tanks) those that wait, with their numbers in `stack`; `rate` (W, K) m³/s.
    """

    def __init__(self, arrays: State, scene, context: FluidContext, carrier):
        fluid, tanks, self.units = scene.fluid, scene.tanks, context.units
        self.particles, self.lists, self.order = context.particles, context.lists, context.lists.order
        self.constants, self.carrier = context.constants, carrier
        self.unknown = [self.particles.eigenvalue, *self.particles.noted]  # of a particle that has just entered
        self.order.let_in(self)
        if self.units.single:
            raise Unavailable('inflow: is computed world by world; set run.arch = "cpu" and run.schedule = "auto".')
        self.count, worlds, exact = len(fluid.inlets), context.particles.worlds, arrays.exact
        outlines = [tank.outline for tank in tanks]
        own = arrays.under("water.inflow")
        self.rooms = Rooms(own, outlines)
        self.heads = Heads(own, fluid.inlets, carrier, worlds)
        self.places = Places(arrays, fluid.inlets, outlines, context, self.rooms, self.heads)
        self.exact, self.volume = exact, fluid.water.spacing**2  # m², of a particle
        share = [one.along / scene.vessels[0].length for one in fluid.inlets]
        self.share = own.holding("share", np.array(share), "inlet", exact)
        self.lengths = np.array([one.along for one in fluid.inlets])
        self.waiting, self.fills = np.array(fluid.waiting), np.array(fluid.fills(len(tanks)))
        self.first = own.holding("first", np.array([0, *accumulate(self.fills)][:-1]), "room", ti.i32)
        self.waited = own.holding("waited", self.waiting, "room", ti.i32)
        self.most = own.holding("most", self.fills, "room", ti.i32)
        filled = fluid.areas(len(tanks))  # m², in each tank at the start
        if scene.mixture:
            filled[:, scene.hold] += scene.grains.solid / tanks[scene.hold].thickness
        self.still = own.holding("still", filled, "world room", exact)
        world, inlet, room = Axis("world", worlds), Axis("inlet", self.count), Axis("room", len(tanks))
        self.due, self.rate = own.reals((world, inlet), "due", "rate", kind=exact)
        (self.entered,) = own.integers((world, inlet), "entered")
        (self.left,) = own.integers((world, room), "left")
        (self.stack,) = own.integers((world, Axis("particle", roomy(fluid.count, USUAL))), "stack")
        self.brought, self.clock = own.reals((world,), "brought", "clock", kind=exact)

    def forget(self) -> None:
        """Nothing has entered yet."""
        for field in (self.due, self.rate, self.entered, self.places.turns, self.brought, self.clock):
            field.fill(0)
        worlds, stack = self.particles.worlds, np.zeros(self.stack.shape[1], dtype=np.int32)
        for end, fill, wait in zip(np.cumsum(self.fills), self.fills, self.waiting, strict=True):
            stack[end - fill : end - fill + wait] = np.arange(end - 1, end - 1 - wait, -1)
        self.left.from_numpy(np.tile(self.waiting, (worlds, 1)).astype(np.int32))
        self.stack.from_numpy(np.tile(stack, (worlds, 1)))

    def read(self, thickness: float) -> dict[str, np.ndarray]:
        """The quantities of every world, for tanks of a `thickness` (m)."""
        return {
            "inflow_volume": self.entered.to_numpy() * self.volume * self.lengths,
            "inflow_rate": self.rate.to_numpy() * self.lengths,
            "inflow_energy": self.brought.to_numpy() * thickness,
        }

    @ti.func
    def note(self, w, t):
        """Note when the step begins."""
        self.clock[w] = ti.cast(t, self.exact)

    @ti.func
    def flow(self, w, frame, kick, dt):
        """Sum up the flow of a step of dt (s) that ends now; lists are rebuilt where a particle is due."""
        self.clock[w] = self.clock[w] + ti.cast(dt, self.exact)
        pose, beds_settle = self.carrier.kinematics(w, self.clock[w]), self.clock[w] < 0.0
        asks = 0
        for k in range(self.count):
            room = self.heads.room[k]
            self.heads.look(w, k, pose, self.clock[w], self.rooms.level(room, pose, self.area(w, room)))
            rate = self.heads.flow(w, k)
            if beds_settle:
                rate = 0.0
            if (self.left[w, room] == 0 and rate > 0.0) or (self.left[w, room] == self.most[room] and rate < 0.0):
                rate = 0.0  # the room is full, or empty
            self.rate[w, k] = rate
            self.due[w, k] = self.due[w, k] + self.rate[w, k] * ti.cast(dt, self.exact) / self.cell()
            if ti.abs(self.due[w, k]) >= 1.0:
                asks = 1
        self.carrier.bear_water(w, self.aboard(w), self.clock[w])
        if asks > 0:
            self.lists.displacement[w * self.units.a_world] = NEVER
        return True

    @ti.func
    def cell(self):
        """Volume (m²) of a particle that enters."""
        return self.places.spacing() * self.places.spacing()

    @ti.func
    def area(self, w, room):
        """Area (m²) of the water in a room."""
        return self.still[w, room] + self.cell() * (self.waited[room] - self.left[w, room])

    @ti.func
    def aboard(self, w):
        """Mass of the water that has entered, per metre of the ship (kg/m)."""
        mass = ti.cast(0.0, self.exact)
        for k in range(self.count):
            mass += self.share[k] * self.entered[w, k]
        return mass * ti.cast(self.constants.get("density"), self.exact) * self.cell()

    @ti.func
    def admit(self, w):
        """Let all that is due in a world enter or leave, before its particles are sorted and its lists rebuilt."""
        p, new = self.particles, 0
        for k in range(self.count):
            room, going = self.heads.room[k], True
            while going and self.due[w, k] >= 1.0 and self.left[w, room] > 0:
                block = p.used[w] + new // p.lanes
                going = block < p.fluid_blocks
                if going:
                    going = self.places.find(w, k, self.clock[w], new)
                if going:
                    self.enter(w, k, w * p.stride + block, new % p.lanes)
                    new += 1
        if new > 0:
            p.used[w] = p.used[w] + (new + p.lanes - 1) // p.lanes
        for k in range(self.count):
            going = True
            while going and self.due[w, k] <= -1.0:
                going = self.leave(w, k)

    @ti.func
    def enter(self, w, k, b, lane):
        """Put the next particle that waits at the noted place, in a lane that is not in use."""
        p, room, motion = self.particles, self.heads.room[k], self.carrier.kinematics(w, self.clock[w])
        y, z, speed_y, speed_z = (
            self.places.spot[w, 0],
            self.places.spot[w, 1],
            self.places.spot[w, 2],
            self.places.spot[w, 3],
        )
        mass = ti.cast(self.constants.get("density"), self.exact) * self.cell()
        self.left[w, room] = self.left[w, room] - 1
        p.place[0][b, lane], p.place[1][b, lane] = ti.cast(y, p.where), ti.cast(z, p.where)
        p.velocity[0][b, lane], p.velocity[1][b, lane] = ti.cast(speed_y, p.real), ti.cast(speed_z, p.real)
        p.deviation[b, lane], p.mass[b, lane] = ti.cast(0.0, p.real), ti.cast(mass, p.real)
        for field in ti.static(self.unknown):
            field[b, lane] = ti.cast(0.0, p.real)
        p.number[b, lane] = self.stack[w, self.first[room] + self.left[w, room]]
        self.pass_by(w, k, 1, mass * (0.5 * (speed_y * speed_y + speed_z * speed_z) + self.lifted(motion, y, z)))

    @ti.func
    def pass_by(self, w, k, way, energy):
        """Count a particle with an energy (J on a slab of 1 m) that passes an opening, 1 in or −1 out."""
        weight = ti.cast(1.0, self.exact)
        if ti.static(self.order.layers > 1):
            weight = self.order.weights[self.heads.room[k]]
        self.due[w, k] = self.due[w, k] - way
        self.entered[w, k] = self.entered[w, k] + way
        self.brought[w] = self.brought[w] + way * weight * energy

    @ti.func
    def lifted(self, motion: ti.template(), y, z):
        """g times the height (m) of a place over the earth's origin."""
        return self.carrier.gravity[0] * (motion[1] + turned(y, z, motion[2])[1])

    @ti.func
    def leave(self, w, k):
        """Take the particle of a room that is nearest to an opening's mouth out of it; returns whether there is one."""
        p, room, motion = self.particles, self.heads.room[k], self.carrier.kinematics(w, self.clock[w])
        self.places.stand_at(w, k, self.heads.place(w, k, self.places.next(w, k), -1.0))
        nearest, found = ti.cast(1e6, self.exact), -1
        for slot in range(self.places.first_slot(w), self.places.end_slot(w, 0)):
            if self.places.is_in(slot // p.lanes, slot % p.lanes, room):
                y = ti.cast(p.place[0][slot // p.lanes, slot % p.lanes], self.exact) - self.places.spot[w, 0]
                z = ti.cast(p.place[1][slot // p.lanes, slot % p.lanes], self.exact) - self.places.spot[w, 1]
                if y * y + z * z < nearest:
                    nearest, found = y * y + z * z, slot
        goes = found >= 0 and self.left[w, room] < self.most[room]
        if goes:
            b, lane = found // p.lanes, found % p.lanes
            self.stack[w, self.first[room] + self.left[w, room]] = p.number[b, lane]
            self.left[w, room] = self.left[w, room] + 1
            u = [ti.cast(p.velocity[a][b, lane], self.exact) for a in ti.static(range(p.axes))]
            r = [ti.cast(p.place[a][b, lane], self.exact) for a in ti.static(range(p.axes))]
            s, m = ti.cast(p.deviation[b, lane], self.exact), ti.cast(p.mass[b, lane], self.exact)
            sound = ti.cast(self.constants.get("stiffness") / self.constants.get("density"), self.exact)
            held = 0.5 * (u[0] * u[0] + u[1] * u[1]) + self.lifted(motion, r[0], r[1])
            self.pass_by(w, k, -1, m * (held + sound * self.constants.state.energy(s)))
            p.number[b, lane], p.mass[b, lane] = UNUSED, ti.cast(0.0, p.real)
            for a in ti.static(range(p.axes)):
                p.place[a][b, lane], p.velocity[a][b, lane] = ti.cast(FAR, p.where), ti.cast(0.0, p.real)
            p.deviation[b, lane] = ti.cast(0.0, p.real)
        return goes
