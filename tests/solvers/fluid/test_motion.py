"""Water in tanks that move, and water that is free: frames, momentum, and drops with known motion."""

from collections.abc import Iterator

import numpy as np
import pytest

from solvers.fluid.given import Pull, particles
from solvers.motion.harmonic import Heave, Roll, Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.water import again, still

MOTIONS = (Roll(0.3, 0.8, centre=(0.1, 0.2)), Sway(0.05, 1.1), Heave(0.02, 0.9))
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


def positions(scene, steps: int) -> tuple[Simulation, np.ndarray]:
    run = Simulation(scene, threads=1, arch="cpu")
    run.advance(steps)
    return run, run.snapshot()["water_position"][0]


STRAIN, PULL = 10.0, Pull(10.0)  # 1/s


@pytest.fixture(scope="module")
def strained() -> Iterator[Simulation]:
    run = Simulation(drop(STRAIN, pull=PULL), threads=1, arch="cpu")
    yield run
    run.close()


def free(run: Simulation, scene: Scene) -> Simulation:
    """The same simulation with another drop, which is not pulled."""
    constants = again(run, scene).water.constants
    values = constants.values.to_numpy()
    values[constants.at["pull"]] = 0.0
    constants.values.from_numpy(values)
    return run


@pytest.mark.slow
def test_a_free_drop_keeps_its_momentum_and_turning(strained):
    scene = drop(2.0)
    scene.fluid.particles["velocity"][0, :, 0] -= 3.0 * scene.fluid.particles["position"][0, :, 1]  # it also turns
    scene.fluid.particles["velocity"][0, :, 1] += 3.0 * scene.fluid.particles["position"][0, :, 0]
    run = free(strained, scene)
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
def test_the_axes_that_a_drop_is_seen_from_do_not_matter():
    """In a tank that rolls, sways and heaves round it without touching, a drop moves over the earth as without."""
    still_run, alone = positions(drop(1.0), 100)
    run, seen = positions(drop(1.0, motions=[MOTIONS]), 100)
    assert run.dt == pytest.approx(still_run.dt)
    pose = run.observe()["pose"][0]
    turn = np.array([[np.cos(pose[2]), -np.sin(pose[2])], [np.sin(pose[2]), np.cos(pose[2])]])
    np.testing.assert_allclose(pose[:2] + seen @ turn.T, alone, atol=1e-9)
    assert np.abs(seen - alone).max() > 0.01  # else nothing was tried


@pytest.mark.slow
def test_walls_work_on_the_water_of_a_moving_tank():
    """Momentum over the earth changes by weight and load, energy by the work of the walls, as the tank rolls."""
    scene = still(0.6, 0.6, 0.2, 10, motions=[MOTIONS[:1]], soft_start=0.1)
    run = Simulation(scene, threads=1, arch="cpu")
    start, steps = run.observe(), 600
    run.advance(steps)
    end = run.observe()
    taken = sum(end[name] - start[name] for name in ("water_viscous", "water_diffusive", "water_wall_energy"))
    work = end["water_work"] - start["water_work"]
    gain = end["water_total"] - start["water_total"]
    assert abs(work[0]) > 5.0 * abs(taken[0])  # else nothing was tried
    np.testing.assert_allclose(gain + taken, work, atol=2e-3 * abs(work[0]))


@pytest.mark.slow
def test_a_strained_drop_becomes_the_ellipse_of_theory(strained):
    """u = σ (y, −z): σ' = σ² (b² − a²)/(a² + b²), a' = σ a, b' = −σ b (Monaghan 1994, eq. 4.4), to 2 % of the axis."""
    duration, run = 0.06, free(strained, drop(STRAIN))
    steps = round(duration / run.dt)
    run.advance(steps)
    place = run.snapshot()["water_position"][0]
    a, b, s, count = 0.1, 0.1, STRAIN, 4000
    dt = steps * run.dt / count
    for _ in range(count):
        s += dt * s * s * (b * b - a * a) / (a * a + b * b)
        a, b = a * (1.0 + s * dt), b * (1.0 - s * dt)
    start = drop(STRAIN).fluid.particles["position"][0]
    found = 0.1 * np.sqrt((place**2).mean(axis=0) / (start**2).mean(axis=0))  # root mean squares grow as the axes
    np.testing.assert_allclose(found, [a, b], rtol=0.02)


@pytest.mark.slow  # that water moves as theory says `tests/lab/studies/test_wave_tank.py` asks for
def test_a_drop_that_is_pulled_to_a_point_swings_at_the_frequency_of_theory(strained):
    """Small strains under −Ω² r: the axes swing at √2 Ω (Monaghan & Rafiee 2013), to 2 %."""
    scene = drop(0.2, pull=PULL)
    scene.fluid.particles["deviation"] = (
        0.5 * 10.0**2 * (0.01 - (scene.fluid.particles["position"] ** 2).sum(axis=-1)) / 20.0**2
    )
    run, wide, time = again(strained, scene), [], []
    for _ in range(60):
        run.advance(max(1, round(0.005 / run.dt)))
        square = (run.snapshot()["water_position"][0] ** 2).mean(axis=0)
        wide.append(square[0] - square[1])
        time.append(run.time)
    wide, time = np.array(wide), np.array(time)
    falls = np.flatnonzero((wide[:-1] > 0.0) & (wide[1:] <= 0.0))[0]
    crossing = time[falls] + (time[falls + 1] - time[falls]) * wide[falls] / (wide[falls] - wide[falls + 1])
    np.testing.assert_allclose(crossing, np.pi / (np.sqrt(2.0) * 10.0), rtol=0.02)
