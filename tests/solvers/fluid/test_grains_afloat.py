"""Grains in a room of a body that floats in water: Archimedes and momentum of all three."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.simulation import Simulation
from tests.oracles.aboard import laden, masses, together
from tests.oracles.water import GRAVITY

SPACING, RATE = 0.05, 0.3  # m, rad/s


@pytest.fixture(scope="module", params=[1, 5], ids=["one step", "five steps of grains in one of the water"])
def floating(request):
    """A laden box that has just been let go: run, and its state then."""
    scene, places = laden()
    scene = scene.holding(replace(scene.fluid, substeps=request.param))
    run = Simulation(scene, places, 1)
    run.advance(run.whole(round(0.15 / run.dt)))
    yield run, run.state()
    run.close()


def momentum(run: Simulation) -> np.ndarray:
    """Momentum (2,) N s of water, body and grains half a step ago, and what of it is on its way to the body."""
    p, hold = run.water.particles, run.parts.bodies.hold
    mass, *velocity = (values[0] for values in p.read(p.mass, *p.velocity))
    pending = hold.gathered.to_numpy()[0] - 0.5 * (hold.every - 1) * run.dt * hold.former.to_numpy()[0]
    of_water = run.scene.thickness * np.array([mass @ along for along in velocity])
    return of_water + together(run)["momentum"] + pending[:2]


@pytest.mark.slow
def test_what_water_and_grains_lose_the_body_and_the_tank_gain(floating):
    """Momentum is kept to 1e-12 of Σ|F|Δt as she rolls, and she is accelerated as was solved for beside water."""
    run, start = floating
    run.restore(start)
    run.parts.bodies.velocity[2].from_numpy(np.full((1, 1), RATE))
    first, began, given, pushed, bodies = momentum(run), run.time, np.zeros(2), 0.0, run.parts.bodies
    rolled = 0.0
    weight = GRAVITY * run.scene.thickness * run.water.particles.read(run.water.particles.mass)[0][0].sum()
    weight += GRAVITY * together(run)["mass"]
    step = run.exchange_interval * run.dt
    for _ in range(300):
        before = [field.to_numpy()[0, 0] for field in bodies.velocity]
        run.advance(run.exchange_interval)
        of_water, of_grains = (
            np.stack([field.to_numpy()[0, :3] for field in load.instant[:2]], axis=-1)
            for load in (run.water.load, run.grains.load)
        )
        given += step * of_water[0]  # on the tank of water
        pushed += step * (np.abs(of_water).sum() + np.abs(of_grains).sum())
        gain = np.subtract([field.to_numpy()[0, 0] for field in bodies.velocity], before) / step
        solved = run.water.extrapolation.coupling.solution.to_numpy()[0, 0]
        np.testing.assert_allclose(gain, solved, atol=1e-10 * GRAVITY)
        rolled = max(rolled, abs(bodies.place[2].to_numpy()[0, 0]))
    fell = np.array([0.0, weight * (run.time - began)])
    assert np.abs(momentum(run) - first + given + fell).max() < 1e-12 * pushed
    assert rolled > 0.01  # rad, else nothing was tried


@pytest.mark.slow
def test_she_floats_as_deep_as_her_weight_and_that_of_the_grains_ask(floating):
    """Half a spacing of draught; what the water bears is both weights, what the room does is that of the grains.

    Means over 2 s, four heaves or more, of which the velocities at the ends leave 1 % of a weight.
    """
    run, start = floating
    run.restore(start)
    run.observe()
    places, loads = [], []
    for _ in range(40):
        run.advance(run.whole(round(0.05 / run.dt)))
        places.append(run.observe()["body_place"][0, 0])
        loads.append(run.loads()[0][:, 1])
    grains, both = GRAVITY * masses(run).sum(), GRAVITY * together(run)["mass"]
    middle = run.scene.parts[0].free.centre[1]
    assert np.mean(places, axis=0) == pytest.approx([0.0, middle, 0.0], abs=0.5 * SPACING)
    assert np.mean(loads, axis=0)[[1, 2]] == pytest.approx([-grains, both], rel=0.01)


@pytest.mark.slow
def test_a_run_with_grains_afloat_goes_on_bit_for_bit(floating):
    run, start = floating
    run.restore(start)
    run.advance(210)
    whole = run.state()
    run.restore(start)
    run.advance(210)
    again = run.state()
    for name, values in whole.items():
        np.testing.assert_array_equal(values, again[name], err_msg=name)
