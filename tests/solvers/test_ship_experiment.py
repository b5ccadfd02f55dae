"""A section free in sway, heave and roll in regular beam waves against its measured amplitudes.

Measured: Sundsdal, Greco, Hanssen and Lugni (NTNU, 2025), data released under CC0: the fundamental of a steady window.
"""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hulls import rounded

from solvers.ship.body import Body
from solvers.ship.hydrostatics import balanced_heave, metacentric_height
from solvers.ship.linear import inertia_for_roll, oscillations, response
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Rig, RollDamping, Ship, start
from solvers.ship.radiation import hydrodynamics
from solvers.ship.water import Water

LENGTH = 0.586  # m, of the model: what is given of it is per metre here
WATER = Water(depth=1.0)
SECTION = rounded(0.40, 0.256, 0.051)
BODY = Body(46.8 / LENGTH, (0.0, 0.106), 46.8 / LENGTH * (0.36 * 0.40) ** 2)
ROLL_PERIOD = 1.26  # s
RIG = Rig(np.array([0.303, 0.0, 0.0]) / LENGTH, np.array([8.7, 8.7, 0.0]) / LENGTH, np.array([59.4, 0.0, 0.0]) / LENGTH)
FREQUENCY = np.array([4.143, 5.194, 5.425, 7.004])
# Sway and heave over the wave's amplitude, roll over its slope's
MEASURED = np.array(
    [[0.931, 1.210, 2.356], [0.344, 1.623, 5.933], [0.308, 1.572, 3.269], [0.397, 0.307, 0.331]],
)


@pytest.fixture(scope="module")
def model():
    """Model, heave, table at the waves' frequencies; its inertia from the measured period of roll."""
    heave = balanced_heave(SECTION, BODY.loading, WATER, 0.0)
    grid = np.sort(np.append(FREQUENCY, 2.0 * pi / ROLL_PERIOD))
    table = hydrodynamics(SECTION, WATER, heave, grid, about=BODY.centre, count=60)
    still = Radiation(table.infinite_added_mass, np.zeros((3, 3)))
    ship = Ship(BODY, Floating(SECTION, WATER, BODY.centre), still, BODY.centre, rig=RIG)
    body = inertia_for_roll(ship, SECTION, WATER, heave, table.at([2.0 * pi / ROLL_PERIOD]))
    return replace(ship, body=body), heave, table.at(FREQUENCY)


def test_what_is_given_of_the_model_agrees(model):
    """GM of 62.9 mm; the measured roll period asks for the gyradius of 0.36 breadths that was weighed."""
    ship, heave, _ = model
    assert heave == pytest.approx(-0.20, abs=0.004)
    assert metacentric_height(SECTION, BODY.loading, WATER) == pytest.approx(0.0629, abs=0.001)
    assert np.sqrt(ship.body.inertia / ship.body.mass) == pytest.approx(0.36 * 0.40, rel=0.01)
    assert len(oscillations(ship, start(ship, heave))) > 0


def test_response_is_near_the_measured_one(model):
    """Sway off its dip to 10 %, roll to 17 %; heave at its resonance too large for want of viscous damping."""
    ship, heave, table = model
    found = np.abs(response(ship, SECTION, WATER, heave, table))
    found[:, 2] /= WATER.wave_number(FREQUENCY)
    ratio = found / MEASURED
    assert ratio[[0, 3], 0] == pytest.approx(np.ones(2), abs=0.1)
    assert ratio[[0, 3], 1] == pytest.approx(np.ones(2), abs=0.06)
    assert np.all(ratio[[1, 2], 1] > 1.1) and np.all(ratio[[1, 2], 1] < 1.25)
    assert ratio[:, 2] == pytest.approx(np.ones(4), abs=0.17)
    more = np.abs(response(replace(ship, damping=RollDamping(0.6)), SECTION, WATER, heave, table))
    assert more[1, 2] < 0.9 * np.abs(response(ship, SECTION, WATER, heave, table))[1, 2]
