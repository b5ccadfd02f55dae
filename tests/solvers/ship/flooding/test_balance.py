"""How a flooded ship lies: closed forms of a box, both methods alike, loll, and capsizing."""

import numpy as np
import pytest

from solvers.ship.flooding.balance import Pose
from solvers.ship.flooding.openings import Opening, circle, rectangle
from solvers.ship.flooding.residual import levers, metacentric_height, without
from solvers.ship.flooding.rooms import Room, Rooms
from solvers.ship.flooding.solids import Prisms, Stations
from solvers.ship.naval.form import Form, prism
from solvers.ship.section import Section
from tests.oracles.flooded import WATER, barge, box, flooded

TOLERANCE = 1e-3


def wing(breadth=2.0) -> Room:
    """A wing tank to starboard along the whole box, from keel to deck."""
    return Room("wing", box(10.0 - breadth, 10.0, 0.0, 10.0), 0.0, 100.0)


def test_a_box_with_a_wing_tank_heels_as_hydrostatics_say():
    """What is left of her is a box 18 m broad with G 1 m to starboard of its middle: tan φ (GM + ½ BM tan² φ) = 1 m."""
    hole = Opening("hole", ("sea", "wing"), rectangle((50.0, 10.0, 2.0), 2.0, 1.0, "side"))
    course = flooded(barge([wing()], height=3.0, trims=False), [hole], 1500.0, 4.0)
    breadth, draught = 18.0, 4.0 * 20.0 / 18.0
    bm = breadth**2 / (12.0 * draught)
    gm = 0.5 * draught + bm - 3.0
    heel = np.arctan(max(np.roots([0.5 * bm, 0.0, gm, -1.0]).real[np.isreal(np.roots([0.5 * bm, 0.0, gm, -1.0]))]))
    assert -course.moments[-1].pose.roll == pytest.approx(heel, rel=TOLERANCE)
    assert abs(course.moments[-1].level[0]) < 1e-3


def test_added_weight_and_lost_buoyancy_give_one_position():
    room = Room("aft", box(2.0, 10.0, 1.0, 10.0), 10.0, 30.0, permeability=0.8)
    ship = barge([room])
    lost = without(ship, np.array([True]))
    pose = lost.rest(np.zeros(0), Pose(4.0))
    volume = ship.rooms.held(pose.level, pose.slope, pose.roll)
    again = ship.rest(volume, Pose(4.0))
    assert (again.level, again.slope, again.roll) == pytest.approx((pose.level, pose.slope, pose.roll), abs=1e-9)
    assert pose.roll < -0.02 and pose.slope < -0.002  # starboard and stern down


def test_lost_buoyancy_of_a_room_amidships_has_the_closed_form():
    """Water from side to side over a length l: T = Δ/(B (L − l)), BM = B²/12T; and by added weight ρ i off M + w."""
    room = Room("midship", box(-10.0, 10.0, 0.0, 10.0), 40.0, 60.0)
    ship = barge([room])
    lost = without(ship, np.array([True]))
    pose = lost.rest(np.zeros(0), Pose(4.0))
    assert pose.level == pytest.approx(5.0, rel=1e-9)
    exact = 2.5 + 400.0 / (12.0 * 5.0) - 4.0
    assert metacentric_height(lost, np.zeros(0), pose) == pytest.approx(exact, rel=TOLERANCE)
    volume = np.array([20.0 * 20.0 * 5.0])
    both = metacentric_height(ship, volume, ship.rest(volume, Pose(5.0)))
    assert both * 1.25 == pytest.approx(exact, rel=TOLERANCE)  # the moment is one: no water goes in or out


def test_levers_are_those_of_a_wall_sided_box():
    ship = barge([Room("dry", box(-1.0, 1.0, 1.0, 2.0), 40.0, 60.0)])
    heels = np.radians([0.0, 5.0, 15.0])
    bm, gm = 400.0 / 48.0, 2.0 + 400.0 / 48.0 - 4.0
    exact = np.sin(heels) * (gm + 0.5 * bm * np.tan(heels) ** 2)
    for side in (1, -1):
        assert levers(ship, np.zeros(1), heels, Pose(4.0), side) == pytest.approx(exact, rel=TOLERANCE, abs=1e-12)


def test_trim_of_a_box_is_exact():
    """A weight forward of amidships: tan θ (GM_L + ½ BM_L tan² θ) = its arm, as it is across her."""
    ship = barge([Room("dry", box(-1.0, 1.0, 1.0, 2.0), 40.0, 60.0)])
    moved = type(ship)(ship.hull, ship.rooms, ship.mass, np.array([53.0, 0.0, 4.0]), WATER)
    pose = moved.rest(np.zeros(1), Pose(4.0))
    bm = 100.0**2 / (12.0 * 4.0)
    gm = 2.0 + bm - 4.0
    assert pose.slope * (gm + 0.5 * bm * pose.slope**2) == pytest.approx(3.0, rel=1e-6)


def test_a_prism_and_its_stations_are_one_hull():
    section = Section(np.array([[-9.0, 0.0], [9.0, 0.0], [10.0, 2.0], [10.0, 10.0], [-10.0, 10.0], [-10.0, 2.0]]))
    solid, lines = Prisms([section.outline], [0.0], [100.0]), Stations(prism(section, 100.0))
    for level, roll in ((4.0, 0.0), (3.0, 0.4), (6.0, -1.0)):
        one, two = (hull.wet(np.array([level]), 0.0, roll) for hull in (solid, lines))
        assert one.volume == pytest.approx(two.volume, rel=1e-12)
        assert one.moment == pytest.approx(two.moment, rel=1e-12)
        assert one.surface == pytest.approx(two.surface, rel=1e-12)


def test_volumes_of_a_trimmed_prism_are_exact():
    """Against 4000 slices, of a room that is dry at one end and full at the other."""
    outline = np.array([[-3.0, 1.0], [2.0, 0.0], [4.0, 3.0], [1.0, 6.0], [-2.0, 5.0]])
    solid = Prisms([outline], [10.0], [50.0])
    found = solid.wet(np.array([-3.0]), 0.18, 0.2)
    x = 10.0 + 40.0 * (np.arange(4000) + 0.5) / 4000
    form = Form(np.array([0.0, 1.0, 2.0]), (Section(outline),) * 3)
    cut = np.array([form.sections[0].immersion(3.0 - 0.18 * place, 0.2).area for place in x])
    assert found.volume[0] == pytest.approx(cut.mean() * 40.0, rel=1e-6)
    assert found.moment[0, 0] == pytest.approx((x * cut).mean() * 40.0, rel=1e-6)


def test_levels_are_found_again_at_any_heel_and_trim():
    rooms = Rooms([wing(), Room("low", np.array([[-5.0, 0.0], [5.0, 1.0], [0.0, 4.0]]), 20.0, 70.0, 0.7)])
    volume = rooms.full * [0.3, 0.85]
    for slope, roll in ((0.0, 0.0), (0.02, 0.5), (-0.1, -1.2)):
        filled = rooms.filled(volume, slope, roll)
        wet = rooms.prisms.wet(filled.level, slope, roll)
        assert rooms.share * wet.volume == pytest.approx(volume, rel=1e-10)


@pytest.mark.parametrize("side", [1, -1])
def test_water_with_a_free_surface_lolls_her_to_the_side_that_is_asked(side):
    """GM = KB + BM − KG − i/∇ < 0 upright; at rest tan² φ = −2 GM / (BM − i/∇) by the wall-sided formula of both."""
    room = Room("tank", box(-10.0, 10.0, 0.0, 10.0), 30.0, 70.0)
    ship = barge([room], height=7.45, draught=6.0, depth=14.0, side=side, trims=False)
    volume = np.array([40.0 * 20.0 * 3.0])
    pose = ship.rest(volume, Pose(7.2))
    whole = 6.0 * 2000.0 + volume[0]
    gravity = (7.45 * 12000.0 + 1.5 * volume[0]) / whole
    spread = (100.0 - 40.0) * 20.0**3 / 12.0 / whole
    height = 0.5 * 7.2 + spread - gravity
    assert height < 0.0
    assert side * np.tan(pose.roll) == pytest.approx(np.sqrt(-2.0 * height / spread), rel=TOLERANCE)


@pytest.mark.slow
def test_she_plunges_where_no_trim_carries_the_water_in_her_bow():
    """A bow of half her length that floods weighs more than the other half can trim to carry."""
    room = Room("bow", box(-10.0, 10.0, 0.0, 10.0), 50.0, 99.0)
    hole = Opening("hole", ("sea", "bow"), circle((75.0, 0.0, 0.0), 6.0, "deck"))
    course = flooded(barge([room], draught=5.0), [hole], 600.0, 5.0)
    assert course.end == "plunged" and course.moments[-1].pose.slope > 0.02


@pytest.mark.slow
def test_she_capsizes_where_no_heel_balances_the_water():
    ship = barge([wing(6.0)], height=7.5, draught=5.0, trims=False)
    hole = Opening("hole", ("sea", "wing"), circle((50.0, 10.0, 2.0), 2.0, "side"))
    course = flooded(ship, [hole], 3000.0, 5.0)
    assert course.end == "capsized"
    assert course.moments[-1].pose.roll < -0.3
