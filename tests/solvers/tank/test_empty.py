"""Tanks that hold no matter: an empty hold afloat, an empty tank that is swayed and tilted."""

from math import cos, exp, pi, sqrt

import numpy as np
import pytest

from solvers.motion.harmonic import Roll, Sway
from solvers.scene import Scene
from solvers.ship.body import NOTHING, Body
from solvers.ship.hydrostatics import metacentric_height
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, RollDamping, Ship, sail, start
from solvers.ship.section import box
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import regular
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.hulls import tapered
from tests.oracles.scenes import box as tank

WATER, BARGE, AXIS, HOLD = Water(), box(0.34, 0.30), (0.0, 0.11), (0.0, 0.02)
BODY = Body(37.0, (0.004, 0.09), 0.6)
STILL = Radiation(np.zeros((3, 3)), np.zeros((3, 3)))
DAMPED = Radiation(np.diag([40.0, 52.0, 0.2]), np.diag([20.0, 100.0, 0.05]))


def empty(worlds: int = 1, **scene) -> Scene:
    return scene_of(np.zeros((worlds, 0)), tank(0.3, 0.25), **scene)


def launched(scene: Scene, schedule: str = "per-world") -> Simulation:
    scene.schedule = schedule
    return Simulation(scene, threads=1, arch="cpu")


def in_waves(hull=BARGE) -> Vessel:
    load = Floating(hull, WATER, AXIS, regular(0.02, 4.4, WATER, soft_start=1.0), np.array([[-30.0j, -400.0, 2.0j]]))
    return Vessel(Ship(BODY, load, DAMPED, AXIS, RollDamping(0.2, 0.3)), HOLD, laden=True)


@pytest.mark.slow
@pytest.mark.parametrize(
    "hull",
    [pytest.param(BARGE, id="section", marks=pytest.mark.slow), pytest.param(tapered(0.25, 0.30, 9), id="stations")],
)
def test_an_empty_hold_moves_as_the_rigid_body_in_waves(hull):
    """Sway, heave and roll of the method of Runge and Kutta alone, to rounding."""
    vessel = in_waves(hull)
    run = launched(empty(vessels=[vessel]))
    interval = int(run.carrier.every[0]) * run.dt
    alone = sail(vessel.ship, start(vessel.ship, vessel.heave(NOTHING, 0.0)), interval, 4.0)
    assert np.ptp(alone.roll) > 0.1
    for look in np.linspace(0, len(alone.time) - 1, 7).astype(int)[1:]:
        run.advance(look * int(run.carrier.every[0]) - run.steps)
        row = run.observe()
        assert run.carrier.pose.to_numpy()[0, :3] == pytest.approx(alone.state[look, :3], abs=1e-10)
        assert not row["wall_force"].any() and row["ship_works"][0, 3] == 0.0
    run.close()


def test_an_empty_ship_rolls_freely_as_a_damped_pendulum():
    """About a fixed axis by a small angle: φ = e^(−δt) (cos ωt + δ/ω sin ωt) φ0, ω² + δ² = m g GM/I."""
    heel, release, damping = 1e-3, 0.5, 0.4
    body = Body(37.0, (0.0, 0.09), 0.6)
    ship = Ship(body, Floating(BARGE, WATER, AXIS), STILL, AXIS, RollDamping(damping), free=(False, False, True))
    run = launched(empty(vessels=[Vessel(ship, HOLD, heel=heel, release=release)]))
    inertia = ship.inertia(0.0)[2, 2]
    fade = damping / (2.0 * inertia)
    swing = sqrt(body.mass * 9.81 * metacentric_height(BARGE, body.loading, WATER) / inertia - fade**2)
    for turns in (0.5, 1.0, 2.5):
        run.advance(round((release + turns * pi / swing) / run.dt) - run.steps)
        t = run.time - release
        wanted = heel * exp(-fade * t) * (cos(swing * t) + fade / swing * np.sin(swing * t))
        assert run.carrier.pose.to_numpy()[0, 2] == pytest.approx(wanted, abs=1e-4 * heel)
    run.close()


def test_a_ship_alone_sets_the_step():
    """Shorter for a ship that rolls faster; never more than half the interval between the water's forces."""
    slow = empty(vessels=[in_waves()])
    assert slow.time_step() <= 0.5 * in_waves().interval
    tiny = Ship(Body(0.01, (0.0, 0.001), 1e-9), Floating(box(0.01, 0.01), WATER, (0.0, 0.0)), STILL, (0.0, 0.0))
    fast = empty(vessels=[Vessel(tiny, (0.0, 0.0))])
    assert fast.time_step() < 0.9 * slow.time_step()
    assert "period" in fast.step_limits()[0].reason
    both = empty(2, vessels=[in_waves(), Vessel(tiny, (0.0, 0.0))])
    assert both.time_step() == fast.time_step()


@pytest.mark.parametrize("schedule", ["per-world", "per-band", "per-grain"])
def test_an_empty_tank_that_is_moved(schedule):
    """It follows its motions exactly, with any step, and nothing loads it."""
    sway, roll = Sway(0.01, 1.5), Roll(0.2, 0.7)
    run = launched(empty(2, motions=[(roll, sway)] * 2, step=0.01), schedule)
    assert run.settle(1e-6, 1.0)
    for steps in (1, 13, 40):
        run.advance(steps)
        row = run.observe()
        wanted = [0.01 * np.sin(2 * pi * 1.5 * run.time), 0.0, 0.2 * np.sin(2 * pi * 0.7 * run.time)]
        assert row["pose"] == pytest.approx(np.array([wanted] * 2), abs=1e-12)
        assert not row["wall_force"].any() and not run.loads().any()
    assert run.snapshot() == {} and run.cargo() == [NOTHING] * 2
    run.close()


def test_nothing_sets_the_step_of_an_empty_tank_on_land():
    with pytest.raises(ValueError, match="give one"):
        empty().time_step()


def test_an_empty_ship_goes_on_with_the_same_bits():
    run = launched(empty(vessels=[in_waves()]))
    run.advance(501)
    run.observe()
    kept = run.state()
    assert set(kept) == set(run.axes())
    run.advance(700)
    pose = run.observe()["pose"]
    run.close()
    other = launched(empty(vessels=[in_waves()]))
    other.restore(kept)
    other.advance(700)
    assert other.observe()["pose"].tobytes() == pose.tobytes()
    other.close()
