"""Water in a tank that rolls freely about an axle: what walls and tank give each other, and water that is held."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import least_squares

from solvers.motion.axle import Axle
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.water import GRAVITY, again, still

THICK = 0.2  # m
WIDE, DEEP, ROWS = 0.6, 0.1, 8
AXLE = Axle((0.05, 0.3), 3.0, -3.0, heel=0.08)


def tank(axle: Axle, **changes) -> Simulation:
    """A tank a quarter full, on an axle above the water, in two bands: the quick tests of water have no others."""
    return Simulation(scene_of(axle, schedule="per-band", **changes), threads=1, arch="cpu", units=2)


def scene_of(axle: Axle, **changes) -> Scene:
    return still(WIDE, 0.4, DEEP, ROWS, axles=[axle], thickness=THICK, sound_speed=10.0, **changes)


@pytest.fixture(scope="module")
def run() -> Iterator[Simulation]:
    made = tank(AXLE)
    yield made
    made.close()


def hung(run: Simulation, scene: Scene) -> Simulation:
    """The same simulation with the water and the axle of another scene."""
    run.carrier.axles = tuple(scene.axles)
    run.carrier.table.from_numpy(np.array([axle.row for axle in scene.axles]))
    return again(run, scene)


def turning(run: Simulation) -> tuple[float, float]:
    """Angular momentum (kg m²/s) about the axle of the water and of the tank, half a step before the places."""
    p, (y0, z0) = run.water.particles, run.carrier.axles[0].place
    y, z, v, w, m = (values[0] for values in p.read(*p.place, *p.velocity, p.mass))
    rate = run.carrier.row.to_numpy()[0, 1]
    return THICK * float(m @ ((y - y0) * w - (z - z0) * v)), run.carrier.axles[0].inertia * rate


@pytest.mark.slow
def test_water_and_tank_keep_their_angular_momentum(run):
    """Without gravity that of both together about the axle, to rounding, as water hits the walls."""
    axle = Axle((0.05, 0.3), 0.1, 0.0)
    scene = scene_of(axle, gravity=0.0)
    scene.fluid.particles["velocity"][0, :, 0] = 0.5
    start = sum(turning(hung(run, scene)))
    given = []
    for _ in range(4):
        run.advance(round(0.2 / run.dt))
        water, own = turning(run)
        given.append(own)
        assert water + own == pytest.approx(start, abs=1e-11 * abs(start))
    assert max(np.abs(given)) > 0.1 * abs(start)  # else nothing was tried


def account(run: Simulation, steps: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Energies (J) at eight times, with so many steps for the usual one.

    What the tank and its water have gained together, losses counted; what the tank has gained beyond the work of its
    load; the work of the walls.
    """
    start, rows = run.observe(), []
    for _ in range(8):
        run.advance(steps * round(0.08 / run.dt / steps))
        row = run.observe()
        tank_gain = row["axle_energy"][0] - start["axle_energy"][0]
        water = row["water_total"] - start["water_total"]
        taken = row["water_viscous"] + row["water_diffusive"] + row["water_wall_energy"]
        rows.append((tank_gain + (water + taken)[0], tank_gain - row["axle_works"][0, 0], row["water_work"][0]))
        assert row["axle_works"][0, 0] == pytest.approx(-row["water_work"][0], rel=1e-3)
    return tuple(np.array(rows).T)


@pytest.mark.slow
def test_what_the_walls_give_the_water_the_tank_loses(run):
    """The energy of an undamped tank and its water, losses counted, to 1e-4 of what passes between them."""
    lost, _, given = account(hung(run, scene_of(AXLE)), 1)
    assert np.abs(given).max() > 0.05
    assert np.abs(lost).max() < 1e-4 * np.abs(given).max()


@pytest.mark.slow
def test_the_account_of_energy_closes_with_the_step():
    """What is missing falls with Δt², of the tank alone and of both: works and losses are those of the same time."""
    runs, dt = [], scene_of(AXLE).time_step()
    for steps in (1, 2, 4):
        run = tank(AXLE, step=dt / steps)
        runs.append(account(run, steps)[:2])
        run.close()
    for missing in zip(*runs, strict=True):
        coarse, middle, fine = (np.abs(values).max() for values in missing)
        assert coarse / middle == pytest.approx(4.0, abs=0.6)
        assert middle / fine == pytest.approx(4.0, abs=0.6)


@pytest.mark.slow
def test_water_that_is_held_is_a_rigid_weight(run):
    """Upright, in a tank that is held, the moment about the axle is that of the water's weight, to 1e-3."""
    hung(run, scene_of(Axle((0.05, 0.3), 3.0, -3.0, release=10.0)))
    run.advance(round(0.5 / run.dt))
    run.observe()
    run.advance(round(0.5 / run.dt))
    row = run.observe()
    weight = (
        1000.0 * GRAVITY * WIDE * DEEP * THICK * (1.0 + 0.5 * GRAVITY * DEEP / run.scene.fluid.water.sound_speed**2)
    )
    assert row["axle_moment"][0] == pytest.approx(0.05 * weight, rel=1e-3)
    assert row["wall_force"][0, 1] == pytest.approx(-weight, rel=1e-3)


def coupled_periods(axle: Axle, width: float, depth: float, modes: int = 4) -> np.ndarray:
    """Periods (s) of small swings of tank and water together, the longest first: linear potential flow.

    The water of a rectangular tank moves as masses on springs at heights H_n over its centre (Graham & Rodriguez 1952;
    Ibrahim 2005, section 5.2), m_n = 8 m tanh(k_n d)/((2n − 1)³ π³ d/l). Of its inertia about its centre, which here
    makes 0.3 % of a period, all is counted.
    """
    mass, odd = 1000.0 * width * depth * THICK, 2.0 * np.arange(modes) + 1.0
    number = odd * np.pi / width
    each = 8.0 * mass * np.tanh(number * depth) / (odd**3 * np.pi**3 * depth / width)
    over = 0.5 * depth - 2.0 / number * np.tanh(0.5 * number * depth)
    centre, rest = 0.5 * depth - axle.place[1], mass - each.sum()
    height = centre + over
    inertia, spring = np.diag([0.0, *each]), np.diag([0.0, *(each * GRAVITY * number * np.tanh(number * depth))])
    inertia[0, 0] = axle.inertia + each @ height**2 + rest * (centre - each @ over / rest) ** 2
    inertia[0, 0] += mass * (width**2 + depth**2) / 12.0
    spring[0, 0] = -GRAVITY * (axle.moment + mass * centre)
    inertia[0, 1:] = inertia[1:, 0] = -each * height
    spring[0, 1:] = spring[1:, 0] = GRAVITY * each
    return 2.0 * np.pi / np.sqrt(eigh(spring, inertia, eigvals_only=True))


@pytest.mark.slow
def test_water_and_tank_swing_at_the_two_periods_of_linear_theory():
    """A tank tuned to its water, let go at 0.3 deg: the roll is two damped sines, to 1 % of it, with periods to 1 %."""
    width, depth, axle = 0.9, 0.092, Axle((0.0, 0.47), 26.9 * THICK / 0.062, -29.2 * THICK / 0.062)
    released = replace(axle, heel=0.3 * np.pi / 180.0, release=0.5)
    scene = still(width, 0.2, depth, 8, axles=[released], thickness=THICK, sound_speed=12.0)
    run, time, roll = Simulation(scene, threads=1, arch="cpu"), [], []
    while run.time < 16.0:
        run.advance(40)
        time.append(run.time - 1.0)
        roll.append(run.observe()["pose"][0, 2])
    run.close()
    free = np.array(time) > 0.0
    time, roll = np.array(time)[free], np.array(roll)[free]

    def missing(x: np.ndarray) -> np.ndarray:
        """The roll that two damped sines leave, each by cosine, sine, rate and decay."""
        parts = [(c * np.cos(w * time) + s * np.sin(w * time)) * np.exp(-d * time) for c, s, w, d in x.reshape(2, 4)]
        return sum(parts) - roll

    wanted = coupled_periods(axle, width, depth)[:2]
    start = [(released.heel / 2.0, 0.0, 2.0 * np.pi / period, 0.02) for period in wanted]
    found = least_squares(missing, np.ravel(start))
    assert np.std(found.fun) < 0.02 * np.std(roll)
    periods = 2.0 * np.pi / found.x.reshape(2, 4)[:, 2]
    np.testing.assert_allclose(periods, wanted, rtol=0.01)
    alone = axle.natural_period(GRAVITY)
    assert wanted[0] > 1.08 * alone > 1.14 * wanted[1]  # else nothing was tried
