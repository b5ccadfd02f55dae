"""A steered tank, and a scene whose materials and gravity change while its grains move."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.motion import Sway
from solvers.motion.steered import Steered, hermite
from tests.oracles.scenes import box, material, simulation

PIECE = 5e-3  # s
AMPLITUDE, FREQUENCY = 0.02, 2.0
SLOPE = np.radians(20.0)


def swayed(time: float) -> np.ndarray:
    """Place, speed and acceleration of a sway."""
    omega = 2.0 * np.pi * FREQUENCY
    return AMPLITUDE * np.array(
        [np.sin(omega * time), omega * np.cos(omega * time), -(omega**2) * np.sin(omega * time)]
    )


def test_a_piece_has_the_motion_given_at_both_ends():
    begin, end = np.array([0.3, -1.0, 4.0]), np.array([0.1, 2.0, -7.0])
    curve = np.polynomial.Polynomial(hermite(0.02, begin, end))
    ends = [[curve.deriv(n)(time) if n else curve(time) for n in range(3)] for time in (0.0, 0.02)]
    assert ends == [pytest.approx(begin), pytest.approx(end)]


@pytest.fixture(scope="module")
def run():
    """Three grains on the floor, far from one another, in a wide tank that is steered along y, z and turns."""
    places = np.array([[[-0.2, 3e-3], [0.0, 3e-3], [0.2, 3e-3]]])
    hands = [Steered("turn", 2.0), Steered("y", 1.0), Steered("z", 1.0)]
    made = simulation(places, 3e-3, box(1.0, 0.2), material(friction=0.3), motions=[hands], stiffness_scale=1e-3)
    yield made
    made.close()


STILL = np.zeros(6)


@pytest.mark.slow
def test_grains_in_a_tank_steered_along_a_sway_move_as_in_the_sway(run):
    start = run.state()
    steps = round(PIECE / run.dt)
    length = steps * run.dt
    for k in range(40):
        run.steer([STILL, hermite(length, swayed(k * length), swayed((k + 1) * length)), STILL])
        run.advance(steps)
    rows, found = run.observe(), run.snapshot()
    run.restore(start)
    run.steer([STILL] * 3)
    context = {"motions": [[Sway(AMPLITUDE, FREQUENCY)]], "stiffness_scale": 1e-3, "step": run.dt}
    other = simulation(start_places(), 3e-3, box(1.0, 0.2), material(friction=0.3), **context)
    other.advance(40 * steps)
    wanted, theirs = other.snapshot(), other.observe()
    other.close()
    assert rows["pose"][..., 0] == pytest.approx(theirs["pose"][..., 0], abs=1e-9)
    assert np.ptp(found["position"] - start_places()) > 1e-3
    assert found["position"] == pytest.approx(wanted["position"], abs=1e-7)


def start_places() -> np.ndarray:
    return np.array([[[-0.2, 3e-3], [0.0, 3e-3], [0.2, 3e-3]]])


@pytest.mark.slow
def test_a_change_of_friction_acts_on_existing_contacts(run):
    """Sliding in a tank that is pulled away: μ g, before and after (Coulomb)."""
    start = run.state()
    grain = run.scene.grains.grain[0]
    pull = np.array([0.0, 0.0, 0.5 * 20.0, 0.0, 0.0, 0.0])  # 20 m/s²: grains slide
    run.steer([STILL, pull, STILL])
    gained = []
    for friction in (0.3, 0.1):
        other = (replace(grain, friction=friction),)
        run.alter(run.scene.holding(replace(run.scene.grains, grain=other, wall=other)))
        run.advance(round(2e-3 / run.dt))  # the floor bears the grains again
        before, time = run.snapshot(), run.time
        run.advance(round(5e-3 / run.dt))
        gained.append((run.snapshot()["velocity"] - before["velocity"])[0, :, 0].mean() / (run.time - time) + 20.0)
    run.alter(run.scene.holding(replace(run.scene.grains, grain=(grain,), wall=(grain,))))
    run.restore(start)
    assert gained == [pytest.approx(0.3 * 9.81, rel=0.1), pytest.approx(0.1 * 9.81, rel=0.1)]


@pytest.mark.slow  # of grains in flight: `test_frames.py`
def test_a_change_of_gravity_acts(run):
    start = run.state()
    run.alter(replace(run.scene, gravity=1.62))
    run.launch(velocity=np.tile([0.0, 0.5], (1, 3, 1)))
    run.advance(round(0.05 / run.dt))
    speed = run.snapshot()["velocity"][0, :, 1]
    elapsed = run.time - float(start["run.steps"]) * run.dt
    run.alter(replace(run.scene, gravity=9.81))
    run.restore(start)
    assert speed == pytest.approx(0.5 - 1.62 * elapsed, abs=0.02)


def test_changes_that_need_shorter_steps_are_refused(run):
    with pytest.raises(Unavailable, match="shorter time steps"):
        run.alter(replace(run.scene, gravity=1e4))
    assert run.scene.gravity == 9.81
