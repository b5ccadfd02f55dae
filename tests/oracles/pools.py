"""Made-up water for the tests of its pictures, with known surfaces, speeds and pressures; no solver had a part."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from lab.paint.footage import NO_GRAINS, Bed
from lab.paint.water.basins import Basin
from lab.paint.water.pool import Pool
from lab.preset.sections.video import Video
from solvers.fluid.given import Gauge, Level

GRAVITY, DENSITY = 9.81, 1000.0


def tank(width: float = 0.9, height: float = 0.508) -> np.ndarray:
    """Outline (4, 2) of a rectangular tank with the origin in the middle of its floor."""
    half = 0.5 * width
    return np.array([(-half, 0.0), (half, 0.0), (half, height), (-half, height)])


def filled(inside: Callable[[np.ndarray], np.ndarray], outline: np.ndarray, spacing: float, rough: float = 0.0):
    """Places (n, 2) of particles on a square lattice in those cells of the tank whose middles are `inside`.

    rough: how far they are moved at random, over the spacing.
    """
    low, high = outline.min(axis=0), outline.max(axis=0)
    lines = [np.arange(low[k] + 0.5 * spacing, high[k], spacing) for k in (0, 1)]
    lattice = np.stack(np.meshgrid(*lines), axis=-1).reshape(-1, 2)
    place = lattice[inside(lattice)]
    return place + rough * spacing * np.random.default_rng(1).uniform(-1.0, 1.0, place.shape)


@dataclass
class MadeFootage:
    """A footage of water alone, one world; the lists have an array for each of its frames."""

    outline: np.ndarray
    spacing: float
    position: list[np.ndarray]
    velocity: list[np.ndarray]
    pressure: list[np.ndarray]
    time: np.ndarray
    series_time: np.ndarray
    series: dict[str, np.ndarray]
    pose: np.ndarray | None = None
    gauges: tuple[Gauge, ...] = ()
    levels: tuple[Level, ...] = ()
    open_edges: tuple[int, ...] = ()
    settings: Video = field(default_factory=Video)
    title: str = "Water in a tank"
    space: None = None

    def __post_init__(self) -> None:
        gauges = {f"P{k}": gauge for k, gauge in enumerate(self.gauges, start=1)}
        levels = {f"L{k}": level for k, level in enumerate(self.levels, start=1)}
        self.water, self.bulk = Pool(np.full((1, 1), self.spacing**2), gauges, levels), None
        self.basins = [Basin(self.outline, self.open_edges, slice(None))]
        self.matters, self.worlds, self.sea, self.ends = ("water",), 1, None, [None]
        self.rail, self.protrudes, self.drive = None, bool(self.open_edges), ""
        self.radius, self.kind, self.kinds = np.zeros((1, 0)), np.zeros((1, 0), dtype=int), ["the rest"]
        self.shapes, self.shape_names, self.fixed, self.parts = None, ["disc"], np.zeros((0, 3)), {}
        self.bodies, self.floating, self.rooms, self.hold = [], (), {}, None
        self.part, self.part_turn = np.zeros((len(self.time), 1, 0, 2)), np.zeros((len(self.time), 1, 0))
        if self.pose is None:
            self.pose = np.zeros((len(self.time), 3))
        self.pose = self.pose.reshape(-1, 1, 3)
        ways = [np.interp(self.series_time, self.time, self.pose[:, 0, k]) for k in range(3)]
        self.series_pose = np.stack(ways, axis=-1)[:, None]

    def grains(self, name: str, frame: int, world: int) -> np.ndarray:
        """No grains."""
        return NO_GRAINS[name]

    def drops(self, name: str, frame: int, world: int) -> np.ndarray:
        """The values of each particle in a frame."""
        return getattr(self, name.removeprefix("water_"))[frame]

    def measured(self, name: str) -> np.ndarray:
        """A quantity of the series (T, 1, ...)."""
        return self.series[name][:, None]

    @property
    def bed(self) -> Bed:
        """The only bed."""
        return Bed(self, 0, "")


def standing_wave(spacing: float = 6e-3, depth: float = 0.2, height: float = 0.05, frames: int = 12) -> MadeFootage:
    """The first standing wave of a tank by linear theory, half a period of it: the surface, velocities and pressures.

    Water at rest moves by height cos ωt (−cosh kz sin kx, sinh kz cos kx)/sinh kd, without divergence, x from the left
    wall. `surface(y, frame)` is its height.
    """
    outline = tank()
    wide = np.ptp(outline[:, 0])
    k = np.pi / wide
    omega = np.sqrt(GRAVITY * k * np.tanh(k * depth))
    time = np.linspace(0.0, np.pi / omega, frames)

    def ways(place: np.ndarray) -> np.ndarray:
        x, z = place[:, 0] + 0.5 * wide, place[:, 1]
        way = np.column_stack([-np.cosh(k * z) * np.sin(k * x), np.sinh(k * z) * np.cos(k * x)])
        return height / np.sinh(k * depth) * way

    line = np.column_stack([np.linspace(-0.5 * wide, 0.5 * wide, 500), np.full(500, depth)])

    def surface(y: np.ndarray, now: float) -> np.ndarray:
        return np.interp(y, *(line + np.cos(omega * now) * ways(line)).T)

    found = {"position": [], "velocity": [], "pressure": []}
    rest = filled(lambda p: p[:, 1] < depth, outline, spacing, rough=0.1)
    way = ways(rest)
    for now in time:
        place = rest + np.cos(omega * now) * way
        found["position"].append(place)
        found["velocity"].append(-omega * np.sin(omega * now) * way)
        found["pressure"].append(DENSITY * GRAVITY * np.maximum(surface(place[:, 0], now) - place[:, 1], 0.0))
    series_time = np.linspace(0.0, time[-1], 300)
    left, right = -0.5 * wide, 0.5 * wide
    gauges = (Gauge((left, 0.05), 0.01), Gauge((right, 0.05), 0.01), Gauge((0.0, 0.0)))
    levels = (Level(-0.4 * wide), Level(0.25 * wide))
    depths = np.array([[surface(level.y, now) for level in levels] for now in series_time])
    heads = [[surface(gauge.place[0], now) - gauge.place[1] for gauge in gauges] for now in series_time]
    series = {"level_depth": depths, "gauge_pressure": DENSITY * GRAVITY * np.array(heads)}
    known = {"series_time": series_time, "series": series, "gauges": gauges, "levels": levels}
    made = MadeFootage(outline, spacing, **found, time=time, **known)
    made.surface = lambda y, frame: surface(y, time[frame])
    return made
