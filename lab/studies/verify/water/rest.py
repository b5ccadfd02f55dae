"""Water at rest in a box and between slanted walls: pressure, level, load, and how little it moves."""

from dataclasses import dataclass

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.water.scenes import G, box, chamfered, looks, order_line, resting, simulated
from solvers.fluid.given import Gauge, Level, Water
from solvers.fluid.start.rest import hydrostatic_deviation
from solvers.tank.outline import area_below

SECTION = "Water: rest"
WIDTH, DEPTH, HEIGHT, CUT = 0.3, 0.3, 0.45, 0.09  # m
SOUND = 10.0 * np.sqrt(G * DEPTH)
ROWS, LONG, SHORT = (10, 20, 40), 60.0, 5.0  # layers; s
STILL = 1e-4  # of ρ g H V
SLANTED = 20.0  # s, of the tanks whose walls are slanted all the way


@dataclass(frozen=True)
class Vessel:
    """A tank: its outline (m, 2) m, a point of its wall where pressure and depth are measured (m), and how long
    it rests (s)."""

    outline: np.ndarray
    gauge: tuple[float, float] = (0.0, 0.0)
    duration: float = LONG


VESSELS = {
    "box": Vessel(box(WIDTH, HEIGHT)),
    "chamfers": Vessel(chamfered(WIDTH, HEIGHT, CUT)),
    "vee": Vessel(np.array([(0.0, 0.0), (0.3, 0.45), (-0.3, 0.45)]), (0.1, 0.15), SLANTED),
    "trapezoid": Vessel(np.array([(-0.1, 0.0), (0.1, 0.0), (0.25, 0.45), (-0.25, 0.45)]), duration=SLANTED),
}


@dataclass(frozen=True)
class Rest:
    """What was seen in the second half: pressures in ρ g H, energies in ρ g H V, levels in H, loads in weights."""

    pressure: float  # root mean square of the errors of all particles, at the worst look
    lasting: float  # root mean square of the particles' mean errors over the looks
    noise: float  # standard error of these means, root mean square over the particles
    gauge: float  # error of the gauge, likewise
    stirred: float  # largest kinetic energy at any look, from the first second on
    level: float  # error of the level in the middle
    down: float
    sideways: float


def rested(vessel: Vessel, rows: int, duration: float) -> Rest:
    """Water in a tank, left alone for a time (s)."""
    outline, deep = vessel.outline, DEPTH - vessel.gauge[1]
    gauges, levels = (Gauge(vessel.gauge, DEPTH / 10.0),), (Level(vessel.gauge[0]),)
    water = Water(DEPTH / rows, SOUND, gauges=gauges, levels=levels)
    head, area = water.density * G * DEPTH, area_below(outline, DEPTH)
    times = np.arange(1.0, duration + 0.5)
    errors, gauged, kinetic, loads = [], [], [], []
    with simulated(resting(water, outline, DEPTH)) as run:
        mass = float(run.water.particles.mass.to_numpy().sum())
        for _ in looks(run, times):
            rows_now, state = run.observe(), run.snapshot()
            below = np.maximum(DEPTH - state["water_position"][0, :, 1], 0.0)
            error = state["water_pressure"][0] - exact(below, water)
            errors.append(error / head)
            gauged.append((rows_now["gauge_pressure"][0, 0] - exact(deep, water)) / head)
            kinetic.append(rows_now["water_kinetic"][0] / (head * area))
            loads.append(rows_now["wall_force"][0, :2] / (mass * G))
        level = rows_now["level_depth"][0, 0]
    half = len(loads) // 2
    load, gauge, late = np.mean(loads[half:], axis=0), max(gauged[half:], key=abs), np.array(errors[half:])
    worst, lasting, noise = rms(late, 1).max(), rms(late.mean(0)), rms(late.std(0)) / np.sqrt(len(late))
    return Rest(worst, lasting, noise, gauge, max(kinetic), (level - deep) / DEPTH, -load[1], load[0])


def rms(value: np.ndarray, axis: int | None = None) -> np.ndarray:
    """Root mean square along an axis, or of all."""
    return np.sqrt((value**2).mean(axis))


def exact(below: np.ndarray | float, water: Water) -> np.ndarray:
    """Pressure (Pa) at depths (m) of the weakly compressible water: ρ0 c0² (exp(g d/c0²) − 1), ρ0 g d to 0.5 %."""
    return water.density * water.sound_speed**2 * hydrostatic_deviation(below, G, water.sound_speed, water.state)


def check(name: str, fast: bool) -> Found:
    """Hydrostatic rest at three spacings; the last decides."""
    vessel = VESSELS[name]
    rows, duration = (ROWS[:1], SHORT) if fast else (ROWS, vessel.duration)
    found = [rested(vessel, count, duration) for count in rows]
    best, spacings = found[-1], [DEPTH / count for count in rows]
    hydrostatic = "hydrostatic"
    allowed = 0.02 if fast else 0.01
    why = "noise of particles that creep; 2 % at ten layers"
    lines = [
        Line.off("pressure, r.m.s., of ρ g H", hydrostatic, best.pressure, allowed, why),
        Line.off("pressure of a gauge in the wall, of ρ g H", hydrostatic, best.gauge, allowed, why),
        Line.off("kinetic energy, of ρ g H V", "rest", best.stirred, STILL, "speeds of 1.4 % of √(g H)"),
        Line.off("level, of H", "volume", best.level, 0.2 / rows[-1], "a fifth of a spacing"),
        Line("load on the tank, of the weight", best.down, 1.0, "weight", 1e-3, "mean over the second half"),
        Line.off("load sideways, of the weight", "rest", best.sideways, 1e-3, "mean over the second half"),
        *order_line("the pressure, mean over the second half", spacings, [one.lasting for one in found], best.noise),
    ]
    spread = [(one.lasting, one.noise) for one in found]
    shown = ", ".join(f"{100 * one.pressure:.2f} % and {one.stirred:.1e}" for one in found)
    lasting, noise = (", ".join(f"{100 * one:.2f} %" for one in each) for each in zip(*spread, strict=True))
    note = f"""{duration:g} s of rest with {", ".join(map(str, rows))} layers; the largest r.m.s. error of the pressure
    in the second half, of ρ g H, and the largest kinetic energy, of ρ g H V, from the first second on: {shown}. The
    mean error of each particle over the looks of the second half is, r.m.s., {lasting}, with standard errors of
    {noise}. Their order is told where the finest is above its standard error."""
    return Found(lines, notes=[note])


def case(name: str, title: str, quick: bool = False) -> Case:
    """The case of a vessel by its name."""
    suffix = "" if name == "box" else f"-{name}"
    return Case(f"water-rest{suffix}", SECTION, title, lambda fast: check(name, fast), quick=quick)


CASES = (
    case("box", "A column of water at rest", quick=True),
    case("chamfers", "Water at rest between slanted corners"),
    case("vee", "Water at rest in a vee"),
    case("trapezoid", "Water at rest in a trapezoid"),
)
