"""Friction of walls before and behind the plane: against its closed form, and where momentum and energy go."""

from collections.abc import Iterator

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.preset.find import load
from solvers.fluid.given import particles
from solvers.fluid.terms.end_walls import RATES, SHARES, EndWallFriction
from solvers.motion.harmonic import Roll, Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.water import again, still

NU, GAP = 1e-3, 0.05  # m²/s, m
RATE = 12.0 * NU / GAP**2  # 4.8 1/s
NARROW = {"viscosity": "laminar", "kinematic": NU, "slip": False, "gap": GAP}


SLOWEST = np.pi**2 * NU / GAP**2


def drop(velocity, spacing=0.01, **how):
    """A square of water all alike, so that nothing but walls before and behind acts on it; and its first places."""
    side = (np.arange(20) + 0.5) * spacing
    grid = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    drops = particles(1, len(grid))
    drops["position"][0], drops["volume"] = grid, spacing**2
    drops["velocity"][0, :, 0], drops["velocity"][0, :, 1] = velocity
    return still(2.0, 2.0, 0.2, 20, drops=drops, walls=False, gravity=0.0, sound_speed=10.0, **(NARROW | how)), grid


def exact(omega: np.ndarray, nu: float = NU) -> np.ndarray:
    """u of the mean over the walls' velocity, tanh z/z with z = (b/2) √(iω/ν), of a liquid that only they move."""
    z = 0.5 * GAP * np.sqrt(1j * omega / nu)
    return np.tanh(z) / z


def test_eight_modes_have_the_drag_of_stokes_flow():
    """From slow flow, 12 ν/b² and a fifth of the inertia, to boundary layers, √(iων) 2/b."""
    shares, rates = np.array(SHARES), SLOWEST * np.array(RATES)
    assert shares.sum() == pytest.approx(1.0) and (shares / rates).sum() == pytest.approx(1.0 / RATE)
    for bound, reach in ((2e-4, 1.0), (5e-3, 100.0), (0.055, 1e5)):
        omega = NU / GAP**2 * np.geomspace(1e-2, reach, 40)
        drag = 1.0 / np.sum(shares / (1j * omega[:, None] + rates), axis=1) - 1j * omega
        np.testing.assert_array_less(np.abs(drag / (1j * omega / (1.0 - exact(omega)) - 1j * omega) - 1.0), bound)
    slow = 1e-3 * NU / GAP**2
    drag = 1.0 / np.sum(shares / (1j * slow + rates)) - 1j * slow
    assert drag.real == pytest.approx(RATE, rel=1e-6) and drag.imag == pytest.approx(0.2 * slow, rel=1e-4)


SPEED, FREQUENCY = 0.1, 2.0  # m/s, Hz
OMEGA = 2.0 * np.pi * FREQUENCY


def taken_along(thin: float, precision: str) -> Scene:
    """A drop in a tank that sways, of so much of the viscosity."""
    sway = Sway(SPEED / OMEGA, FREQUENCY)
    return drop((0.0, 0.0), motions=[(sway,)], soft_start=0.2, kinematic=thin * NU, precision=precision)[0]


@pytest.fixture(scope="module", params=["f64", pytest.param("f32", marks=pytest.mark.slow)])
def swayed(request) -> Iterator[Simulation]:
    run = Simulation(taken_along(1.0, request.param), threads=1, arch="cpu")
    yield run
    run.close()


@pytest.mark.slow
@pytest.mark.parametrize("thin", [1.0, 0.01])
def test_a_tank_that_sways_takes_a_free_drop_along(swayed, thin):
    """By tanh z/z, at b²ω/ν = 31 and 3100, where the drag is three times and a third of 12 ν u/b² and late."""
    run = again(swayed, taken_along(thin, swayed.scene.precision))
    times, found = [], []
    while run.time < 2.0:
        run.advance(5)
        found.append(run.snapshot()["water_velocity"][0, :, 0].mean())
        times.append(run.time)
    late = np.array(times) > 1.0
    phases = OMEGA * np.array(times)[late]
    fit = np.linalg.lstsq(np.column_stack([np.cos(phases), np.sin(phases), 0 * phases + 1]), np.array(found)[late])[0]
    wanted = SPEED * exact(OMEGA, thin * NU)
    np.testing.assert_allclose(fit[0] - 1j * fit[1] + SPEED, wanted, atol=0.04 * abs(wanted))  # seen from the tank


@pytest.mark.slow
def test_a_free_drop_is_stopped_as_flow_between_walls_is():
    """All of it alike, so that nothing else acts; the walls have its momentum, and viscosity its energy."""
    velocity = np.array([0.6, -0.2])
    scene, grid = drop(velocity)
    assert EndWallFriction.rate(scene.fluid.water) == pytest.approx(RATE)
    odd = np.arange(1, 400, 2)[:, None]
    share, rate = 8.0 / (np.pi * odd) ** 2, odd**2 * SLOWEST
    run = Simulation(scene, threads=1, arch="cpu")
    before = run.observe()
    for part in range(3):
        run.advance(150)
        after = run.observe()
        wanted = np.sum(share * np.exp(-rate * run.time), axis=0) * velocity
        gone = np.sum(share / rate * (1.0 - np.exp(-rate * run.time)), axis=0) * velocity
        place, speed = (run.snapshot()[f"water_{name}"][0] for name in ("place", "velocity"))
        np.testing.assert_allclose(speed, np.broadcast_to(wanted, speed.shape), atol=5e-3 * 0.6)
        np.testing.assert_allclose(place - grid, np.broadcast_to(gone, place.shape), atol=2e-3)
        lost = after["water_viscous"] - before["water_viscous"]
        np.testing.assert_allclose(lost, before["water_kinetic"] - after["water_kinetic"], rtol=0.01)
        taken = before["water_momentum"] - after["water_momentum"]
        push = after["wall_force"][:, :2] * 150 * run.dt
        if part:  # at first the drag is without bound, and its first step half a kick
            np.testing.assert_allclose(push, taken[:, :2], rtol=0.01)
        before = after
    run.close()


@pytest.mark.slow
def test_a_rolling_tank_works_on_water_that_its_walls_hold_back():
    """Energy changes by the work of the walls, friction of those before and behind included."""
    scene = still(0.6, 0.6, 0.2, 8, motions=[(Roll(0.2, 0.8, centre=(0.1, 0.2)),)], soft_start=0.1, **NARROW)
    run = Simulation(scene, threads=1, arch="cpu")
    start = run.observe()
    run.advance(600)
    end = run.observe()
    viscous = (end["water_viscous"] - start["water_viscous"])[0]
    taken = sum((end[name] - start[name])[0] for name in ("water_viscous", "water_diffusive", "water_wall_energy"))
    work = (end["water_work"] - start["water_work"])[0]
    assert viscous > 0.1 * abs(work)  # else nothing was tried
    gain = (end["water_total"] - start["water_total"])[0]
    assert gain + taken == pytest.approx(work, abs=2e-3 * abs(work))
    run.close()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"water.viscosity": "artificial", "water.kinematic_viscosity": False}, "water.kinematic_viscosity: missing"),
        ({"tank.thickness": False}, "tank.thickness: missing"),
        ({"air.density": "1.2 kg/m^3"}, "water.between_walls: is for water alone"),
    ],
)
def test_walls_that_cannot_be_are_told(changes, words):
    with pytest.raises(LabError, match=words):
        load("sloshing/roll-damper-glycerine", changes)


def test_walls_are_a_tanks_length_apart_where_it_has_one():
    water = load("sloshing/roll-damper-glycerine", {"axle.length": "0.5 m"}).resolved.liquid
    assert water.gap == 0.5
    assert load("sloshing/roll-damper-glycerine").resolved.liquid.gap == 0.062


@pytest.mark.parametrize(
    ("preset", "changes", "words"),
    [
        ("ship/ballast-and-grain", {}, "water.between_walls: is for one tank"),
        ("ship/anti-roll-tank", {"water.model": "frozen"}, 'water.between_walls: water.model = "frozen" has no walls'),
    ],
)
def test_walls_beside_tanks_of_ships_that_cannot_be_are_told(preset, changes, words):
    narrow = {"water.between_walls": True, "water.kinematic_viscosity": "1e-6 m^2/s", "tank.thickness": "0.3 m"}
    with pytest.raises(LabError, match=words):
        load(preset, narrow | changes)
