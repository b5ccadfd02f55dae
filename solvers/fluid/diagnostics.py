"""Diagnostics of the water: sums over its particles, taken in one order on any number of threads."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import taichi as ti

from solvers.fluid import quantities
from solvers.fluid.constants import Constants
from solvers.fluid.lists.order import Order
from solvers.fluid.phases import quantities as of_air
from solvers.fluid.state import UNUSED, Particles
from solvers.machine.quantity import places
from solvers.machine.state import Axis, State, padded, roomy
from solvers.motion.frame import turned
from solvers.space.axes import dot
from solvers.tank.walls import Walls

CHUNK = 64  # blocks whose sum one thread takes
DENSE = 0.03  # deviation of the density from which it is counted
NEVER = -1.0
USUAL = 8  # level gauges for which there is room at least
SUMS = (
    *("mass", "moment_y", "moment_z", "momentum_y", "momentum_z", "moving", "flowing", "pulled", "elastic", "dense"),
    *(
        "air_mass",
        "air_y",
        "air_z",
        "air_flowing",
        "air_pressed",
        "air_volume",
    ),  # of two phases: the air's part of these
    *("deviation", "escaped", "air_density_deviation"),  # largest values, not sums
)


@dataclass(frozen=True)
class Pool:
    """The tanks of the water: their walls, whose water is whose, and whether it may leave none of them (`closed`).

    Of the first with water its number and the places `sides` (m) of its corners along y.
    """

    walls: Walls
    order: Order
    closed: bool
    first: int
    sides: np.ndarray

    @classmethod
    def of(cls, scene, walls: Walls, order: Order) -> "Pool":
        """The tanks of a scene (`solvers.scene.Scene`)."""
        wet = [number for number, fill in enumerate(scene.fills) if fill]
        shut = scene.fluid.water.walls and not any(scene.tanks[number].open_edges for number in wet)
        sides = scene.tanks[wet[0]].outline[:, 0]
        return cls(walls, order, shut and not scene.fluid.water.periodic, wet[0], sides)


@ti.data_oriented
class Diagnostics:
    """Sums over a world's particles, and what each particle's velocity is now, relative to the tank.

    `now` (W,) m/s, rad/s, m/s²: velocity, rate of roll and gravity of the tank in its own axes when it was last noted.
    `behind` (W,) s is by how much velocities are behind places.
    """

    def __init__(self, arrays: State, particles: Particles, constants: Constants, carrier, pool: Pool, levels):
        self.particles, self.constants, self.carrier = particles, constants, carrier
        self.walls, self.order, self.first = pool.walls, pool.order, pool.first
        self.exact, self.closed = arrays.exact, pool.closed
        listed = *quantities.SERIES, *(of_air.SERIES if particles.two else ()), quantities.ESCAPED
        self.quantities = tuple(quantity.within(particles.axes) for quantity in listed)
        self.at = SimpleNamespace(**{name: k for k, name in enumerate(SUMS)})
        self.columns = places(self.quantities)
        own, world = arrays.under("water.diagnostics"), Axis("world", particles.worlds)
        self.chunks = -(-particles.fluid_blocks // CHUNK)
        sums = world, Axis("chunk", self.chunks)
        self.sums = own.reals(sums, *SUMS, kind=arrays.exact, kept=False)
        names = "tank_y", "tank_z", "tank_rate", "pull_y", "pull_z", "height"
        self.now = own.reals((world,), *names, kind=arrays.exact, kept=False)
        (self.behind,) = own.reals((world,), "behind", kind=arrays.exact)
        self.levels, room = len(levels), roomy(len(levels), USUAL)
        places_y = padded(np.array([level.y for level in levels]), room)
        self.level_number = own.holding("level_number", np.array([self.levels]), "one", ti.i32)
        self.level_y = own.holding("level_y", places_y, "level", arrays.exact)
        sides = pool.sides.min(), pool.sides.max()
        self.level_sides = own.holding("level_sides", np.array(sides), "side", arrays.exact)
        (self.level_depth,) = own.reals((world, Axis("level", room)), "level_depth", kept=False)

    def sums_at(self, time: float, thickness: float) -> dict[str, np.ndarray]:
        """Sums of every world at `time` (s), (W, …) by the names of `SUMS`, for a tank of `thickness` (m)."""
        self.count(time)
        found = {name: field.to_numpy() for name, field in zip(SUMS, self.sums, strict=True)}
        extreme = {name: found.pop(name).max(axis=1) for name in ("deviation", "escaped", "air_density_deviation")}
        return {name: values.sum(axis=1) * thickness for name, values in found.items()} | extreme

    def of_water(self, sums: dict[str, np.ndarray], mass: np.ndarray, centre: np.ndarray) -> dict[str, np.ndarray]:
        """Centre and dense share of the water alone, and what is known of the air, of sums and both phases' centre."""
        if not self.particles.two:
            return {"water_centre": centre, "water_dense": sums["dense"] / mass}
        of_air = np.stack([sums["air_y"], sums["air_z"]], axis=1)
        water, air = mass - sums["air_mass"], np.maximum(sums["air_mass"], 1e-300)
        return {
            "water_centre": (centre * mass[:, None] - of_air) / water[:, None],
            "water_dense": sums["dense"] / water,
            "air_centre": of_air / air[:, None],
            "air_kinetic": sums["air_flowing"],
            "air_mean_pressure": sums["air_pressed"] / np.maximum(sums["air_volume"], 1e-300),
            "air_volume": sums["air_volume"],
            "air_density_deviation": sums["air_density_deviation"],
        }

    def buoyed(self, sums: dict[str, np.ndarray], down: np.ndarray) -> np.ndarray | float:
        """Σ ρ_a m_i/ρ_0i r_i·`down` (W,) kg m: times g, what `ReducedPressure` adds to the potential; else 0."""
        if not self.constants.modified:
            return 0.0
        share = self.constants.numbers["buoyed"]
        of_air = np.stack([sums["air_y"], sums["air_z"]], axis=1)
        of_all = np.stack([sums["moment_y"], sums["moment_z"]], axis=1)
        return ((share * (of_all - of_air) + of_air) * down).sum(axis=1)

    def whole(self, pressure: np.ndarray, place: list[np.ndarray]) -> np.ndarray:
        """The pressures (W, n) Pa at `place` (y and z), from those that are found, which may be reduced ones."""
        if not self.constants.modified:
            return pressure
        pull = np.stack([field.to_numpy() for field in self.now[3:5]], axis=1)
        return pressure + self.constants.reduced.head(self.constants.numbers, pull, np.stack(place, axis=-1))

    @ti.kernel
    def count(self, time: ti.f64):
        """Fill the sums and the level gauges."""
        for w in range(self.particles.worlds):
            self.note_now(w, time)
        for w, chunk in self.sums[0]:
            self.sum_chunk(w, chunk)
        for w, level in self.level_depth:
            if level < self.level_number[0]:
                self.measure_level(w, level)

    @ti.kernel
    def note(self, time: ti.f64):
        """Note how the tanks move at a time (s)."""
        for w in range(self.particles.worlds):
            self.note_now(w, time)

    @ti.func
    def note_now(self, w, time):
        """Note how the tank of a world moves at a time (s)."""
        gravity = self.carrier.gravity[0]
        self.now[3][w], self.now[4][w] = 0.0, -gravity
        if ti.static(self.carrier.moving):
            pose = self.carrier.kinematics(w, time)
            velocity, pull = turned(pose[3], pose[4], -pose[2]), turned(0.0, -gravity, -pose[2])
            self.now[0][w], self.now[1][w], self.now[2][w] = velocity[0], velocity[1], pose[5]
            self.now[3][w], self.now[4][w], self.now[5][w] = pull[0], pull[1], pose[1]

    @ti.func
    def sum_chunk(self, w, chunk):
        """Sums over one chunk of blocks."""
        p, c = self.particles, self.constants
        sums = [ti.cast(0.0, self.exact) for _ in ti.static(range(len(SUMS)))]
        sums[self.at.escaped] = NEVER
        start = w * p.stride
        sound = ti.cast(c.get("stiffness") / c.get("density"), self.exact)
        for b in range(start + chunk * CHUNK, start + ti.min(p.used[w], (chunk + 1) * CHUNK)):
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED:
                    m, s = ti.cast(p.mass[b, lane], self.exact), ti.cast(p.deviation[b, lane], self.exact)
                    m *= self.order.weight(b)
                    r = [ti.cast(p.place[a][b, lane], self.exact) for a in ti.static(range(p.axes))]
                    u = self.velocity_now(w, b, lane)
                    v = [
                        u[0] - self.now[0][w] + self.now[2][w] * r[1],
                        u[1] - self.now[1][w] - self.now[2][w] * r[0],
                    ]
                    sums[self.at.mass] += m
                    sums[self.at.moment_y] += m * r[0]
                    sums[self.at.moment_z] += m * r[1]
                    sums[self.at.momentum_y] += m * u[0]
                    sums[self.at.momentum_z] += m * u[1]
                    sums[self.at.moving] += 0.5 * m * dot(u, u)
                    sums[self.at.flowing] += 0.5 * m * dot(v, v)
                    if ti.static(c.pulled):
                        out = [r[0] - c.get("pull_y"), r[1] - c.get("pull_z")]
                        sums[self.at.pulled] += 0.5 * m * c.get("pull") * dot(out, out)
                    if ti.static(c.tense):
                        tension = ti.cast(p.stress[0][b, lane] + p.stress[2][b, lane], self.exact)
                        sums[self.at.elastic] += self.order.weight(b) * p.volume[b, lane] * tension
                    if ti.static(c.pressed):
                        self.add_background(sums, m, s, p.gas_at(b, lane))
                    is_water = p.gas_at(b, lane) < 0.5
                    if ti.static(p.two):  # noqa: SIM102 (compiled only where there is air)
                        if not is_water:
                            self.add_air(sums, [m, s], r, v, w)
                    if is_water:
                        sums[self.at.elastic] += m * sound * c.state.energy(s)
                        sums[self.at.dense] += ti.select(ti.abs(s) > DENSE, m, 0.0)
                        sums[self.at.deviation] = ti.max(sums[self.at.deviation], ti.abs(s))
                    if ti.static(self.closed):
                        dent = 0.5 + p.gas_at(b, lane)  # spacings: water may squeeze air into a wall
                        if self.is_out(w, self.order.layer(b), [p.place[0][b, lane], p.place[1][b, lane]], dent):
                            sums[self.at.escaped] = ti.max(sums[self.at.escaped], p.number[b, lane])
        for k in ti.static(range(len(SUMS))):
            self.sums[k][w, chunk] = sums[k]

    @ti.func
    def add_air(self, sums: ti.template(), held: ti.template(), r: ti.template(), v: ti.template(), w):
        """Add a particle of air, of the mass (kg/m) and density deviation `held`, at r (m) and v (m/s) in the tank."""
        c, m, s = self.constants, held[0], held[1]
        stiffness = ti.cast(c.get("air_stiffness"), self.exact)
        volume = m / ((1.0 + s) * c.get("air_density"))
        sums[self.at.elastic] += m * stiffness / c.get("air_density") * c.gas.energy(s)
        if ti.static(c.coheres):
            pull = ti.cast(c.get("cohesion"), self.exact)
            sums[self.at.elastic] += m * pull / c.get("air_density") * c.cohesion.energy(s)
            sums[self.at.air_pressed] += volume * pull * c.cohesion.share(s)
        sums[self.at.air_mass] += m
        sums[self.at.air_y] += m * r[0]
        sums[self.at.air_z] += m * r[1]
        sums[self.at.air_flowing] += 0.5 * m * dot(v, v)
        sums[self.at.air_volume] += volume
        sums[self.at.air_pressed] += volume * stiffness * c.gas.share(s)
        if ti.static(c.modified):
            sums[self.at.air_pressed] += volume * c.reduced.above(c, [self.now[3][w], self.now[4][w]], r)
        sums[self.at.air_density_deviation] = ti.max(sums[self.at.air_density_deviation], ti.abs(s))

    @ti.func
    def add_background(self, sums: ti.template(), m, s, gas):
        """Add −p_b (V − V0), what the background pressure holds of a particle's compression."""
        light = self.constants.get("background") / self.constants.of("density", gas)
        sums[self.at.elastic] += m * light * (s / (1.0 + s))

    @ti.func
    def is_out(self, w, tank, place: ti.template(), dent):
        """Whether a place is outside its tank by more than `dent` spacings: in an impact water may dent a wall."""
        near, y, z, out = dent * self.constants.get("spacing"), place[0], place[1], False
        if ti.static(self.order.layers > 1):
            out = self.walls.is_off(tank, y, z, near)
        elif not self.walls.holds(y, z):
            out = True
            shift = self.walls.shift(w, 0.0)
            for feature in range(self.walls.features):
                if self.walls.near(feature, shift, near, y, z):
                    out = False
        return out

    @ti.func
    def velocity_now(self, w, b, lane):
        """Velocity (m/s) of a particle over the earth now, in the tank's axes: that kept, and half a kick."""
        p, c, half = self.particles, self.constants, self.behind[w]
        pull = [self.now[3 + a][w] for a in ti.static(range(p.axes))]
        if ti.static(c.modified):
            for a in ti.static(range(p.axes)):
                pull[a] *= ti.cast(c.reduced.sinking(c, p.gas_at(b, lane)), self.exact)
        return [
            ti.cast(p.velocity[a][b, lane], self.exact)
            + half * (ti.cast(p.acceleration[a][b, lane], self.exact) + pull[a])
            for a in ti.static(range(p.axes))
        ]

    @ti.func
    def measure_level(self, w, level):
        """Depth at a level gauge: the water's volume around it, weighted by a one-dimensional kernel."""
        p = self.particles
        reach, y = ti.cast(self.constants.get("reach"), self.exact), self.level_y[level]
        total = ti.cast(0.0, self.exact)
        for b in range(w * p.stride, w * p.stride + p.used[w]):
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED and self.order.layer(b) == self.first:
                    t = 1.0 - ti.abs(ti.cast(p.place[0][b, lane], self.exact) - y) / reach
                    if t > 0.0 and p.gas_at(b, lane) < 0.5:
                        total += ti.cast(p.volume[b, lane], self.exact) * t * t * (3.0 - 2.0 * t)
        left, right = (y - self.level_sides[0]) / reach, (self.level_sides[1] - y) / reach
        self.level_depth[w, level] = ti.cast(total / (reach * (self.covered(left) + self.covered(right))), p.real)

    @ti.func
    def covered(self, x):
        """∫ from 0 to x of the kernel t² (3 − 2 t), t = 1 − x, which is 1/2 from x = 1 on."""
        t = 1.0 - ti.max(0.0, ti.min(1.0, x))
        return 0.5 - t * t * t * (1.0 - 0.5 * t)

    def relative(self, time: float, place, velocity, push, gas: np.ndarray) -> np.ndarray:
        """Velocities (W, n, 2) m/s relative to the tank at `time` (s), from those kept and the last accelerations.

        Of each two (W, n) along y and z; `gas` (W, n) is 1 for air.
        """
        self.note(time)
        tank_y, tank_z, rate, pull_y, pull_z, _ = (field.to_numpy()[:, None] for field in self.now)
        half = self.behind.to_numpy()[:, None]
        if self.constants.modified:
            sinks = (1.0 - gas) * (1.0 - self.constants.numbers["buoyed"])
            pull_y, pull_z = pull_y * sinks, pull_z * sinks
        return np.stack(
            [
                velocity[0] + half * (push[0] + pull_y) - tank_y + rate * place[1],
                velocity[1] + half * (push[1] + pull_z) - tank_z - rate * place[0],
            ],
            axis=-1,
        )
