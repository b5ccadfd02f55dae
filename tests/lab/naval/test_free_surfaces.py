"""What the water in a ship's tanks takes off her GM: against closed forms, and against where level water goes."""

import numpy as np
import pytest

from lab.assembly.scene import vessels
from lab.naval import sheet
from lab.naval.condition import condition
from lab.naval.free_surfaces import free_surfaces, surface_moment
from lab.preset.find import load
from solvers.ship.cargo import filling_centre
from solvers.ship.section import Section

ART = "ship/anti-roll-tank"
TONNE = 1000.0


def of(name: str, **overrides):
    preset = load(name, overrides).resolved
    return condition(preset, vessels(preset)[0])


def test_anti_roll_tank_by_hand():
    """A tank 13.699 m broad and 2.8 m long, of fresh water: ρ b³ l/12, over the displacement."""
    found, moment = of(ART), 1.0 * 13.699**3 / 12.0 * 2.8
    assert found.free_surface == pytest.approx(moment, rel=1e-6)
    assert found.displacement == pytest.approx(1.025 * (13.7088 * 3.9984 - 1.48**2) * 27.8, rel=1e-6)
    assert found.solid_gm - found.metacentric_height == pytest.approx(moment / found.displacement, rel=1e-6)
    heel = np.radians(20.0)
    righting = float(found.levers.at(heel))
    bare = found.form.righting_levers(found.displacement, found.water, [heel], (0.0, found.gravity_height))
    assert righting == pytest.approx(float(bare[0]) - moment / found.displacement * np.sin(heel), rel=1e-6)


def test_table_shows_solid_and_fluid():
    """GM solid less the correction is GM fluid, in the lines that a user reads."""
    rows = dict(sheet.facts(of(ART)))
    assert rows["free surface, tank"] == "13.699 m broad, 2.8 m long, rho i = 599.9 t m"
    solid, fluid = (float(rows[name].split()[0]) for name in ("GM solid", "GM fluid"))
    rise = float(rows["free surfaces"].split()[-2])
    assert solid == pytest.approx(2.393, abs=1e-9) and rise == pytest.approx(0.400, abs=1e-9)
    assert fluid == pytest.approx(solid - rise, abs=1.1e-3)  # each is rounded by itself


def test_u_tube_by_hand():
    """Two wings of 1.6 m whose water communicates: 2 (y₂³ − y₁³)/3."""
    assert of("ship/u-tube").free_surface == pytest.approx(2.0 * (6.6**3 - 5.0**3) / 3.0 * 2.8, rel=1e-6)


def test_tank_of_a_model_goes_with_the_fourth_power_of_the_scale():
    model, full = (of("ship/ballast-and-grain", **more) for more in ({}, {"ship.scale": 50}))
    assert model.free_surface == pytest.approx(0.32**3 / 12.0 * 0.2, rel=1e-6)
    assert full.free_surface == pytest.approx(50.0**4 * model.free_surface, rel=1e-9)
    assert full.metacentric_height == pytest.approx(50.0 * model.metacentric_height, rel=1e-9)


def test_bare_ship_has_the_weight_of_her_water():
    """199 kg at 0.140 m and 76 kg of water at 0.220 + 0.095 m: KG of both, and GM of a box with that, solid."""
    found = of("ship/barge-two-tanks")
    water = 1000.0 * 0.8 * 0.19 * 0.5
    whole = 1000.0 * 2.546 * 0.108
    assert found.gravity_height == pytest.approx(((whole - water) * 0.14 + water * 0.315) / whole, rel=1e-3)
    assert found.solid_gm == pytest.approx(0.054 + 1.0 / 12.0 / 0.108 - found.gravity_height, rel=2e-3)
    assert found.free_surface == pytest.approx(0.8**3 / 12.0 * 0.5, rel=1e-6)


def test_water_in_a_side_tank_is_judged_on_its_side():
    """A tank to port of a ship without her water: G lies to port, and she is judged there."""
    keys = {"tank.width": "300 mm", "ship.hold": ["-300 mm", "300 mm"], "gauges.side.y": "0 mm"}
    found = of("ship/barge-two-tanks", **keys)
    share = 0.3 * 0.19 * 0.5 / (2.546 * 0.108)
    assert found.side == "port" and found.aside == pytest.approx(0.3 * share, rel=1e-3)
    assert float(found.levers.at(0.0)) == pytest.approx(-found.aside, rel=1e-6)
    assert dict(sheet.facts(found))["G aside"].endswith("to port, the side that she is judged on")
    rest = found.levers.equilibrium()
    assert np.tan(rest) == pytest.approx(found.aside / found.metacentric_height, rel=0.01)


def test_full_tank_and_frozen_cargo_have_none():
    assert free_surfaces(load("ship/handysize-grain").resolved) == []
    full = {"water.depth": "2.4 m", "water.full": True, "water.model": "frozen"}
    assert free_surfaces(load(ART, full).resolved) == []


def test_water_in_the_pores_of_a_bed_has_none():
    """Soaked to its surface a bed has none; water over it has that of the hold, ρ b³/12."""
    assert free_surfaces(load("ship/coal-soaked").resolved) == []
    (over,) = free_surfaces(load("ship/slurry").resolved)
    assert over.moment == pytest.approx(1000.0 * 0.3**3 / 12.0, rel=1e-9)


@pytest.mark.parametrize("aside", [0.0, 4.0])
def test_communicating_surfaces_have_one_middle_line(aside):
    """Wings of 1 and 2 m: Σ(y₂³ − y₁³)/3 less A ȳ², wherever the tank stands."""
    tube = np.array([[-3, 0], [4, 0], [4, 5], [2, 5], [2, 1], [-2, 1], [-2, 5], [-3, 5]])
    breadth, moment = surface_moment(np.add(tube, [aside, 0.0]), 3.0)
    middle = (2.0 * 3.0 - 1.0 * 2.5) / 3.0
    assert breadth == pytest.approx(3.0)
    assert moment == pytest.approx((64.0 - 8.0 + 27.0 - 8.0) / 3.0 - 3.0 * middle**2, rel=1e-6)


def test_puddles_have_a_middle_line_each():
    """A rib of the floor higher than the water parts it; lower than the water it does not."""
    ribbed = np.array([[-3, 0], [-1, 0], [-1, 4], [1, 4], [1, 0], [3, 0], [3, 5], [-3, 5]])
    assert surface_moment(ribbed, 3.0) == pytest.approx((4.0, 2.0 * 2.0**3 / 12.0), rel=1e-6)
    assert surface_moment(ribbed, 4.5) == pytest.approx((6.0, 6.0**3 / 12.0), rel=1e-6)


def test_correction_is_the_way_of_level_water():
    """ρ i is the slope of its moment against heel: the water's centre found anew for a small heel."""
    outline, level = np.array([[-4.0, 0], [3, 0], [5, 3], [5, 6], [-4, 6]]), 2.0
    section, small = Section(outline), 1e-4
    area = float(section.immersion(-level, 0.0).area)
    way = filling_centre(section, area, small) - filling_centre(section, area, 0.0)
    assert abs(way[0]) * area / small == pytest.approx(surface_moment(outline, level)[1], rel=1e-3)
