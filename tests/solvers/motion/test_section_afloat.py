"""A section free in sway, heave and roll in regular beam waves against its measured amplitudes.

Measured: Sundsdal, Greco, Hanssen and Lugni (NTNU, 2025), data released under CC0: the fundamental of a window, by a
camera and by accelerometers aboard. The records themselves are looked for in the folder `ship_section_beam_sea` of the
one that CARGOLAB_DATA names, or of `../shared/data` beside the checkout.
"""

import os
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

from solvers.ship.body import Body
from solvers.ship.hydrostatics import balanced_heave, metacentric_height
from solvers.ship.linear import inertia_for_roll, oscillations, response
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Rig, RollDamping, Ship, start
from solvers.ship.potential.flume import Flap, fundamental
from solvers.ship.potential.radiation import hydrodynamics
from solvers.ship.water import Water
from tests.oracles.hulls import rounded

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
ABOARD = np.array([[1.214, 2.256], [1.840, 6.234], [1.897, 3.507], [0.356, 0.379]])  # heave, roll, by accelerometers
DATA = Path(os.environ.get("CARGOLAB_DATA", Path(__file__).parents[4] / "shared" / "data")) / "ship_section_beam_sea"
# Of each record: nominal amplitude (m), and the window (s)
RECORDS = {
    "3012_1": (0.020, 37.85, 42.40),
    "3041_2": (0.012, 30.76, 38.02),
    "3061_1": (0.012, 28.82, 35.77),
    "3101_3": (0.012, 27.09, 36.96),
}
recorded = pytest.mark.skipif(not DATA.is_dir(), reason=f"the measured records are not in {DATA}; see CARGOLAB_DATA")


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


def test_the_given_data_of_the_model_agree(model):
    """GM of 62.9 mm; the measured roll period asks for the gyradius of 0.36 breadths that was weighed."""
    ship, heave, _ = model
    assert heave == pytest.approx(-0.20, abs=0.004)
    assert metacentric_height(SECTION, BODY.loading, WATER) == pytest.approx(0.0629, abs=0.001)
    assert np.sqrt(ship.body.inertia / ship.body.mass) == pytest.approx(0.36 * 0.40, rel=0.01)
    assert len(oscillations(ship, start(ship, heave))) > 0


def test_response_is_near_the_measured_one(model):
    """Sway off its dip to 10 %, heave to 6 % of one instrument or between both, roll to 17 % (it was not steady)."""
    ship, heave, table = model
    found = np.abs(response(ship, SECTION, WATER, heave, table))
    found[:, 2] /= WATER.wave_number(FREQUENCY)
    ratio = found / MEASURED
    assert ratio[[0, 3], 0] == pytest.approx(np.ones(2), abs=0.1)
    assert np.all(found[:, 1] > 0.94 * MEASURED[:, 1]) and np.all(found[:, 1] < 1.06 * ABOARD[:, 0])
    assert ratio[:, 2] == pytest.approx(np.ones(4), abs=0.17)
    more = np.abs(response(replace(ship, damping=RollDamping(0.6)), SECTION, WATER, heave, table))
    assert more[1, 2] < 0.9 * np.abs(response(ship, SECTION, WATER, heave, table))[1, 2]


def test_depth_matters_for_long_waves(model):
    """Waves of 3.6 m over 1 m: sway is 5 % more than in deep water; water of 20 m is deep to 0.1 %."""
    ship, heave, table = model
    found = []
    for water in (Water(depth=20.0), Water()):
        other = hydrodynamics(SECTION, water, heave, FREQUENCY[[0, 3]], about=BODY.centre, count=40)
        found.append(np.abs(response(ship, SECTION, water, heave, other)))
    assert found[0] == pytest.approx(found[1], rel=1e-3)
    here = np.abs(response(ship, SECTION, WATER, heave, table))[[0, 3]]
    assert here[0, 0] / found[1][0, 0] == pytest.approx(1.05, abs=0.02)
    assert here[1, 0] / found[1][1, 0] == pytest.approx(1.0, abs=0.01)


def record(name: str) -> np.ndarray:
    """Time, flap, two probes, sway, heave, roll, force, a row an instant."""
    return np.genfromtxt(DATA / f"decim50Hz_{name}.csv", delimiter=",", skip_header=1)


@recorded
def test_amplitudes_are_those_of_the_records():
    for (name, (amplitude, begin, end)), omega, told in zip(RECORDS.items(), FREQUENCY, MEASURED, strict=True):
        rows = record(name)
        rows = rows[(rows[:, 0] >= begin) & (rows[:, 0] <= end)]
        found = np.abs(fundamental(rows[:, 0], rows[:, 4:7], omega)) / amplitude
        found[2] /= WATER.wave_number(omega)
        assert found == pytest.approx(told, rel=0.1), name


@recorded
def test_roll_near_its_resonance_was_not_steady():
    """At 5.194 rad/s it grows by a fifth from the first half of the window to the second, at 7.004 it does not."""
    growth = []
    for name, omega in (("3041_2", 5.194), ("3101_3", 7.004)):
        rows, (_, begin, end) = record(name), RECORDS[name]
        middle = 0.5 * (begin + end)
        halves = [rows[(rows[:, 0] >= a) & (rows[:, 0] <= b)] for a, b in ((begin, middle), (middle, end))]
        first, second = (abs(fundamental(half[:, 0], half[:, 6], omega)) for half in halves)
        growth.append(second / first - 1.0)
    assert growth[0] > 0.15 and growth[1] < 0.05


@recorded
def test_the_wave_train_agrees_with_the_recorded_one():
    """Heights of single periods at the probe 5.5 m from the flap, until what the model throws back gets there."""
    for name, omega in (("3041_2", 5.194), ("3101_3", 7.004)):
        rows, period = record(name), 2.0 * pi / omega
        time, flap = rows[:, 0], np.abs(rows[:, 1])
        begin = time[np.flatnonzero(flap > 0.5 * flap.max())[0]] - 2.5 * period
        waves = Flap(0.9, 5.5, 5.0).train(0.012, omega, WATER, 40.0)
        last = begin + (5.5 + 3.0) / float(WATER.group_speed(omega))
        for start_of in np.arange(begin + period, last - period, period):
            inside = (time >= start_of) & (time < start_of + period)
            measured = abs(fundamental(time[inside], rows[inside, 3], omega))
            ours = abs(fundamental(time[inside], waves.elevation(0.0, time[inside] - begin), omega))
            assert ours == pytest.approx(measured, abs=0.1 * 0.012), (name, start_of)
