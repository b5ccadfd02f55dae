"""Momentum that is kept to rounding, and axes that do not matter."""

from math import cos, sin

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.plain import across, turned
from lab.studies.verify.plain_water import EarthWater, Pose
from lab.studies.verify.water.scenes import (
    Field,
    G,
    box,
    filled,
    grid,
    kept,
    looks,
    resting,
    scene,
    set_going,
    simulated,
)
from solvers.fluid.given import Water
from solvers.fluid.start.rest import at_rest
from solvers.motion.harmonic import Heave, Roll, Sway
from solvers.motion.tilt import Tilt
from solvers.scene import Scene

SECTION = "Water: balances"
RADIUS, SPACING = 0.1, 0.01  # m, of the drop
FLIGHT = 0.2  # s
MOTIONS = (Roll(0.3, 0.8, centre=(0.1, 0.2)), Sway(0.05, 1.1), Heave(0.02, 0.9))
WIDTH, HEIGHT, DEPTH, ROWS = 0.6, 0.6, 0.3, 15  # m
STEPS = 200
ROUNDING = {"f64": 1e-12, "mixed": 1e-6}
WHY = {
    "f64": "pair forces are equal and opposite; 1e-16 of each, over thousands of pairs and 200 steps",
    "mixed": "forces are sums of 32 bits, 6e-8 of each",
}
HELD, LONG_TILTED = -0.4, 100.0  # rad; s, a time at which the tilt is over
# Each starts at its end, without a speed; the first turns about a fixed point.
SHAKEN = Roll(0.3, 0.8, np.pi / 2.0, (0.1, 0.2)), Sway(0.05, 1.1, np.pi / 2.0), Heave(0.02, 0.9, np.pi / 2.0)
SMALL = 0.2, 0.1, 10  # m, m, and layers: a box of water
A_WHILE, LONGER = 0.03, 0.15  # s
EXACT = "no error of the step: drifts of the tank's frame are exact, and forces and rates see the same walls; rounding"
STEP = 8e-4  # s: the derived ones differ, with the height of the turned outline


def drop(motions: tuple = (), gravity: float = 0.0) -> Scene:
    """A round drop that is strained and turns, by default without gravity, in a tank that it does not touch."""
    water = Water(SPACING, 20.0, alpha=0.02, walls=False)
    place = grid(2.0 * RADIUS, 2.0 * RADIUS, SPACING) - RADIUS
    place = place[np.hypot(*place.T) < RADIUS]
    drops = filled(place, water, lambda r: r * [2.0, -2.0] + 3.0 * np.stack([-r[:, 1], r[:, 0]], axis=1))
    return scene(water, drops, box(1.0, 1.0), gravity, motions=[motions])


def tossed() -> Field:
    """Velocities (m/s) of water that is stirred at random."""
    random = np.random.default_rng(1)
    return lambda place: 0.2 * random.uniform(-1.0, 1.0, place.shape)


def free_drop(gravity: float) -> Line:
    """Momentum of a free drop less that of its fall, in shares of the sum of its particles' own and of the fall's."""
    with simulated(drop(gravity=gravity)) as run:
        run.advance(1)  # the first kick is half a step long
        _, before, mass = kept(run)
        steps = round(FLIGHT / run.dt)
        run.advance(steps)
        fall = np.array([0.0, -gravity * steps * run.dt])
        off = np.abs(mass @ (kept(run)[1] - before) - fall * mass.sum()).max()
        share = off / (mass @ np.hypot(*before.T) - fall[1] * mass.sum())
    name = "falling drop, beside m g t, of Σ m |u| + m g t" if gravity else "drop, of Σ m |u|"
    return Line.off(name, "m g t" if gravity else "kept", share, 1e-12, "pair forces are equal and opposite")


def tank(precision: str) -> Line:
    """What the water gains beside its weight and what the tank's load says that it gave, of Σ|F| Δt."""
    water = Water(DEPTH / ROWS, 10.0 * np.sqrt(G * DEPTH))
    start = resting(water, box(WIDTH, HEIGHT), DEPTH, tossed())
    start.precision = precision
    with simulated(start) as run:
        run.advance(1)  # the first kick is half a step long
        run.observe()
        _, before, mass = kept(run)
        pushed = 0.0
        for _ in range(STEPS):
            run.advance(1)
            load = run.observe()["wall_force"][0, :2]
            pushed = pushed + run.dt * load
        _, after, _ = kept(run)
        gained = mass @ (after - before)
        weight = np.array([0.0, -G * mass.sum()]) * STEPS * run.dt
        scale = STEPS * run.dt * G * mass.sum()
    error = np.abs(gained - weight + pushed).max() / scale
    name = f"water and tank, {precision}, of the weight's impulse"
    return Line.off(name, "kept", error, ROUNDING[precision], WHY[precision])


def momentum(_: bool) -> Found:
    """A free drop, one that falls, and water with its tank, in both precisions."""
    return Found([free_drop(0.0), free_drop(G), tank("f64"), tank("mixed")])


def flight(_: bool) -> Found:
    """A drop as seen from a tank that rolls, sways and heaves round it, over the earth the same as seen at rest."""
    places = []
    for motions in ((), MOTIONS):
        with simulated(drop(motions)) as run:
            list(looks(run, [FLIGHT]))
            place, pose = run.snapshot()["water_position"][0], run.observe()["pose"][0]
            places.append((place, pose[:2] + place @ turning(pose[2]).T))
    (alone, _), (inside, over) = places
    away = 1e3 * np.abs(inside - alone).max()
    error = np.abs(over - alone).max()
    line = Line.off("places", "the drop seen at rest", error, 1e-9, "drifts are exact; rounding", "m")
    return Found([line], notes=[f"Seen from the tank the drop goes up to {away:.0f} mm elsewhere."])


def over_earth(time: float) -> Pose:
    """Where SHAKEN has the tank at a time (s): it turns about a fixed point, and then sways and heaves."""
    rates, sizes, phases = (
        np.array([getattr(one, name) for one in SHAKEN]) for name in ("frequency", "amplitude", "phase")
    )
    rates = 2.0 * np.pi * rates
    turns = rates * time + phases
    (angle, *way), (rate, *velocity) = sizes * np.sin(turns), sizes * rates * np.cos(turns)
    gain, *acceleration = -sizes * rates**2 * np.sin(turns)
    centre = np.array(SHAKEN[0].centre)
    arm = turned(-centre, angle)
    return Pose(
        way + centre + arm,
        angle,
        velocity + rate * across(arm),
        rate,
        acceleration + gain * across(arm) - rate**2 * arm,
        gain,
    )


def walls(fast: bool) -> Found:
    """Water on the walls of a tank that rolls, sways and heaves, and the same walls as they move over the earth."""
    side, deep, rows = SMALL
    water = Water(deep / rows, 10.0 * np.sqrt(G * deep))
    drops = at_rest(box(side, side), deep, water, G)[None]
    with simulated(scene(water, drops, box(side, side), motions=[SHAKEN])) as run:
        run.advance(1)  # the first kick is half a step long
        plain, first = EarthWater(run.scene, over_earth), over_earth(run.time)
        place, velocity, mass = kept(run)
        (deviation,) = (values[0] for values in run.water.particles.read(run.water.particles.deviation))
        r, u, s = first.places(place), turned(velocity, first.angle), deviation
        for _ in range(round((A_WHILE if fast else LONGER) / run.dt)):
            r, u, s = plain.step(r, u, s, mass, run.time, run.dt)
            run.advance(1)
        now, after = over_earth(run.time), kept(run)[0]
        error = np.abs(now.places(after) - r).max()
        moved, gone = np.abs(r - first.places(place)).max(), np.abs(after - place).max()
        on_walls = int((plain.wall_pressure(r, mass, s) > 0.0).sum())
    line = Line.off("places", "moving walls in the earth frame, plain arrays", error, 1e-9, EXACT, "m")
    note = f"""{len(r)} particles of the tank {1e3 * side:.0f} mm wide, by double sums over all of them and {on_walls}
    wall particles that bear pressure, for {run.time:.2f} s. Over the earth the water goes up to {1e3 * moved:.0f} mm,
    in its tank up to {1e3 * gone:.0f} mm."""
    return Found([line], notes=[note])


def turning(angle: float) -> np.ndarray:
    """Matrix that turns by an angle (rad)."""
    return np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])


def held(_: bool) -> Found:
    """Water let go in a tank held at an angle, and in a turned outline: the physics is the same in any direction."""
    water, upright, places = Water(DEPTH / ROWS, 10.0 * np.sqrt(G * HEIGHT)), box(WIDTH, HEIGHT), []
    drops = at_rest(upright, DEPTH, water, G)[None]
    set_going(drops, lambda place: np.zeros_like(place))
    for outside in (True, False):
        turn, start = turning(HELD if outside else 0.0), drops.copy()
        start["position"][0] = drops["position"][0] @ turn.T
        motions = () if outside else (Tilt(rate=1.0, angle=HELD),)
        with simulated(scene(water, start, upright @ turn.T, motions=[motions], step=STEP)) as run:
            run.origin = 0.0 if outside else LONG_TILTED
            run.advance(STEPS)
            places.append(run.snapshot()["water_position"][0] @ turn)
    moved = 1e3 * np.linalg.norm(places[0] - drops["position"][0], axis=1).max()
    error = np.abs(places[0] - places[1]).max()
    line = Line.off("places", "the turned outline", error, 1e-9, "rounding, grown by the water's motion", "m")
    return Found([line], notes=[f"Water that was level in the tank flows by up to {moved:.0f} mm."])


CASES = (
    Case("water-momentum", SECTION, "Momentum of water and tank", momentum),
    Case("water-frame-flight", SECTION, "A drop seen from a moving tank", flight, quick=False),
    Case("water-frame-walls", SECTION, "Water on the walls of a moving tank, and walls that move", walls),
    Case("water-frame-tilt", SECTION, "Water in a tank held at an angle, and in a turned one", held, quick=False),
)
