"""Water in tanks that move, and water that is free: momentum and energy.

Frames, and drops with known motion, are cases of `cargolab verify`.
"""

import numpy as np
import pytest

from solvers.fluid.given import particles
from solvers.motion.harmonic import Roll
from solvers.simulation import Simulation
from tests.oracles.water import still

ROLL = Roll(0.3, 0.8, centre=(0.1, 0.2))
DROP = {"walls": False, "gravity": 0.0, "sound_speed": 20.0, "alpha": 0.02}


def drop(rate: float, across: int = 20, **changes):
    """A round drop of radius 0.1 m that is strained by u = σ (y, −z), σ = `rate` (1/s), with no gravity."""
    spacing = 0.2 / across
    side = (np.arange(across) + 0.5) * spacing - 0.1
    grid = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    grid = grid[np.hypot(*grid.T) < 0.1]
    drops = particles(1, len(grid))
    drops["position"][0], drops["volume"] = grid, spacing**2
    drops["velocity"][0, :, 0], drops["velocity"][0, :, 1] = rate * grid[:, 0], -rate * grid[:, 1]
    return still(1.0, 1.0, spacing * 20, 20, drops=drops, **(DROP | changes))


@pytest.mark.slow
def test_a_free_drop_keeps_its_momentum_and_turning():
    scene = drop(2.0)
    scene.fluid.particles["velocity"][0, :, 0] -= 3.0 * scene.fluid.particles["position"][0, :, 1]  # it also turns
    scene.fluid.particles["velocity"][0, :, 1] += 3.0 * scene.fluid.particles["position"][0, :, 0]
    run = Simulation(scene, threads=1, arch="cpu")
    p = run.water.particles
    sums = []
    for _ in range(2):
        y, z, v, w, m = (values[0] for values in p.read(*p.place, *p.velocity, p.mass))
        sums.append((np.array([m @ v, m @ w, m @ (y * w - z * v)]), m @ np.hypot(v, w), m @ np.hypot(y * w, z * v)))
        run.advance(200)
    (before, pushed, turning), (after, *_) = sums
    np.testing.assert_allclose(after[:2], before[:2], atol=1e-12 * pushed)
    # Places and velocities are half a step apart, so that the sum of their products is kept to the order of the step
    np.testing.assert_allclose(after[2], before[2], atol=1e-3 * turning)


@pytest.mark.slow
def test_walls_work_on_the_water_of_a_moving_tank():
    """Momentum over the earth changes by weight and load, energy by the work of the walls, as the tank rolls."""
    scene = still(0.6, 0.6, 0.2, 10, motions=[[ROLL]], soft_start=0.1)
    run = Simulation(scene, threads=1, arch="cpu")
    start, steps = run.observe(), 600
    run.advance(steps)
    end = run.observe()
    taken = sum(end[name] - start[name] for name in ("water_viscous", "water_diffusive", "water_wall_energy"))
    work = end["water_work"] - start["water_work"]
    gain = end["water_total"] - start["water_total"]
    assert abs(work[0]) > 5.0 * abs(taken[0])  # else nothing was tried
    np.testing.assert_allclose(gain + taken, work, atol=2e-3 * abs(work[0]))
