"""Water in a ship's rooms that stands level at once, and what enters them through openings, without particles."""

from dataclasses import replace

import numpy as np
import taichi as ti

from solvers.fluid.inflow import quantities as of_inflow
from solvers.fluid.inflow.heads import Heads
from solvers.fluid.inflow.rooms import Rooms
from solvers.liquid.liquid import Liquid
from solvers.liquid.marks import marks_in
from solvers.machine.phase import Phase
from solvers.machine.state import Axis, Scope
from solvers.tank.context import Context
from solvers.tank.outline import moments


@ti.data_oriented
class LevelMatter(Liquid):
    """Water of the volume V in each room, level at any heel: a point mass ρ V at the centroid r of what it fills.

    With b the body force per mass at r, g and the tank's acceleration there,

        force = ρ V b,   moment = ρ V (y b_z − z b_y),   dV/dt = Σ Q,

    added weight, lumped at the water's centre (as in Acanfora, Begovic & De Luca 2019, J. Mar. Sci. Eng. 7, 111, whose
    surface has a slope of its own; here it is horizontal), Q by `Heads`, explicit in time. So the mass takes part in
    sway, heave and, at its lever, in roll; it has no moment of inertia about its own centre, since a level surface does
    not turn with the ship. That r moves in the room as she heels has no inertia either (own choice): taken along by the
    level, a thin layer would have a boundless one, that of a mass at its metacentre, ρ V (l²/12d)² for a depth d. What
    enters has her speed at once. Walls reach round the whole outline, and nothing spills. Nothing flows while beds
    settle, at times below zero. No energies are known, as of other water without particles.

    Limits: for motions slow beside the room's first wave; no sloshing, and no wave runs ahead of the level.

    `area` (W, R) m² is V per metre of each room that may have water, R of them; `entered` (W, K) m² what has come in by
    each opening, less what has left, and `rate` (W, K) m²/s.
    """

    def __init__(self, scene, context: Context):
        super().__init__(scene, context)
        fluid, tanks, worlds = scene.fluid, scene.tanks, context.worlds
        areas, self.inlets, self.openings = fluid.areas(len(tanks)), fluid.inlets, len(fluid.inlets)
        led = {inlet.room for inlet in fluid.inlets}
        self.numbers = [number for number in range(len(tanks)) if areas[:, number].any() or number in led]
        self.outlines = [tanks[number].outline for number in self.numbers]
        self.start, self.count = areas[:, self.numbers], len(self.numbers)
        own = context.arrays.under("liquid")
        self.piece = own.holding("piece", np.array(self.numbers), "room", ti.i32)
        self.dense = own.holding("dense", self.water.density * np.array([1.0, self.thickness]), "number", own.exact)
        self.rooms = Rooms(own, self.outlines)
        world, room = Axis("world", worlds), Axis("room", self.count)
        (self.area,) = own.reals((world, room), "area", kind=own.exact)
        self.level, self.y, self.z = own.reals((world, room), "level", "y", "z", kind=own.exact, kept=False)
        (self.turn,) = own.reals((world,), "turn", kind=own.exact, kept=False)
        if self.inlets:
            self._open(own.under("inflow"), scene, worlds)
        self.before, self.after = (Phase(self.push),), (Phase(self.follow),)

    def _open(self, own: Scope, scene, worlds: int) -> None:
        """Declare what belongs to openings."""
        inlets = [replace(one, room=self.numbers.index(one.room)) for one in self.inlets]
        self.heads = Heads(own, inlets, self.carrier, worlds)
        share = [one.along / scene.vessels[0].length for one in inlets]
        self.share = own.holding("share", np.array(share), "inlet", own.exact)
        full = [moments(outline)[0] for outline in self.outlines]
        self.full = own.holding("full", np.array(full), "room", own.exact)
        self.lengths = np.array([one.along for one in inlets])
        each = Axis("world", worlds), Axis("inlet", len(inlets))
        self.entered, self.rate = own.reals(each, "entered", "rate", kind=own.exact)

    @ti.func
    def push(self, u, t, kick, dt):
        """The load of the water on tanks that are not accelerated, and its added mass; then what flows in and out."""
        self.load.begin(u)
        w = self.units.world(u)
        motion = self.carrier.kinematics(w, t)
        self.stand(w, motion)
        g, square = self.carrier.gravity[0], motion[5] * motion[5]
        self.pull[0][w], self.pull[1][w] = 0.0 - g * ti.sin(motion[2]), 0.0 - g * ti.cos(motion[2])
        for k in range(self.count):
            y, z = self.y[w, k], self.z[w, k]
            mass = self.dense[1] * self.area[w, k]
            force_y, force_z = mass * (square * y + self.pull[0][w]), mass * (square * z + self.pull[1][w])
            self.add_mass(u, self.piece[k], ti.Vector([mass, mass, 0.0 - mass * z, mass * y, mass * (y * y + z * z)]))
            self.load.book(u, self.piece[k], ti.Vector([force_y, force_z, y * force_z - z * force_y]), dt)
        if ti.static(self.openings > 0):
            self.flow(w, motion, ti.cast(t, self.exact), ti.cast(dt, self.exact))

    @ti.func
    def stand(self, w, pose):
        """Find the level of the water in each room at a pose of the tanks, and its centre in their axes."""
        self.turn[w] = pose[2]
        for k in range(self.count):
            level = self.rooms.level(k, pose, self.area[w, k])
            centre = self.rooms.centre_below(k, pose, level)
            self.level[w, k], self.y[w, k], self.z[w, k] = level - pose[1], centre[0], centre[1]

    @ti.func
    def flow(self, w, pose, t, dt):
        """Let flow what the heads at t (s) ask for during dt (s), as far as a room has it, or has room for it."""
        aboard = ti.cast(0.0, self.exact)
        for k in range(self.openings):
            room = self.heads.room[k]
            self.heads.look(w, k, pose, t, pose[1] + self.level[w, room])
            wanted = ti.select(t < 0.0, 0.0, self.heads.flow(w, k) * dt)
            gain = ti.max(ti.min(wanted, self.full[room] - self.area[w, room]), 0.0 - self.area[w, room])
            self.area[w, room] = self.area[w, room] + gain
            self.entered[w, k], self.rate[w, k] = self.entered[w, k] + gain, gain / dt
            aboard += self.share[k] * self.entered[w, k]
        self.carrier.bear_water(w, self.dense[0] * aboard, t + dt)

    @ti.func
    def follow(self, u, frame, kick, dt):
        """Book what the tank's acceleration adds to the load; returns that all is well."""
        self.react(u, frame, dt)
        return True

    @ti.kernel
    def look(self, time: ti.f64):
        """Let the water stand as it does at a time (s), which is now."""
        for w in range(self.units.worlds):
            self.stand(w, self.carrier.kinematics(w, time))

    def observe(self, time: float) -> dict[str, np.ndarray]:
        """The quantities of water at `time` (s), which is now: its centre, NaN without water, and what has entered."""
        self.look(time)
        rows, area = self.unknown(), self.area.to_numpy()
        with np.errstate(invalid="ignore"):
            centre = [(area * place.to_numpy()).sum(axis=1) / area.sum(axis=1) for place in (self.y, self.z)]
        rows["water_centre"] = np.stack(centre, axis=1)
        if self.inlets:
            rows |= {one.name: np.zeros((len(area), *one.shape)) for one in of_inflow.SERIES}
            rows["inflow_volume"] = self.entered.to_numpy() * self.lengths
            rows["inflow_rate"] = self.rate.to_numpy() * self.lengths
        return rows

    def place(self, position: np.ndarray | None) -> None:
        """Let the rooms have the water that they have at the start."""
        self.area.from_numpy(self.start)
        for field in (self.entered, self.rate, self.heads.seen) if self.inlets else ():
            field.fill(0.0)
        self.load.forget()

    def snapshot(self, time: float) -> dict[str, np.ndarray]:
        """Places (W, n, 2) of marks that fill the water evenly at `time` (s), which is now; they have no velocities.

        Each of a room stands for the same area; those that are not needed have no place (NaN).
        """
        self.look(time)
        fluid, spacing = self.scene.fluid, self.water.spacing
        place, ends = np.full((self.units.worlds, fluid.count, 2), np.nan), np.cumsum([0, *self.scene.fills])
        area, level, turn = self.area.to_numpy(), self.level.to_numpy(), self.turn.to_numpy()
        for k, number in enumerate(self.numbers):
            own = slice(ends[number], ends[number + 1])
            if not self.scene.fills[number]:
                continue  # smaller than a mark
            marks, of_one = place[:, own], fluid.particles["volume"][:, own].mean(axis=1)
            for w in range(len(place)):
                count = min(marks.shape[1], round(area[w, k] / of_one[w]))
                marks[w, :count] = marks_in(self.outlines[k], turn[w], level[w, k], count, spacing)
        still = np.where(np.isnan(place), np.nan, 0.0)
        return {"water_position": place, "water_velocity": still, "water_pressure": still[..., 0]}
