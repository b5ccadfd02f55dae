"""A whole hull by its stations: closed forms at any heel, the one section all along, and her energy as she rolls."""

from math import pi

import numpy as np
import pytest

from solvers.ship.body import Body
from solvers.ship.hydrostatics import (
    Loading,
    buoyancy,
    equilibrium,
    metacentric_height,
    potential_energy,
    restoring,
    righting_levers,
    stiffness,
)
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Ship, sail, start
from solvers.ship.section import Section, Stations, box
from solvers.ship.water import Water
from tests.oracles.energy import mechanical_energy
from tests.oracles.hulls import circle, lopsided, tapered

WATER = Water()
HALF, HEIGHT, DRAUGHT, COUNT = 0.17, 0.30, 0.11, 81  # m
HULL = tapered(HALF, HEIGHT, COUNT)
LADEN = Loading(WATER.density * 2.0 * HALF * DRAUGHT * 2.0 / 3.0, (0.0, 0.10))


def test_wall_sided_stations_have_scribantis_levers():
    """GZ = sin φ (GM + ½ BM tan² φ), BM = I/∇ of the parabolic waterline, until the widest bilge comes out."""
    bm = (2.0 / 3.0) * HALF**3 * (16.0 / 35.0) / (2.0 * HALF * DRAUGHT * 2.0 / 3.0)
    gm = 0.5 * DRAUGHT + bm - LADEN.centre[1]
    assert metacentric_height(HULL, LADEN, WATER) == pytest.approx(gm, rel=1e-5)
    heel = np.radians([-32.0, -10.0, 5.0, 20.0, 32.0])
    wanted = np.sin(heel) * (gm + 0.5 * bm * np.tan(heel) ** 2)
    assert righting_levers(HULL, LADEN, WATER, heel) == pytest.approx(wanted, abs=1e-5 * HALF)
    amidships = righting_levers(box(2.0 * HALF, HEIGHT), Loading(1.5 * LADEN.mass, LADEN.centre), WATER, heel)
    assert (np.abs(amidships - wanted) > 0.01 * HALF * np.abs(np.sin(heel))).all()  # she is not her section


def test_round_stations_right_about_their_axis():
    """A body of revolution: GZ = (z of its axis − KG) sin φ, at any heel, whatever it displaces."""
    height, gravity = 0.4, 0.33  # m, of axis and centre of gravity
    radii = np.linspace(0.05, 0.3, 7)
    rings = tuple(Section(circle(r, 720).outline + np.array([0.0, height])) for r in radii)
    body = Stations(rings, np.full(7, 1.0 / 7.0))
    heel = np.radians([15.0, 90.0, 150.0, -60.0])
    for share in (0.2, 0.7):
        found = righting_levers(body, Loading(share * body.area * WATER.density, (0.0, gravity)), WATER, heel)
        assert found == pytest.approx((height - gravity) * np.sin(heel), abs=2e-5)


def test_equal_stations_are_their_section():
    one, loading = lopsided(), Loading(20.0, (0.01, 0.1))
    many = Stations((one, one, one), np.array([0.25, 0.5, 0.25]))
    assert many.area == pytest.approx(one.area, rel=1e-14) and many.size == one.size
    for heave, roll in ((-0.1, 0.2), (-0.2, -1.3)):
        assert buoyancy(many, WATER, heave, roll, 0.02, 0.1) == pytest.approx(
            buoyancy(one, WATER, heave, roll, 0.02, 0.1), rel=1e-12
        )
        assert stiffness(many, loading, WATER, heave, roll) == pytest.approx(
            stiffness(one, loading, WATER, heave, roll), rel=1e-12, abs=1e-9
        )
    assert equilibrium(many, loading, WATER) == pytest.approx(equilibrium(one, loading, WATER), abs=1e-9)


def test_restoring_is_the_slope_of_the_energy():
    step = 1e-6
    for heave, roll in ((-0.1, 0.0), (-0.15, 0.8), (0.05, 2.0)):
        # By heave of the centre of gravity, and by roll about it.
        found = restoring(HULL, LADEN, WATER, heave, roll)
        along = [potential_energy(HULL, LADEN, WATER, heave + s * step, roll) for s in (-1.0, 1.0)]
        ways = np.array([-step, step])
        lift = LADEN.centre[1] * (np.cos(roll) - np.cos(roll + ways))
        turned = potential_energy(HULL, LADEN, WATER, heave + lift, roll + ways)
        slope = -(along[1] - along[0]) / (2.0 * step), -(turned[1] - turned[0]) / (2.0 * step)
        assert found[1:] == pytest.approx(slope, abs=1e-5 * LADEN.mass * WATER.gravity)


@pytest.mark.slow
def test_she_keeps_her_energy_as_she_rolls_far():
    ship = Ship(
        Body(LADEN.mass, LADEN.centre, LADEN.mass * 0.1**2),
        Floating(HULL, WATER, (0.0, DRAUGHT)),
        Radiation(np.diag([20.0, 30.0, 0.1]), np.zeros((3, 3))),
        (0.0, DRAUGHT),
    )
    begun = start(ship, -DRAUGHT, 0.3 * pi)
    voyage = sail(ship, begun, 1e-3, 3.0)
    energy = np.array([mechanical_energy(ship, state) for state in voyage.state])
    swing = mechanical_energy(ship, begun) - mechanical_energy(ship, start(ship, -DRAUGHT))
    assert np.ptp(voyage.roll) > 0.4 * pi
    assert np.abs(energy - energy[0]).max() < 2e-6 * swing
