"""A steady bore, against the jump relations of shallow water.

A stream of depth h1 runs with U against a wall. It comes to rest behind a bore, which runs away from the wall with c
and leaves a depth h2. Mass and momentum are kept across it, with hydrostatic pressure before and behind,

    (c + U) h1 = c h2,   (c + U)² = ½ g h2 (h1 + h2)/h1,

and energy is lost, per time and width ρ h1 (c + U) g (h2 − h1)³/(4 h1 h2) (Rayleigh 1914, Proc. R. Soc. A 90, 324;
Stoker 1957, Water Waves, ch. 10). It is measured on the water that was within some length of the wall at first: what
is ahead of it pushes it with ½ ρ g h1² at the speed U, and what of this it does not gain is lost. The force on the
wall is that on the tank; the far wall, which the stream leaves, has 0.3 % of it.

Tolerances follow from how a bore breaks, about once while it runs its own depth h2, so N = 12 times from 6 h2 to 18 h2
off the wall. A straight line through 12 values that scatter by σ over 12 h2 has the standard error σ √12/(√12 · 12 h2)
of its slope, and two of these are allowed. The front of a breaker swings by a quarter of h2: 4 % of c. What one
breaking leaves the next one takes; if the lost energy scatters by 0.3 of a breaking's, its slope is off by 5 %, and
ripples of 0.1 h2 behind the bore hold another 2 % of what is lost. With h2 they are 1.75 h2 long, those that stand
still behind the bore by c² = (g/k) tanh(k h2); over 2 h2 and more their mean is at most 0.1 h2 · 1.75/(2 π) = 3 % of
h2, and the wall's force, ½ ρ g h2², is off by twice as much.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from lab.studies.case import Case, Found, Line, Picture, Table
from lab.studies.verify.water.drawing import courses
from lab.studies.verify.water.scenes import G, box, looks, order_line, resting, simulated
from solvers.fluid.given import Water

SECTION = "Water: a bore"
DEPTH, RATIO = 0.1, 2.5  # m, h1; h2/h1, as shallow water has it in SPHERIC's benchmark 10 (2.1 to 2.7)
RUN, FROM = 18.0, 6.0  # in h2: how far the bore runs, and from where on it is measured
WALL, ROLLER, LEAST = 2.0, 5.0, 2.0  # in h2: what is left out at the wall and behind the front, and what must be left
LID, MARGIN = 6.0, 4.0  # in h1: height of the tank, and what its length has to spare
EVERY = 0.5  # √(h1/g), between looks
DENSITY = 1000.0  # kg/m³
UNIT = DENSITY * G * DEPTH**3  # J/m, ρ g h1³
ROWS = (6, 9, 12)  # layers of the stream
DEEP, FAST, PUSHED, LOST = 0.03, 0.04, 0.06, 0.07
SOURCE = "jump relations"


@dataclass(frozen=True)
class Jump:
    """The bore between depths `before` h1 and `after` h2 (m), the water behind it at rest."""

    before: float
    after: float

    @property
    def inflow(self) -> float:
        """c + U (m/s), with which the stream meets the bore."""
        return float(np.sqrt(0.5 * G * self.after * (self.before + self.after) / self.before))

    @property
    def speed(self) -> float:
        """c (m/s)."""
        return self.inflow * self.before / self.after

    @property
    def stream(self) -> float:
        """U (m/s)."""
        return self.inflow - self.speed

    @property
    def loss(self) -> float:
        """Energy lost per time and width (W/m)."""
        return DENSITY * self.inflow * G * (self.after - self.before) ** 3 / (4.0 * self.after)

    @property
    def push(self) -> float:
        """Force (N/m) of the water behind on the wall."""
        return 0.5 * DENSITY * G * self.after**2


JUMP = Jump(DEPTH, RATIO * DEPTH)
DURATION = RUN * JUMP.after / JUMP.speed
SOUND = 10.0 * np.sqrt(G * JUMP.after)


@dataclass(frozen=True)
class Bore:
    """Of a bore at times (T,) s, per metre of width: its place (m), the force on the wall (N) and the energies (J) lost
    in it and, in the whole tank, taken by viscosity, by diffusion and by the wall particles; of the water behind it
    volumes (m²), kinetic energies (J) and lengths (m), these zero where too little is behind."""

    time: np.ndarray
    place: np.ndarray
    force: np.ndarray
    lost: np.ndarray
    viscous: np.ndarray
    diffusive: np.ndarray
    held: np.ndarray
    volume: np.ndarray
    kinetic: np.ndarray
    length: np.ndarray

    def rate(self, name: str) -> float:
        """By how much a number of this name grows in a second, by a straight line, once the bore is measured."""
        late = self.time >= FROM * JUMP.after / JUMP.speed
        return float(np.polyfit(self.time[late], getattr(self, name)[late], 1)[0])

    @property
    def depth(self) -> float:
        """Depth (m) behind, a mean over length and time."""
        return float(self.volume.sum() / self.length.sum())

    @property
    def stirred(self) -> float:
        """Kinetic energy (W) that stays behind the bore per time."""
        return float(JUMP.speed * self.kinetic.sum() / self.length.sum())

    @property
    def kept(self) -> float:
        """Mean energy (J) that the bore should have lost by then and has not, while it is measured."""
        late = self.time >= FROM * JUMP.after / JUMP.speed
        return float((JUMP.loss * self.time - self.lost)[late].mean())

    @property
    def pushed(self) -> float:
        """Mean force (N) on the wall, while the bore is measured."""
        return float(self.force[self.time >= FROM * JUMP.after / JUMP.speed].mean())


def run_up(rows: int) -> Bore:
    """A stream with so many layers in a tank so long that what its far wall does does not reach the bore."""
    spacing, wave = DEPTH / rows, np.sqrt(G * DEPTH)
    length = np.ceil(((JUMP.inflow + wave) * DURATION + MARGIN * DEPTH) / spacing) * spacing
    water = Water(spacing, SOUND, density=DENSITY)
    start = resting(water, box(length, LID * DEPTH), DEPTH, lambda place: np.tile([-JUMP.stream, 0.0], (len(place), 1)))
    start.precision = "mixed"
    particles = start.fluid.particles[0]
    volume = (1.0 + particles["deviation"]) * particles["volume"]
    within = particles["position"][:, 0] + 0.5 * length < length - wave * DURATION - 0.5 * MARGIN * DEPTH
    found, energy = [], []
    with simulated(start) as run:
        for time in looks(run, np.arange(0.0, DURATION, EVERY * np.sqrt(DEPTH / G))):
            state, sums = run.snapshot(), run.observe()
            (y, z), speed = (state["water_position"][0] + [0.5 * length, 0.0]).T, state["water_velocity"][0]
            kinetic = 0.5 * DENSITY * volume * (speed**2).sum(axis=1)
            squeezed = 0.5 * (state["water_pressure"][0] / (DENSITY * SOUND)) ** 2
            energy.append((kinetic + DENSITY * volume * (G * z + squeezed))[within].sum())
            given = 0.5 * DENSITY * G * DEPTH**2 * JUMP.stream * time
            taken = (sums[name][0] for name in ("water_viscous", "water_diffusive", "water_wall_energy"))
            place = front(y, volume, length)
            row = place, -sums["wall_force"][0, 0], given - energy[-1] + energy[0], *taken
            found.append((time, *row, *behind(place, y, volume, kinetic)))
    return Bore(*np.array(found).T)


def front(y: np.ndarray, volume: np.ndarray, length: float) -> float:
    """How far (m) from the wall at y = 0 the depth falls through the mean of both, in columns half a depth h1 wide."""
    edges = np.arange(0.0, length, 0.5 * DEPTH)
    depth, middle = np.histogram(y, edges, weights=volume)[0] / (0.5 * DEPTH), 0.5 * (JUMP.before + JUMP.after)
    deep = np.flatnonzero(depth > middle)
    if not len(deep):
        return 0.0
    last = deep[-1]
    return float(edges[last] + 0.5 * DEPTH * (0.5 + (depth[last] - middle) / (depth[last] - depth[last + 1])))


def behind(place: float, y: np.ndarray, volume: np.ndarray, kinetic: np.ndarray) -> tuple[float, float, float]:
    """Volume, kinetic energy and length of the water behind a bore at a place (m), away from it and from the wall."""
    low, high = WALL * JUMP.after, place - ROLLER * JUMP.after
    if high - low < LEAST * JUMP.after:
        return 0.0, 0.0, 0.0
    there = (y > low) & (y < high)
    return volume[there].sum(), kinetic[there].sum(), high - low


def bores(_: bool) -> Found:
    """A bore of h2 = 2.5 h1 at three spacings; the last decides."""
    found = [run_up(count) for count in ROWS]
    best = found[-1]
    ripples, breaking = "ripples of 0.1 h2, over 2 h2 and more", "scatter of 12 breakings over 12 h2"
    named = "energy lost per time and width"
    spacings = [DEPTH / count for count in ROWS]
    lines = [
        Line("depth behind, h2", best.depth, JUMP.after, SOURCE, DEEP, ripples, "m"),
        Line("speed of the bore, c", best.rate("place"), JUMP.speed, SOURCE, FAST, breaking + ", by h2/4", "m/s"),
        Line("force on the wall, ½ ρ g h2²", best.pushed, JUMP.push, SOURCE, PUSHED, "as h2, twice", "N/m"),
        Line(named, best.rate("lost"), JUMP.loss, SOURCE, LOST, breaking + ", by 0.3; ripples", "W/m"),
        *order_line("the depth", spacings, [one.depth / JUMP.after - 1.0 for one in found], DEEP),
        *order_line("the energy lost", spacings, [one.rate("lost") / JUMP.loss - 1.0 for one in found], LOST),
    ]
    return Found(lines, [Picture("water-bore", lost_figure(ROWS, found), CAPTION)], tables=[shares(ROWS, found)])


HEAD = (
    *("layers before", "h2", "c", "force on the wall", "energy lost"),
    *("by viscosity, whole tank", "by diffusion, whole tank", "by wall particles, whole tank"),
    *("kinetic energy behind", "lost too late, ρ g h1³"),
)
CAPTION = "Energy that the bore has lost, in ρ g h1³, with so many layers of particles in the stream ahead of it."


def shares(rows: tuple[int, ...], found: Sequence[Bore]) -> Table:
    """Each number over that of the jump relations; energies per time over the loss, and what of it comes too late."""
    told = []
    for count, one in zip(rows, found, strict=True):
        energies = (*(one.rate(name) for name in ("lost", "viscous", "diffusive", "held")), one.stirred)
        parts = one.depth / JUMP.after, one.rate("place") / JUMP.speed, one.pushed / JUMP.push
        shown = *parts, *(energy / JUMP.loss for energy in energies)
        told.append([str(count), *(f"{share:.3f}" for share in shown), f"{one.kept / UNIT:.1f}"])
    return Table(HEAD, told)


def lost_figure(rows: tuple[int, ...], found: Sequence[Bore]) -> Figure:
    """Energy lost against how far the bore should have run."""
    far = JUMP.speed / JUMP.after
    curves = {f"{count} layers": (far * one.time, one.lost / UNIT) for count, one in zip(rows, found, strict=True)}
    time = found[-1].time
    curves["exact"] = far * time, JUMP.loss * time / UNIT
    return courses(curves, ("c t/h2", "energy lost (ρ g h1³)"))


CASES = (Case("water-bore", SECTION, "A steady bore", bores, quick=False),)
