"""The hydrostatics of a ship whose hull has lines: those of all of her, not of her section."""

from dataclasses import replace

import numpy as np
import pytest

from lab.assembly.hull_tables import whole_form
from lab.assembly.scene import vessels
from lab.assembly.ship import hull_table
from lab.base.errors import LabError
from lab.preset.find import load
from solvers.ship.hydrostatics import righting_levers
from solvers.ship.linear import impedance, oscillations
from solvers.ship.motion import start
from solvers.ship.section import Section

G = 9.81
FROZEN = {"water.model": "frozen"}
COLUMNS = ("station", "z", "half_breadth")


@pytest.fixture(scope="module")
def preset(tmp_path_factory):
    """Her lines at every second station and at both ends: the potential flow of each station takes its time."""
    columns = load("ship/anti-roll-s175", FROZEN).resolved.ship.offsets.columns
    x = np.unique(columns["station"])
    few = [*x[:-1:2], x[-1]]
    rows = [row for row in zip(*(columns[name] for name in COLUMNS), strict=True) if row[0] in few]
    file = tmp_path_factory.mktemp("lines") / "s175.csv"
    file.write_text("\n".join([",".join(COLUMNS), *(",".join(map(repr, map(float, row))) for row in rows)]) + "\n")
    return load("ship/anti-roll-s175", {**FROZEN, "ship.offsets": str(file)}).resolved


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


@pytest.mark.slow
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


def test_righting_levers_are_those_of_all_stations_heeled(preset, ship):
    """GZ of the form, which finds her draught and sums the stations by itself, at any heel; her section has others."""
    form, given, heel = whole_form(preset.ship), preset.ship, np.radians([3.0, 20.0, 45.0, 80.0, 150.0])
    found = righting_levers(ship.load.section, ship.body.loading, ship.load.water, heel)
    mass = form.hydrostatics(given.draught, ship.load.water).displacement
    wanted = form.righting_levers(mass, ship.load.water, heel, (0.0, given.gravity_height))
    assert found == pytest.approx(wanted, abs=1e-6 * given.draught)
    section, loading = Section(given.corners), replace(ship.body.loading, mass=ship.body.mass * given.length / 28.24)
    amidships = righting_levers(section, loading, ship.load.water, heel)
    assert np.abs(amidships - wanted).max() > 0.05 * given.draught


def test_her_weight_is_that_of_the_water_she_displaces(preset, ship):
    """1523 t, by the trapezoidal rule over areas of polygons cut at her draught."""
    columns = preset.ship.offsets.columns
    station, z, half = (np.array(columns[name]) for name in ("station", "z", "half_breadth"))
    areas = []
    for one in np.unique(station):
        level, side = z[station == one], half[station == one]
        fine = np.linspace(0.0, preset.ship.draught, 2001)
        areas.append(np.trapezoid(2.0 * np.interp(fine, level, side, left=0.0), fine))
    volume = np.trapezoid(areas, np.unique(station))
    assert ship.body.mass * preset.ship.length == pytest.approx(preset.sea.density * volume, rel=0.01)


def test_she_rolls_and_heaves_as_stiffness_and_inertia_say(preset, ship):
    """Natural frequencies of the equations in time are where the frequency domain has no real part left."""
    table = hull_table(preset.ship, preset.sea, preset.run.gravity)
    found = np.sort(oscillations(ship, start(ship, preset.ship.heave)).imag)
    omega = np.linspace(0.5, 0.9, 401)
    whole = impedance(ship, ship.load.section, ship.load.water, preset.ship.heave, table.at(omega))
    least = omega[np.abs(np.linalg.det(whole)).argmin()]
    assert np.abs(found / least - 1.0).min() < 0.02


def test_a_hull_of_one_section_floats_as_that_section(tmp_path):
    """Offsets of her section all along: the same weight, levers and forces of waves."""
    given = load("ship/anti-roll-tank", FROZEN).resolved.ship
    side = given.corners[given.corners[:, 0] >= 0.0]
    side = np.vstack([[0.0, 0.0], side[side[:, 1].argsort()]])
    lines = [f"{x},{z},{y}" for x in (0.0, 0.5 * given.length, given.length) for y, z in side]
    file = tmp_path / "prism.csv"
    file.write_text("\n".join(["station,z,half_breadth", *lines]) + "\n")
    changes = {**FROZEN, "ship.hydrodynamics": "strips"}
    hull, section = (
        vessels(load("ship/anti-roll-tank", changes | more).resolved)[0].ship
        for more in ({"ship.offsets": str(file)}, {})
    )
    assert hull.body.mass == pytest.approx(section.body.mass, rel=1e-12)
    heel = np.radians([5.0, 40.0, 100.0])
    levers = [righting_levers(one.load.section, one.body.loading, one.load.water, heel) for one in (hull, section)]
    assert levers[0] == pytest.approx(levers[1], abs=1e-9)
    pose = np.array([0.4, section.about[1] + given.heave, 0.3])
    assert hull.load.force(pose, 31.0) == pytest.approx(section.load.force(pose, 31.0), rel=1e-3)


def test_steps_too_long_for_a_stiff_mooring_are_refused():
    """A barge of 108 kg/m and some added mass on a spring of 1 MPa: the message names the key and the longest step."""
    given = {"ship.rig.sway_spring": "1 MPa", "ship.coupling": "staggered"}
    with pytest.raises(LabError, match=r"ship.coupling_step: 100 ms is not stable .* 0.0\d+ s; take at most \d\d ms"):
        vessels(load("ship/barge-two-tanks", given | {"ship.coupling_step": "100 ms"}).resolved)
    ship = vessels(load("ship/barge-two-tanks", given | {"ship.coupling_step": "10 ms"}).resolved)[0]
    assert ship.handover == 0.01
