"""Loads of water in tanks against closed forms, and where the energy of a sea goes that meets a ship with water."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.motion import Roll, Sway
from solvers.scene import Scene
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Ship
from solvers.ship.potential.sloshing import SloshingLiquid
from solvers.ship.section import box as hull
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water as Sea
from solvers.ship.waves import regular
from solvers.simulation import Simulation
from solvers.time.schedules import moved, work
from tests.oracles.voyages import hull_energy
from tests.oracles.water import GRAVITY, still
from tests.solvers.motion.test_water_aboard import ADDED, AXIS, BARE, DAMPED, DEEP, HIGH, HOLD, LENGTH, ROWS, WIDE

WIDTH, DEPTH = 0.4, 0.1
LIQUID = SloshingLiquid(WIDTH, DEPTH, (0.0, DEPTH), 1000.0, GRAVITY)
SHARES = np.array([0.4, 0.55, 0.7, 0.85, 1.15, 1.25, 1.35, 1.5])  # of the first natural frequency
SIZE, RAMP = 1e-3, 6.0  # m, s
ACCOUNT = {"water_total": 1.0, "water_viscous": 1.0, "water_diffusive": 1.0, "water_wall_energy": 1.0}


def swayed(model: str, rows: int) -> Scene:
    """A tank in each world, swayed at one of the frequencies."""
    scene, worlds = still(WIDTH, 0.2, DEPTH, rows, model=model, smoothing=3.0), len(SHARES)
    moved = [(Sway(SIZE, share * LIQUID.rates[0] / (2.0 * np.pi)),) for share in SHARES]
    scene = scene.holding(
        replace(scene.fluid, particles=np.tile(scene.fluid.particles, (worlds, 1))),
        motions=moved,
        soft_start=RAMP,
    )
    return replace(scene, step=scene.time_step() if model == "sph" else 1e-3)


def answers(scene: Scene, lasts: float) -> np.ndarray:
    """The load over the way, complex, over that of linear theory (Graham & Rodriguez 1952), at each frequency.

    What swings on at the natural frequencies, for want of damping, is fitted and taken off.
    """
    run = Simulation(scene, threads=1, arch="cpu")
    every = max(1, round(0.01 / run.dt))
    step, rows = every * run.dt, []
    while run.time < lasts:
        run.advance(every)
        row = run.observe()
        rows.append((run.time, row["wall_force"][:, 0], row["pose"][:, 0]))
    run.close()
    time = np.array([row[0] for row in rows])
    force, way = (np.array([row[k] for row in rows])[time > RAMP] for k in (1, 2))
    time, found = time[time > RAMP], []
    for k, omega in enumerate(SHARES * LIQUID.rates[0]):
        own = _amplitudes(time - 0.5 * step, force[:, k], [omega, *LIQUID.rates[:2]])  # a load is a mean over `step`
        linear = omega**2 * float(LIQUID.added_mass(np.array([omega]))[0, 0, 0])
        found.append(own / _amplitudes(time, way[:, k], [omega]) / linear)
    return np.array(found)


def _amplitudes(time: np.ndarray, signal: np.ndarray, rates: list[float]) -> complex:
    """Complex amplitude of a signal at the first of some rates (rad/s), with the others and a constant beside it."""
    columns = [wave(rate * time) for rate in rates for wave in (np.cos, np.sin)]
    fit = np.linalg.lstsq(np.stack([*columns, np.ones(len(time))], axis=1), signal, rcond=None)[0]
    return fit[0] - 1j * fit[1]


def test_masses_on_springs_load_a_swayed_tank_as_graham_and_rodriguez_say():
    """Amplitude to 3 % and phase to 3 degrees at eight frequencies, 15 % and more off the natural ones; far better."""
    found = answers(swayed("linear", 4), 18.0)
    assert np.abs(found) == pytest.approx(1.0, abs=0.005)
    assert np.degrees(np.angle(found)) == pytest.approx(0.0, abs=0.5)


@pytest.mark.slow
def test_particles_load_a_swayed_tank_as_graham_and_rodriguez_say():
    """Waves of a millimetre leave particles in their places, where h = 2 Δx makes them stiff; h = 3 Δx hardly does.

    With 16 layers amplitude is within 3 % and phase within 3 degrees up to 1.35 of the first natural frequency; at 1.5
    a fifth of the water's inertia is left, beside which 4.9 % and 5.3 degrees are as small. They fall with the spacing:
    24 layers have 1.8 % and 3.2 degrees there, 0.6 % and 1.9 degrees elsewhere, 28 layers 0.7 % and 2.7 degrees.
    """
    found = answers(swayed("sph", 16), 14.0)
    print(np.abs(found) - 1.0, np.degrees(np.angle(found)))
    whole = SHARES < 1.4
    assert np.abs(found[whole]) == pytest.approx(1.0, abs=0.03)
    assert np.degrees(np.angle(found[whole])) == pytest.approx(0.0, abs=3.5)
    assert np.abs(found[~whole]) == pytest.approx(1.0, abs=0.08)
    assert np.degrees(np.angle(found[~whole])) == pytest.approx(0.0, abs=7.0)


def test_frozen_water_loads_a_tank_as_a_rigid_body():
    """Sway and roll: force and moment are those of mass, centre and moment of inertia, at every moment."""
    scene = still(WIDTH, 0.2, DEPTH, 4, model="frozen", step=1e-3)
    scene = replace(scene, motions=[(Roll(0.2, 0.7, centre=(0.1, 0.3)), Sway(0.05, 1.3))])
    run = Simulation(scene, threads=1, arch="cpu")
    mass, high, told = 1000.0 * WIDTH * DEPTH, 0.5 * DEPTH, []
    for _ in range(200):
        before = run.observe()
        run.advance(1)
        told.append((run.observe()["wall_force"][0], before["pose"][0], before["pose_rate"][0]))
    run.close()
    rate = np.array([row[2] for row in told])
    gain = (rate[2:] - rate[:-2]) / (2.0 * run.dt)
    pose, load = np.array([row[1] for row in told])[1:-1], np.array([row[0] for row in told])[1:-1]
    c, s, up, square = np.cos(pose[:, 2]), np.sin(pose[:, 2]), gain[:, 2], rate[1:-1, 2] ** 2
    across = c * gain[:, 0] + s * (gain[:, 1] + GRAVITY) - up * high
    along = -s * gain[:, 0] + c * (gain[:, 1] + GRAVITY) - square * high
    turning = mass * (WIDTH**2 + DEPTH**2) / 12.0
    exact = np.stack([-mass * across, -mass * along, mass * high * across - turning * up], axis=1)
    assert np.ptp(load[:, 2]) > 1.0
    assert load == pytest.approx(exact, abs=2e-4 * np.abs(exact).max())


@pytest.mark.slow  # in a whole world the liquid is in `test_water_aboard.py`; that it is not cut is below
@pytest.mark.parametrize("model", ["frozen", "linear", "level"])
def test_liquid_in_a_ship_whose_world_is_cut_into_bands(model):
    """Bands are of the grains beside it: it answers as in a whole world. On two cores such a ship once ended a run."""
    poses = []
    for schedule, units in (("per-world", 1), ("per-band", 3)):
        scene = at_sea(model)
        scene.schedule = schedule
        run = Simulation(scene, threads=1, arch="cpu", units=units)
        run.advance(700)
        poses.append(run.observe()["pose"][0])
        run.close()
    assert np.abs(poses[0]).max() > 1e-3
    assert poses[1] == pytest.approx(poses[0], abs=1e-12)


def test_liquid_without_particles_is_not_cut():
    scene = at_sea("linear")
    assert scene.particles > 0 and moved(scene) == 0 and work(scene) == 1


def at_sea(model: str, **changes) -> Scene:
    """The barge in regular waves, with a tank of water half as long as she is."""
    sea = Sea()
    waves = regular(0.008, 5.0, sea, 2.0)
    push = np.array([[2200.0, 4000.0j, 60.0]]) * 0.5
    load = Floating(hull(0.5, 0.30), sea, AXIS, waves, push)
    vessel = Vessel(Ship(BARE, load, Radiation(ADDED, DAMPED), AXIS), HOLD, LENGTH)
    scene = still(WIDE, HIGH, DEEP, ROWS, vessels=[vessel], length=0.5 * LENGTH, model=model, **changes)
    return scene if model == "sph" else replace(scene, step=1e-3)


@pytest.mark.slow  # ten periods; what water and ship give each other is in `test_water_aboard.py`
def test_what_the_waves_give_is_in_ship_and_water_or_lost():
    """Over ten periods the budget of sea, ship and particles closes to 1 % of the waves' work."""
    scene = at_sea("sph", alpha=0.05)
    scene = replace(scene, step=scene.time_step())
    run, period = Simulation(scene, threads=1, arch="cpu"), 2.0 * np.pi / 5.0
    rows = []
    for time in (2.0, 2.0 + 10.0 * period):
        run.advance(round((time - run.time) / run.dt))
        rows.append(run.observe())
    run.close()
    first, last = rows
    waves, radiation, viscosity, _ = (last["ship_works"] - first["ship_works"])[0]
    tank = np.array([[*row["pose"][0], *row["pose_rate"][0], 0.0, 0.0, 0.0] for row in rows])
    gained = float(np.diff(hull_energy(scene.vessels[0].ship, HOLD, tank))[0])
    of_water = 0.5 * sum(sign * (last[name] - first[name])[0] for name, sign in ACCOUNT.items())
    assert waves > 1.0
    assert abs(of_water) > 0.03 * waves
    assert waves - radiation - viscosity == pytest.approx(gained + of_water, abs=0.01 * waves)
