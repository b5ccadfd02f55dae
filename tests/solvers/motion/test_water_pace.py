"""Water in a ship on steps of its own, several of hers long, as beside grains."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.simulation import Simulation
from tests.oracles.water import GRAVITY
from tests.solvers.motion.test_water_aboard import aboard, momentum, ship

PACE, LASTS, EVERY = 8, 1.5, 0.02  # s


def paced(step: float, substeps: int) -> Simulation:
    """A barge with water whose steps are `pace` of hers of `step` (s)."""
    made = aboard(ship())
    return Simulation(made.holding(replace(made.fluid, substeps=substeps), step=step), threads=1, arch="cpu")


@pytest.fixture(scope="module")
def run():
    made = paced(aboard(ship()).step / PACE, PACE)
    yield made
    made.close()


@pytest.mark.slow
def test_what_the_water_loses_the_ship_gains_in_its_own_steps(run):
    """The mean load of the ship's few steps is the momentum that the water loses in its one, to rounding."""
    run.advance(PACE * round(0.5 / run.dt / PACE))
    angle = run.observe()["pose"][0, 2]
    before, worst = momentum(run, angle), 0.0
    mass = float(run.water.particles.read(run.water.particles.mass)[0][0].sum())
    for _ in range(20):
        run.advance(PACE)
        row = run.observe()
        c, s = np.cos(angle), np.sin(angle)
        y, z, _ = row["wall_force"][0]
        load = np.array([c * y - s * z, s * y + c * z])
        angle, now = row["pose"][0, 2], momentum(run, row["pose"][0, 2])
        worst = max(worst, np.abs(now - before - PACE * run.dt * (np.array([0.0, -mass * GRAVITY]) - load)).max())
        before = now
    assert worst < 1e-12 * mass


@pytest.mark.slow
def test_ship_and_water_on_steps_of_their_own():
    """With the water's steps eight times hers, she rolls as with both on hers, to 3e-4 of the swing (1e-4 found).

    The load that stands is that of the middle of the water's step; that of its beginning lags by half of it: 8e-4.
    """
    step = aboard(ship()).step / PACE
    rolls = []
    for substeps in (PACE, 1):
        one, found = paced(step, substeps), []
        a_look = one.whole(round(EVERY / one.dt))
        a_look -= a_look % PACE
        for _ in range(round(LASTS / (a_look * step))):
            one.advance(a_look)
            found.append(one.observe()["pose"][0, 2])
        one.close()
        rolls.append(np.array(found))
    assert np.ptp(rolls[1]) > 0.02
    assert rolls[0] == pytest.approx(rolls[1], abs=3e-4 * np.ptp(rolls[1]))


@pytest.mark.slow  # a matter at a pace of its own is in `test_pace.py`, water in a ship in `test_water_aboard.py`
def test_a_run_goes_on_with_the_same_bits(run):
    """Saved after a step of the water and restored, it goes on as if it had not stopped."""
    state, steps = run.state(), run.steps
    run.advance(5 * PACE)
    wanted = run.observe()["pose"]
    run.restore(state)
    assert run.steps == steps
    run.advance(5 * PACE)
    assert (run.observe()["pose"] == wanted).all()
