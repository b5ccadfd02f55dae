"""A hull that floats, with grains in the water in her room, for tests."""

from dataclasses import replace

import numpy as np

from lab.studies.verify.wet.scenes import SIZE, SPACING, glass
from solvers.fluid.given import Fluid, Water
from solvers.fluid.start.parts import clear_of
from solvers.grains.given import Grains
from solvers.mixture.given import Mixture
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Body, Free, Hull, Opening
from solvers.tank.tank import Tank
from tests.oracles.floating import DENSITY, rectangle
from tests.oracles.water import GRAVITY, box, lattice

WIDE, HIGH, WALL, DEEP, LEVEL = 0.08, 0.16, 0.008, 0.104, 0.16  # m: the room, the wall, water in it and round the hull
SOUND, KEEL, HOLE = 10.0, 0.04, 0.032  # m/s, m; no wall particle is at an end of the hole
PLACES = np.array([[(-0.012, 0.09), (0.0, 0.094), (0.012, 0.09)]])  # m over the floor of the room, from its middle
NEVER, PACE = 1e9, 14  # s; steps of the grains in one of the water


def water() -> Water:
    """The water of these scenes."""
    return Water(SPACING, SOUND, alpha=0.02)


def grains(count: int) -> Grains:
    """Beads of glass."""
    return Grains(np.full((1, count), 0.5 * SIZE), glass(), glass(), stiffness_scale=1e-3, tangential="mindlin")


def in_hull(
    release: float = 0.0,
    opens: float = 0.0,
    shift: tuple[float, float] = (0.0, 0.0),
    deep: float = DEEP,
    places: np.ndarray = PLACES,
) -> tuple[Scene, np.ndarray]:
    """A scene, all of it `shift` (m) away, and the places (1, n, 2) m of grains in water `deep` (m) in a hull.

    With the usual depth she floats as deep as she is drawn. In her floor is a hole that `opens` (s).
    """
    low, high = (-0.5 * WIDE, KEEL + WALL), (0.5 * WIDE, KEEL + WALL + HIGH)
    room, outer = (moved(rectangle(np.subtract(low, wall), np.add(high, wall)), shift) for wall in (0.0, WALL))
    middle = KEEL + 0.5 * WALL
    hole = Opening(moved(((-0.5 * HOLE, middle), (0.5 * HOLE, middle)), shift), opens)
    across = WIDE + 2.0 * WALL
    mass = DENSITY * SIZE * (across * (LEVEL - KEEL) - WIDE * DEEP)
    [centre] = moved(((0.0, KEEL + 0.06),), shift)
    free = Free(mass, mass * (across**2 + HIGH**2) / 12.0, centre, release)
    body = Body(outer, closed=True, free=free, hull=Hull(WALL, (room,), (hole,)))
    drops = lattice(4.0 * WIDE, LEVEL, SPACING, SOUND)
    drops["position"] += shift
    drops = drops[:, clear_of(drops["position"][0], (body,), SPACING)]
    if deep:
        inside = lattice(WIDE, deep, SPACING, SOUND)
        inside["position"] += np.add(shift, (0.0, KEEL + WALL))
        drops = np.concatenate([drops, inside], axis=1)
    scene = Scene(
        np.add(box(4.0 * WIDE, 4.0 * WIDE), shift),
        (grains(places.shape[1]), Fluid(water(), drops, in_tanks=(drops.shape[1], 0))),
        mixture=Mixture(), thickness=SIZE, gravity=GRAVITY, parts=(body,),
        more_tanks=(Tank(np.array(room), SIZE, aboard=0),),
    )  # fmt: skip
    return paced(scene), places + np.add(shift, (0.0, KEEL + WALL))


def in_tank(places: np.ndarray = PLACES) -> tuple[Scene, np.ndarray]:
    """The same grains and water in a tank as large as the room."""
    drops = lattice(WIDE, DEEP, SPACING, SOUND)
    scene = Scene(
        box(WIDE, HIGH), (grains(places.shape[1]), Fluid(water(), drops)), mixture=Mixture(level=DEEP),
        thickness=SIZE, gravity=GRAVITY,
    )  # fmt: skip
    return paced(scene), places


def paced(scene: Scene) -> Scene:
    """The scene at its derived steps, those of the water as long as they may be in a hull."""
    step = scene.time_step()
    return scene.holding(replace(scene.fluid, substeps=PACE), step=step)


def moved(points: tuple, shift: tuple[float, float]) -> tuple:
    """Points, `shift` (m) away."""
    return tuple(tuple(point) for point in np.add(points, shift).tolist())


def run_of(scene: Scene, places: np.ndarray) -> Simulation:
    """A simulation on one thread."""
    return Simulation(scene, places, 1, arch="cpu")
