"""Friction of walls before and behind the plane: against its closed form, and where momentum and energy go."""

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.preset.find import load
from solvers.fluid.given import VELOCITY_Y, VELOCITY_Z, VOLUME
from solvers.fluid.walls.between import Between
from solvers.motion.harmonic import Roll
from solvers.simulation import Simulation
from tests.oracles.water import still

NU, APART = 1e-3, 0.05  # m²/s, m
RATE = 12.0 * NU / APART**2  # 4.8 1/s
NARROW = {"viscosity": "laminar", "kinematic": NU, "slip": False, "apart": APART}


def test_a_free_drop_is_stopped_as_e_to_the_minus_12_nu_t_over_b_squared():
    """All of it alike, so that nothing else acts; the walls have its momentum, and viscosity its energy."""
    spacing, velocity = 0.01, np.array([0.6, -0.2])
    side = (np.arange(20) + 0.5) * spacing
    grid = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    drops = np.zeros((1, len(grid), 6))
    drops[0, :, :2], drops[..., VOLUME] = grid, spacing**2
    drops[0, :, VELOCITY_Y], drops[0, :, VELOCITY_Z] = velocity
    scene = still(2.0, 2.0, 0.2, 20, drops=drops, walls=False, gravity=0.0, sound_speed=10.0, **NARROW)
    assert Between.rate(scene.water) == pytest.approx(RATE)
    run = Simulation(scene, threads=1, arch="cpu")
    before = run.observe()
    for _ in range(3):
        run.advance(150)
        after = run.observe()
        wanted = np.exp(-RATE * run.time) * velocity
        place, speed = (run.snapshot()[f"water_{name}"][0] for name in ("place", "velocity"))
        np.testing.assert_allclose(speed, np.broadcast_to(wanted, speed.shape), atol=2e-3 * 0.6)
        np.testing.assert_allclose(place - grid, np.broadcast_to((velocity - wanted) / RATE, place.shape), atol=1e-3)
        lost = after["water_viscous"] - before["water_viscous"]
        np.testing.assert_allclose(lost, before["water_kinetic"] - after["water_kinetic"], rtol=0.01)
        taken = before["water_momentum"] - after["water_momentum"]
        push = after["wall_force"][:, :2] * 150 * run.dt
        np.testing.assert_allclose(push, taken[:, :2], rtol=0.01)
        before = after
    run.close()


def test_a_rolling_tank_works_on_water_that_its_walls_hold_back():
    """Energy changes by the work of the walls, friction of those before and behind included."""
    scene = still(0.6, 0.6, 0.2, 8, motions=[(Roll(0.2, 0.8, centre=(0.1, 0.2)),)], soft_start=0.1, **NARROW)
    run = Simulation(scene, threads=1, arch="cpu")
    start = run.observe()
    run.advance(600)
    end = run.observe()
    viscous = (end["water_viscous"] - start["water_viscous"])[0]
    taken = sum((end[name] - start[name])[0] for name in ("water_viscous", "water_diffusive", "water_held"))
    work = (end["water_work"] - start["water_work"])[0]
    assert viscous > 0.1 * abs(work)  # else nothing was tried
    gain = (end["water_total"] - start["water_total"])[0]
    assert gain + taken == pytest.approx(work, abs=2e-3 * abs(work))
    run.close()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"water.slip": True}, "water.between_walls: goes with viscosity"),
        ({"water.viscosity": "artificial", "water.kinematic_viscosity": False}, "water.between_walls: goes with"),
        ({"tank.thickness": False}, "tank.thickness: missing"),
        ({"air.density": "1.2 kg/m^3"}, "water.between_walls: is for water alone"),
    ],
)
def test_walls_that_cannot_be_are_told(changes, words):
    with pytest.raises(LabError, match=words):
        load("sloshing/roll-damper-glycerine", changes)
