"""Small scenes of grains in water, made at the solver."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np

from solvers.fluid.given import Fluid, Water, particles
from solvers.fluid.matter import WaterMatter
from solvers.fluid.timestep import longest_pace
from solvers.grains.given import Grains
from solvers.grains.materials import Material
from solvers.mixture.given import Mixture
from solvers.scene import Scene
from solvers.simulation import Simulation

SIZE, SPACING = 4e-3, 8e-3  # m: grains, and particles of water two diameters apart
HEAVY = 2500.0  # kg/m³: glass


def glass(**changes: float) -> Material:
    """A material as dense as glass; its stiffness is that of the lab's usual beads."""
    usual = {"density": HEAVY, "young": 3.2e9, "poisson": 0.28, "friction": 0.25, "restitution": 0.6}
    return Material(**usual | changes)


def solid_area(size: float, thickness: float | None = None) -> float:
    """The volume of a grain of a diameter (m) over the thickness of its slab (m), its own diameter by default, m²."""
    return np.pi / 6.0 * size**3 / (thickness or size)


def rows(columns: int, lines: int, gap: float, lowest: float, size: float = SIZE) -> np.ndarray:
    """Places (1, n, 2) m of grains in a grid `gap` diameters apart, a little off their places, from a height on."""
    y = (np.arange(columns) - 0.5 * (columns - 1)) * gap * size
    z = lowest + np.arange(lines) * gap * size
    place = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)
    place[:, 0] += np.random.default_rng(0).uniform(-0.02, 0.02, len(place)) * size
    return place[None]


def evenly(count: int, area: float) -> np.ndarray:
    """So many particles (1, count) of water of an area (m²) in all, yet to be laid."""
    drops = particles(1, count)
    drops["volume"][0] = area / count
    return drops


def wet(
    outline: np.ndarray, grains: Grains, water: Water, drops: np.ndarray, mixture: Mixture, **changes: object
) -> Scene:
    """A scene of grains in water, at their derived steps; the water's are as many as its bounds allow."""
    made = Scene(outline, (grains, Fluid(water, drops)), mixture=mixture, **changes)
    step = made.time_step()
    return made.holding(replace(made.fluid, substeps=longest_pace(made, step)), step=step)


@dataclass(frozen=True)
class Laid:
    """Water laid where it was found, in place of `solvers.mixture.start.Laying`."""

    drops: np.ndarray

    def particles(self, _: np.ndarray) -> np.ndarray:
        """The particles (W, n), wherever grains are."""
        return self.drops.copy()


@contextmanager
def simulated(scene: Scene, place: np.ndarray, drops: np.ndarray | None = None) -> Iterator[Simulation]:
    """A simulation on one core of grains at places (1, n, 2) m, in water laid as the solver does or as `drops` are."""
    run = Simulation(scene, place, threads=1, arch="cpu")
    try:
        if drops is not None:
            run.water.laying.laying = Laid(drops)
            run.place(place)
        yield run
    finally:
        run.close()


def as_found(water: WaterMatter, time: float) -> np.ndarray:
    """The particles (1, n) of a water now, at rest, with the mass and density that they have."""
    mass, deviation = water.particles.read(water.particles.mass, water.particles.deviation)
    drops = particles(*mass.shape)
    drops["position"], drops["deviation"] = water.snapshot(time)["water_position"], deviation
    drops["volume"] = mass / (water.water.density * (1.0 + deviation))
    return drops


def advance(run: Simulation, until: float) -> None:
    """Advance to a time (s), to the nearest whole step of the water, at least one of them."""
    run.advance(run.whole(round((until - run.time) / run.dt)))


def on_walls(run: Simulation) -> np.ndarray:
    """The upward impulses (2,) N s on the tank, of grains and of water, since it was last observed."""
    return np.array([matter.load.impulse[1].to_numpy().sum() for matter in run.matters.values()])
