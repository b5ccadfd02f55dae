"""The pools that are timed: a small standing wave, a column that collapses, and that column in full motion."""

from dataclasses import dataclass

import numpy as np

from benchmarks.peers.pool import Pool
from lab.preset.outline import rectangle
from solvers.fluid.given import Fluid, Water, particles
from solvers.fluid.start.rest import hydrostatic_deviation
from solvers.scene import Scene

GRAVITY, DENSITY = 9.81, 1000.0
GENTLE, DEPTH, LID = 2.0, 1.0, 1.2  # m: width, depth and height of the tank of the gentle wave
STEEP = 0.02  # amplitude of the wave over the depth
# Lobovský et al. (2014): a column of 600 mm by 300 mm in a tank of 1610 mm by 600 mm.
TANK, HEIGHT, COLUMN, HIGH = 1.61, 0.6, 0.6, 0.3  # m


@dataclass(frozen=True)
class Case:
    """Particles `drops` (n,) as they start in a rectangular tank, their spacing and speed of sound."""

    drops: np.ndarray
    width: float
    height: float
    spacing: float
    sound_speed: float

    @property
    def count(self) -> int:
        """Number of particles."""
        return len(self.drops)

    def scene(self, precision: str = "mixed", schedule: str = "auto", worlds: int = 1, **of_water: object) -> Scene:
        """The scene of the lab in as many equal worlds, its defaults changed by `of_water`."""
        outline = np.array(rectangle(self.width, self.height))
        water = Water(**{"spacing": self.spacing, "sound_speed": self.sound_speed, "density": DENSITY} | of_water)
        fluid, how = Fluid(water, np.tile(self.drops, (worlds, 1))), {"precision": precision, "schedule": schedule}
        return Scene(outline, (fluid,), **how)

    def pool(self, seconds: float, every: float, threads: int = 1) -> Pool:
        """The same for a peer: its pressures are those of the linear equation of state."""
        s = self.drops["deviation"]
        return Pool(
            position=self.drops["position"],
            velocity=self.drops["velocity"],
            pressure=DENSITY * self.sound_speed**2 * s,
            mass=DENSITY * (1.0 + s) * self.drops["volume"],
            width=self.width,
            height=self.height,
            spacing=self.spacing,
            sound_speed=self.sound_speed,
            seconds=seconds,
            every=every,
            threads=threads,
        )


def gentle(rows: int, steep: float = STEEP, mach: float = 10.0, state: str = "linear") -> Case:
    """A tank of 2 m with 1 m of water in `rows`, at the instant when its first standing wave is flat.

    c0 = mach √(gH); the water bears its own weight by the equation of `state` of that name.
    """
    drops = _block(GENTLE, DEPTH, rows, mach, -0.5 * GENTLE, state)
    place = drops["position"]
    drops["velocity"] = steep * DEPTH * frequency() * mode(place)
    return Case(drops, GENTLE, LID, DEPTH / rows, mach * np.sqrt(GRAVITY * DEPTH))


def dam(rows: int) -> Case:
    """A column of water, twice as wide as high, let go at once; c0 = 20 √(gH), ten times the front's speed."""
    spacing = HIGH / rows
    width = round(TANK / spacing) * spacing
    return Case(_block(COLUMN, HIGH, rows, 20.0, -0.5 * width), width, HEIGHT, spacing, 20.0 * np.sqrt(GRAVITY * HIGH))


def frequency() -> float:
    """Angular frequency (1/s) of the first standing wave by linear theory, √(g k tanh kH)."""
    k = np.pi / GENTLE
    return float(np.sqrt(GRAVITY * k * np.tanh(k * DEPTH)))


def mode(place: np.ndarray) -> np.ndarray:
    """Velocities (n, 2) of that wave at places (n, 2) m, 1 m/s upwards at the surface on the left wall."""
    k, x = np.pi / GENTLE, place[:, 0] + 0.5 * GENTLE
    z = place[:, 1]
    shape = np.stack([-np.cosh(k * z) * np.sin(k * x), np.sinh(k * z) * np.cos(k * x)], axis=-1)
    return shape / np.sinh(k * DEPTH)


def _block(width: float, depth: float, rows: int, mach: float, left: float, state: str = "linear") -> np.ndarray:
    spacing, sound = depth / rows, mach * np.sqrt(GRAVITY * depth)
    y = left + (np.arange(round(width / spacing)) + 0.5) * spacing
    z = (np.arange(rows) + 0.5) * spacing
    grid = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)
    drops = particles(len(grid))
    drops["position"], drops["volume"] = grid, spacing**2
    drops["deviation"] = hydrostatic_deviation(depth - grid[:, 1], GRAVITY, sound, state)
    return drops
