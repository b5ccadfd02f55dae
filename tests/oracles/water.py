"""Water for tests: lattices, scenes, and the step in plain numpy that `cargolab verify` has."""

import numpy as np

from lab.studies.verify.plain_water import PlainWater, kernel
from solvers.fluid.given import Fluid, Water, particles
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.given import scene_of

__all__ = ["GRAVITY", "PlainWater", "again", "box", "kernel", "lattice", "still"]

GRAVITY = 9.81


def box(width: float, height: float) -> np.ndarray:
    """Outline of a rectangular tank, its origin in the middle of the floor."""
    half = 0.5 * width
    return np.array([[-half, 0.0], [half, 0.0], [half, height], [-half, height]])


def lattice(width: float, depth: float, spacing: float, sound: float, left: float | None = None) -> np.ndarray:
    """Drops (1, n) of a column of water at rest under gravity, from `left` (m) on, by default in the middle."""
    y = (np.arange(round(width / spacing)) + 0.5) * spacing + (-0.5 * width if left is None else left)
    z = (np.arange(round(depth / spacing)) + 0.5) * spacing
    grid = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)
    drops = particles(1, len(grid))
    drops["position"][0] = grid
    drops["deviation"][0] = GRAVITY * (depth - grid[:, 1]) / sound**2
    drops["volume"][0] = spacing**2
    return drops


def still(width: float, height: float, depth: float, rows: int, **changes) -> Scene:
    """A tank with `rows` layers of water at rest; changes of the scene or of its water."""
    spacing, sound = depth / rows, changes.pop("sound_speed", 10.0 * np.sqrt(GRAVITY * depth))
    of_water = {name: changes.pop(name) for name in list(changes) if name in Water.__dataclass_fields__}
    drops = changes.pop("drops", None)
    drops = lattice(width, depth, spacing, sound) if drops is None else drops
    water = Water(**{"spacing": spacing, "sound_speed": sound} | of_water)
    given = {"radius": np.zeros((len(drops), 0)), "outline": box(width, height), "gravity": GRAVITY}
    return scene_of(**{**given, "fluid": Fluid(water, drops), **changes})


def again(run: Simulation, scene: Scene) -> Simulation:
    """The same simulation with the water of another scene that differs in nothing else: it has its kernels already.

    The numbers of the water's models may differ, too, and with them the step, but where a ship or an axle has it.
    """
    if run.carrier.responds:
        assert run.dt < 1.01 * scene.time_step()
    else:
        run.dt, run.longest_step = scene.time_step(), scene.longest_step(1.0)
    if scene.fluid.water != run.scene.fluid.water:
        sound_switch = run.water.sound_switch
        sound_switch.soft = sound_switch.stiff = sound_switch.now = scene.fluid.water
    run.scene, run.water.fluid = scene, scene.fluid
    run.alter(scene)
    run.start_clock()
    run.place(np.zeros((1, 0, 2)))
    return run
