"""A suspension that settles: its speed is the law's at its porosity, and the pressure bears the grains."""

from dataclasses import dataclass

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.water.scenes import G, box
from lab.studies.verify.wet.grain import SECTION
from lab.studies.verify.wet.laws import DENSITY, settling_speed
from lab.studies.verify.wet.scenes import HEAVY, SIZE, SPACING, advance, evenly, glass, rows, simulated, solid_area, wet
from solvers.fluid.given import Water
from solvers.grains.given import Grains
from solvers.mixture.given import Mixture

WIDTH, LEVEL, HEIGHT, SOUND = 0.128, 0.3, 0.32, 18.0  # m, m/s
GAPS = 1.25, 1.6  # diameters between grains, as wanted
LOWEST, HIGH = 0.04, 0.2  # m: the suspension's lower end and height
EDGE = 0.04  # m at both ends that are not looked at
# By 80 ms grains have come within 1 % of their speed; until 130 ms the suspension is even, then it overturns.
STEADY, UNTIL, EVERY = 0.08, 0.127, 2e-3  # s
PERIOD = 0.06  # s: from then on it is one period, 4 H/c0 = 67 ms, of the slowest sound


@dataclass(frozen=True)
class Settled:
    """A suspension's porosity; the speed (m/s) at which it sank; and the pressure's gradient over ρ g."""

    porosity: float
    speed: float
    gradient: float

    @property
    def told(self) -> float:
        """The speed (m/s) by the law."""
        return settling_speed(HEAVY - DENSITY, self.porosity, SIZE, G)

    @property
    def borne(self) -> float:
        """The gradient over ρ g that bears water and grains."""
        return 1.0 + (1.0 - self.porosity) * (HEAVY - DENSITY) / DENSITY


def settled(gap: float) -> Settled:
    """Grains about so many diameters apart, let go in water at rest."""
    columns = int(WIDTH / (gap * SIZE))
    gap = WIDTH / columns / SIZE
    place = rows(columns, int(HIGH / (gap * SIZE)), gap, LOWEST)
    grains = Grains(np.full(place.shape[:2], 0.5 * SIZE), glass(), glass(), stiffness_scale=1e-3)
    drops = evenly(round(0.8 * WIDTH * LEVEL / SPACING**2), WIDTH * LEVEL)
    water = Water(SPACING, SOUND, alpha=0.02)
    found = []
    with simulated(wet(box(WIDTH, HEIGHT), grains, water, drops, Mixture(level=LEVEL), thickness=SIZE), place) as run:
        while run.time < UNTIL:
            advance(run, run.time + EVERY)
            found.append((run.time, *looked_at(run.snapshot())))
    time, speed, slope = np.array(found).T
    porosity = 1.0 - solid_area(SIZE) / (gap * SIZE) ** 2
    return Settled(porosity, -speed[time > STEADY].mean(), -slope[time > PERIOD].mean() / (DENSITY * G))


def looked_at(now: dict[str, np.ndarray]) -> tuple[float, float]:
    """The mean upward speed (m/s) of the grains away from both ends, and the pressure's slope (Pa/m) there."""
    place, speed = now["position"][0, :, 1], now["velocity"][0, :, 1]
    low, high = place.min() + EDGE, place.max() - EDGE
    depth = now["water_position"][0, :, 1]
    within = (depth > low) & (depth < high)
    slope = np.polyfit(depth[within], now["water_pressure"][0, within], 1)[0]
    return speed[(place > low) & (place < high)].mean(), slope


def settling(_: bool) -> Found:
    """Two suspensions, and the exponent of porosity between them (Richardson & Zaki 1954)."""
    found = [settled(gap) for gap in GAPS]
    lines = []
    for one in found:
        at = f"at ε = {one.porosity:.2f}"
        speed = "an exponent that is off by 0.25, the scatter of those that are measured"
        allowed = -0.25 * np.log(one.porosity)
        lines.append(Line(f"speed {at}", one.speed, one.told, "the law's closed form", allowed, speed, "m/s"))
        still = "grains still gain 0.3 m/s², a thirtieth of g, and sound swings"
        name = f"pressure's gradient {at}, over ρ g"
        lines.append(Line(name, one.gradient, one.borne, "the weight of both", 0.05, still))
    loose, dense = found[1], found[0]
    logs = np.log(loose.porosity / dense.porosity)
    power, told = np.log(loose.speed / dense.speed) / logs, np.log(loose.told / dense.told) / logs
    scatter, name = "the scatter of measured exponents", "exponent of ε between the two"
    lines.append(Line(name, power, told, "the law's closed form", 0.25, scatter, relative=False))
    note = """The pressure is the mean over one period of the slowest sound, 4 H/c0. As the grains are let go, all at
    once, its gradient swings by up to 30 % of their buoyant weight to either side."""
    return Found(lines, notes=[note])


CASES = (Case("wet-settling", SECTION, "Suspensions that settle", settling, quick=False),)
