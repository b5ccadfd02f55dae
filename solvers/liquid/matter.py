"""Water in a ship's tanks as a rigid weight or as masses on springs, with the interface of water as particles."""

from typing import ClassVar

import numpy as np
import taichi as ti

from solvers.fluid import quantities
from solvers.liquid.modes import Modes, modes_of
from solvers.machine.phase import Phase
from solvers.machine.state import Axis
from solvers.machine.units import Units
from solvers.motion.carrier import per_slab
from solvers.ship.body import Body, frozen
from solvers.tank.context import Context
from solvers.tank.matter import Matter

MASS, CENTRE_Y, CENTRE_Z, TURNING = range(4)  # columns of the table of tanks


@ti.data_oriented
class LiquidMatter(Matter):
    """The liquid of each tank: a rigid body, and masses m_n that slide along the floor on springs.

    With s the way of a mass in the tank, at (y, z) from the tank's origin and with b the body force per mass there,

        s̈ = −ω² s − 2 ζ ω ṡ + b_y,   force = −m s̈,   moment = z m s̈ + s m b_z   beyond those of the frozen liquid.

    What of this follows from the tank's acceleration at once is the load's `inertia`. Velocities are half a step behind
    places (leapfrog, of second order; the damping is implicit).

    Limits: see `ship.potential.springs`; a displaced mass does not feel the tank accelerate upwards (second order).
    """

    name = "water"
    of_contacts: ClassVar = ()

    def __init__(self, scene, context: Context):
        self.scene, self.water = scene, scene.fluid.water
        arrays, worlds = context.arrays, context.worlds
        self.carrier, self.exact = context.carrier, arrays.exact
        self.units = Units(worlds, 1, 1, 1)
        self.load = context.load(arrays.under("water"), self.units)
        self.load.add_mass(arrays.under("water"))
        self.thickness = scene.tanks[0].thickness
        self.modes: list[Modes] = modes_of(scene)
        self.tanks, self.swings = len(self.modes), max(len(one.mass) for one in self.modes)
        own = arrays.under("liquid")
        rigid = np.array([[one.body.mass, *one.body.centre, one.body.inertia] for one in self.modes])
        self.rigid = own.holding("rigid", self.thickness * rigid, "tank number", own.exact)
        self.piece = own.holding("piece", np.array([one.tank for one in self.modes]), "tank", ti.i32)
        rows = np.array([self._padded(one) for one in self.modes])
        self.table = own.holding("table", rows, "tank mode number", own.exact)
        each = Axis("world", worlds), Axis("tank", self.tanks), Axis("mode", max(1, self.swings))
        self.way, self.speed_of = own.reals(each, "way", "speed", kind=own.exact)
        (self.rise,) = own.reals(each, "rise", kind=own.exact)
        self.pull = own.reals(each[:1], "pull_y", "pull_z", kind=own.exact, kept=False)  # gravity, in the tank's axes
        # Of whole worlds: a band of one, cut for the grains beside it, has no liquid of its own.
        self.before = (Phase(self.push),)
        self.after = (Phase(self.swing),)

    def _padded(self, one: Modes) -> np.ndarray:
        """Mass (kg), place (m), frequency (rad/s) and damping of each mass, (modes, 5); unused ones have no mass."""
        rows = np.zeros((max(1, self.swings), 5))
        rows[:, 3] = 1.0
        for k, mass in enumerate(one.mass):
            rows[k] = self.thickness * mass, one.middle, one.height[k], one.frequency[k], one.damping
        return rows

    @property
    def extent(self) -> float:
        """How far (m) from the tank's origin a particle may be."""
        return self.scene.span

    @ti.func
    def push(self, u, t, kick, dt):
        """The load of the liquid on tanks that are not accelerated, and its added mass."""
        self.load.begin(u)
        w = self.units.world(u)
        motion = self.carrier.kinematics(w, t)
        c, s = ti.cos(motion[2]), ti.sin(motion[2])
        g, square = self.carrier.gravity[0], motion[5] * motion[5]
        self.pull[0][w], self.pull[1][w] = 0.0 - g * s, 0.0 - g * c
        during = ti.cast(dt, self.exact)
        for k in range(self.tanks):
            mass, y, z = self.rigid[k, MASS], self.rigid[k, CENTRE_Y], self.rigid[k, CENTRE_Z]
            b_y, b_z = square * y - g * s, square * z - g * c
            force_y, force_z, moment = mass * b_y, mass * b_z, mass * (y * b_z - z * b_y)
            across, slant, turning = mass, -mass * z, self.rigid[k, TURNING] + mass * (y * y + z * z)
            for n in range(self.swings):
                m, at, high, omega = self.table[k, n, 0], self.table[k, n, 1], self.table[k, n, 2], self.table[k, n, 3]
                way, fast = self.way[w, k, n], self.speed_of[w, k, n] + 0.5 * during * self.rise[w, k, n]
                free = square * at - g * s  # b_y of a tank that is not accelerated
                pull = m * (omega * (omega * way + 2.0 * self.table[k, n, 4] * fast) - free)
                force_y += pull
                moment += way * m * (square * high - g * c) - high * pull
                across -= m
                slant += m * high
                turning -= m * high * high
            none = 0.0 * mass
            entries = ti.Vector([across, none, slant, none, mass, mass * y, slant, mass * y, turning])
            for n in ti.static(range(self.load.entries)):
                self.load.added_mass[u, self.piece[k], n] = entries[n]
            self.load.book(u, self.piece[k], ti.Vector([force_y, force_z, moment]), dt)

    @ti.func
    def swing(self, u, frame, kick, dt):
        """Move the masses, and book what the tank's acceleration adds to the load; returns that all is well."""
        w = self.units.world(u)
        b, rate, up = ti.cast(frame[0], self.exact), ti.cast(frame[2], self.exact), ti.cast(frame[3], self.exact)
        gains = ti.Vector([self.pull[0][w] - b, self.pull[1][w] - ti.cast(frame[1], self.exact), up])
        for piece in range(self.load.pieces):
            self.load.book_reaction(u, piece, gains, dt)
        during, whole = ti.cast(kick, self.exact), ti.cast(dt, self.exact)
        sound = True
        for k in range(self.tanks):
            for n in range(self.swings):
                at, high, omega = self.table[k, n, 1], self.table[k, n, 2], self.table[k, n, 3]
                slowed = self.table[k, n, 4] * omega * during
                old = self.speed_of[w, k, n]
                gain = b + up * high + rate * rate * at - omega * omega * self.way[w, k, n]
                new = ((1.0 - slowed) * old + during * gain) / (1.0 + slowed)
                self.rise[w, k, n] = (new - old) / during
                self.speed_of[w, k, n] = new
                self.way[w, k, n] = self.way[w, k, n] + whole * new
                sound = sound and ti.abs(new) < self.water.sound_speed
        return sound

    def as_rigid(self) -> list[Body]:
        """The water of each world as one rigid body, per metre of the ship's length, in the tank's frame."""
        particles = self.scene.fluid.particles
        mass = self.water.density * per_slab(self.scene) * particles["volume"]
        return [frozen(*p["position"].T, m, p["volume"]) for p, m in zip(particles, mass, strict=True)]

    def observe(self, time: float) -> dict[str, np.ndarray]:
        """The quantities of water at `time` (s): its centre; others that particles have are zero."""
        worlds, sizes = self.units.worlds, {"level": len(self.water.levels), "edge": len(self.water.edges)}
        sizes |= {"gauge": len(self.water.gauges), "part": 0}
        rows = {}
        for one in quantities.SERIES:
            owner = (sizes[one.per],) if one.per in sizes else ()
            rows[one.name] = np.zeros((worlds, *owner, *one.shape))
        way, whole = self.way.to_numpy().astype(float), sum(one.water.mass for one in self.modes)
        for k, one in enumerate(self.modes):
            rows["water_centre"] += one.water.mass / whole * np.array(one.water.centre)
            count = len(one.mass)
            rows["water_centre"][:, 0] += (way[:, k, :count] * one.mass).sum(axis=1) / whole
        for number, level in enumerate(self.water.levels):
            rows["level_depth"][:, number] = self.modes[0].level(level.y, way[:, 0])
        return rows

    def place(self, position: np.ndarray | None) -> None:
        """Let the liquid be at rest."""
        for field in (self.way, self.speed_of, self.rise):
            field.fill(0.0)
        self.load.forget()

    def snapshot(self, time: float) -> dict[str, np.ndarray]:
        """Places and velocities (W, n, 2) of marks in the liquid, by its potential, and no pressures."""
        way, fast = self.way.to_numpy().astype(float), self.speed_of.to_numpy().astype(float)
        start = self.scene.fluid.particles
        place, velocity = start["position"].copy(), np.zeros((*start.shape, 2))
        ends = np.cumsum([0, *self.scene.fills])
        for k, one in enumerate(self.modes):
            own = slice(ends[one.tank], ends[one.tank + 1])
            for w in range(len(start)):
                moved = one.moved(start["position"][w, own])
                place[w, own] += moved @ way[w, k, : len(one.mass)]
                velocity[w, own] = moved @ fast[w, k, : len(one.mass)]
        still = np.zeros(start.shape)
        return {"water_position": place, "water_velocity": velocity, "water_pressure": still}


def make_liquid(scene, context: Context) -> LiquidMatter | None:
    """The water of a scene (`solvers.scene.Scene`) without particles; None where it has none of that kind."""
    if scene.fluid is None or scene.fluid.moved:
        return None
    return LiquidMatter(scene, context)
