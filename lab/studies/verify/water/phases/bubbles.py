"""The surface between water and air under tension: a drop at rest, and a bubble that rises."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BLUE, GREY, VERMILION, canvas
from lab.studies.case import Case, Found, Line, Picture
from lab.studies.verify.water.scenes import bearing, box, looks, order_line, scene, simulated
from solvers.fluid.given import Air, Water, particles
from solvers.fluid.phases.adiabatic import Adiabatic
from solvers.fluid.start.packing import packed
from solvers.scene import Scene
from solvers.simulation import Simulation

SECTION = "Water and air"
SIDE, RADIUS, TENSION = 1.0, 0.25, 1.0  # m, m, N/m: a drop in a box
DROP_SOUND, STIFFER = 1.0, 3.0  # m/s of the water; the air's over it
RESTED = 3.0  # s
CORNERS = 96  # of a circle's polygon
# Hysing et al. (2009), Int. J. Numer. Meth. Fluids 60, 1259, case 1, their finest grids.
LIGHT, VISCOUS, THIN, PULL, TAUT = 100.0, 10.0, 1.0, 0.98, 24.5  # kg/m³, Pa s, Pa s, m/s², N/m
FASTEST, WHEN, CENTRE, ROUNDEST = 0.2417, 0.92, 1.0813, 0.9012  # m/s, s, m at 3 s, least circularity
SOUND = 10.0 * np.sqrt(PULL * 2.0)  # m/s
RISING = 3.0  # s
ROWS = (24, 48, 72)  # particles a metre


def circle(radius: float, middle: tuple[float, float]) -> np.ndarray:
    """A polygon (k, 2) m with the area of a circle, counter-clockwise."""
    turns = 2.0 * np.pi * (np.arange(CORNERS) + 0.5) / CORNERS
    same_area = radius * np.sqrt(2.0 * np.pi / (CORNERS * np.sin(2.0 * np.pi / CORNERS)))
    return np.array(middle) + same_area * np.stack([np.cos(turns), np.sin(turns)], axis=1)


def of_both(outline: np.ndarray, round_one: np.ndarray, water: Water, gas_inside: bool) -> np.ndarray:
    """Drops (1, n) at rest, without pressure: one fluid in a polygon, the other round it in the tank."""
    top = outline[:, 1].max()
    inner = packed(round_one, round_one[:, 1].max(), water)
    outer = packed(outline, top, water, [round_one])
    parts = [(inner, gas_inside), (outer, not gas_inside)]
    found = []
    for packing, gas in sorted(parts, key=lambda part: part[1]):
        drops = particles(len(packing.points))
        drops["position"], drops["volume"], drops["gas"] = packing.points, packing.volume, float(gas)
        found.append(drops)
    return np.concatenate(found)[None]


def pressed(drops: np.ndarray, water: Water, pressure: np.ndarray) -> None:
    """Give drops (1, n) the densities at which they have pressures (n,) Pa."""
    air, gas = water.air, drops["gas"][0] > 0.5
    of_water = pressure / (water.density * water.sound_speed**2)
    of_air = Adiabatic.deviation(pressure / (air.density * air.sound_speed**2))
    drops["deviation"][0] = np.where(gas, of_air, of_water)


def drop_at_rest(rows: int) -> float:
    """The pressure in a round drop over that round it, of σ/R."""
    air = Air(100.0, STIFFER * DROP_SOUND, alpha=0.2, tension=TENSION)
    water = bearing(Water(SIDE / rows, DROP_SOUND, alpha=0.2, periodic=("y", "z"), air=air))
    drops = of_both(box(SIDE, SIDE), circle(RADIUS, (0.0, 0.5 * SIDE)), water, gas_inside=False)
    inside = drops["gas"][0] < 0.5
    pressed(drops, water, np.where(inside, TENSION / RADIUS, 0.0))
    found = []
    with simulated(scene(water, drops, box(SIDE, SIDE), 0.0)) as run:
        for time in looks(run, np.arange(0.1, RESTED + 0.05, 0.1)):
            if time > 0.5 * RESTED:
                found.append(jump(run))
    return float(np.mean(found)) / (TENSION / RADIUS)


def jump(run: Simulation) -> float:
    """Mean pressure (Pa) within the drop less that round it, both well off the surface."""
    state, reach = run.snapshot(), 1.5 * run.scene.fluid.water.length
    away = [np.hypot(*(state[f"{phase}_position"][0] - [0.0, 0.5 * SIDE]).T) for phase in ("water", "air")]
    inner = state["water_pressure"][0][away[0] < RADIUS - reach]
    return float(inner.mean() - state["air_pressure"][0][away[1] > RADIUS + reach].mean())


def laplace(fast: bool) -> Found:
    """A drop's pressure at three spacings; the last decides."""
    rows = (24,) if fast else (24, 48, 96)
    found = [drop_at_rest(count) for count in rows]
    shown = ", ".join(f"{100 * (one - 1):+.2f} %" for one in found)
    allowed = 0.1 if fast else 0.02
    line = Line(
        "pressure in a drop over σ/R", found[-1], 1.0, "Laplace", allowed, "2 % at 24 particles over the radius"
    )
    return Found([line], notes=[f"Errors at {rows} particles over four radii: {shown}."])


@dataclass(frozen=True)
class Rise:
    """Centre (T,) m, speed (T,) m/s and circularity (T,) of a bubble at times (T,) s."""

    time: np.ndarray
    centre: np.ndarray
    speed: np.ndarray
    roundness: np.ndarray


def bubble(rows: int) -> Scene:
    """Case 1 of Hysing et al. (2009) with so many particles a metre: sides of symmetry, floor and lid that stick."""
    spacing = 1.0 / rows
    stiff = SOUND * np.sqrt(1000.0 / LIGHT)
    air = Air(LIGHT, stiff, kinematic=THIN / LIGHT, tension=TAUT)
    sticky = {"viscosity": "laminar-stress", "kinematic": VISCOUS / 1000.0, "slip": False}
    water = Water(spacing, SOUND, periodic=("y",), air=air, **sticky)
    outline = box(1.0, 2.0)
    drops = of_both(outline, circle(RADIUS, (0.0, 0.5)), water, gas_inside=True)
    gas = drops["gas"][0] > 0.5
    deep = 1000.0 * PULL * (2.0 - drops["position"][0, :, 1])
    pressed(drops, water, deep + np.where(gas, TAUT / RADIUS, 0.0))
    return scene(water, drops, outline, PULL)


def risen(rows: int) -> Rise:
    """How the bubble rises."""
    found = []
    with simulated(bubble(rows)) as run:
        for time in looks(run, np.arange(0.04, RISING + 0.01, 0.04)):
            state = run.snapshot()
            place, velocity = state["air_position"][0], state["air_velocity"][0]
            found.append(
                (time, place[:, 1].mean(), velocity[:, 1].mean(), roundness(place, run.scene.fluid.water.spacing))
            )
    return Rise(*np.array(found).T)


def roundness(place: np.ndarray, spacing: float) -> float:
    """Perimeter of the circle of equal area over the perimeter of the bubble, whose particles are at `place` (n, 2) m.

    The outline is where their smoothed volume is one half, on a grid of half a spacing.
    """
    import contourpy
    from scipy.ndimage import gaussian_filter

    low, high = place.min(axis=0) - 6.0 * spacing, place.max(axis=0) + 6.0 * spacing
    edges = [np.arange(a, b, 0.5 * spacing) for a, b in zip(low, high, strict=True)]
    counts = np.histogram2d(*place.T, bins=edges)[0]
    field = gaussian_filter(4.0 * counts, 2.4)
    middles = [0.5 * (edge[1:] + edge[:-1]) for edge in edges]
    lines = contourpy.contour_generator(*middles, field.T).lines(0.5)
    line = max(lines, key=len)
    y, z = line.T
    area = 0.5 * abs(y @ np.roll(z, -1) - z @ np.roll(y, -1))
    return float(2.0 * np.sqrt(np.pi * area) / np.hypot(*np.diff(line, axis=0).T).sum())


def rising(fast: bool) -> Found:
    """The bubble at three spacings; the last decides."""
    rows = ROWS[:1] if fast else ROWS
    rises = [risen(count) for count in rows]
    best, source, allowed = rises[-1], "Hysing et al. 2009, case 1", 0.1 if fast else 0.02
    why = "spread of grid methods below 0.5 %; the surface is a smoothing length thick"
    lines = [
        Line("largest rise velocity", best.speed.max(), FASTEST, source, allowed, why, "m/s"),
        Line("centre at 3 s", best.centre[-1], CENTRE, source, allowed, why, "m"),
        Line("least circularity", best.roundness.min(), ROUNDEST, source, allowed, why),
        *order_line(
            "the largest rise velocity", [1.0 / n for n in rows], [one.speed.max() / FASTEST - 1 for one in rises], 0.02
        ),
    ]
    shown = "; ".join(
        f"{n}: {one.speed.max():.4f} m/s at {one.time[one.speed.argmax()]:.2f} s, {one.centre[-1]:.4f} m, "
        f"{one.roundness.min():.3f}"
        for n, one in zip(rows, rises, strict=True)
    )
    note = f"""Particles a metre, largest velocity (reference {FASTEST} m/s at {WHEN} s), centre at 3 s, least
    circularity: {shown}."""
    return Found(lines, [Picture("water-bubble", figure(rows, rises), CAPTION)], notes=[note])


CAPTION = "Rise velocity of a bubble; the dashed line is the largest of the reference."


def figure(rows: tuple[int, ...], rises: list[Rise]) -> Figure:
    """Rise velocity against time."""
    page, axes = canvas((6.4, 3.0))
    for count, one, colour in zip(rows, rises, (GREY, VERMILION, BLUE), strict=False):
        axes.plot(one.time, one.speed, color=colour, label=f"{count} particles a metre", lw=1.0)
    axes.axhline(FASTEST, color="black", ls="--", lw=0.8)
    axes.set(xlabel="time (s)", ylabel="rise velocity (m/s)")
    axes.legend()
    return page


CASES = (
    Case("water-air-laplace", SECTION, "A drop under tension", laplace),
    Case("water-air-bubble", SECTION, "A bubble that rises", rising),
)
