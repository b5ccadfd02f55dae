"""Ships whose hold is a slice of spheres: they take the forces along y and z and the moment about x of their cargo."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from solvers.machine.quantity import PLANE, flat, in_plane
from solvers.ship.body import Body
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, RollDamping, Ship
from solvers.ship.section import box
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import regular
from solvers.simulation import Simulation
from solvers.tank.solids.solid import Prism
from tests.oracles.given import scene_of
from tests.oracles.scenes import box as tank
from tests.oracles.scenes import material

G, STEP, STEPS, EVERY = 9.81, 2.5e-5, 4000, 0.1
RADIUS, ACROSS, DEEP = 0.015, 10, 3
WIDE, HIGH = 2.0 * ACROSS * RADIUS, 0.25  # m
SHEET, SLICE = 2.0 * RADIUS, 12.0 * RADIUS  # m, thickness of the plane and of the slice
SHORT = 1.0 / 6.0  # m, a hold of the plane that weighs as much as one of a metre whose slice has one layer
WATER = Water()
AXIS, HOLD = (0.0, 0.11), (0.0, 0.02)  # m above the keel
GRAIN = material(young=5e7, friction=0.6, restitution=0.3)
ROWS = [
    (2 * k - ACROSS + 1 + row % 2, 1.1 + np.sqrt(3.0) * row) for row in range(DEEP) for k in range(ACROSS - row % 2)
]
LAYER = RADIUS * np.array(ROWS)  # in a triangular lattice, which falls by a tenth of a radius
COUNT = len(LAYER)
MASS = 4.0 / 3.0 * pi * RADIUS**3 * GRAIN.density  # kg, of a grain
CARGO = COUNT * MASS / SLICE  # kg/m
LIVELY, VACUUM, STILL = range(3)
ADDED = Radiation(np.diag([40.0, 52.0, 0.2]), np.diag([20.0, 100.0, 0.05]))
NONE = Radiation(np.zeros((3, 3)), np.zeros((3, 3)))


def floating(amplitude, water=WATER):
    waves = regular(amplitude, 5.0, water, soft_start=0.0)
    excess = np.array([[-30.0j, -400.0 + 100.0j, 2.0 + 1.0j]]) * (water.density > 0.0)
    return Floating(box(0.34, 0.30), water, AXIS, waves, excess)


def fleet():
    """A light hull in waves, one without water, and one in calm water."""
    hull = Body(0.5 * CARGO, (0.004, 0.10), 0.35)
    lively = Ship(hull, floating(0.03), ADDED, AXIS, RollDamping(0.1, 0.1))
    still = Ship(replace(hull, centre=(0.0, 0.10)), floating(0.0), ADDED, AXIS)
    return [
        Vessel(lively, HOLD),
        Vessel(Ship(hull, floating(0.0, Water(density=0.0)), NONE, AXIS), HOLD, height=0.0),
        Vessel(still, HOLD),
    ]


def aboard(vessels, place, **changes):
    """Ships with grains at a place (n, axes) each, which starts to fall as they do."""
    given = {"tangential": "mindlin", "vessels": vessels, "length": 1.0, "step": STEP} | changes
    radius = np.full((len(vessels), COUNT), RADIUS)
    scene = scene_of(radius, tank(0.9999 * WIDE, HIGH), GRAIN, GRAIN, **given)
    return Simulation(scene, np.tile(place, (len(vessels), 1, 1)), 1)


@pytest.fixture(scope="module")
def run():
    """All three in a slice with one layer of grains."""
    made = aboard(fleet(), np.column_stack([LAYER, np.zeros(COUNT)]), solid=Prism(SLICE, periodic=True))
    yield made
    made.arrays.release()


def begun(run, place, velocity=None):
    """The run with its cargo anew."""
    worlds = run.scene.worlds
    run.place(np.tile(place, (worlds, 1, 1)), None if velocity is None else np.tile(velocity, (worlds, 1, 1)))
    run.start_clock()
    return run


def test_the_freedoms_of_the_plane_are_found_in_space():
    assert in_plane(3) == (0, 1, 5)
    assert in_plane(2) == (0, 1, 2)
    np.testing.assert_array_equal(flat(np.arange(6.0)), [0.0, 1.0, 5.0])
    np.testing.assert_array_equal(flat(np.arange(3.0)), np.arange(3.0))


@pytest.mark.slow
def test_momentum_of_ship_and_spheres_without_water(run):
    """With weight alone m (v_G + g t) is constant, whatever the impacts: what a slice pushes counts by its length.

    Velocities are those of the grains' half steps carried on by half a step, as in the plane.
    """
    random = np.random.default_rng(3)
    grid = np.stack(np.meshgrid(range(5), range(3), range(2), indexing="ij"), axis=-1).reshape(-1, 3)[:COUNT]
    place = 3.5 * RADIUS * (grid - grid.mean(axis=0)) + [0.0, 0.1, 0.0] + random.uniform(-0.1, 0.1, (COUNT, 3)) * RADIUS
    velocity = random.normal(0.0, 0.7, (COUNT, 3))
    velocity[:, 0] += 0.3
    begun(run, place, velocity)
    ship, sums, rolls = run.carrier.vessels[VACUUM].ship, [], []
    for look in range(11):
        now, motion = run.snapshot(), run.carrier.tank_frame.tank.to_numpy()[VACUUM, :9]
        sums.append(_momentum(ship, motion, now["position"][VACUUM], now["velocity"][VACUUM]))
        sums[-1][1] += (ship.body.mass + CARGO) * G * look * EVERY
        rolls.append(motion[2])
        run.advance(round(EVERY / STEP))
    assert np.ptp(rolls) > 0.05
    np.testing.assert_allclose(sums, np.tile(sums[0], (11, 1)), rtol=0.0, atol=1e-4 * (ship.body.mass + CARGO))


def _momentum(ship, motion, place, velocity):
    """Of hull and grains a metre (2,), kg/s."""
    roll, rate = motion[2], motion[5]
    c, s = np.cos(roll), np.sin(roll)
    turn = np.array([[c, -s], [s, c]])
    arm = ship.lever(roll) - turn @ np.subtract(HOLD, AXIS)
    hull = ship.body.mass * (motion[3:5] + rate * np.array([-arm[1], arm[0]]))
    relative = velocity[:, :PLANE] + rate * np.column_stack([-place[:, 1], place[:, 0]])
    return hull + MASS / SLICE * (motion[3:5] + relative @ turn.T).sum(axis=0)


@pytest.mark.slow
def test_a_ship_is_in_balance_with_a_settled_bed(run):
    """The bed weighs on the floor what it weighs, and a ship that floats in equilibrium with it stays where she is.

    Its centre is at rest to 1e-7 m g d; a share of the weight of 1e-3 would let her heave by 0.02 mm.
    """
    begun(run, np.column_stack([LAYER, np.zeros(COUNT)]))
    assert run.settle(1e-7, 2.0)
    start = run.observe()["pose"][STILL]
    for _ in range(5):
        run.advance(round(0.1 / STEP))
        rows = run.observe()
        assert rows["pose"][STILL, :2] == pytest.approx(start[:2], abs=2e-5)
        np.testing.assert_array_equal(rows["pose"][STILL, 2:5], 0.0)
    force = rows["wall_force"][STILL]
    assert force[1] == pytest.approx(-COUNT * MASS * G, rel=1e-3)
    assert np.abs(force[2:5]).max() < 1e-9
    assert run.cargo()[STILL].mass == pytest.approx(CARGO, rel=1e-12)


@pytest.mark.slow
def test_a_slice_with_one_layer_moves_a_ship_as_the_discs_of_the_plane(run):
    """Of the same mass a metre: to rounding, which four thousand steps of contacts let grow to 1e-10 diameters."""
    begun(run, np.column_stack([LAYER, np.zeros(COUNT)]))
    flat_run = aboard(fleet()[:1], LAYER, thickness=SHEET, length=SHORT)
    for one in (run, flat_run):
        one.advance(STEPS)
    space, plane = ({**one.observe(), **one.snapshot()} for one in (run, flat_run))
    flat_run.arrays.release()
    assert plane["contacts"][0] > 20
    assert np.abs(plane["pose"][0]).min() > 1e-5
    np.testing.assert_allclose(flat(space["pose"][LIVELY]), plane["pose"][0], rtol=0.0, atol=1e-10 * 2.0 * RADIUS)
    np.testing.assert_allclose(flat(space["pose_rate"][LIVELY]), plane["pose_rate"][0], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(
        space["position"][LIVELY, :, :2], plane["position"][0], rtol=0.0, atol=1e-10 * 2.0 * RADIUS
    )
    np.testing.assert_array_equal(space["position"][LIVELY, :, 2], 0.0)


@pytest.mark.slow
def test_a_ship_in_space_goes_on_from_a_kept_state_bit_for_bit(run):
    begun(run, np.column_stack([LAYER, np.zeros(COUNT)]))
    run.advance(STEPS)
    kept = run.state()
    ends = []
    for _ in range(2):
        run.restore(kept)
        run.advance(STEPS)
        ends.append({**run.observe(), **run.snapshot()})
    for name, values in ends[0].items():
        np.testing.assert_array_equal(ends[1][name], values, err_msg=name)
