"""Water and air in plain numpy: scenes of both, and a step by double sums over all particles."""

import numpy as np

from solvers.fluid.given import Air, Fluid, Water, particles
from solvers.fluid.phases.dispersed import LIGHT
from solvers.fluid.phases.interfaces import INTERFACES
from solvers.fluid.start.air import air_above, with_air
from solvers.fluid.start.rest import at_rest
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.water import GRAVITY, PlainWater, box, kernel
from tests.oracles.water import again as placed_again


def both(width: float, height: float, depth: float, rows: int, **changes) -> Scene:
    """A closed tank with `rows` layers of water at rest and air over it; changes of the scene, water or air."""
    spacing, sound = depth / rows, changes.pop("sound_speed", 10.0 * np.sqrt(GRAVITY * depth))
    of_air = changes.pop("air", {})
    of_water = {name: changes.pop(name) for name in list(changes) if name in Water.__dataclass_fields__}
    water = Water(
        **{"spacing": spacing, "sound_speed": sound, "air": Air(**{"sound_speed": sound} | of_air)} | of_water
    )
    outline = box(width, height)
    drops = with_air(at_rest(outline, depth, water, GRAVITY), air_above(outline, depth, water, GRAVITY))
    given = {"radius": np.zeros((1, 0)), "outline": outline, "gravity": GRAVITY}
    return scene_of(**{**given, "fluid": Fluid(water, drops[None]), **changes})


def filled(places: np.ndarray, gas: np.ndarray, volume: float, deviation: np.ndarray | float = 0.0) -> np.ndarray:
    """Drops (1, n) at places (n, 2) m of equal volumes (m²), the water first; gas (n,) is 1 for air."""
    order = np.argsort(gas, kind="stable")
    drops = particles(1, len(places))
    drops["position"][0], drops["gas"][0], drops["volume"][0] = places[order], gas[order], volume
    drops["deviation"][0] = np.broadcast_to(deviation, gas.shape)[order]
    return drops


def again(run: Simulation, scene: Scene) -> Simulation:
    """As `tests.oracles.water.again`, with as many particles, of which others may be air."""
    gas = scene.fluid.particles["gas"].astype(float)
    first = gas.shape[1] - int(gas[0].sum())
    run.water.gas, run.water.phases = gas, {"water": slice(0, first), "air": slice(first, None)}
    return placed_again(run, scene)


class PlainBoth(PlainWater):
    """The equations of a tank at rest with free slip, linear water and adiabatic air, weighted by their densities."""

    def __init__(self, scene: Scene):
        super().__init__(scene)
        water, air = scene.fluid.water, scene.fluid.water.air
        self.gas = scene.fluid.particles["gas"][0].astype(float)
        self.cohesion = air.cohesion * self.gas
        self.liquid = 1.0 - self.gas

        def of(of_water: float, of_air: float) -> np.ndarray:
            return np.where(self.gas > 0.5, of_air, of_water)

        self.density, self.sound = of(water.density, air.density), of(water.sound_speed, air.sound_speed)
        mu = of(water.alpha * water.density * water.sound_speed, air.alpha * air.density * air.sound_speed)
        self.strength = water.length * 2.0 * mu[:, None] * mu / (mu[:, None] + mu)
        self.other = self.gas[:, None] - self.gas
        self.lean = INTERFACES[air.interface].leans(water.density, air.density)[0]
        self.weighs = np.ones(len(self.gas)) if air.reduced is None else of(1.0 - air.density / water.density, 0.0)

    def most(self, s: np.ndarray) -> np.ndarray:
        """No bound: beside air fullness is of both phases, and certain."""
        return np.full_like(s, np.inf)

    def volume(self, mass, s):
        """V = m/ρ."""
        return mass / (self.density * (1.0 + s))

    def pressure(self, s):
        """Linear of water; ρ c²/1.4 ((1 + s)^1.4 − 1) of air; and the background's."""
        of_air = self.density * self.sound**2 * ((1.0 + s) ** 1.4 - 1.0) / 1.4
        alone = np.where(self.gas > 0.5, of_air, self.density * self.sound**2 * s)
        whole = alone + self.water.background - self.cohesion * s * (2.0 + s)
        bounded = (self.gas > 0.5) & (self.cohesion == 0.0) & (self.water.air.density < LIGHT * self.water.density)
        return np.where(bounded, np.maximum(whole, 0.0), whole)

    def extra(self, s):
        """What air feels besides, of each of its neighbours: 2 a ρ² (Mokos et al. 2015)."""
        return 2.0 * self.cohesion * (1.0 + s) ** 2

    def wall_pressure(self, r, mass, s, gas: float):
        """The walls' pressures that one phase sees: Adami, Hu & Adams (2012), eq. 27, over that phase alone."""
        of, volume = self.gas == gas, self.volume(mass, s)
        apart, _, value, _ = self.between(self.wall, r)
        weight = (value * volume)[:, of]
        lever = -(apart[:, of] @ self.gravity) * (self.weighs * mass / volume)[of] + self.pressure(s)[of]
        found = (weight * lever).sum(axis=1) / np.maximum(weight.sum(axis=1), 1e-30)
        return found if gas else np.maximum(found, 0.0)

    def image(self, r, u, volume):
        """What air sees of walls: the flow of water along them, by its share and the weight of the pair."""
        apart, _, value, _ = self.between(self.wall, r)
        seen, water = value * volume, value * volume * (1.0 - self.gas)
        inward = (seen[..., None] * apart).sum(axis=1)
        across = inward / np.maximum(np.linalg.norm(inward, axis=1), 1e-30)[:, None]
        flow = (water @ u) / np.maximum(water.sum(axis=1), 1e-30)[:, None]
        flow = flow - (flow * across).sum(axis=1)[:, None] * across
        share = water.sum(axis=1) / np.maximum(seen.sum(axis=1), 1e-30)
        return ((1.0 + self.lean) * share)[:, None] * flow

    def push(self, r, u, s, mass):
        """Accelerations without gravity, renormalised gradients of s within a phase, and the walls' forces."""
        volume, pressure, same = self.volume(mass, s), self.pressure(s), self.other == 0.0
        self.flow = self.image(r, u, volume)
        apart, square, _, gradient = self.between(r, r)
        between = pressure[:, None] + pressure + self.lean * self.other * (pressure[:, None] - pressure)
        between = between + self.extra(s)[:, None]
        pi = ((u[None] - u[:, None]) * apart).sum(axis=2) / (square + 1e-6 * self.water.length**2)
        pairs = (self.strength * pi - between) * volume[:, None] * volume
        force = (pairs[..., None] * gradient).sum(axis=1)
        to_wall, _, _, at_wall = self.between(r, self.wall)
        heavier = pressure[:, None] + (self.weighs * mass / volume)[:, None] * (to_wall @ self.gravity)
        seen = np.where(self.gas[:, None] > 0.5, heavier, self.wall_pressure(r, mass, s, 0.0)[None])
        own = np.where(self.gas > 0.5, pressure, np.maximum(pressure, 0.0))
        own = own + self.extra(s)
        walls = -(((own[:, None] + seen) * volume[:, None] * self.wall_volume)[..., None] * at_wall).sum(axis=1)
        matrix = np.einsum("ij,j,ija,ijb->iab", same, volume, apart, gradient)
        raw = np.einsum("ij,j,ij,ija->ia", same, volume, s[None] - s[:, None], gradient)
        self.eigenvalue = np.linalg.eigvalsh(matrix)[:, 0]
        regular = self.eigenvalue > 0.05
        slope = np.zeros_like(r)
        slope[regular] = np.linalg.solve(matrix[regular], raw[regular][..., None])[..., 0]
        return (force + walls) / mass[:, None], slope, walls

    def mixed(self, r, mass, s, plane: float):
        """How full the own phase is, of water with walls; the rate of s that keeps volumes; the s that is borne."""
        volume, same, wet = self.volume(mass, s), self.other == 0.0, self.gas < 0.5
        apart, _, value, gradient = self.between(r, r)
        to_wall, _, _, at_wall = self.between(r, self.wall)
        trace, of_walls = (apart * gradient).sum(axis=2), (to_wall * at_wall).sum(axis=2) @ self.wall_volume
        lean = np.einsum("j,ij,ija->ia", volume, same, gradient)
        lean += wet[:, None] * np.einsum("j,ija->ia", self.wall_volume, at_wall)
        lacking = plane * np.linalg.norm(lean, axis=1)
        full = 0.5 * ((same * trace) @ volume + wet * of_walls) + lacking
        filled, pace = 0.5 * (trace @ volume + of_walls), 0.01 * self.water.delta * self.water.air.sound_speed
        of_air = pace / self.water.length * (1.0 + s) * np.maximum(self.over(filled), -0.1)
        keeping = np.where(wet, self.keeping(full, lacking, s), of_air)
        seen, stiff = (~same * value) @ volume, self.density * self.sound**2
        over = (~same * value) @ (volume * self.pressure(s)) / np.maximum(seen, 1e-30) - self.water.background
        of_water = np.where(seen > 0.02, np.maximum(over / stiff, self.least), self.least)
        of_air = np.minimum((1.0 + 1.4 * np.maximum(over / stiff, 1.0)) ** (1.0 / 1.4) - 1.0, 9.0)
        return full, keeping, np.where(wet, of_water, of_air)

    @property
    def least(self) -> float:
        """The density deviation of water that bears the suction of the background."""
        return -self.water.background / (self.water.density * self.water.sound_speed**2)

    def later(self, r, u, s, mass, slope, pressed, dt, mixed=None):
        """The density deviation after a step, from its middle; water with few of its kind about bears no suction.

        `mixed`: what the method of that name gave at the start of the step; None where it does not act.
        """
        wet = self.gas < 0.5
        spray = (self.eigenvalue < 0.2) & wet
        (full, keeping, rest), before = mixed or (np.ones_like(s), 0.0, s), s
        for rate, more in zip(self.rates(r, u, s, mass, slope, pressed), (keeping, 0.0), strict=True):
            s = s + dt * (rate + more)
            s = np.where(spray, np.maximum(s, self.least), s)
        loose = np.clip((np.where(wet, 0.93, 0.5) - full) / 0.05, 0.0, 1.0)
        share = 1.0 - 1.0 / (1.0 + loose * dt * self.water.sound_speed / self.water.length)
        air = self.water.air
        borne = self.water.background / (air.density * air.sound_speed**2)
        thinnest = (1.0 - 1.4 * borne) ** (1.0 / 1.4) - 1.0 if air.density < LIGHT * self.water.density else -1.0
        squeezed, stretched = np.maximum(s - np.maximum(rest, before), 0.0), np.minimum(s - thinnest, 0.0)
        return s - np.where(wet, share * (s - rest), loose * squeezed + share * stretched)

    def rates(self, r, u, s, mass, slope, pressed):
        """Rates of s in the middle of a step, by the particles and by the walls."""
        water, volume, same = self.water, self.volume(mass, s), self.other == 0.0
        apart, _, _, gradient = self.between(r, r)
        flow = ((1.0 + self.lean * self.other) * ((u[None] - u[:, None]) * gradient).sum(axis=2)) @ volume
        _, _, _, at_wall = self.between(r, self.wall)
        gas = self.gas[:, None, None]
        walled = ((gas * self.flow - (1.0 + gas) * u[:, None]) * at_wall).sum(axis=2) @ self.wall_volume
        more = 2.0 * (s[None] - s[:, None]) - ((slope[:, None] + slope[None]) * apart).sum(axis=2)
        eta = -kernel(np.linalg.norm(apart, axis=2), water.length)[1]
        evened = water.delta * water.length * self.sound * ((same * more * eta) @ volume)
        walled = walled - self.closing(r, u, s, mass, pressed)
        return evened - (1.0 + s) * flow, -(1.0 + s) * walled


def held(run: Simulation) -> list[np.ndarray]:
    """Places, velocities, s, masses, accelerations and slopes of all particles, by their numbers."""
    p = run.water.particles
    y, z, v, w, s, m, *rest = p.read(*p.place, *p.velocity, p.deviation, p.mass, *p.acceleration, *p.gradient)
    pairs = [np.stack(pair, axis=-1)[0] for pair in ((y, z), (v, w), rest[0:2], rest[2:4])]
    return [*pairs[:2], s[0], m[0], *pairs[2:]]


def follows_double_sums(run: Simulation, steps: int = 7) -> None:
    """Some steps, and one more beside plain numpy."""
    plain, dt = PlainBoth(run.scene), run.dt
    run.advance(steps)
    r, u, s, m, *_ = held(run)
    run.advance(1)
    push, slope, _ = plain.push(r, u, s, m)
    mixed = plain.mixed(r, m, s, run.water.constants.numbers["plane"]) if run.water.forces.voids.acts else None
    pressed = plain.wall_pressure(r, m, s, 0.0) > 0.0
    u = u + dt * (push + plain.weighs[:, None] * plain.gravity)
    middle = r + 0.5 * dt * u
    s = plain.later(middle, u, s, m, slope, pressed, dt, mixed)
    found = held(run)
    np.testing.assert_allclose(found[4], push, atol=1e-9 * np.abs(push).max())
    np.testing.assert_allclose(found[5], slope, atol=1e-8 * np.abs(slope).max())
    np.testing.assert_allclose(found[2], s, atol=1e-9 * np.abs(s).max())
    np.testing.assert_allclose(found[0], middle + 0.5 * dt * u, atol=1e-12)
