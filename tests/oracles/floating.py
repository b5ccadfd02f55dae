"""Bodies that float, for tests: boxes in the middle of a tank, and how the whole of water and bodies is balanced."""

from dataclasses import replace
from math import cos, sin, sqrt

import numpy as np

from solvers.fluid.given import Fluid, Water
from solvers.fluid.start.parts import clear_of
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Body, Free, Hull, Opening
from tests.oracles.water import GRAVITY, box, lattice

DENSITY = 1000.0
NEVER = 1e9  # s


def afloat(
    ratio: float,
    size: tuple[float, float] = (1.0, 0.5),
    tank: tuple[float, float] = (2.0, 1.4),
    depth: float = 0.8,
    spacing: float = 0.05,
    place: tuple[float, float] | None = None,
    heel: float = 0.0,
    release: float = 0.0,
    **changes,
) -> Scene:
    """A box of a `size` (m) and of `ratio` times the water's density, as deep in still water as it floats upright.

    Or with its middle at a `place` (m), and heeled (rad). It is hollow, with an opening that stays covered, so that it
    has the kernels of `hull`. Changes are of the scene or of its water.
    """
    width, height = size
    middle = place or (0.0, depth + (0.5 - ratio) * height)

    def drawn(*points: tuple[float, float]) -> tuple[tuple[float, float], ...]:
        return tuple(
            (middle[0] + cos(heel) * y - sin(heel) * z, middle[1] + sin(heel) * y + cos(heel) * z) for y, z in points
        )

    half, wall = (0.5 * width, 0.5 * height), 0.25 * min(size)
    outer, room = (rectangle((-y, -z), (y, z)) for y, z in (half, (half[0] - wall, half[1] - wall)))
    floor = 0.5 * wall - half[1]
    covered = Opening(drawn((-0.05, floor), (0.05, floor)), NEVER)
    mass = DENSITY * ratio * width * height
    free = Free(mass, mass * (width**2 + height**2) / 12.0, middle, release)
    hollow = Hull(wall, (drawn(*room),), (covered,))
    body = Body(drawn(*outer), closed=True, free=free, hull=hollow)
    sound = 10.0 * sqrt(GRAVITY * depth)
    drops = lattice(tank[0], depth, spacing, sound)
    drops = drops[:, clear_of(drops["position"][0], (body,), spacing)]
    of_water = {name: changes.pop(name) for name in list(changes) if name in Water.__dataclass_fields__}
    water = Water(**{"spacing": spacing, "sound_speed": sound, "density": DENSITY} | of_water)
    given = {"outline": box(*tank), "matters": (Fluid(water, drops),), "parts": (body,), "gravity": GRAVITY}
    return Scene(**{**given, "thickness": 1.0, **changes})


def momentum(run: Simulation) -> np.ndarray:
    """Momentum (2,) N s of the water and the bodies of the first world, in the tank's axes, where steps end."""
    p, bodies = run.water.particles, run.parts.bodies
    mass, *velocity = (values[0] for values in p.read(p.mass, *p.velocity))
    of_water = np.array([mass @ along for along in velocity])
    own = bodies.velocity[:2] if bodies.count else ()
    of_bodies = np.array([field.to_numpy()[0] @ bodies.rows[:, 0] for field in own] or [0.0, 0.0])
    return run.scene.tanks[0].thickness * of_water + of_bodies


def weight(run: Simulation) -> float:
    """Weight (N) of the water and the bodies of the first world."""
    p = run.water.particles
    return GRAVITY * (run.scene.tanks[0].thickness * p.read(p.mass)[0][0].sum() + run.parts.bodies.rows[:, 0].sum())


def rectangle(low: tuple[float, float], high: tuple[float, float]) -> tuple[tuple[float, float], ...]:
    """Corners of an upright rectangle, counter-clockwise."""
    return (low, (high[0], low[1]), high, (low[0], high[1]))


def hull(
    wall: float = 1.0,
    inside: float = 0.0,
    hole: float = 0.0,
    opens: float = 0.0,
    spacing: float = 0.05,
    depth: float = 1.0,
    keel: float = 0.4,
    **changes,
) -> Scene:
    """A hull, 1 m wide and high, held with its keel so high (m) over the floor of a tank 2 m wide, `depth` (m) deep.

    Its walls are `wall` spacings thick; within is water up to `inside` (m) over its floor. In its right side a `hole`
    (m) high opens after a while (s), 0.1 m over the keel.
    """
    thick, sound = wall * spacing, 10.0 * sqrt(GRAVITY * depth)
    outer, room = rectangle((-0.5, keel), (0.5, keel + 1.0)), rectangle((thick - 0.5, keel + thick), (0.5 - thick, 1.3))
    middle, foot = 0.5 - 0.5 * thick, keel + 0.1
    openings = (Opening(((middle, foot), (middle, foot + hole)), opens),) if hole else ()
    held = Free(600.0, 120.0, (0.0, keel + 0.4), NEVER)
    body = Body(outer, closed=True, free=held, hull=Hull(thick, (room,), openings))
    drops = lattice(2.0, depth, spacing, sound)
    drops = drops[:, clear_of(drops["position"][0], (body,), spacing)]
    if inside:
        within = lattice(1.0 - 2.0 * thick, inside, spacing, sound)
        within["position"][..., 1] += keel + thick
        drops = np.concatenate([drops, within], axis=1)
    of_water = {name: changes.pop(name) for name in list(changes) if name in Water.__dataclass_fields__}
    water = Water(**{"spacing": spacing, "sound_speed": sound, "density": DENSITY} | of_water)
    given = {"outline": box(2.0, 2.0), "matters": (Fluid(water, drops),), "parts": (body,), "gravity": GRAVITY}
    return Scene(**{**given, "thickness": 1.0, **changes})


def pair(width: float = 2.0, spacing: float = 0.05, **changes) -> Scene:
    """Two boxes, of half and of 0.7 times the water's density, heeled towards each other between two walls.

    What touches first are their upper corners, above the water.
    """
    one = afloat(0.5, size=(0.5, 0.3), place=(-0.6, 0.8), heel=0.15, tank=(width, 1.4), spacing=spacing)
    two = afloat(0.7, size=(0.5, 0.3), place=(0.0, 0.74), heel=0.1, tank=(width, 1.4), spacing=spacing)
    parts = tuple(replace(scene.parts[0], hull=None) for scene in (one, two))
    drops = lattice(width, 0.8, spacing, one.fluid.water.sound_speed)
    drops = drops[:, clear_of(drops["position"][0], parts, spacing)]
    return replace(one, parts=parts, matters=(Fluid(one.fluid.water, drops),), **changes)


def solid(scene: Scene, centre: float | None = None) -> Scene:
    """The same scene with its body full, and its centre of mass at a height (m) over the keel, as it floats upright."""
    body = replace(scene.parts[0], hull=None)
    if centre is not None:
        corners = np.array(body.points)
        keel, up = 0.5 * (corners[0] + corners[1]), corners[3] - corners[0]
        place = keel + centre * up / np.hypot(*up)
        body = replace(body, free=replace(body.free, centre=tuple(place.tolist())))
    return replace(scene, parts=(body,))


def account(run: Simulation, until: float, every: float = 0.01) -> tuple[float, float]:
    """What the energy of water and bodies lacks (J) at most until a time (s), and the most of what is exchanged.

    Exchanged is the kinetic energy of water and bodies, and what viscosity, diffusion and contacts took.
    """
    totals, exchanged, inertia = [], 0.0, run.parts.bodies.rows[:, [0, 0, 1]]
    while run.time < until:
        run.advance(max(1, round(every / run.dt)))
        rows = {name: values[0] for name, values in run.observe().items()}
        taken = rows["water_viscous"] + rows["water_diffusive"] + rows["contact_lost"]
        kept = rows["water_total"] + rows["body_energy"].sum() + rows["contact_elastic"] + rows["water_wall_energy"]
        totals.append(kept + taken)
        moving = rows["water_kinetic"] + 0.5 * (inertia * rows["body_velocity"] ** 2).sum()
        exchanged = max(exchanged, moving + abs(taken))
    return float(np.ptp(totals)), float(exchanged)
