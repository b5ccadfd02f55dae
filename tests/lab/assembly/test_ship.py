"""The hydrostatics of a ship whose hull has lines: those of all of her, not of her section, in small motions."""

from dataclasses import replace
from math import radians, sin

import numpy as np
import pytest

from lab.assembly.hull_tables import whole_form
from lab.assembly.scene import vessels
from lab.assembly.ship import hull_table
from lab.preset.find import load
from solvers.ship.linear import impedance, oscillations
from solvers.ship.motion import start

G = 9.81
FROZEN = {"water.model": "frozen"}


@pytest.fixture(scope="module")
def preset():
    return load("ship/anti-roll-s175", FROZEN).resolved


@pytest.fixture(scope="module")
def ship(preset):
    return vessels(preset)[0].ship


@pytest.fixture(scope="module")
def waterline(preset):
    """Stations (m) of her offsets and half-breadths (m) at her draught."""
    station, z, half = (np.array(preset.ship.offsets.columns[name]) for name in ("station", "z", "half_breadth"))
    x = np.unique(station)
    rows = [(z[station == one], half[station == one]) for one in x]
    return x, np.array([np.interp(preset.ship.draught, *row, left=0.0) for row in rows])


def test_stiffness_is_that_of_the_whole_waterline(preset, ship, waterline):
    """ρ g A_wp in heave and W GM in roll, with BM of the waterline summed here."""
    x, half = waterline
    still = replace(hull_table(preset.ship, preset.sea, preset.run.gravity).at([1.0]), frequency=np.array([1e-6]))
    spring = impedance(ship, ship.load.section, ship.load.water, preset.ship.heave, still)[0].real
    plane, second = np.trapezoid(2.0 * half, x), np.trapezoid(2.0 / 3.0 * half**3, x)
    length, salt = preset.ship.length, preset.sea.density
    assert spring[1, 1] == pytest.approx(salt * G * plane / length, rel=0.01)
    form = whole_form(preset.ship)
    volume, (_, _, kb) = form.displaced(np.full(len(form.x), preset.ship.draught))
    height = kb + second / volume - preset.ship.gravity_height
    assert spring[2, 2] == pytest.approx(salt * G * volume / length * height, rel=0.02)


def test_righting_moment_is_that_of_all_stations_heeled(preset, ship):
    """W GZ of the form at 1 and 3 degrees, which heels every station, about her centre of gravity."""
    form, given = whole_form(preset.ship), preset.ship
    weight = ship.body.mass * G
    for heel in (radians(1.0), radians(3.0)):
        state = start(ship, given.heave, heel)
        place = given.about[1] - given.gravity_height
        moment = ship.load.force(state[:3], 0.0)[2] - ship.rig.spring[2] * heel
        about_centre = moment - weight * place * sin(heel)  # from her axis in the waterline to her centre of gravity
        arms = form.righting_levers(
            form.hydrostatics(given.draught, ship.load.water).displacement,
            ship.load.water,
            np.array([heel]),
            (0.0, given.gravity_height),
        )
        assert -about_centre / weight == pytest.approx(arms[0], rel=0.03)


def test_she_rolls_and_heaves_as_stiffness_and_inertia_say(preset, ship):
    """Natural frequencies of the equations in time are where the frequency domain has no real part left."""
    table = hull_table(preset.ship, preset.sea, preset.run.gravity)
    found = np.sort(oscillations(ship, start(ship, preset.ship.heave)).imag)
    omega = np.linspace(0.5, 0.9, 401)
    whole = impedance(ship, ship.load.section, ship.load.water, preset.ship.heave, table.at(omega))
    least = omega[np.abs(np.linalg.det(whole)).argmin()]
    assert np.abs(found / least - 1.0).min() < 0.02


def test_a_hull_of_one_section_has_nothing_beyond_it(tmp_path):
    """Offsets of her section all along add no stiffness."""
    given = load("ship/anti-roll-tank", FROZEN).resolved.ship
    side = given.corners[given.corners[:, 0] >= 0.0]
    side = np.vstack([[0.0, 0.0], side[side[:, 1].argsort()]])
    lines = [f"{x},{z},{y}" for x in (0.0, 0.5 * given.length, given.length) for y, z in side]
    file = tmp_path / "prism.csv"
    file.write_text("\n".join(["station,z,half_breadth", *lines]) + "\n")
    preset = load("ship/anti-roll-tank", {**FROZEN, "ship.offsets": str(file), "ship.hydrodynamics": "strips"}).resolved
    prism = vessels(preset)[0].ship
    assert np.abs(prism.rig.spring).max() < 1e-6 * prism.body.mass * G
