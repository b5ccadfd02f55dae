"""Single spheres in a prism: one slides with an oblique spin, one rolls across a slope, two bounce off walls."""

import numpy as np
import pytest

from solvers.tank.solids.solid import Prism
from tests.oracles.scenes import material, simulation

G, RADIUS, FRICTION = 9.81, 3e-3, 0.3
SLOPE = np.radians(20.0)
DOWN, UP = np.array([-np.cos(SLOPE), -np.sin(SLOPE)]), np.array([-np.sin(SLOPE), np.cos(SLOPE)])
HALF = 0.5  # m, as far are the end walls and the left side wall from the origin
OUTLINE = np.array([[-HALF, 0.0], [0.5, 0.0], [1.5, np.tan(SLOPE)], [1.5, 1.2], [-HALF, 1.2]])
SLIDING, ROLLING, TO_SIDE, TO_END = range(4)
SPEED, SPIN = np.array([0.3, 0.0, -0.2]), np.array([60.0, 25.0, -40.0])  # m/s and rad/s of the sliding sphere; y, z, x
ACROSS = 0.15  # m/s, of the rolling sphere
SOFT = 1e-3
ALIKE = {"tangential": "mindlin", "twisting": "marshall", "stiffness_scale": SOFT, "gravity": G}


def contact_radius():
    """Radius (m) of the area of contact of a sphere at rest on the floor, √(R ξ), by Hertz."""
    grain = material()
    stiffness = 4.0 / 3.0 * SOFT * grain.young / (2.0 * (1.0 - grain.poisson**2)) * np.sqrt(RADIUS)
    weight = 4.0 / 3.0 * np.pi * RADIUS**3 * grain.density * G
    return np.sqrt(RADIUS * (weight / stiffness) ** (2.0 / 3.0))


@pytest.fixture(scope="module")
def run():
    """Four spheres that do not meet: on the floor, on the slope, and two that fly at walls at x and at y."""
    place = np.array([[0.0, RADIUS, 0.0], [0.0, 0.0, 0.2], [-0.49, 0.6, 0.0], [0.0, 0.6, -0.49]])
    place[ROLLING, :2] = np.array([0.5, 0.0]) - 0.8 * DOWN + RADIUS * UP
    velocity, spin = np.zeros((4, 3)), np.zeros((4, 3))
    velocity[SLIDING], spin[SLIDING] = SPEED, SPIN
    velocity[ROLLING, 2] = ACROSS
    spin[ROLLING, :2] = -ACROSS / RADIUS * DOWN  # v = ω × R n, n = UP
    velocity[TO_SIDE], velocity[TO_END] = [-0.5, 0.2, 0.3], [-0.3, 0.2, -0.5]
    spin[TO_SIDE], spin[TO_END] = [20.0, 50.0, -30.0], [30.0, 50.0, 20.0]
    grain = material(friction=FRICTION, restitution=0.5)
    made = simulation(
        place[None], RADIUS, OUTLINE, grain, velocity=velocity[None], spin=spin[None], solid=Prism(2 * HALF), **ALIKE
    )
    yield made
    made.arrays.release()


def at(run, time):
    """Places, velocities and spins (4, 3) at a time (s)."""
    run.advance(round(time / run.dt) - run.steps)
    state = run.snapshot()
    return (state[name][0] for name in ("position", "velocity", "spin"))


@pytest.mark.slow
def test_spheres_slide_roll_and_bounce_in_any_direction(run):
    """One flight of all four; the sphere that slides bends its way in a parabola until it rolls."""
    start = run.snapshot()["position"][0]
    slip = SPEED + np.cross(SPIN, [0.0, -RADIUS, 0.0])
    rolls_after = 2.0 * np.linalg.norm(slip) / (7.0 * FRICTION * G)
    _, velocity, _ = at(run, 0.5 * rolls_after)
    half = SPEED - FRICTION * G * 0.5 * rolls_after * slip / np.linalg.norm(slip)
    np.testing.assert_allclose(velocity[SLIDING], half, atol=1e-3 * np.linalg.norm(slip))
    place, velocity, spin = at(run, 0.15)
    np.testing.assert_allclose(velocity[SLIDING], SPEED - 2.0 / 7.0 * slip, atol=1e-3 * np.linalg.norm(slip))

    # About the normal it spins more slowly by (2/3) a μ m g/I a second; it bounces a little at first
    lost = 2.0 / 3.0 * contact_radius() * FRICTION * G / (0.4 * RADIUS**2) * run.time
    np.testing.assert_allclose(SPIN[1] - spin[SLIDING, 1], lost, rtol=1e-2)

    # Rolling down the slope by (5/7) g sin, and on across it
    gain = 5.0 / 7.0 * G * np.sin(SLOPE) * run.time
    np.testing.assert_allclose(velocity[ROLLING, :2] @ DOWN, gain, rtol=2e-3)
    np.testing.assert_allclose(velocity[ROLLING, 2], ACROSS, rtol=2e-3)
    np.testing.assert_allclose(place[ROLLING, 2] - start[ROLLING, 2], ACROSS * run.time, rtol=2e-3)

    # An end wall is like a side wall, turned by 90° about z
    assert velocity[TO_SIDE, 0] > 0.0
    np.testing.assert_allclose(velocity[TO_END], velocity[TO_SIDE][[2, 1, 0]] * [-1, 1, 1], rtol=1e-9)
