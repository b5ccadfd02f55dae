"""Water in space: a box at rest, and a standing wave in a slice without ends, beside linear theory and the plane."""

from dataclasses import dataclass

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.water import waves
from lab.studies.verify.water.rest import exact, rms
from lab.studies.verify.water.scenes import LATTICE, G, Swing, box, looks, order_line, simulated, swing
from solvers.fluid.given import Fluid, Water
from solvers.fluid.start.rest import at_rest
from solvers.scene import Scene
from solvers.tank.solids.solid import Prism

SECTION = "Water: space"
SMOOTHING = 1.5  # h/Δx, that of presets in space
WIDTH, DEPTH, HEIGHT = 0.3, 0.3, 0.45  # m, of the box; as long as it is wide
SOUND = 10.0 * np.sqrt(G * DEPTH)
LAYERS, LONG = 30, 20.0  # s
FEW, SHORT = 10, 2.0
ROWS, THICK = (20, 40), 6  # layers of the wave; spacings of its slice, four smoothing lengths


@dataclass(frozen=True)
class Still:
    """Of water left alone, at the worst look of the second half: the pressures' r.m.s. error over ρ g H, and speeds,
    r.m.s. and largest, over √(g H); the load over the weight, and the mean height over half the depth at the end."""

    pressure: float
    speed: float
    fastest: float
    load: np.ndarray
    middle: float


def scene(water: Water, outline: np.ndarray, depth: float, along: float, periodic: bool = False) -> Scene:
    """A prism with a depth (m) of water at rest."""
    drops = at_rest(outline, depth, water, G, along=along)[None]
    return Scene(outline, (Fluid(water, drops),), gravity=G, solid=Prism(along, periodic))


def rested(layers: int, duration: float) -> Still:
    """A box of water with so many layers, left alone for a time (s)."""
    water, unit = Water(DEPTH / layers, SOUND, smoothing=SMOOTHING, start="lattice"), np.sqrt(G * DEPTH)
    pressure, speed, fastest, loads, middle = [], [], [], [], 0.0
    with simulated(scene(water, box(WIDTH, HEIGHT), DEPTH, WIDTH)) as run:
        mass = float(run.water.particles.mass.to_numpy().sum())
        for _ in looks(run, np.linspace(0.0, duration, 21)[1:]):
            rows, state = run.observe(), run.snapshot()
            below = np.maximum(DEPTH - state["water_position"][0, :, 1], 0.0)
            error = state["water_pressure"][0] - exact(below, water)
            moving = np.linalg.norm(state["water_velocity"][0], axis=1)
            pressure.append(float(rms(error)) / (water.density * G * DEPTH))
            speed.append(float(rms(moving)) / unit)
            fastest.append(float(moving.max()) / unit)
            loads.append(rows["wall_force"][0, :3] / (mass * G))
            middle = float(rows["water_centre"][0, 1]) / (0.5 * DEPTH)
    half = len(loads) // 2
    return Still(max(pressure[half:]), max(speed), max(fastest), np.mean(loads[half:], axis=0), middle)


def still(fast: bool) -> Found:
    """Hydrostatic rest of a box."""
    layers, duration = (FEW, SHORT) if fast else (LAYERS, LONG)
    found, allowed = rested(layers, duration), 0.02 if fast else 0.005
    lines = [
        Line.off("pressure, r.m.s., of ρ g H", "hydrostatic", found.pressure, allowed, "noise; 2 % at ten layers"),
        Line.off("speed, r.m.s., of √(g H)", "rest", found.speed, 0.01, "a tenth of the Mach number that is allowed"),
        Line("load on the tank, of the weight", -found.load[1], 1.0, "weight", 1e-3, "mean over the second half"),
        Line.off("load sideways", "rest", float(np.hypot(*found.load[[0, 2]])), 1e-3, "mean over the second half"),
    ]
    note = f"""A cube of {1e3 * DEPTH:g} mm of water with {layers} layers, {layers**3} particles, h = {SMOOTHING:g} Δx,
    left alone for {duration:g} s. The largest speed of a particle at any look is {100 * found.fastest:.2g} % of
    √(g H); the centre of mass ends at {found.middle:.5f} of half the depth."""
    return Found(lines, notes=[note])


def waved(rows: int, smoothing: float = SMOOTHING) -> Swing:
    """The standing wave of `water-wave` in a slice without ends, with so many layers of particles."""
    spacing = waves.DEPTH / rows
    alpha = 10.0 * waves.VISCOSITY / (smoothing * spacing * waves.SOUND)
    water = Water(spacing, waves.SOUND, alpha=alpha, smoothing=smoothing, start="lattice", periodic=("x",))
    made = scene(water, box(waves.WIDTH, 1.3 * waves.DEPTH), waves.DEPTH, THICK * spacing, True)
    drops = made.fluid.particles
    flow = waves.STEEP / waves.K * waves.RATE * waves.mode(drops["position"][0, :, :2])
    drops["velocity"][0, :, :2] = flow
    times = np.arange(1, round(waves.PERIODS * waves.A_PERIOD)) * 2.0 * np.pi / (waves.RATE * waves.A_PERIOD)
    found = []
    with simulated(made) as run:
        for time in looks(run, times):
            state = run.snapshot()
            shape = waves.mode(state["water_position"][0, :, :2])
            found.append((time, (state["water_velocity"][0, :, :2] * shape).sum() / (shape**2).sum()))
    time, amplitude = np.array(found).T
    later = time > 2.0 * np.pi / waves.RATE
    return swing(time[later], amplitude[later], waves.RATE)


def standing(fast: bool) -> Found:
    """Period and decay of a standing wave in a slice; the finest decides."""
    rows = ROWS[:1] if fast else ROWS
    swings, theory = [waved(count) for count in rows], waves.viscous()
    spacings, best = [waves.DEPTH / count for count in rows], swings[-1]
    slack = "as of the plane's wave: c0 = 10 √(g H) and the steepness make 0.1 %, the surface half a spacing"
    lossy = "the surface is half a spacing thick, and diffusion and noise take energy too; twice that with 20 layers"
    source = "linear theory with viscosity"
    lines = [
        Line("period", 2.0 * np.pi / best.rate, 2.0 * np.pi / waves.RATE, "ω² = g k tanh kH", 0.01, slack, "s"),
        Line("decay of the energy", 2.0 * best.decay, -2.0 * theory.real, source, 0.2 if fast else 0.1, lossy, "1/s"),
        *order_line("the period", spacings, [one.rate / theory.imag - 1.0 for one in swings], LATTICE),
    ]
    errors = (
        f"{count}: {100 * (theory.imag / one.rate - 1):.2f} %, {100 * (-one.decay / theory.real - 1):.1f} %"
        for count, one in zip(rows, swings, strict=True)
    )
    note = f"""The wave of `water-wave`, Reynolds number 500, in a slice {THICK} spacings thick that repeats itself,
    h = {SMOOTHING:g} Δx, ν = α h c/10. Errors of period and decay by layers: {"; ".join(errors)}."""
    return Found(lines, notes=[note])


CASES = (
    Case("water-space-rest", SECTION, "A box of water at rest in space", still),
    Case("water-space-wave", SECTION, "A standing wave in a slice", standing),
)
