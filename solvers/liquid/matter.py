"""Water in a ship's tanks as a rigid weight or as masses on springs."""

import numpy as np
import taichi as ti

from solvers.liquid.level import LevelMatter
from solvers.liquid.liquid import Liquid
from solvers.liquid.modes import Modes, modes_of
from solvers.machine.phase import Phase
from solvers.machine.state import Axis
from solvers.tank.context import Context

MASS, CENTRE_Y, CENTRE_Z, TURNING = range(4)  # columns of the table of tanks


@ti.data_oriented
class LiquidMatter(Liquid):
    """The liquid of each tank: a rigid body, and masses m_n that slide along the floor on springs.

    With s the way of a mass in the tank, at (y, z) from the tank's origin and with b the body force per mass there,

        s̈ = −ω² s − 2 ζ ω ṡ + b_y,   force = −m s̈,   moment = z m s̈ + s m b_z   beyond those of the frozen liquid.

    What of this follows from the tank's acceleration at once is the load's `inertia`. Velocities are half a step behind
    places (leapfrog, of second order; the damping is implicit).

    Limits: see `ship.potential.springs`; a displaced mass does not feel the tank accelerate upwards (second order).
    """

    def __init__(self, scene, context: Context):
        super().__init__(scene, context)
        self.modes: list[Modes] = modes_of(scene)
        self.tanks, self.swings = len(self.modes), max(len(one.mass) for one in self.modes)
        own = context.arrays.under("liquid")
        rigid = np.array([[one.body.mass, *one.body.centre, one.body.inertia] for one in self.modes])
        self.rigid = own.holding("rigid", self.thickness * rigid, "tank number", own.exact)
        self.piece = own.holding("piece", np.array([one.tank for one in self.modes]), "tank", ti.i32)
        rows = np.array([self._padded(one) for one in self.modes])
        self.table = own.holding("table", rows, "tank mode number", own.exact)
        each = Axis("world", context.worlds), Axis("tank", self.tanks), Axis("mode", max(1, self.swings))
        self.way, self.speed_of = own.reals(each, "way", "speed", kind=own.exact)
        (self.rise,) = own.reals(each, "rise", kind=own.exact)
        self.before = (Phase(self.push),)
        self.after = (Phase(self.swing),)

    def _padded(self, one: Modes) -> np.ndarray:
        """Mass (kg), place (m), frequency (rad/s) and damping of each mass, (modes, 5); unused ones have no mass."""
        rows = np.zeros((max(1, self.swings), 5))
        rows[:, 3] = 1.0
        for k, mass in enumerate(one.mass):
            rows[k] = self.thickness * mass, one.middle, one.height[k], one.frequency[k], one.damping
        return rows

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
            self.add_mass(u, self.piece[k], ti.Vector([across, mass, slant, mass * y, turning]))
            self.load.book(u, self.piece[k], ti.Vector([force_y, force_z, moment]), dt)

    @ti.func
    def swing(self, u, frame, kick, dt):
        """Move the masses, and book what the tank's acceleration adds to the load; returns that all is well."""
        w = self.units.world(u)
        b, rate, up = ti.cast(frame[0], self.exact), ti.cast(frame[2], self.exact), ti.cast(frame[3], self.exact)
        self.react(u, frame, dt)
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

    def observe(self, time: float) -> dict[str, np.ndarray]:
        """The quantities of water at `time` (s): its centre; others that particles have are zero."""
        rows = self.unknown()
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


def make_liquid(scene, context: Context) -> Liquid | None:
    """The water of a scene (`solvers.scene.Scene`) without particles; None where it has none of that kind."""
    if scene.fluid is None or scene.fluid.moved:
        return None
    return LevelMatter(scene, context) if scene.fluid.water.model == "level" else LiquidMatter(scene, context)
