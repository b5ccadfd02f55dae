"""Hulls with rooms: thin walls, what is in a room, and openings."""

import numpy as np
import pytest

from solvers.fluid.bodies.hulls import OPENS
from solvers.simulation import Simulation
from tests.oracles.floating import hull, momentum
from tests.oracles.water import GRAVITY


@pytest.fixture(scope="module")
def thin():
    """A hull with walls of one spacing, water within, and a hole in its floor that is covered: run and its state."""
    run = Simulation(hull(wall=1.0, inside=0.3, hole=0.3, opens=1e9), threads=1)
    yield run, run.state()
    run.close()


def test_a_thin_wall_keeps_the_water_on_either_side_apart(thin):
    """The lift is that of hydrostatics to 1 %; the mass within stays, and its level to 0.02 spacings."""
    run, start = thin
    run.restore(start)
    mass, lifts, levels = run.observe()["room_water"][0, 0], [], []
    within = np.abs(run.snapshot()["water_position"][0] - (0.0, 0.6)).max(axis=1) < 0.45
    within &= np.abs(run.snapshot()["water_position"][0][:, 1] - 0.6) < 0.16
    assert mass == pytest.approx(1000.0 * 0.3 * 0.9, rel=2e-3)
    for _ in range(20):
        run.advance(round(0.05 / run.dt))
        rows = run.observe()
        lifts.append(rows["part_force"][0, 0, 1])
        levels.append(2.0 * (run.snapshot()["water_position"][0][within, 1].mean() - 0.45))
    assert rows["room_water"][0, 0] == pytest.approx(mass, rel=1e-9)
    assert np.mean(lifts) == pytest.approx(1000.0 * GRAVITY * (0.6 * 1.0 - 0.3 * 0.9), rel=0.01)
    assert np.mean(levels) == pytest.approx(0.3, abs=0.02 * 0.05)


def test_water_flows_in_by_forces_that_are_equal_and_opposite(thin):
    """Open the hole: water enters with the flow by which the room fills, and momentum is kept to 1e-12 of Σ|F|Δt."""
    run, start = thin
    run.restore(start)
    lines = run.water.bodies.hulls.lines
    covered = lines.to_numpy()
    opened = covered.copy()
    opened[:, OPENS] = 0.0
    lines.from_numpy(opened)
    try:
        run.advance(1)
        weighs = GRAVITY * run.water.particles.read(run.water.particles.mass)[0][0].sum()
        first, began, booked, pushed, flowed = momentum(run), run.time, run.loads() * 0.0, 0.0, 0.0
        before = run.observe()["room_water"][0, 0]
        for _ in range(100):
            run.advance(2)
            rows = run.observe()
            booked = booked + 2 * run.dt * run.loads()
            pushed += 2 * run.dt * np.abs(run.loads()[0, :, :2]).sum()
            flowed += 2 * run.dt * rows["opening_flow"][0, 0]
        lost = momentum(run) - first + booked[0, :, :2].sum(axis=0)
        lost[1] += weighs * (run.time - began)
        assert np.abs(lost).max() < 1e-12 * pushed
        assert flowed > 10.0  # kg
        assert rows["room_water"][0, 0] - before == pytest.approx(flowed, rel=0.1)
    finally:
        lines.from_numpy(covered)
