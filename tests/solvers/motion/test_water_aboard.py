"""Water in the tanks of a ship: as particles, by linear potential theory, and frozen."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from solvers.fluid.start.packing import area_of
from solvers.machine.errors import Unavailable
from solvers.motion.staggered_error import growth, lagrange
from solvers.ship.body import Body, bolted
from solvers.ship.hydrostatics import turned
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Ship, sail, start
from solvers.ship.potential.sloshing import SloshingLiquid
from solvers.ship.potential.springs import BoxLiquid
from solvers.ship.section import box as hull
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water as Sea
from solvers.ship.waves import regular
from solvers.simulation import Simulation
from solvers.tank.outline import moments
from solvers.tank.tank import Tank
from tests.oracles.water import GRAVITY, box, lattice, still

AXIS, HOLD, LENGTH = (0.0, 0.11), (0.0, 0.02), 2.0  # m
BARE = Body(37.0, (0.004, 0.09), 0.9)
WIDE, DEEP, ROWS, HIGH = 0.4, 0.05, 8, 0.2
ACCOUNT = (
    ("water_total", 1.0),
    ("water_viscous", 1.0),
    ("water_diffusive", 1.0),
    ("water_wall_energy", 1.0),
    ("water_work", -1.0),
)
ADDED, DAMPED = np.diag([40.0, 52.0, 0.2]), np.diag([20.0, 100.0, 0.1])


def ship(**changes) -> Vessel:
    """A barge in calm water, without memory, let go with a heel."""
    sea = Sea()
    load = Floating(hull(0.5, 0.30), sea, AXIS, regular(0.0, 4.4, sea), np.zeros((1, 3)))
    given = {"heel": 0.02, "release": 0.3} | changes
    return Vessel(Ship(BARE, load, Radiation(ADDED, DAMPED), AXIS), HOLD, LENGTH, **given)


def aboard(vessel: Vessel, model: str = "sph", **changes):
    """A tank with water in her, half as long as she is."""
    scene = still(WIDE, HIGH, DEEP, ROWS, vessels=[vessel], length=0.5 * LENGTH, model=model, **changes)
    return replace(scene, step=changes.get("step", scene.time_step()))


def poses(scene, lasts: float) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) s of a run and poses (n, 3) of her tank's origin: y and z in m, roll in rad."""
    run = Simulation(scene, threads=1, arch="cpu")
    steps = round(0.02 / run.dt)
    found = [(run.time, run.observe()["pose"][0])]
    while run.time < lasts:
        run.advance(steps)
        found.append((run.time, run.observe()["pose"][0]))
    run.close()
    time, pose = zip(*found, strict=True)
    return np.array(time), np.array(pose)


def roll(scene, lasts: float) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and rolls (rad) of a run."""
    time, pose = poses(scene, lasts)
    return time, pose[:, 2]


@pytest.mark.slow
def test_frozen_water_is_a_rigid_weight():
    """She sways, heaves and rolls as with a body of the water's mass, centre and moment of inertia bolted to her."""
    scene = aboard(ship(), "frozen", step=1e-3)  # she is let go at a whole number of steps
    time, found = poses(scene, 3.0)
    mass = 1000.0 * 0.5 * WIDE * DEEP
    water = Body(mass, (HOLD[0], HOLD[1] + 0.5 * DEEP), mass * (WIDE**2 + DEEP**2) / 12.0)
    whole = replace(ship().ship, body=bolted(BARE, water))
    vessel = replace(ship(), ship=whole)
    begin = start(whole, vessel.heave(Body(0.0, (0.0, 0.0), 0.0), 0.02), 0.02)
    voyage = sail(whole, begin, 0.005, 2.8, begin=0.3)
    origin = voyage.state[:, :3].copy()
    origin[:, :2] += np.array([turned(np.subtract(HOLD, AXIS), one) for one in voyage.roll])
    free = time > 0.3
    for motion, least, allowed in ((0, 2e-4, 1e-6), (1, 2e-5, 1e-6), (2, 0.02, 6e-6)):  # m, m, rad
        seen = np.interp(time, voyage.time, origin[:, motion])
        assert np.ptp(found[free, motion]) > least
        assert found[free, motion] == pytest.approx(seen[free], abs=allowed)


def test_masses_on_springs_answer_as_the_potential_does():
    """Sway and roll of a tank at eight frequencies: the load of the masses is that of the potential flow."""
    liquid = BoxLiquid(WIDE, DEEP, 1000.0, GRAVITY)
    place = (0.0, -0.06)  # of the floor's middle from the axis
    omega = np.sqrt(GRAVITY * np.pi / WIDE * np.tanh(np.pi * DEEP / WIDE)) * np.array(
        [0.2, 0.5, 0.8, 0.9, 1.1, 1.3, 1.7, 2.1]
    )
    other = SloshingLiquid(WIDE, DEEP, (place[0], place[1] + DEEP), 1000.0, GRAVITY)
    wanted = -(omega[:, None, None] ** 2) * other.added_mass(omega) + other.stiffness()
    height = place[1] + 0.5 * DEEP
    rigid = np.diag([liquid.mass, liquid.mass, liquid.turning + liquid.mass * height**2])
    rigid[0, 2] = rigid[2, 0] = -liquid.mass * height
    found = np.array([-(w**2) * rigid for w in omega])
    found[:, 2, 2] -= liquid.mass * GRAVITY * height
    for m, high, own in zip(liquid.masses, liquid.heights, liquid.frequencies, strict=True):
        way = np.zeros((len(omega), 3))
        way[:, 0], way[:, 2] = 1.0, -(place[1] + high + GRAVITY / omega**2)
        answer = m * omega**4 / (own**2 - omega**2)
        found -= answer[:, None, None] * way[:, :, None] * way[:, None, :]
    size = np.sqrt(np.abs(wanted[:, [0, 1, 2], [0, 1, 2]]))
    assert np.abs((found - wanted) / (size[:, :, None] * size[:, None, :])).max() < 2e-3


@pytest.mark.parametrize("model", ["linear", pytest.param("sph", marks=pytest.mark.slow)])
def test_a_free_surface_takes_stability(model):
    """At a fixed heel the water's moment beyond that of a rigid weight is ρ g l³/12 tan φ: its surface is level.

    What a column gains as it gets deeper has the density at the floor: particles, which sound of speed c compresses
    there by g d/c² (1 %), take as much more.
    """
    heel = 0.03
    vessel = ship(heel=heel, release=3.0)
    fixed = replace(vessel, ship=replace(vessel.ship, free=(False, False, False)))
    changes = {"alpha": 0.1} if model == "sph" else {"swing_damping": 0.3}
    scene = aboard(fixed, model, **changes)
    run = Simulation(scene, threads=1, arch="cpu")
    run.advance(round(7.0 / run.dt))
    run.observe()
    run.advance(round(4.0 / run.dt))
    moment = run.observe()["wall_force"][0, 2]
    run.close()
    low = np.array([[-0.5 * WIDE, 0.0], [0.5 * WIDE, 0.0]])
    rise = 0.5 * WIDE * np.tan(heel)
    area, centre, _ = moments(np.array([*low, [0.5 * WIDE, DEEP - rise], [-0.5 * WIDE, DEEP + rise]]))
    weight = 1000.0 * GRAVITY * area
    exact = weight * (centre[0] * -np.cos(heel) - centre[1] * -np.sin(heel))
    rigid = weight * 0.5 * DEEP * np.sin(heel)
    assert exact - rigid == pytest.approx(1000.0 * GRAVITY * WIDE**3 / 12.0 * np.tan(heel), rel=0.01)
    denser = 1.0 + GRAVITY * DEEP / scene.fluid.water.sound_speed**2 if model == "sph" else 1.0
    assert moment - rigid == pytest.approx(denser * (exact - rigid), rel=0.008 if model == "sph" else 0.002)


def momentum(run: Simulation, angle: float) -> np.ndarray:
    """Momentum (2,) of the water over the earth, half a step before the places, kg/s."""
    p = run.water.particles
    v, w, m = (values[0] for values in p.read(*p.velocity, p.mass))
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * (m @ v) - s * (m @ w), s * (m @ v) + c * (m @ w)])


@pytest.fixture(scope="module")
def run() -> Iterator[Simulation]:
    made = Simulation(aboard(ship(heel=0.06)), threads=1, arch="cpu")
    yield made
    made.close()


@pytest.mark.slow
def test_water_and_ship_work_on_each_other(run):
    """What she gives the walls the water gets; energy of the water is accounted for."""
    run.advance(round(0.3 / run.dt) + 1)  # she is let go
    first = run.observe()
    run.advance(round(2.0 / run.dt))
    row = run.observe()
    done = 0.5 * (row["water_work"] - first["water_work"])[0]  # the tank is half as long as she is
    gained = (row["ship_works"] - first["ship_works"])[0, 3]
    assert abs(done) > 0.05
    assert gained == pytest.approx(-done, rel=0.01)
    missing = sum(sign * (row[name] - first[name])[0] for name, sign in ACCOUNT)
    assert abs(missing) < 0.01 * (np.abs(row["water_work"]) + row["water_viscous"] + row["water_kinetic"])[0]


@pytest.mark.slow
def test_what_the_water_loses_the_ship_gains(run):
    """The load on the ship at each step is the momentum that the water loses in it, its weight aside, to rounding."""
    run.advance(round(0.5 / run.dt))
    row = run.observe()
    angle, before = row["pose"][0, 2], momentum(run, row["pose"][0, 2])
    mass, worst = 1000.0 * run.scene.fluid.particles["volume"][0].sum(), 0.0
    mass = float(run.water.particles.read(run.water.particles.mass)[0][0].sum())
    for _ in range(20):
        run.advance(1)
        row = run.observe()
        c, s = np.cos(angle), np.sin(angle)
        y, z, _ = row["wall_force"][0]
        load = np.array([c * y - s * z, s * y + c * z])
        angle, now = row["pose"][0, 2], momentum(run, row["pose"][0, 2])
        weight = np.array([0.0, -mass * GRAVITY])
        worst = max(worst, np.abs(now - before - run.dt * (weight - load)).max())
        before = now
    run.close()  # those that follow find their kernels
    assert worst < 1e-12 * mass


@pytest.mark.slow
def test_tanks_one_behind_the_other():
    """Two halves of a tank in the same place of the plane act as the whole, and their waters do not meet."""
    whole = aboard(ship())
    half = Tank(whole.outline, 1.0, length=0.25 * LENGTH)
    count = whole.fluid.particles.shape[1]
    twice = np.concatenate([whole.fluid.particles] * 2, axis=1)
    fluid = replace(whole.fluid, particles=twice, in_tanks=(count, count))
    halves = whole.holding(fluid, length=0.25 * LENGTH, more_tanks=(half,))
    (_, one), (_, two) = roll(whole, 1.0), roll(halves, 1.0)
    assert np.ptp(one) > 0.02
    assert two == pytest.approx(one, abs=1e-9)


def test_grains_and_water_share_no_tank():
    """A tank with both is refused in one sentence."""
    drops = lattice(WIDE, DEEP, DEEP / ROWS, 10.0)
    assert area_of(box(WIDE, DEEP)) == pytest.approx(drops["volume"][0].sum())
    from solvers.fluid.checks import refuse_scene

    with pytest.raises(Unavailable, match="give them tanks of their own"):
        refuse_scene((10,), 0)


def test_a_load_that_is_extrapolated_drives_a_light_ship():
    """The staggered scheme of the source is stable up to 1/31 of her mass, whatever its steps."""
    assert lagrange() == pytest.approx([5.0, -10.0, 10.0, -5.0, 1.0])
    assert growth(0.99 / 31.0) < 1.0 < growth(1.01 / 31.0)
    factors = [growth(ratio) for ratio in (0.1, 0.3, 1.0, 3.0)]
    assert factors == sorted(factors)
    assert factors[0] > 1.3


@pytest.mark.slow  # grains of twice the hull's mass are in `test_afloat.py`
@pytest.mark.parametrize("ratio", [0.1, 3.0])
def test_ours_bears_any_mass_in_the_tanks(ratio):
    """Frozen water of 0.1 to 3 times the hull's mass: she rolls as the rigid body that she is with it."""
    water = 1000.0 * 0.5 * WIDE * DEEP
    hull_alone = Body(water / ratio, (0.0, 0.05), 0.02 * water / ratio)
    vessel = ship()
    vessel = replace(vessel, ship=replace(vessel.ship, body=hull_alone, radiation=Radiation(0.01 * ADDED, DAMPED)))
    time, found = roll(aboard(vessel, "frozen", step=1e-3), 1.5)
    frozen = Body(water, (HOLD[0], HOLD[1] + 0.5 * DEEP), water * (WIDE**2 + DEEP**2) / 12.0)
    whole = replace(vessel.ship, body=bolted(hull_alone, frozen))
    begin = start(whole, replace(vessel, ship=whole).heave(Body(0.0, (0.0, 0.0), 0.0), 0.02), 0.02)
    voyage = sail(whole, begin, 0.001, 1.3, begin=0.3)
    free = time > 0.3
    assert found[free] == pytest.approx(np.interp(time, voyage.time, voyage.roll)[free], abs=1e-3 * 0.02)
