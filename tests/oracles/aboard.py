"""Grains in a room of a body that moves freely, for tests: scenes, and what body and grains have together."""

from dataclasses import replace

import numpy as np

from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Body, Free
from solvers.tank.tank import Tank
from tests.oracles.floating import DENSITY, afloat
from tests.oracles.given import scene_of
from tests.oracles.scenes import material
from tests.oracles.water import GRAVITY, box

RADIUS, THICKNESS, YOUNG = 0.01, 0.02, 5e7  # m, m, Pa
ROOM, SHELL = np.add(box(0.12, 0.10), (0.03, 1.02)), np.add(box(0.16, 0.14), (0.03, 1.0))  # m, off the origin
PLACES = np.array([[(0.0, 1.031), (0.0215, 1.0305), (0.045, 1.05), (0.06, 1.09)]])  # of grains that touch nothing
SHELF, FIXED = Body(((-0.02, 1.075), (0.01, 1.075)), tank=1), np.array([[0.08, 1.03, RADIUS]])


def dry(inertia: float = 4e-4, release: float = 0.0, dt: float = 2e-5, **changes) -> Scene:
    """Four grains in a box of 0.05 kg, twice their mass, in an empty tank; with them a shelf and a fixed grain.

    The centre of mass is not that of the room. `material` changes that of the grains.
    """
    body = Body(tuple(map(tuple, SHELL)), closed=True, free=Free(0.05, inertia, (0.02, 1.06), release))
    grain = material(young=YOUNG, **changes.pop("material", {}))
    given = {"more_tanks": (Tank(ROOM, THICKNESS, aboard=0),), "parts": (body, SHELF), "fixed": FIXED}
    given |= {"thickness": THICKNESS, "tangential": "mindlin", "gravity": GRAVITY, "step": dt, "start_speed": 1.0}
    return scene_of(np.full((1, len(PLACES[0])), RADIUS), box(8.0, 3.0), grain, grain, **given | changes)


def masses(run: Simulation) -> np.ndarray:
    """Masses (n,) kg of the grains."""
    return run.grains.mass[0]


def of_grains(run: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 2) m and velocities (n, 2) m/s of the grains over the earth, half a step ago."""
    bodies, g, dt = run.parts.bodies, run.grains.grains, 0.5 * run.dt
    u = np.array([field.to_numpy()[0, 0] for field in bodies.velocity])
    *centre, turn = (field.to_numpy()[0, 0] - dt * speed for field, speed in zip(bodies.place, u, strict=True))
    place, velocity = (
        np.stack([field.to_numpy()[0, : g.mobile] for field in of], axis=-1) for of in (g.place, g.velocity)
    )
    back = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    arm = (place - dt * velocity - bodies.rows[0, 2:4]) @ back
    return arm + centre, velocity @ back + u[:2] + u[2] * np.column_stack([-arm[:, 1], arm[:, 0]])


def together(run: Simulation) -> dict[str, np.ndarray]:
    """Momentum (2,), moment of momentum about the tank's origin, and kinetic energy of body and grains half a step ago.

    Also the common centre of mass then.
    """
    bodies, mass = run.parts.bodies, masses(run)
    place, velocity = of_grains(run)
    spin = run.grains.grains.spin[0].to_numpy()[0, : len(mass)]
    own = 1.0 / run.grains.grains.inverse_inertia.to_numpy()[0, : len(mass)]
    u = np.array([field.to_numpy()[0, 0] for field in bodies.velocity])
    at = np.array([field.to_numpy()[0, 0] for field in bodies.place]) - 0.5 * run.dt * u
    m, inertia = bodies.rows[0, :2]
    turning = spin + u[2]  # the grains' spins are relative to the body
    moment = mass @ (place[:, 0] * velocity[:, 1] - place[:, 1] * velocity[:, 0]) + own @ turning
    moment += m * (at[0] * u[1] - at[1] * u[0]) + inertia * u[2]
    kinetic = 0.5 * (mass @ (velocity**2).sum(axis=1) + own @ turning**2 + m * (u[:2] @ u[:2]) + inertia * u[2] ** 2)
    whole = m + mass.sum()
    return {
        "momentum": mass @ velocity + m * u[:2],
        "moment": moment,
        "kinetic": kinetic,
        "centre": (mass @ place + m * at[:2]) / whole,
        "mass": whole,
    }


def laden(ratio: float = 0.3, **changes) -> tuple[Scene, np.ndarray]:
    """A box in water, `afloat`, with a layer of grains on the floor of a room in it, and their places (1, n, 2) m.

    The box alone has `ratio` times the water's density; she stands as deep as with the grains she floats.
    """
    radius, thick = 0.04, 0.08
    grain = material(young=1e6, friction=0.5)
    mass = 4.0 / 3.0 * np.pi * radius**3 * grain.density
    count, (width, height) = 11, (1.0, 0.5)
    loaded = ratio + count * mass / (DENSITY * width * height * thick)
    water = afloat(loaded, size=(width, height), release=0.1, **changes)
    (body,), keel = water.parts, 0.8 - loaded * height
    own = DENSITY * ratio * width * height * thick
    free = replace(body.free, mass=own, inertia=own * (width**2 + height**2) / 12.0)
    room = np.add(box(count * 2.0 * radius + 0.002, 0.3), (0.0, keel + 0.1))
    places = np.column_stack(
        [2.0 * radius * (np.arange(count) - 0.5 * (count - 1)), np.full(count, keel + 0.1 + radius)]
    )
    scene = scene_of(
        np.full((1, count), radius), water.outline, grain, grain, tangential="mindlin", thickness=thick,
        more_tanks=(Tank(room, thick, aboard=0),), parts=(replace(body, free=free),), gravity=GRAVITY,
        fluid=replace(water.fluid, in_tanks=(water.fluid.count, 0)),
    )  # fmt: skip
    return scene, places[None]
