"""Matters side by side, one of them at a pace of its own: its steps are longer, and its load stands in between."""

import numpy as np
import pytest

from solvers.matters import MATTERS
from solvers.ship.body import Body
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Ship
from solvers.ship.section import box as section
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import regular
from solvers.simulation import Simulation
from solvers.tank.given import Given
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material
from tests.oracles.weight import Weight

G, RADIUS, STEP = 9.81, 5e-3, 5e-5
MASS, SPRING, MIDDLE, START = 0.2, 800.0, (0.01, 0.05), (0.012, 0.047)
AXIS = (0.0, 0.11)


class Hung(Given):
    """What a scene says of the weight."""

    worlds = 1


def two_matters(monkeypatch, every: int, push=(0.0, 0.0), spring=SPRING, schedule="per-world", vessels=()):
    """A simulation of two grains on the floor and a weight that acts `every` few steps."""

    def make_weight(scene, context):
        return Weight(scene, context, MASS, MIDDLE, spring, push, every)

    monkeypatch.setitem(MATTERS, Hung, (lambda scene, closing: [], (make_weight,)))
    grain = material(young=5e7)
    position = np.array([[[-0.02, RADIUS], [0.02, RADIUS]]])
    radius = np.full((1, 2), RADIUS)
    few = {"tangential": "none", "step": STEP}  # laws, so that kernels compile fast
    scene = scene_of(radius, box(0.1, 0.1), grain, grain, schedule=schedule, vessels=vessels, **few)
    run = Simulation(scene.holding(Hung()), position, 2, arch="cpu", units=2 if schedule == "per-band" else None)
    run.matters["weight"].put(*START)
    return run


def verlet(beats: int, step: float) -> np.ndarray:
    """Place and velocity after so many steps (s) of Verlet's scheme, the velocity half a step behind."""
    place, velocity = np.array(START), np.zeros(2)
    for beat in range(beats):
        force = -SPRING * (place - MIDDLE) + [0.0, -MASS * G]
        velocity = velocity + (0.5 if beat == 0 else 1.0) * step * force / MASS
        place = place + step * velocity
    return np.concatenate([place, velocity])


SLOW = pytest.mark.slow


@pytest.mark.slow
@pytest.mark.parametrize(
    "schedule", ["per-world", pytest.param("per-band", marks=SLOW), pytest.param("per-grain", marks=SLOW)]
)
def test_a_matter_with_a_pace_takes_steps_that_are_as_much_longer(monkeypatch, schedule):
    """On all schedules the weight of pace 5 is where Verlet's scheme with five times the step takes it.

    The impulse on the tank is what it lacks in momentum, weight included, and the grains' own weight.
    """
    run = two_matters(monkeypatch, 5, schedule=schedule)
    run.advance(1)  # kicks of the first step are half as long
    run.observe()
    before, grains = run.matters["weight"].read()[0], run.grains.mass[0].sum()
    run.advance(400)
    run.advance(2)
    rows, now, beats = run.observe(), run.matters["weight"].read()[0], 81
    np.testing.assert_allclose(now, verlet(beats, 5 * STEP), rtol=1e-11, atol=1e-14)
    beat_time, time = 5 * STEP * (beats - 1), 402 * STEP
    gained = MASS * (now[2:] - before[2:]) + [0.0, MASS * G * beat_time]
    force = rows["wall_force"][0, :2] * time + gained
    assert force[0] == pytest.approx(0.0, abs=1e-12 * SPRING * RADIUS * time)
    assert force[1] == pytest.approx(-grains * G * time, rel=1e-2)  # the grains still bounce a little
    run.close()


def hull() -> Vessel:
    """A barge in calm water, without memory."""
    water = Water()
    load = Floating(section(0.34, 0.30), water, AXIS, regular(0.0, 4.4, water), np.zeros((1, 3)))
    radiation = Radiation(np.diag([40.0, 52.0, 0.2]), np.diag([20.0, 100.0, 0.05]))
    return Vessel(Ship(Body(37.0, (0.004, 0.09), 0.6), load, radiation, AXIS), (0.0, 0.02), 2.0)


@SLOW
def test_the_load_of_a_matter_stands_between_its_beats(monkeypatch):
    """A ship pushed by a constant force moves the same, whether that is computed at each step or at every seventh.

    A state saved between two beats holds the standing load: the run goes on from it with the same bits.
    """
    poses, start = [], 0.0
    for every in (1, 7):
        run = two_matters(monkeypatch, every, push=(0.3, 0.5), spring=0.0, vessels=[hull()])
        start = run.observe()["pose"][0]
        run.advance(1370)
        saved = run.state()
        run.advance(30)
        rows = run.observe()
        poses.append(rows["pose"][0])
    assert np.abs(poses[0] - start).min() > 1e-6
    np.testing.assert_allclose(poses[1], poses[0], rtol=0.0, atol=1e-12)
    run.restore(saved)
    run.advance(30)
    for name, values in run.observe().items():
        assert values.tobytes() == rows[name].tobytes(), name
    run.close()
