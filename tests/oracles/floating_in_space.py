"""Bodies that float in space, for tests: in the middle of a box of water, and how the whole of both is balanced."""

from math import sqrt

import numpy as np

from solvers.fluid.given import Fluid, Water
from solvers.fluid.start.rest import at_rest
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Body, Free
from solvers.tank.shapes import PrismShape, SphereShape
from solvers.tank.solids.solid import Prism
from tests.oracles.water import GRAVITY, box

DENSITY = 1000.0


def body_of(shape: SphereShape | PrismShape, mass: float, **changes) -> Body:
    """An even body of a shape and a mass (kg) that floats."""
    inertia = tuple(map(tuple, (mass * shape.gyration).tolist()))
    free = Free(mass, changes.pop("inertia", inertia), changes.pop("centre", tuple(shape.centroid.tolist())), **changes)
    low, high = shape.bounds
    points = shape.corners if isinstance(shape, PrismShape) else ((low[0], low[1]), (high[0], high[1]))
    return Body(points, closed=True, free=free, shape=shape)


def afloat_in_space(
    bodies: tuple[Body, ...], sides: tuple[float, float, float], depth: float, spacing: float, **changes
) -> Scene:
    """Bodies in a box with these sides (m; y, z, x) and water of a depth (m). Changes are of the scene or its water."""
    sound = 10.0 * sqrt(GRAVITY * depth)
    of_water = {name: changes.pop(name) for name in list(changes) if name in Water.__dataclass_fields__}
    water = Water(**{"spacing": spacing, "sound_speed": sound, "density": DENSITY, "smoothing": 1.5} | of_water)
    outline = box(sides[0], sides[1])
    drops = at_rest(outline, depth, water, GRAVITY, parts=bodies, along=sides[2])
    given = {"outline": outline, "matters": (Fluid(water, drops[None]),), "parts": bodies, "gravity": GRAVITY}
    return Scene(**{**given, "solid": Prism(sides[2]), **changes})


def momentum(run: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Momentum (3,) N s of water and bodies of the first world in the tank's axes, and its moment (3,) N m s."""
    p, bodies = run.water.particles, run.parts.bodies
    columns = p.read(p.mass, *p.velocity, *p.place)
    mass, velocity, place = (
        columns[0][0],
        np.stack([c[0] for c in columns[1:4]], 1),
        np.stack([c[0] for c in columns[4:]], 1),
    )
    found, turning = mass @ velocity, mass @ np.cross(place, velocity)
    if bodies.count:
        speed = np.stack([field.to_numpy()[0] for field in bodies.velocity], axis=1)
        at = np.stack([field.to_numpy()[0] for field in bodies.place[:3]], axis=1)
        push = bodies.rows[:, :1] * speed[:, :3]
        found, turning = found + push.sum(axis=0), turning + (np.cross(at, push) + speed[:, 3:]).sum(axis=0)
    return found, turning
