"""Water in a tank that rolls freely about an axle: what walls and tank give each other, and water that is held."""

import numpy as np
import pytest

from solvers.fluid.given import VELOCITY_Y
from solvers.motion.axle import Axle
from solvers.simulation import Simulation
from tests.oracles.water import GRAVITY, still

THICK = 0.2  # m
WIDE, DEEP, ROWS = 0.6, 0.1, 8
AXLE = Axle((0.05, 0.3), 3.0, -3.0, heel=0.08)


def tank(axle: Axle, **changes) -> Simulation:
    """A tank a quarter full, on an axle above the water."""
    return Simulation(scene_of(axle, **changes), threads=1, arch="cpu")


def scene_of(axle: Axle, **changes):
    return still(WIDE, 0.4, DEEP, ROWS, axles=[axle], thickness=THICK, **changes)


def turning(run: Simulation) -> tuple[float, float]:
    """Angular momentum (kg m²/s) about the axle of the water and of the tank, half a step before the places."""
    p, (y0, z0) = run.water.particles, run.carrier.axles[0].place
    y, z, v, w, m = (values[0] for values in p.read(*p.place, *p.velocity, p.mass))
    rate = run.carrier.row.to_numpy()[0, 1]
    return THICK * float(m @ ((y - y0) * w - (z - z0) * v)), run.carrier.axles[0].inertia * rate


def test_water_and_tank_keep_their_angular_momentum():
    """Without gravity that of both together about the axle, to rounding, as water hits the walls."""
    axle = Axle((0.05, 0.3), 0.1, 0.0)
    scene = scene_of(axle, gravity=0.0, sound_speed=10.0)
    scene.drops[0, :, VELOCITY_Y] = 0.5
    run = Simulation(scene, threads=1, arch="cpu")
    start = sum(turning(run))
    given = []
    for _ in range(4):
        run.advance(100)
        water, own = turning(run)
        given.append(own)
        assert water + own == pytest.approx(start, abs=1e-11 * abs(start))
    assert max(np.abs(given)) > 0.1 * abs(start)  # else nothing was tried
    run.close()


def account(steps: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Energies (J) at eight times, with so many steps for the usual one.

    What the tank and its water have gained together, losses counted; what the tank has gained beyond the work of its
    load; the work of the walls.
    """
    dt = scene_of(AXLE).time_step() / steps
    run = tank(AXLE, step=dt)
    start, rows = run.observe(), []
    for _ in range(8):
        run.advance(steps * round(0.08 / dt / steps))
        row = run.observe()
        tank_gain = row["axle_energy"][0] - start["axle_energy"][0]
        water = row["water_total"] - start["water_total"]
        taken = row["water_viscous"] + row["water_diffusive"] + row["water_held"]
        rows.append((tank_gain + (water + taken)[0], tank_gain - row["axle_works"][0, 0], row["water_work"][0]))
        assert row["axle_works"][0, 0] == pytest.approx(-row["water_work"][0], rel=1e-3)
    run.close()
    return tuple(np.array(rows).T)


def test_what_the_walls_give_the_water_the_tank_loses():
    """The energy of an undamped tank and its water, losses counted, to 2e-3 of what passes between them."""
    lost, _, given = account(1)
    assert np.abs(given).max() > 0.05
    assert np.abs(lost).max() < 2e-3 * np.abs(given).max()


@pytest.mark.slow
def test_the_account_of_energy_closes_with_the_step():
    """What is missing falls with Δt, of the tank alone and of both: works and losses lag by half a step."""
    runs = [account(steps)[:2] for steps in (1, 2, 4)]
    for missing in zip(*runs, strict=True):
        coarse, middle, fine = (np.abs(values).max() for values in missing)
        assert coarse / middle == pytest.approx(2.0, abs=0.3)
        assert middle / fine == pytest.approx(2.0, abs=0.3)


def test_water_that_is_held_is_a_rigid_weight():
    """Upright, in a tank that is held, the moment about the axle is that of the water's weight, to 1e-3."""
    run = tank(Axle((0.05, 0.3), 3.0, -3.0, release=10.0))
    run.advance(round(0.5 / run.dt))
    run.observe()
    run.advance(round(0.5 / run.dt))
    row = run.observe()
    weight = 1000.0 * GRAVITY * WIDE * DEEP * THICK * (1.0 + 0.5 * GRAVITY * DEEP / run.scene.water.sound_speed**2)
    assert row["axle_moment"][0] == pytest.approx(0.05 * weight, rel=1e-3)
    assert row["wall_force"][0, 1] == pytest.approx(-weight, rel=1e-3)
    run.close()
