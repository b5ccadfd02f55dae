"""Diagnostics of the water: sums over its particles, taken in one order on any number of threads."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import taichi as ti

from solvers.fluid import quantities
from solvers.fluid.constants import Constants
from solvers.fluid.lists.order import Order
from solvers.fluid.phases import quantities as of_air
from solvers.fluid.state import FAR, UNUSED, Particles
from solvers.fluid.surface.level_gauges import LevelGauges
from solvers.machine.quantity import PLANE, places
from solvers.machine.state import Axis, State
from solvers.motion.frame import turned
from solvers.motion.poses import Poses
from solvers.motion.poses_in_space import PosesInSpace
from solvers.motion.prescribed_in_space import PLACE, RATE, VELOCITY, part, seen
from solvers.space.axes import UP, dot, named, named_turns, swing, turns
from solvers.tank.solids.making import AnyWalls
from solvers.tank.walls import Walls

CHUNK = 64  # blocks whose sum one thread takes
DENSE = 0.03  # deviation of the density from which it is counted
NEVER = -1.0
LARGEST = "deviation", "escaped", "air_density_deviation"  # largest values, not sums


def sums_of(axes: int) -> tuple[str, ...]:
    """Names of what is summed over the particles in a scene of so many axes, and at the end LARGEST."""
    moments, momenta, of_air = (named(what, axes) for what in ("moment", "momentum", "air"))
    energies = "moving", "flowing", "pulled", "elastic", "dense"
    air = "air_mass", *of_air, "air_flowing", "air_pressed", "air_volume"  # of two phases: the air's part of these
    return "mass", *moments, *momenta, *energies, *air, *LARGEST


@dataclass(frozen=True)
class Pool:
    """The tanks of the water: their walls, whose water is whose, and whether it may leave none of them (`closed`).

    Of the first with water its number and between which `sides` (m) it reaches along y, and along x. In space `walls`
    are those of the outline, which is drawn out from −`half` to `half` (m). `poses` are the tanks'.
    """

    walls: Walls
    order: Order
    poses: Poses | PosesInSpace
    closed: bool
    first: int
    sides: tuple[tuple[float, float], ...]
    half: float = 0.0

    @classmethod
    def of(cls, scene, walls: AnyWalls, order: Order, poses: Poses | PosesInSpace) -> "Pool":
        """The tanks of a scene (`solvers.scene.Scene`)."""
        wet = [number for number, fill in enumerate(scene.fills) if fill]
        shut = scene.fluid.water.walls and not any(scene.tanks[number].open_edges for number in wet)
        corners = scene.tanks[wet[0]].outline[:, 0]
        closed, half = shut and not scene.fluid.water.periodic, 0.0
        if scene.solid:
            walls, half = walls.section, scene.solid.half(scene.outline)
        long = FAR if "x" in scene.fluid.water.periodic else half
        sides = (float(corners.min()), float(corners.max())), (-long, long)
        return cls(walls, order, poses, closed, wet[0], sides, half)


@ti.data_oriented
class Diagnostics:
    """Sums over a world's particles, and what each particle's velocity is now, relative to the tank.

    `now` (W,) m/s, rad/s, m/s²: velocity, rate of roll and gravity of the tank in its own axes when it was last noted.
    `behind` (W,) s is by how much velocities are behind places.
    """

    def __init__(self, arrays: State, particles: Particles, constants: Constants, carrier, pool: Pool, levels):
        self.particles, self.constants, self.carrier = particles, constants, carrier
        self.walls, self.order = pool.walls, pool.order
        self.poses = pool.poses
        self.exact, self.closed = arrays.exact, pool.closed
        listed = *quantities.SERIES, *(of_air.SERIES if particles.two else ()), quantities.ESCAPED
        self.quantities = tuple(quantity.within(particles.axes) for quantity in listed)
        axes, self.names = particles.axes, sums_of(particles.axes)
        self.at = SimpleNamespace(**{name: k for k, name in enumerate(self.names)})
        self.at.moment, self.at.momentum, self.at.air = self.at.moment_y, self.at.momentum_y, self.at.air_y
        self.columns = places(self.quantities)
        own, world = arrays.under("water.diagnostics"), Axis("world", particles.worlds)
        self.chunks = -(-particles.fluid_blocks // CHUNK)
        sums = world, Axis("chunk", self.chunks)
        self.sums = own.reals(sums, *self.names, kind=arrays.exact, kept=False)
        names = *named("tank", axes), *named_turns("tank_rate", axes), *named("pull", axes), "height"
        self.pull, self.about = axes + turns(axes), turns(axes)  # where in `now` gravity is; axes of turning
        self.now = own.reals((world,), *names, kind=arrays.exact, kept=False)
        (self.behind,) = own.reals((world,), "behind", kind=arrays.exact)
        self.ends = own.holding("ends", np.array([pool.half]), "one", arrays.exact)
        self.gauges = LevelGauges(arrays, particles, constants, self.order, levels, (pool.first, pool.sides))

    def sums_at(self, time: float, thickness: float) -> dict[str, np.ndarray]:
        """Sums of every world at `time` (s), (W, …) by their names, for a tank of `thickness` (m), in space 1."""
        self.count(time)
        found = {name: field.to_numpy() for name, field in zip(self.names, self.sums, strict=True)}
        extreme = {name: found.pop(name).max(axis=1) for name in LARGEST}
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

    def pulls(self) -> list[np.ndarray]:
        """Gravity (W,) m/s² along each of the tank's axes, as last noted."""
        return [field.to_numpy() for field in self.now[self.pull : self.pull + self.particles.axes]]

    def whole(self, pressure: np.ndarray, place: list[np.ndarray]) -> np.ndarray:
        """The pressures (W, n) Pa at `place` (y and z), from those that are found, which may be reduced ones."""
        if not self.constants.modified:
            return pressure
        pull = np.stack(self.pulls(), axis=1)
        return pressure + self.constants.reduced.head(self.constants.numbers, pull, np.stack(place, axis=-1))

    @ti.kernel
    def count(self, time: ti.f64):
        """Fill the sums and the level gauges."""
        for w in range(self.particles.worlds):
            self.note_now(w, time)
        for w, chunk in self.sums[0]:
            self.sum_chunk(w, chunk)
        for w, level in self.gauges.depth:
            self.gauges.measure(w, level)

    @ti.kernel
    def note(self, time: ti.f64):
        """Note how the tanks move at a time (s)."""
        for w in range(self.particles.worlds):
            self.note_now(w, time)

    @ti.func
    def note_now(self, w, time):
        """Note how the tank of a world moves at a time (s)."""
        gravity = self.carrier.gravity[0]
        self.now[self.pull + UP][w] = -gravity
        if ti.static(self.carrier.moving and self.particles.axes > PLANE):
            m = self.poses.motion(w, time)
            velocity, rate = seen(m, part(m, VELOCITY)), seen(m, part(m, RATE))
            pull = seen(m, [0.0 * gravity, -gravity, 0.0 * gravity])
            for a in ti.static(range(3)):
                self.now[a][w], self.now[3 + a][w], self.now[6 + a][w] = velocity[a], rate[a], pull[a]
            self.now[9][w] = m[PLACE + UP]
        elif ti.static(self.carrier.moving):
            pose = self.carrier.kinematics(w, time)
            velocity, pull = turned(pose[3], pose[4], -pose[2]), turned(0.0, -gravity, -pose[2])
            self.now[0][w], self.now[1][w], self.now[2][w] = velocity[0], velocity[1], pose[5]
            self.now[3][w], self.now[4][w], self.now[5][w] = pull[0], pull[1], pose[1]

    @ti.func
    def sum_chunk(self, w, chunk):
        """Sums over one chunk of blocks."""
        p, c = self.particles, self.constants
        sums = [ti.cast(0.0, self.exact) for _ in ti.static(range(len(self.names)))]
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
                    v = [(u[a] - self.now[a][w]) for a in ti.static(range(p.axes))]
                    swing([(0.0 - self.now[p.axes + k][w]) for k in ti.static(range(self.about))], r, v)
                    sums[self.at.mass] += m
                    for a in ti.static(range(p.axes)):
                        sums[self.at.moment + a] += m * r[a]
                        sums[self.at.momentum + a] += m * u[a]
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
                        place = [p.place[a][b, lane] for a in ti.static(range(p.axes))]
                        if self.is_out(w, self.order.layer(b), place, dent):
                            sums[self.at.escaped] = ti.max(sums[self.at.escaped], p.number[b, lane])
        for k in ti.static(range(len(self.names))):
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
        for a in ti.static(range(self.particles.axes)):
            sums[self.at.air + a] += m * r[a]
        sums[self.at.air_flowing] += 0.5 * m * dot(v, v)
        sums[self.at.air_volume] += volume
        sums[self.at.air_pressed] += volume * stiffness * c.gas.share(s)
        if ti.static(c.modified):
            sums[self.at.air_pressed] += volume * c.reduced.above(
                c, [self.now[self.pull + a][w] for a in ti.static(range(2))], r
            )
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
        if ti.static(self.particles.axes > PLANE):
            out = out or ti.abs(place[2]) > self.ends[0] + near
        return out

    @ti.func
    def velocity_now(self, w, b, lane):
        """Velocity (m/s) of a particle over the earth now, in the tank's axes: that kept, and half a kick."""
        p, c, half = self.particles, self.constants, self.behind[w]
        pull = [self.now[self.pull + a][w] for a in ti.static(range(p.axes))]
        if ti.static(c.modified):
            for a in ti.static(range(p.axes)):
                pull[a] *= ti.cast(c.reduced.sinking(c, p.gas_at(b, lane)), self.exact)
        return [
            ti.cast(p.velocity[a][b, lane], self.exact)
            + half * (ti.cast(p.acceleration[a][b, lane], self.exact) + pull[a])
            for a in ti.static(range(p.axes))
        ]

    def relative(self, time: float, place, velocity, push, gas: np.ndarray) -> np.ndarray:
        """Velocities (W, n, D) m/s relative to the tank at `time` (s), from those kept and the last accelerations.

        Of each D (W, n) along the axes; `gas` (W, n) is 1 for air.
        """
        self.note(time)
        axes, half, sinks = self.particles.axes, self.behind.to_numpy()[:, None], 1.0
        now = [field.to_numpy()[:, None] for field in self.now]
        if self.constants.modified:
            sinks = (1.0 - gas) * (1.0 - self.constants.numbers["buoyed"])
        found = [velocity[a] + half * (push[a] + now[self.pull + a] * sinks) - now[a] for a in range(axes)]
        rate = now[axes : self.pull]
        if axes == PLANE:
            swung = [-rate[0] * place[1], rate[0] * place[0]]
        else:
            swung = [rate[a - 2] * place[a - 1] - rate[a - 1] * place[a - 2] for a in range(axes)]
        return np.stack([one - own for one, own in zip(found, swung, strict=True)], axis=-1)
