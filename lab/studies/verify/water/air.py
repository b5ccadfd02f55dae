"""Water and air: a still tank, the wave between them, air in a closed column, and what pairs of both must keep."""

from dataclasses import dataclass

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.water.scenes import (
    G,
    Swing,
    box,
    grid,
    kept,
    looks,
    order_line,
    scene,
    set_going,
    simulated,
    swing,
)
from solvers.fluid.given import EXCESS, GAS, VOLUME, Air, Water, Y, Z
from solvers.fluid.start.air import air_above, with_air
from solvers.fluid.start.rest import at_rest
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Body

SECTION = "Water and air"
WIDTH, DEPTH, HEIGHT = 0.3, 0.15, 0.3  # m, of the still tank
REST, ROWS = 20.0, (8, 16)  # s, layers
K = np.pi  # 1/m, of the wave in a box of 1 m, half filled with 1 m of water
WAVED, STEEP, VISCOSITY = (20, 40), 0.03, np.sqrt(G) / 500.0  # layers; k times the largest rise; m²/s
PERIODS, A_PERIOD = 5.0, 20
COLUMN, PRESSED, POOL = 0.15, 0.03, 0.05  # m: height of the closed air, how much of it a piston takes, the water below
SQUEEZE = 0.3  # s, how long the piston moves
REAL = 343.0  # m/s


def of_both(water: Water, outline: np.ndarray, depth: float) -> Scene:
    """A closed tank with a depth (m) of water and air over it, at rest."""
    return scene(water, with_air(at_rest(outline, depth, water, G), air_above(outline, depth, water, G))[None], outline)


def rested(rows: int, duration: float) -> tuple[float, float, float]:
    """How far the surface came off its place in spacings, r.m.s., error of the pressure in ρ g H, and of the energy.

    The surface is between the highest water and the lowest air of each column of two smoothing lengths, over the second
    half of the time (s).
    """
    sound = 10.0 * np.sqrt(G * DEPTH)
    water = Water(DEPTH / rows, sound, air=Air(sound_speed=sound))
    off, pressed, bins = [], [], np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, max(2, rows // 2))
    with simulated(of_both(water, box(WIDTH, HEIGHT), DEPTH)) as run:
        for time in looks(run, np.arange(1.0, duration + 0.5)):
            rows_now, state = run.observe(), run.snapshot()
            if time < 0.5 * duration:
                continue
            wet, dry = state["water_place"][0], state["air_place"][0]
            high = [wet[np.digitize(wet[:, 0], bins) == k, 1].max() for k in range(1, len(bins))]
            low = [dry[np.digitize(dry[:, 0], bins) == k, 1].min() for k in range(1, len(bins))]
            off.append(np.abs(0.5 * np.add(high, low) - DEPTH).max() / water.spacing)
            error = state["water_pressure"][0] - water.density * G * (DEPTH - wet[:, 1])
            pressed.append(np.sqrt((error**2).mean()) / (water.density * G * DEPTH))
    stirred = rows_now["air_kinetic"][0] / (0.5 * air_mass(run))
    return max(off), max(pressed), float(np.sqrt(stirred))


def air_mass(run: Simulation) -> float:
    """Mass (kg) of the air in a slab of one metre."""
    drops, air = run.scene.drops[0], run.scene.water.air
    return float((air.density * (1.0 + drops[:, EXCESS]) * drops[:, VOLUME] * drops[:, GAS]).sum())


def still(fast: bool) -> Found:
    """Twenty seconds of rest at two spacings; the last decides."""
    rows, duration = (ROWS[:1], 4.0) if fast else (ROWS, REST)
    found = [rested(count, duration) for count in rows]
    off, pressed, stirred = found[-1]
    lines = [
        Line.off("surface, of a spacing, largest of all columns", "rest", off, 0.5, "half a spacing"),
        Line.off(
            "pressure in the water, r.m.s., of ρ g H", "hydrostatic", pressed, 0.02, "noise of particles that creep"
        ),
        Line.off("speed of the air at the end, r.m.s.", "rest", stirred, 0.05, "noise", "m/s"),
    ]
    shown = "; ".join(
        f"{count} layers: {a:.2f} Δx, {100 * b:.2f} %, {c:.3f} m/s"
        for count, (a, b, c) in zip(rows, found, strict=True)
    )
    return Found(lines, notes=[f"{duration:g} s; surface, pressure, air's speed at the end. {shown}."])


@dataclass(frozen=True)
class Between:
    """The wave between water and a lighter fluid of a density (kg/m³)."""

    density: float

    @property
    def rate(self) -> float:
        """ω (1/s): ω² = g k (ρ_w − ρ_a)/(ρ_w coth kd + ρ_a coth kd_a) (Lamb 1932, §231)."""
        cotangent = 1.0 / np.tanh(K)
        return float(np.sqrt(G * K * (1000.0 - self.density) / ((1000.0 + self.density) * cotangent)))

    def waved(self, rows: int) -> Swing:
        """The oscillation of the mode's momentum, from a level surface, with so many layers of each fluid."""
        spacing, sound = 1.0 / rows, 10.0 * np.sqrt(G)
        alpha = 8.0 * VISCOSITY / (2.0 * spacing * sound)
        water = Water(spacing, sound, alpha=alpha, air=Air(self.density, sound, alpha))
        made = of_both(water, box(1.0, 2.0), 1.0)
        set_going(made.drops, lambda place: STEEP / K * self.rate * mode(place))
        times, found = np.arange(1, round(PERIODS * A_PERIOD)) * 2.0 * np.pi / (self.rate * A_PERIOD), []
        with simulated(made) as run:
            for time in looks(run, times):
                place, velocity, mass = kept(run)
                shape = mode(place)
                found.append((time, (mass[:, None] * velocity * shape).sum() / (mass[:, None] * shape**2).sum()))
        time, amplitude = np.array(found).T
        later = time > 2.0 * np.pi / self.rate
        return swing(time[later], amplitude[later], self.rate)


def mode(place: np.ndarray) -> np.ndarray:
    """Velocities (n, 2) of the first mode of two fluids 1 m deep each in a box 1 m wide."""
    y, z = place.T
    lower, upper = z <= 1.0, np.where(z <= 1.0, z, 2.0 - z)
    along = np.where(lower, 1.0, -1.0) * np.cos(K * y) * np.cosh(K * upper)
    return np.stack([along, np.sin(K * y) * np.sinh(K * upper)], axis=1) / np.sinh(K)


def waves(fast: bool) -> Found:
    """Waves of water under air, and under a fluid of half its density."""
    rows, lines, notes = WAVED[:1] if fast else WAVED, [], []
    for fluid in (Between(1.2), *(() if fast else (Between(500.0),))):
        swings = [fluid.waved(count) for count in rows]
        errors = [one.rate / fluid.rate - 1.0 for one in swings]
        name = f"rate under a fluid of {fluid.density:g} kg/m³"
        why, allowed = "the surface is known to half a spacing; c0 = 10 √(g H)", 0.02 if fast else 0.01
        if fluid.density > 100.0:
            why, allowed = "layers of shear on both sides of the surface slow it, which the reference has not", 0.02
        source = "ω² = g k (ρ_w − ρ_a)/(ρ_w coth kd + ρ_a coth kd_a)"
        lines.append(Line(name, swings[-1].rate, fluid.rate, source, allowed, why, "1/s"))
        lines += order_line(name, [1.0 / count for count in rows], errors, 0.01)
        decays = ", ".join(f"{one.decay / (2.0 * VISCOSITY * K**2):.2f}" for one in swings)
        shown = ", ".join(f"{100 * error:+.2f} %" for error in errors)
        notes.append(f"{fluid.density:g} kg/m³, {rows} layers: rates {shown}; decay over 2 ν k², {decays}.")
    return Found(lines, notes=notes)


def squeezed(sound: float, rows: int) -> tuple[float, float]:
    """Mean pressure (Pa) of a closed column of air after a piston took a fifth of it, and that of p V^1.4."""
    spacing, width = COLUMN / rows, 8.0 * COLUMN / rows
    of_water = max(10.0 * np.sqrt(G * POOL), sound / 7.4)
    water = Water(spacing, of_water, air=Air(sound_speed=sound, alpha=0.1))
    top, outline = POOL + COLUMN, box(width, POOL + 1.3 * COLUMN)
    closed = box(width, top)
    drops = with_air(at_rest(closed, POOL, water, G), air_above(closed, POOL, water, G))[None]
    speed = 1.5 * PRESSED / SQUEEZE
    lid = Body(
        ((-0.6 * width, top), (0.6 * width, top)), (0.0, -PRESSED), speed=speed, acceleration=4.5 * PRESSED / SQUEEZE**2
    )
    with simulated(scene(water, drops, outline, parts=(lid,))) as run:
        list(looks(run, [SQUEEZE + 0.1]))
        found, start = [], run.time
        for _ in looks(run, start + np.arange(1, 11) * 0.02):
            found.append(run.observe()["air_mean_pressure"][0])
    at_rest_pressure = 1.2 * sound**2 / 1.4
    return float(np.mean(found)), at_rest_pressure * ((COLUMN / (COLUMN - PRESSED)) ** 1.4 - 1.0)


def column(fast: bool) -> Found:
    """Closed air at a fifth less volume, for a slow and for the real speed of sound."""
    lines = []
    for name, sound in (("equal", 10.0 * np.sqrt(G * POOL)), *(() if fast else (("real", REAL),))):
        found, wanted = squeezed(sound, 8 if fast else 16)
        share = 1.2 * sound**2 / 1.4
        value, exact = (1.0 + pressure / share for pressure in (found, wanted))
        lines.append(Line(f"p/p_a, {name} speed of sound", value, exact, "p V^1.4", 0.01, "1 % at a fifth less volume"))
    return Found(lines)


def balance(_: bool) -> Found:
    """Both fluids in space without walls, stirred: momentum and energy."""
    water = Water(0.05, 20.0, alpha=0.02, periodic=("y", "z"), air=Air(1.2, 15.0, 0.02))
    place = grid(1.0, 1.0, 0.05) + np.array([-0.5, 0.0])
    gas = (np.abs(place[:, 1] - 0.5) > 0.25).astype(float)
    order = np.argsort(gas, kind="stable")
    drops, random = np.zeros((1, len(place), 7)), np.random.default_rng(1)
    drops[0, :, [Y, Z]] = (place[order] + 0.005 * random.uniform(-1.0, 1.0, place.shape)).T
    drops[0, :, VOLUME], drops[0, :, GAS] = 0.05**2, gas[order]
    set_going(drops, lambda where: 0.2 * random.uniform(-1.0, 1.0, where.shape))
    with simulated(scene(water, drops, box(1.0, 1.0), 0.0, step=1e-3)) as run:
        start = run.observe()
        _, before, mass = kept(run)
        run.advance(200)
        end = run.observe()
        change = np.abs(mass @ (kept(run)[1] - before)).max() / (mass @ np.hypot(*before.T))
    lost = start["water_total"][0] - end["water_total"][0]
    taken = sum(end[name][0] - start[name][0] for name in ("water_viscous", "water_diffusive", "water_held"))
    return Found(
        [
            Line.off("momentum, of Σ m |u|", "kept", change, 1e-12, "pair forces are equal and opposite"),
            Line(
                "energy that viscosity and diffusion take, of what is lost",
                taken / lost,
                1.0,
                "balance",
                0.01,
                "the step",
            ),
        ]
    )


CASES = (
    Case("water-air-rest", SECTION, "A still tank of water and air", still),
    Case("water-air-wave", SECTION, "The wave between water and air", waves),
    Case("water-air-column", SECTION, "Air in a closed column", column),
    Case("water-air-balance", SECTION, "What pairs of water and air keep", balance, quick=True),
)
