"""A layer of grains under water that consolidates under its own weight (Terzaghi 1923)."""

from dataclasses import dataclass

import numpy as np

from lab.studies.case import Case, Found, Line, Picture, Table
from lab.studies.verify.water.drawing import courses
from lab.studies.verify.water.scenes import G, box
from lab.studies.verify.wet.laws import DENSITY
from lab.studies.verify.wet.scenes import (
    HEAVY,
    SIZE,
    SPACING,
    advance,
    as_found,
    evenly,
    glass,
    simulated,
    solid_area,
    wet,
)
from lab.studies.verify.wet.smearing import lowered
from solvers.fluid.given import Water
from solvers.grains.given import Grains
from solvers.grains.laws.linear_spring import spring_coefficient, spring_stiffness
from solvers.grains.materials import Material, effective_young, hertz_stiffness
from solvers.mixture.given import Mixture
from solvers.scene import Scene

SECTION = "Wet cargo: beds"
COLUMNS, LINES = 16, (40, 80)  # grains
SPRING, HELD = 2500.0, 3e-4  # N/m; of a diameter, by which columns are pressed together, so that they do not buckle
SOUND, LIQUID = 120.0, 4e-5  # m/s, m²/s: forty times as viscous as water, so that the law of drag is linear to 2 %
LASTS, SLOW = 0.2, 4.0  # s, H²/c_v of the deeper layer; of one that drains slowly
ABOVE, CALM, LIGHT = 20, 2.0, 0.1  # diameters of water over it; s; of the buoyant weight, while the water comes to rest
FACTORS = 0.1, 0.3, 0.6  # time factors T = c_v t/H² that are looked at
EVERY, TERMS, BINS = 1e-3, 200, 10
SLOWLY = 0.1  # the time factor at which the slow layer is looked at


def consolidated(factor: np.ndarray | float) -> np.ndarray:
    """Degree of consolidation U = 1 − Σ 4 (−1)^m/N³ exp(−N² T), N = π (m + ½), of an excess pressure γ' z at first.

    z is the depth below the surface, which drains, over a floor that does not (Terzaghi 1923, Terzaghi & Fröhlich
    1936). U is that of the settlement, and one less the mean excess pressure over that at first.
    """
    m = np.arange(TERMS)
    terms = 4.0 * (-1.0) ** m / (np.pi * (m + 0.5)) ** 3
    return 1.0 - np.exp(-np.multiply.outer(factor, (np.pi * (m + 0.5)) ** 2)) @ terms


def excess(depth: np.ndarray, factor: float) -> np.ndarray:
    """Excess pressure over γ' H at depths (n,) of H: Σ 2 (−1)^m/N² sin(N z) exp(−N² T)."""
    m = np.arange(TERMS)
    n = np.pi * (m + 0.5)
    return np.sin(np.outer(depth, n)) @ (2.0 * (-1.0) ** m / n**2 * np.exp(-(n**2) * factor))


def softened(grain: Material) -> float:
    """The factor on the stiffness with which two grains are a spring of SPRING (N/m), by the linear law."""
    mass = np.pi / 6.0 * SIZE**3 * grain.density
    whole = hertz_stiffness(effective_young(grain, grain), 0.25 * SIZE)
    return (SPRING / spring_stiffness(spring_coefficient(grain.restitution_speed), whole, 0.5 * mass)) ** 1.25


@dataclass(frozen=True)
class Layer:
    """So many lines of grains in columns between smooth walls, and the water above; SI units.

    Columns are springs in a row: M = k d/(a b) with a between them and b the slab's thickness. The water's own
    compressibility ε/(ρ c0²) adds to 1/M, and takes the share 1 − B of the weight off the pressure at first.
    """

    lines: int
    lasts: float = LASTS  # H²/c_v of 80 lines

    @property
    def apart(self) -> float:
        """Distance between columns."""
        return SIZE * (1.0 - HELD)

    @property
    def height(self) -> float:
        """H, the depth of the layer."""
        return self.lines * SIZE

    @property
    def width(self) -> float:
        """The width of the tank."""
        return COLUMNS * self.apart

    @property
    def porosity(self) -> float:
        """ε."""
        return 1.0 - solid_area(SIZE) / (self.apart * SIZE)

    @property
    def buoyant(self) -> float:
        """γ', the buoyant weight of a volume."""
        return (1.0 - self.porosity) * (HEAVY - DENSITY) * G

    @property
    def modulus(self) -> float:
        """M."""
        return SPRING * SIZE / (self.apart * SIZE)

    @property
    def share(self) -> float:
        """B, the share of a sudden load that water bears (Skempton 1954)."""
        return 1.0 / (1.0 + self.modulus * self.porosity / (DENSITY * SOUND**2))

    @property
    def finer(self) -> float:
        """d over the true size with which c_v = H²/lasts of 80 lines, by Ergun's law for slow flow.

        c_v = B k M/μ, k = ε³ d²/(150 (1 − ε)²).
        """
        diffusion = (LINES[-1] * SIZE) ** 2 / self.lasts
        mobility = diffusion / (self.share * self.modulus)
        true = mobility * 150.0 * DENSITY * LIQUID * (1.0 - self.porosity) ** 2 / self.porosity**3
        return SIZE / float(np.sqrt(true))

    @property
    def period(self) -> float:
        """H²/c_v."""
        return self.lasts * (self.lines / LINES[-1]) ** 2

    @property
    def sinking(self) -> float:
        """The settlement of the surface in the end, γ' H²/2M."""
        return 0.5 * self.buoyant * self.height**2 / self.modulus

    @property
    def ringing(self) -> float:
        """The period of the slowest sound: 4 (H + water above)/c, of grains and water that move as one."""
        density = self.porosity * DENSITY + (1.0 - self.porosity) * HEAVY
        return 4.0 * (self.height + ABOVE * SIZE) / (SOUND * np.sqrt(DENSITY / (self.porosity * density)))

    @property
    def drained(self) -> float:
        """By what factor it drains sooner than one whose surface is not smeared by the kernel."""
        return (1.0 - lowered(Water(SPACING, SOUND), self.porosity) / self.height) ** -2

    def grains(self) -> np.ndarray:
        """Places (1, n, 2), which touch in columns without pressing."""
        y, z = (np.arange(COLUMNS) - 0.5 * (COLUMNS - 1)) * self.apart, (np.arange(self.lines) + 0.5) * SIZE
        return np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(1, -1, 2)

    def scene(self, density: float, alpha: float) -> Scene:
        """The scene with grains of a density and water of a viscosity."""
        grain = glass(density=density, friction=0.0, restitution=0.8)
        level = self.height + ABOVE * SIZE
        area = self.width * (self.porosity * self.height + ABOVE * SIZE)
        grains = Grains(
            np.full((1, COLUMNS * self.lines), 0.5 * SIZE), grain, grain, normal="linear", tangential="none",
            stiffness_scale=softened(grain),
        )  # fmt: skip
        mixture = Mixture("ergun", LIQUID, self.finer, level)
        water, drops = Water(SPACING, SOUND, alpha=alpha, periodic=("y",)), evenly(round(area / SPACING**2), area)
        return wet(box(self.width, level + 6.0 * SPACING), grains, water, drops, mixture, thickness=SIZE)


@dataclass(frozen=True)
class Course:
    """What became of a layer: at times (T,) s the surface's settlement (T,) m and the excess pressure (T, BINS) Pa.

    The bins go from the surface down.
    """

    layer: Layer
    time: np.ndarray
    sunk: np.ndarray
    pressure: np.ndarray

    def about(self, factor: float) -> np.ndarray:
        """Weights (T,) of looks about a time factor, at first for 0: a hump three periods of sound long.

        It takes the slowest sound away, and nearly all of faster ones.
        """
        half = 1.5 * self.layer.ringing
        away = (self.time - max(factor * self.layer.period, half)) / half
        weight = np.where(np.abs(away) < 1.0, 1.0 + np.cos(np.pi * away), 0.0)
        return weight / weight.sum()

    def settled(self, factor: float, sooner: float = 1.0) -> tuple[float, float]:
        """Settlement about a time factor over that in the end, and what it should be, drained so much `sooner`."""
        weight, share = self.about(factor), self.layer.share
        exact = 1.0 - share + share * consolidated(sooner * self.time / self.layer.period)
        return float(weight @ self.sunk) / self.layer.sinking, float(weight @ exact)

    def pressed(self, factor: float) -> tuple[float, float]:
        """Mean excess pressure about a time factor over that at first, B γ' H/2, and what it should be."""
        weight, first = self.about(factor), 0.5 * self.layer.share * self.layer.buoyant * self.layer.height
        exact = 1.0 - consolidated(self.time / self.layer.period)
        return float(weight @ self.pressure.mean(axis=1)) / first, float(weight @ exact)

    def profile(self, factor: float) -> tuple[np.ndarray, np.ndarray]:
        """Excess pressures (BINS,) about a time factor over B γ' H, and what they should be."""
        weight, depth = self.about(factor), (np.arange(BINS) + 0.5) / BINS
        whole = self.layer.share * self.layer.buoyant * self.layer.height
        exact = np.array([excess(depth, time / self.layer.period) for time in self.time])
        return weight @ self.pressure / whole, weight @ exact


def at_rest(layer: Layer) -> tuple[np.ndarray, np.ndarray]:
    """Water (1, n) at rest between grains that hardly weigh more, and its pressure (n,) Pa."""
    with simulated(layer.scene(DENSITY + LIGHT * (HEAVY - DENSITY), 0.5), layer.grains()) as run:
        advance(run, CALM)
        return as_found(run.water, run.time), run.snapshot()["water_pressure"][0]


def consolidating(layer: Layer, drops: np.ndarray, still: np.ndarray, until: float) -> Course:
    """A layer let go up to a time factor: its grains touch without pressing, the water bears its own weight alone."""
    place, looks = layer.grains(), []
    with simulated(layer.scene(HEAVY, 0.02), place, drops) as run:
        while run.time < until * layer.period + 1.6 * layer.ringing:
            advance(run, run.time + EVERY)
            now = run.snapshot()
            sunk = (place[0] - now["position"][0]).reshape(COLUMNS, layer.lines, 2)[:, -1, 1].mean()
            depth = (layer.height - now["water_position"][0, :, 1]) / layer.height
            bins, more = np.floor(depth * BINS), now["water_pressure"][0] - still
            looks.append((run.time, sunk, *(more[bins == k].mean() for k in range(BINS))))
    found = np.array(looks)
    return Course(layer, found[:, 0], found[:, 1], found[:, 2:])


def consolidation(_: bool) -> Found:
    """Two layers, of which the deeper one decides, and one that drains slowly."""
    courses_ = []
    for lines in LINES:
        layer = Layer(lines, LASTS * (LINES[-1] / lines) ** 2)  # all in the same time
        water = at_rest(layer)
        courses_.append(consolidating(layer, *water, FACTORS[-1]))
    best, slow = courses_[-1], consolidating(Layer(LINES[-1], SLOW), *water, SLOWLY)
    rows = [row(one, factor) for one in courses_ for factor in FACTORS] + [row(slow, SLOWLY)]
    head = "layers", "H²/c_v", "T", "settlement", "exact", "from a lower surface", "mean excess pressure", "exact"
    note = f"""γ' H = {layer.buoyant * layer.height:.0f} Pa, M = {1e-3 * layer.modulus:.0f} kPa, ε =
    {layer.porosity:.3f}, B = {layer.share:.3f}, grains {layer.finer:.2f} times finer than they are drawn. All at once
    the weight is on the water: it rings, so that values are means over three periods of its slowest
    sound, {1e3 * layer.ringing:.0f} ms. The kernel smears the surface, for the flow as if it were
    {lowered(Water(SPACING, SOUND), layer.porosity) / SIZE:.1f} d lower."""
    leak = """The layer that drains slowly does so too soon: what ties the density that particles carry to the room that
    they have (`solvers.fluid.surface.reinitialisation`) lets pressure leak from a bed in some seconds. Without it, it
    settles as one with a lower surface."""
    return Found(lines_of(best, slow), [picture(best)], notes=[note, leak], tables=[Table(head, rows)])


def lines_of(best: Course, slow: Course) -> list[Line]:
    """What is judged."""
    smeared = "a surface that is smeared is 0.03 ahead; the keeping of volume leaks"
    borne = "nothing has drained yet, water bears all; what is left of sound"
    name = "mean excess pressure at first, drained slowly, of B γ' H/2"
    lines = [Line(name, *slow.pressed(0.0), "the buoyant weight", 0.05, borne)]
    for factor in FACTORS:
        settled, pressed = best.settled(factor), best.pressed(factor)
        name = f"settlement at T = {factor:g}, of all"
        lines.append(Line(name, *settled, "Terzaghi", 0.05, smeared, relative=False))
        name = f"mean excess pressure at T = {factor:g}"
        lines.append(Line(name, *pressed, "Terzaghi", 0.05, smeared, relative=False))
        found, exact = best.profile(factor)
        off = float(np.sqrt(((found - exact) ** 2).mean()))
        lines.append(Line.off(f"excess pressure at T = {factor:g}, r.m.s. over depth", "Terzaghi", off, 0.05, smeared))
    return lines


def row(one: Course, factor: float) -> tuple[str, ...]:
    """A course in the table."""
    layer = one.layer
    values = *one.settled(factor), one.settled(factor, layer.drained)[1], *one.pressed(factor)
    return str(layer.lines), f"{layer.period:g} s", f"{factor:g}", *(f"{value:.3f}" for value in values)


def picture(course: Course) -> Picture:
    """Excess pressure over depth."""
    depth, curves = (np.arange(BINS) + 0.5) / BINS, {}
    for factor in FACTORS:
        found, exact = course.profile(factor)
        curves[f"T = {factor:g}"] = depth, found
        curves[f"T = {factor:g}, exact"] = depth, exact
    figure = courses(curves, ("depth, of H", "excess pressure, of B γ' H"))
    return Picture("wet-consolidation", figure, "Excess pressure in a layer that consolidates, over depth.")


CASES = (Case("wet-consolidation", SECTION, "A layer that consolidates", consolidation, quick=False),)
