"""The physics in the tank's frame is the same as in the earth's."""

from math import cos, pi, sin

import numpy as np

from lab.preset.outline import rectangle
from lab.studies.case import Case, Found, Line
from lab.studies.verify.plain import Pose, Tank, across, turned
from lab.studies.verify.scenes import ACETATE, G, Setup, again, grain, simulated

SECTION = "Frames"
RADIUS = 1.5e-3
# Innermost first, as the lab applies them: amplitude (m, rad), frequency (Hz), phase (rad).
SWAY, HEAVE, ROLL = (0.010, 4.0, -0.8), (0.008, 5.0, 1.2), (0.2, 2.0, 0.5)
CENTRE = (0.4, -0.5)
WIDTH, HEIGHT, TIME, STEP = 0.02, 0.03, 0.04, 1e-5
# Of the tank that moves: dampers far below 0.2 m_t/Δt, so that the solver, too, takes the law as it is written.
SOFT = {
    "young": 3.2e6,
    "poisson": 0.28,
    "density": 1319.0,
    "friction": 0.4,
    "dissipative_time": 2e-4,
    "shear_damping": 0.015,
}


# What is compared, and by how much it may differ at STEP: 0.1 to 0.3 % of what moves there (mm, 0.3 m/s, 1 rad,
# 100 rad/s). The plain scheme takes forces at the middle of a kick, the solver their means over it.
SEEN = {"position": (1e-6, "m"), "velocity": (3e-4, "m/s"), "angle": (3e-3, "rad"), "spin": (0.2, "rad/s")}
SOURCE = "moving walls in the earth frame, plain arrays"
HELD, LONG_TILTED = -1.1, 100.0  # rad; s, a time at which the tilt is over
GROWN = "rounding, grown by collisions"
FLIGHT = 0.2  # s


def motion_tables() -> dict:
    """The motions as a preset has them."""
    sway, heave, roll = (dict(zip(("amplitude", "frequency", "phase"), m, strict=True)) for m in (SWAY, HEAVE, ROLL))
    return {"sway": sway, "heave": heave, "roll": roll | {"centre": CENTRE}}


def pose(t: float) -> Pose:
    """Sway and heave, then roll about the CENTRE."""
    (y, vy), (z, vz), (angle, rate) = (harmonic(m, t) for m in (SWAY, HEAVE, ROLL))
    centre = np.array(CENTRE)
    arm = turned(np.array([y, z]) - centre, angle)
    return centre + arm, angle, turned(np.array([vy, vz]), angle) + rate * across(arm), rate


def harmonic(motion: tuple[float, float, float], t: float) -> tuple[float, float]:
    """A sin(2πft + phase) and its rate."""
    amplitude, frequency, phase = motion
    turn = 2.0 * pi * frequency * t + phase
    return amplitude * sin(turn), amplitude * 2.0 * pi * frequency * cos(turn)


def scattered(columns: int, rows: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Radii (n,) and places (n, 2) m of a loose lattice of unequal grains above a floor centred on the origin."""
    random = np.random.default_rng(seed)
    sites = np.stack(np.meshgrid(np.arange(columns) - 0.5 * (columns - 1), np.arange(rows) + 0.6), axis=-1)
    sites = sites.reshape(-1, 2)
    radius = RADIUS * random.uniform(0.8, 1.0, len(sites))
    return radius, 2.15 * RADIUS * (sites + random.uniform(-0.03, 0.03, sites.shape))


def moving_tank(fast: bool) -> Found:
    """A swayed, heaved and rolled tank in its own frame, and as moving walls in the earth frame."""
    radius, place = scattered(5, 5, seed=8)
    rows = [grain(y, z, r) for (y, z), r in zip(place, radius, strict=True)]
    contact = {"tangential": "haff-werner"}
    setup = Setup(np.array(rows), SOFT, {"width": WIDTH, "height": HEIGHT}, contact=contact, motion=motion_tables())
    tank, steps = Tank(radius, SOFT, WIDTH, HEIGHT, pose), (STEP,) if fast else (STEP, STEP / 2.0)
    found = []
    with simulated(setup) as run:
        start = run.snapshot()["position"]
        for step in steps:
            again(run, start, step)
            run.advance(round(TIME / step))
            expected = tank.run(start[0], step, round(TIME / step))
            state = run.snapshot()
            found.append(
                [np.sqrt(((state[name][0] - wanted) ** 2).mean()) for name, wanted in zip(SEEN, expected, strict=True)]
            )
    lines, orders = [], []
    for k, (name, (allowed, unit)) in enumerate(SEEN.items()):
        quantity = f"{name}, Δt = {1e6 * STEP:g} µs"
        lines.append(Line.off(quantity, SOURCE, found[0][k], allowed, "both schemes O(Δt²)", unit))
        if len(found) > 1:
            orders.append(f"{name} {np.log2(found[0][k] / found[1][k]):.2f}")
    moved = 1e3 * np.linalg.norm(state["position"] - start, axis=-1)
    turns = np.degrees(np.abs(state["angle"]).max())
    note = f"""{len(radius)} grains go {moved.min():.1f} to {moved.max():.1f} mm through the tank and turn by up to
    {turns:.0f}°. The reference looks at every pair, so it tries the neighbour lists as well. Differences are root mean
    squares over the grains."""
    halved = f"""Half the step divides the differences by two to the powers {", ".join(orders)}: 2 is the schemes', 1
    what a contact leaves that begins within a step, and where it begins is chance. So this is told, not judged."""
    return Found(lines, notes=[note, halved] if orders else [note])


def held_tank(_: bool) -> Found:
    """A tank held at an angle is a turned tank under the same gravity."""
    radius, place = scattered(5, 8, seed=3)
    width, height = 0.026, 0.05
    corners = np.array(rectangle(width, height))
    contact, run = {"tangential": "mindlin", "stiffness_scale": 1e-3}, {"step": 1e-5, "force_step": True}
    states = []
    for tilted in (True, False):
        angle = 0.0 if tilted else HELD
        rows = [grain(y, z, r) for (y, z), r in zip(turned(place, angle), radius, strict=True)]
        motion = {"tilt": {"rate": 1.0, "angle": HELD}} if tilted else {}
        setup = Setup(
            np.array(rows), ACETATE, {"outline": turned(corners, angle)}, contact=contact, motion=motion, run=run
        )
        with simulated(setup) as simulation:
            simulation.origin = LONG_TILTED
            simulation.advance(3000)
            states.append(simulation.snapshot())
    inside, outside = states
    gap = np.linalg.norm(inside["position"] - turned(outside["position"], -HELD), axis=-1).max()
    turning = np.abs(inside["angle"] - outside["angle"]).max()
    lines = [
        Line.off("places", "the turned outline", gap, 1e-13, GROWN, "m"),
        Line.off("angles", "the turned outline", turning, 1e-10, GROWN, "rad"),
    ]
    fallen = 1e3 * np.linalg.norm(inside["position"][0] - place, axis=-1).min()
    turns = np.degrees(np.abs(inside["angle"]).max())
    note = f"""Held at {np.degrees(HELD):.0f}° the grains fall at least {fallen:.1f} mm and turn by up to {turns:.0f}°.
    The turned outline also shows that the physics is the same in any direction."""
    return Found(lines, notes=[note])


def flight(_: bool) -> Found:
    """A grain that touches nothing in the moving tank flies a parabola in the earth frame, and its spin stays."""
    place, velocity, spin = np.array([0.05, 0.6]), np.array([0.4, 0.8]), 7.0
    rows, tank = [grain(*place, RADIUS, *velocity, spin)], {"width": 1.2, "height": 1.2}
    with simulated(Setup(np.array(rows), SOFT, tank, motion=motion_tables())) as run:
        again(run, run.snapshot()["position"], STEP, run.scene.grains.velocity, run.scene.grains.spin)
        run.advance(round(FLIGHT / STEP))
        state, time = run.snapshot(), run.time
    origin, angle, carried, rate = pose(0.0)
    x = origin + turned(place, angle)
    v = carried + rate * across(x - origin) + turned(velocity, angle)
    x, v = x + v * time - [0.0, 0.5 * G * time**2], v - [0.0, G * time]
    spun, turn = spin + rate, angle + (spin + rate) * time
    origin, angle, carried, rate = pose(time)
    arm = turned(state["position"][0, 0], angle)
    speed = carried + rate * across(arm) + turned(state["velocity"][0, 0], angle)
    found = (
        ("place", np.linalg.norm(origin + arm - x), 1e-7, "m"),
        ("velocity", np.linalg.norm(speed - v), 1e-6, "m/s"),
        ("angle", abs(state["angle"][0, 0] + angle - turn), 1e-7, "rad"),
        ("spin", abs(state["spin"][0, 0] + rate - spun), 1e-6, "rad/s"),
    )
    reason = "O(Δt²): (ωΔt)² of the tank's motion"
    return Found([Line.off(name, "parabola", value, allowed, reason, unit) for name, value, allowed, unit in found])


CASES = (
    Case("frame-motion", SECTION, "A swayed, heaved and rolled tank, and moving walls", moving_tank),
    Case("frame-tilt", SECTION, "A tank held at an angle, and a turned one", held_tank, quick=False),
    Case("frame-flight", SECTION, "A flight through a moving tank", flight, quick=False),
)
