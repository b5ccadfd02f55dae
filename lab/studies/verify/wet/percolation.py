"""Water that flows through a bed of fixed grains, for a hundred diameters."""

from dataclasses import dataclass

import numpy as np

from lab.studies.case import Case, Found, Line, Table
from lab.studies.verify.water.scenes import G, box
from lab.studies.verify.wet.grain import SECTION
from lab.studies.verify.wet.laws import DENSITY, speed_between
from lab.studies.verify.wet.scenes import advance, evenly, glass, simulated, solid_area, wet
from solvers.fluid.given import Water
from solvers.grains.given import Grains
from solvers.mixture.given import Mixture
from solvers.motion.tilt import Tilt
from solvers.simulation import Simulation

WIDTH, DEEP, HEIGHT = 0.12, 0.1, 0.3  # m
SIZE, SPACING, SHARE = 3e-3, 6e-3, 0.75  # m, m: grains that fill so much of the plane
BED, SLOPE, SOUND = 0.16, 0.1, 10.0  # m, rad, m/s: the bed stands out of the water
EVERY, LOOKS = 0.9, 10  # s: ten diameters of flow, a hundred in all
LOW, HIGH = 0.02, 0.07  # m: where the pressure is looked at
STILL = 3  # looks, from the third on: it has come to rest


def fixed_bed(width: float, height: float, size: float, share: float) -> np.ndarray:
    """Fixed grains (n, 3): y, z, radius in m, of a `size` (m) that fill a share of a tank, as a shaken crystal."""
    apart = size * np.sqrt(np.pi / (2.0 * np.sqrt(3.0) * share))
    columns = round(width / apart)
    apart = width / columns
    random, lines = np.random.default_rng(1), int((height - 0.5 * size) / (0.5 * np.sqrt(3.0) * apart)) + 1
    place = np.array(
        [
            [(k + 0.25 + 0.5 * (line % 2)) * apart - 0.5 * width, 0.5 * size + line * 0.5 * np.sqrt(3.0) * apart]
            for line in range(lines)
            for k in range(columns)
        ]
    )
    place += random.uniform(-0.15, 0.15, place.shape) * (apart - 0.8 * size)
    place[:, 0] = (place[:, 0] + 0.5 * width) % width - 0.5 * width
    return np.column_stack([place, np.full(len(place), 0.5 * size)])


@dataclass(frozen=True)
class Look:
    """Level (m), mean pressure (Pa), its scatter off a line in the middle of the depth (Pa), and speed (m/s)."""

    level: float
    pressure: float
    scatter: float
    speed: float


def look(run: Simulation) -> Look:
    """What there is to be seen now."""
    now, p = run.snapshot(), run.water.particles
    height, pressure = now["water_position"][0, :, 1], now["water_pressure"][0]
    inner = (height > LOW) & (height < HIGH)
    line = np.polyval(np.polyfit(height[inner], pressure[inner], 1), height[inner])
    level = p.read(p.volume)[0][0].sum() / WIDTH
    return Look(level, pressure.mean(), (pressure[inner] - line).std(), -now["water_velocity"][0, :, 0].mean())


def flowing() -> tuple[list[Look], float]:
    """Looks ten diameters of flow apart, and the mean porosity that water sees."""
    bed = fixed_bed(WIDTH, BED, SIZE, SHARE)
    area = WIDTH * DEEP * (1.0 - solid_area(SIZE) * len(bed) / (WIDTH * BED))
    grains = Grains(np.full((1, 1), 0.5 * SIZE), glass(), glass(), fixed=bed, stiffness_scale=1e-3)
    water = Water(SPACING, SOUND, periodic=("y",), alpha=0.02)
    drops = evenly(round(area / SPACING**2), area)
    motions = [(Tilt(angle=SLOPE, rate=0.5),)]
    scene = wet(box(WIDTH, HEIGHT), grains, water, drops, Mixture(level=DEEP), thickness=SIZE, motions=motions)
    found = []
    with simulated(scene, np.array([[[0.0, HEIGHT - 0.02]]])) as run:
        for n in range(LOOKS):
            advance(run, (n + 1) * EVERY)
            found.append(look(run))
        seen = run.water.particles.read(run.water.particles.porosity)[0].mean()
    return found, float(seen)


def percolation(_: bool) -> Found:
    """A bed without end, tilted by 0.1 rad."""
    found, seen = flowing()
    head = DENSITY * G * np.cos(SLOPE) * DEEP
    first, rest = found[0], found[1:]
    told = speed_between(seen * DENSITY * G * np.sin(SLOPE) / (1.0 - seen), seen, SIZE)
    level = max((one.level - first.level for one in rest), key=abs)
    pressure = max((one.pressure / (0.5 * head) - 1.0 for one in rest), key=abs)
    scatter = max(one.scatter for one in found[STILL - 1 :]) / head
    speed, mean = float(np.mean([one.speed for one in rest])), "the mean of ε at particles stands for that of the law"
    drift = "a density that is carried drifts with the way that water goes between grains, if nothing holds it"
    lines = [
        Line("speed between grains", speed, told, "the law's closed form", 0.03, mean, "m/s"),
        Line.off("change of the level from 10 diameters of flow on", "volume", level, 0.1 * SPACING, drift, "m"),
        Line.off("mean pressure from 20 diameters on, of that at rest", "ρ g H/2", pressure, 0.02, drift),
        Line.off("scatter of the pressure from 30 on, of ρ g H", "a line", scatter, 0.02, "grains that it must pass"),
    ]  # fmt: skip
    rows = [
        (f"{10 * (n + 1)}", f"{1e3 * (one.level - first.level):+.3f} mm", f"{one.pressure:.1f} Pa",
         f"{one.scatter:.1f} Pa", f"{1e3 * one.speed:.2f} mm/s")
        for n, one in enumerate(found)
    ]  # fmt: skip
    note = f"Half of ρ g H is {0.5 * head:.1f} Pa, the porosity {seen:.3f}."
    names = "diameters of flow", "level over the first", "mean pressure", "scatter", "speed"
    return Found(lines, notes=[note], tables=[Table(names, rows)])


CASES = (Case("wet-percolation", SECTION, "Water through a fixed bed", percolation, quick=False),)
