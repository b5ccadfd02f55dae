"""Hard cases of ships with water: heavy water, resonance without damping, turning over, a tank that runs dry."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.scene import Scene
from solvers.ship.body import Body
from solvers.ship.hydrostatics import turned
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Ship, sail
from solvers.ship.section import box as hull
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water as Sea
from solvers.ship.waves import regular
from solvers.simulation import Simulation
from tests.oracles.water import GRAVITY, still

pytestmark = pytest.mark.slow
AXIS, HOLD = (0.0, 0.11), (0.0, 0.02)  # m
WIDE, HIGH, ROWS = 0.4, 0.2, 10
HALF = 0.5 * HIGH
WATER = 1000.0 * WIDE * HALF  # kg/m
ADDED = np.diag([40.0, 52.0, 0.2])


def barge(body: Body, push: float = 0.0, omega: float = 5.0, damped: float = 1.0, **changes) -> Vessel:
    """A barge, in waves that push her by so many N/m for each metre of their height, or in calm water."""
    sea = Sea()
    waves = regular(0.01 if push else 0.0, omega, sea, 1.0)
    load = Floating(hull(0.6, 0.40), sea, AXIS, waves, push * np.array([[1.0, 1.0j, 0.03]]))
    return Vessel(Ship(body, load, Radiation(ADDED, damped * np.diag([20.0, 100.0, 0.1])), AXIS), HOLD, **changes)


def half_full(vessel: Vessel, **changes) -> Scene:
    """A half-full tank as long as she is."""
    scene = still(WIDE, HIGH, HALF, ROWS, vessels=[vessel], length=vessel.length, **changes)
    return replace(scene, step=scene.time_step())


def rows_of(scene: Scene, lasts: float, every: float = 0.05) -> list[dict[str, np.ndarray]]:
    """What is observed on the way; the checks of the water's state raise if it is not physical."""
    run, rows = Simulation(scene, threads=1, arch="cpu"), []
    while run.time < lasts and not (rows and (rows[-1]["capsized"] >= 0.0).all()):
        run.advance(max(1, round(every / run.dt)))
        rows.append({"time": run.time} | run.observe())
    run.close()
    return rows


def test_a_half_full_tank_as_heavy_as_the_hull():
    """In waves she rolls as with water by linear theory, which is small here, to a fifth of it."""
    vessel = barge(Body(WATER, (0.0, 0.06), 0.04 * WATER), push=1000.0)
    rolls = []
    for model in ("sph", "linear"):
        scene = half_full(vessel, model=model, **({"swing_damping": 0.02} if model == "linear" else {}))
        scene = replace(scene, step=1e-3) if model == "linear" else scene
        rolls.append(np.array([row["pose"][0, 2] for row in rows_of(scene, 6.0)]))
    assert rolls[1][-60:].std() > 2e-3
    assert rolls[0][-60:].std() == pytest.approx(rolls[1][-60:].std(), rel=0.2)


def test_resonance_without_damping():
    """Undamped, in waves of the tank's first period: the water takes the energy, and she stays within her limits."""
    omega = np.sqrt(GRAVITY * np.pi / WIDE * np.tanh(np.pi * HALF / WIDE))
    vessel = barge(Body(2.0 * WATER, (0.0, 0.06), 0.06 * WATER), push=1500.0, omega=float(omega), damped=0.0)
    rows = rows_of(half_full(vessel), 10.0)
    roll, spent = np.array([row["pose"][0, 2] for row in rows]), rows[-1]["water_viscous"] + rows[-1]["water_diffusive"]
    assert np.isfinite(roll).all()
    assert np.abs(roll).max() < 1.0
    assert rows[-1]["ship_works"][0, 0] > 0.0
    assert spent[0] > 0.0


def test_a_ship_that_turns_over_with_her_water():
    """Top-heavy she goes round to 180 degrees; the water lies on the roof then, and none has left."""
    vessel = barge(Body(1.5 * WATER, (0.0, 0.40), 0.08 * WATER), heel=0.05, release=0.1, damped=10.0)
    rows = rows_of(half_full(vessel, alpha=0.05, sound_speed=40.0), 8.0)
    roll = np.array([row["pose"][0, 2] for row in rows])
    assert np.degrees(np.abs(roll[-20:].mean())) == pytest.approx(180.0, abs=25.0)
    assert rows[-1]["water_centre"][0, 1] > 0.6 * HIGH
    assert rows[-1]["water_escaped"][0] < 0.0  # never


def test_a_tank_that_runs_dry():
    """Heeled to 109 degrees, a tank without a roof pours its water out; let go, she rolls as the empty hull does.

    Water that has left falls and turns past her faster than half the speed of sound, which is no fault of hers.
    """
    vessel = barge(Body(1.5 * WATER, (0.0, 0.05), 0.05 * WATER), heel=1.9, release=3.0)
    scene = half_full(vessel, open_edges=(2,), sound_speed=20.0)
    rows = rows_of(scene, 8.0, 0.05)
    time = np.array([row["time"] for row in rows])
    load = np.array([np.abs(row["wall_force"][0, :2]).max() for row in rows])
    roll = np.array([row["pose"][0, 2] for row in rows])
    assert load[0] > 0.9 * WATER * GRAVITY
    free = time > 3.05
    assert load[free].max() < 1e-3 * WATER * GRAVITY
    first = rows[int(np.argmax(free))]
    pose, rate = first["pose"][0].copy(), first["pose_rate"][0].copy()  # of the tank's origin; hers are of the axis
    arm = turned(np.subtract(AXIS, HOLD), pose[2])
    pose[:2] += arm
    rate[:2] += rate[2] * np.array([-arm[1], arm[0]])
    state = np.concatenate([pose, rate])
    empty = sail(vessel.ship, state, 1e-3, time[-1] - time[free][0], begin=time[free][0])
    assert np.ptp(roll[free]) > 1.0
    assert roll[free] == pytest.approx(np.interp(time[free], empty.time, empty.roll), abs=1e-3 * np.ptp(roll[free]))
