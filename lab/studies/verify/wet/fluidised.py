"""A bed that water is pumped up through: at rest on its grid, and fluidised."""

from dataclasses import dataclass

import numpy as np

from lab.report.plots import BLUE, canvas
from lab.studies.case import Case, Found, Line, Picture, Table
from lab.studies.verify.water.scenes import G, box
from lab.studies.verify.wet.grain import SECTION
from lab.studies.verify.wet.laws import DENSITY, bed_drop, settling_speed
from lab.studies.verify.wet.scenes import (
    HEAVY,
    SIZE,
    SPACING,
    advance,
    evenly,
    glass,
    on_walls,
    simulated,
    solid_area,
    wet,
)
from solvers.fluid.given import Pull, Water
from solvers.grains.given import Grains
from solvers.mixture.given import Mixture
from solvers.mixture.start import laid, porosity_map
from solvers.scene import Scene
from solvers.simulation import Simulation

COLUMNS, LINES, LOOSE = 14, 90, 1.005  # grains, as they are laid; diameters between columns
WIDTH, ROUND = LOOSE * COLUMNS * SIZE, 0.86  # m: the shaft, and the way round once
PLATE, PLATE_LINES, PLATE_GAP = 0.7, 14, 1.02  # m: where the plate of fixed grains begins; lines, diameters
SOUND, PRESSED = 30.0, 4000.0  # m/s; Pa, under which all is, so that walls need not pull
ALPHA = 0.2  # with 0.02 water that leaves the bed at 30 mm/s is stirred to 1 m/s
FAR = 1e6  # m: from there the pump pulls
WEIGHT = LINES * COLUMNS * np.pi / 6.0 * SIZE**3 * (HEAVY - DENSITY) * G / (SIZE * WIDTH)  # Pa, buoyant
PUMPED = 0.5, 0.75, 1.15, 1.35  # of WEIGHT: the pump's pressure; the plate takes its part of it
BEGUN, UNTIL, EVERY = 1.5, 3.0, 0.01  # s: looks from when to when, and how often
FIXED = 2  # how many of these do not lift the bed


@dataclass(frozen=True)
class Flow:
    """A bed under a steady flow, in the mean over looks.

    `speed` (m/s) of the flow per area, `carried`: the share of the buoyant weight that water bears, `dropped`: that
    which pressures above and below tell, `height` (m) of the bed, `stirred` (m/s): the grains' mean speed, `scatter`
    (Pa) of the pressure.
    """

    speed: float
    carried: float
    dropped: float
    height: float
    stirred: float
    scatter: float

    @property
    def porosity(self) -> float:
        """The mean porosity of the bed."""
        return 1.0 - LINES * COLUMNS * solid_area(SIZE) / (WIDTH * self.height)

    @property
    def told(self) -> float:
        """The flow (m/s) that bears a bed of this porosity, by the law."""
        return settling_speed(HEAVY - DENSITY, self.porosity, SIZE, G)


def pumped(pressure: float) -> tuple[Scene, np.ndarray, np.ndarray]:
    """Scene, grains and water of a shaft that goes on above as it begins below, under a pump's pressure (Pa).

    Water goes round; for the grains alone there is a floor. The pump's gradient P/L, and that of water at rest, act on
    water and grains alike: −V (∂p/∂z) = V ρ (g + δ), δ = P/(ρ L). Only the rest of the pressure repeats itself. So
    grains weigh (ρ_g − ρ) g − ρ δ a volume, and water ρ δ upwards: gravity is set for the grains, and the pull makes up
    the difference for the water. Both are exact.
    """
    pump = pressure / (DENSITY * ROUND)
    gravity = ((HEAVY - DENSITY) * G - DENSITY * pump) / HEAVY
    pull = Pull(((pump + gravity) / FAR) ** 0.5, (0.0, FAR))
    place, plate = bed()
    outline, taken = box(WIDTH, ROUND), solid_area(SIZE)
    water = Water(SPACING, SOUND, alpha=ALPHA, periodic=("z",), pull=pull)
    area = WIDTH * ROUND - taken * (place.shape[1] + len(plate))
    whole = np.concatenate([place[0], plate[:, :2]])
    porosity = porosity_map(whole, np.full(len(whole), taken), outline, water)
    drops = laid(porosity, round(area / SPACING**2), area, water, 0.0)[None]
    drops["position"][0, :, 1] *= ROUND / (drops["position"][0, :, 1].max() + 0.5 * SPACING)
    drops["deviation"] = PRESSED / (DENSITY * SOUND**2)
    smooth = glass(friction=0.0)
    grains = Grains(np.full(place.shape[:2], 0.5 * SIZE), smooth, smooth, fixed=plate, stiffness_scale=1e-3)
    drops_yet = evenly(drops.shape[1], area)
    scene = wet(outline, grains, water, drops_yet, Mixture(), thickness=SIZE, gravity=gravity)
    return scene, place, drops


def bed() -> tuple[np.ndarray, np.ndarray]:
    """Grains (1, n, 2) m on the floor, a little off their lattice, and those of the plate (k, 3), y, z and radius."""
    random = np.random.default_rng(0)
    y = (np.arange(COLUMNS) - 0.5 * (COLUMNS - 1)) * LOOSE * SIZE
    z = (np.arange(LINES) + 0.5) * SIZE
    place = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)
    place += random.uniform(0.0, 1.0, place.shape) * [0.002 * SIZE, 0.01 * SIZE]
    across = PLATE_GAP * SIZE
    y = (np.arange(int(WIDTH / across)) - 0.5 * (int(WIDTH / across) - 1)) * across
    z = PLATE + np.arange(PLATE_LINES) * across
    plate = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)
    return place[None], np.column_stack([plate, np.full(len(plate), 0.5 * SIZE)])


def flowing(pressure: float) -> Flow:
    """The bed under a pump's pressure (Pa)."""
    scene, place, drops = pumped(pressure)
    looks = []
    with simulated(scene, place, drops) as run:
        advance(run, BEGUN)
        before, begun = on_walls(run), run.time
        while run.time < UNTIL:
            advance(run, run.time + EVERY)
            looks.append(look(run, pressure))
        on_floor = (before - on_walls(run))[0] / (run.time - begun)
    speed, middle, stirred, drop, scatter = np.mean(looks, axis=0)
    carried = 1.0 - on_floor / (WEIGHT * SIZE * WIDTH)
    return Flow(speed, carried, drop / WEIGHT, 2.0 * middle, stirred, scatter)


def look(run: Simulation, pressure: float) -> tuple[float, ...]:
    """Flow (m/s), height of the grains' centre (m), their mean speed (m/s), and over the bed the pressure's drop (Pa).

    Last the scatter (Pa) of the pressure above the bed.
    """
    p, now = run.water.particles, run.snapshot()
    mass, upward = (values[0] for values in p.read(p.mass, p.velocity[1]))
    place, speed = now["position"][0], now["velocity"][0]
    flow = mass @ upward / DENSITY + speed[:, 1].sum() * solid_area(SIZE)
    height = now["water_position"][0, :, 1]
    reach, top = run.water.water.reach, 2.0 * place[:, 1].mean()
    excess = now["water_pressure"][0] - pressure * height / ROUND
    above = (height > top + reach) & (height < PLATE - reach)
    below = (height > PLATE + PLATE_LINES * PLATE_GAP * SIZE + reach) & (height < ROUND - reach)
    drop = excess[below].mean() + pressure - excess[above].mean()
    fast = np.linalg.norm(speed, axis=1).mean()
    return flow / (WIDTH * ROUND), place[:, 1].mean(), fast, drop, excess[above].std()


def least(flows: list[Flow]) -> tuple[float, float]:
    """The flow (m/s) at which the bed at rest would be borne, and what the law says of it at its porosity.

    From the last flow that does not lift the bed, by how drag grows with the flow at its porosity.
    """
    last, steps = flows[FIXED - 1], np.linspace(1.0, 3.0, 2001)
    drag = np.array([bed_drop(last.speed * step, last.porosity, SIZE) for step in steps])
    return last.speed * float(np.interp(1.0, last.carried * drag / drag[0], steps)), last.told


def fluidised(_: bool) -> Found:
    """Four flows from below: two that the bed bears, two that bear the bed."""
    flows = [flowing(share * WEIGHT) for share in PUMPED]
    lines = []
    start, told = least(flows)
    why = "packings of one layer are none of those that the law was made for; measured ones scatter by as much"
    lines.append(Line("flow that would lift the bed", start, told, "the law at the bed's porosity", 0.15, why, "m/s"))
    for one in flows[FIXED:]:
        at = f"at {1e3 * one.speed:.0f} mm/s"
        grid = "the lowest layer lies on the grid: the kernel smears it into the water below, 1 of 90"
        lines.append(Line(f"weight that water bears {at}, of the buoyant", one.carried, 1.0, "balance", 0.02, grid))
        uneven = "the bed is not even: where it is open, more goes through"
        lines.append(Line(f"flow {at}", one.speed, one.told, "the law at the mean porosity", 0.15, uneven, "m/s"))
    table = [
        (f"{share:g}", f"{1e3 * one.speed:.1f} mm/s", f"{one.carried:.3f}", f"{one.dropped:.3f}",
         f"{1e3 * one.height:.0f} mm", f"{one.porosity:.3f}", f"{1e3 * one.told:.1f} mm/s",
         f"{1e3 * one.stirred:.0f} mm/s", f"{one.scatter:.0f} Pa")
        for share, one in zip(PUMPED, flows, strict=True)
    ]  # fmt: skip
    head = (
        *("pump, of the weight", "flow", "weight borne", "pressure's drop", "height", "porosity"),
        *("flow that bears it, by the law", "grains' speed", "scatter of the pressure"),
    )
    note = f"""The water goes round, up through a plate of fixed grains and the bed. It has α = {ALPHA:g}: with 0.02,
    particles that leave a bed through its surface at 30 mm/s, and have to close up there, are stirred to 1 m/s, and
    one such run was stopped after 3 s. The weight borne is what the grid does not bear. The pressure's drop, told by
    particles above and below, is 0.1 to 0.15 more; the more, the higher the pressure that all are under besides, 4 to
    7 kPa here, so that it seems to be of how unevenly particles lie."""
    return Found(lines, [picture(flows)], notes=[note], tables=[Table(head, table)])


def picture(flows: list[Flow]) -> Picture:
    """What water bears against its flow, and the law for the bed at rest."""
    last = flows[FIXED - 1]
    speed = np.linspace(0.0, 1.1 * flows[-1].speed, 100)[1:]
    drag = np.array([bed_drop(one, last.porosity, SIZE) for one in speed]) * last.height / WEIGHT
    figure, axes = canvas((6.4, 3.0))
    axes.plot(speed, np.minimum(drag, 1.0), color="black", ls="--", lw=0.8, label="the law, bed at rest")
    axes.plot([one.speed for one in flows], [one.carried for one in flows], "o", color=BLUE, label="computed")
    axes.set(xlabel="flow per area (m/s)", ylabel="weight that water bears, of the buoyant")
    axes.legend()
    return Picture("wet-fluidised", figure, "Weight that the flow bears, of the bed's buoyant weight.")


CASES = (Case("wet-fluidised", SECTION, "A bed that is fluidised", fluidised, quick=False),)
