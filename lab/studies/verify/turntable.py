"""A sphere that rolls on a table which turns about the vertical: a tank in space that yaws at a constant rate."""

import numpy as np

from lab.preset.outline import rectangle
from lab.studies.case import Case, Found, Line
from lab.studies.verify.references import hertz_stiffness, resting_overlap, sphere_mass
from lab.studies.verify.scenes import ACETATE, G
from solvers.grains.given import Grains
from solvers.grains.materials import Material
from solvers.motion.history import Recorded
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.solids.solid import Prism

SECTION = "Sliding and rolling"
RADIUS, SOFT = 3e-3, 1e-3  # m; of the stiffness, for longer steps
RATE = 2.0 * np.pi  # rad/s, of the table
STARTS = np.array([[0.10, 0.0], [-0.05, 0.12]])  # y and x of the spheres, m
SPEEDS = np.array([[0.0, 0.1], [0.15, -0.05]])  # of them over the earth, m/s
OVERLAP = resting_overlap(
    sphere_mass(RADIUS, ACETATE["density"]) * G,
    hertz_stiffness(SOFT * ACETATE["young"], ACETATE["poisson"], RADIUS),
)
LEVER = RADIUS - 0.5 * OVERLAP  # m, of the contact
INERTIA = 0.4 * (RADIUS / LEVER) ** 2  # over m l², l the lever
SHARE = INERTIA / (1.0 + INERTIA)  # of the table's rate at which it circles: 2/7 of a rigid sphere
PERIOD = 2.0 * np.pi / (SHARE * RATE)  # s, of a circle
LOOKS, NEAR = 14, 1e-3


def table() -> Recorded:
    """The yaw of the tank, at a constant rate from the start on."""
    time = tuple(np.linspace(0.0, 2.0 * PERIOD, 8))
    return Recorded("yaw", time, tuple(RATE * t for t in time))


def circled(_: bool) -> Found:
    """A sphere that rolls without slipping circles at 2/7 of the table's rate, wherever it starts and however fast.

    With v the velocity over the earth, Ω the table's rate and a rolling contact, v' = (2/7) Ω × v (Weltner 1979,
    Am. J. Phys. 47:984): a circle of radius |v|/((2/7) Ω), closed after 7/2 turns of the table. The sphere here sinks
    in by ξ and rolls on the lever R − ξ/2, which makes the share of its rate 0.13 % larger.
    """
    position = np.column_stack([STARTS[:, 0], np.full(len(STARTS), RADIUS - OVERLAP), STARTS[:, 1]])
    over_earth = np.column_stack([SPEEDS[:, 0], np.zeros(len(STARTS)), SPEEDS[:, 1]])
    turning = np.array([0.0, RATE, 0.0])
    # Where it touches, the sphere moves as the table: v + ω × (−l n) = Ω × r, with n upwards and no spin about it
    lacking = np.cross(turning, position * [1.0, 0.0, 1.0]) - over_earth
    spin = np.cross(lacking, [0.0, 1.0, 0.0]) / LEVER
    grain = Material(**ACETATE)
    given = Grains(
        np.full((1, len(position)), RADIUS), grain, grain, tangential="mindlin", stiffness_scale=SOFT, start_speed=0.5
    )
    scene = Scene(np.array(rectangle(1.0, 0.1)), (given,), motions=[(table(),)], solid=Prism(1.0), gravity=G)
    run = Simulation(scene, position[None], 1, arch="cpu")
    # The run counts velocities and spins from the tank, in its axes, which at the start are those of the earth
    run.launch((over_earth - np.cross(turning, position))[None], (spin - turning)[None])
    places, times = [], []
    for _ in range(LOOKS):
        run.advance(round(PERIOD / LOOKS / run.dt))
        places.append(turned(run.snapshot()["position"][0], RATE * run.time))
        times.append(run.time)
    run.close()
    return Found(list(_lines(np.array(times), np.array(places)[:, :, [0, 2]])))


def turned(place: np.ndarray, angle: float) -> np.ndarray:
    """Places (n, 3) of the tank over the earth, y, z, x: turned about z, which takes x towards y."""
    y, z, x = place.T
    return np.column_stack([np.cos(angle) * y + np.sin(angle) * x, z, np.cos(angle) * x - np.sin(angle) * y])


def _lines(times: np.ndarray, places: np.ndarray):
    reason = "the spring of the contact"
    for number, (start, speed) in enumerate(zip(STARTS, SPEEDS, strict=True), start=1):
        size, angle = np.hypot(*speed) / (SHARE * RATE), SHARE * RATE * times
        # About z a velocity (y, x) turns into (cos y + sin x, cos x − sin y); its integral is the way
        across = np.array([-speed[1], speed[0]])
        expected = start + (np.sin(angle)[:, None] * speed - (1.0 - np.cos(angle))[:, None] * across) / (SHARE * RATE)
        off = np.linalg.norm(places[:, number - 1] - expected, axis=1).max() / size
        yield Line.off(
            f"farthest from its circle, sphere {number}, of its radius", "2/7 Ω, of the lever", off, NEAR, reason
        )
        shut = float(np.linalg.norm(places[-1, number - 1] - expected[-1]) / size)
        yield Line.off(f"circle {number} closes, of its radius", "2/7 Ω, of the lever", shut, NEAR, reason)


CASES = (Case("space-turntable", SECTION, "A sphere that rolls on a turntable", circled, quick=False),)
