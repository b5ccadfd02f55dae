"""Flooding in time against closed forms, 0.1 %: emptying, two tanks, an air pocket by Boyle, doors and covers.

The integration's errors are 1e-6 a step, and heads below 1e-4 of the depth go in proportion; both are far below 0.1 %.
"""

import numpy as np
import pytest

from solvers.ship.flooding.openings import Opening, circle, rectangle
from solvers.ship.flooding.rooms import Room
from tests.oracles.flooded import WATER, barge, box, flooded

G = WATER.gravity
TOLERANCE = 1e-3


def test_a_tank_above_the_sea_empties_as_torricelli_says():
    """t = (A / C_d A_h) √(2/g) (√h_1 − √h_2), though the ship rises as it empties."""
    room = Room("tank", box(-2.0, 2.0, 5.0, 9.0), 45.0, 55.0, water=4.0 * 10.0 * 3.0)
    hole = Opening("hole", ("tank", "sea"), circle((50.0, 0.0, 5.0), 0.5, "deck"))
    course = flooded(barge([room], trims=False), [hole], 300.0, 4.0)
    time = np.array([one.time for one in course.moments])
    height = np.array([one.volume[0] for one in course.moments]) / 40.0
    for left in (2.0, 1.0, 0.3):
        exact = 40.0 / (0.6 * hole.area) * np.sqrt(2.0 / G) * (np.sqrt(3.0) - np.sqrt(left))
        assert np.interp(-left, -height, time) == pytest.approx(exact, rel=TOLERANCE)


def test_two_tanks_level_out():
    """√Δ falls evenly, by C_d A √(2g) (1/A_1 + 1/A_2) / 2 a second; then both stand level, and no water is lost."""
    one = Room("aft", box(-2.0, 2.0, 1.0, 9.0), 40.0, 50.0, water=40.0 * 6.0)
    two = Room("fore", box(-2.0, 2.0, 1.0, 9.0), 50.0, 55.0, water=20.0 * 1.0)
    pipe = Opening("pipe", ("aft", "fore"), circle((50.0, 0.0, 1.4), 0.4, "bulkhead"))
    course = flooded(barge([one, two], trims=False), [pipe], 200.0, 4.0)
    time = np.array([one.time for one in course.moments])
    apart = np.array([one.level[0] - one.level[1] for one in course.moments])
    slope = 0.5 * 0.6 * pipe.area * np.sqrt(2.0 * G) * (1.0 / 40.0 + 1.0 / 20.0)
    for left in (4.0, 2.0, 0.5, 0.1):
        exact = (np.sqrt(5.0) - np.sqrt(left)) / slope
        assert np.interp(-left, -apart, time) == pytest.approx(exact, rel=TOLERANCE)
    total = np.array([one.volume.sum() for one in course.moments])
    assert np.abs(total - 260.0).max() < 1e-6 and abs(apart[-1]) < 1e-3


@pytest.mark.parametrize("index", [1.0, 1.4])
def test_an_air_pocket_stops_the_water_where_its_pressure_does(index):
    """p_0 (h / (h − x))^n = p_0 + ρ g (sea − floor − x), while the ship sinks by x A / S: Boyle, and the adiabatic."""
    area, height, whole = 8.0 * 20.0, 6.0, 100.0 * 20.0
    room = Room("tank", box(-4.0, 4.0, 0.0, height), 40.0, 60.0, vented=False, index=index)
    hole = Opening("hole", ("sea", "tank"), circle((50.0, 0.0, 0.0), 1.0, "deck"))
    course = flooded(barge([room], trims=False), [hole], 400.0, 4.0)
    outside, weight = 101325.0, WATER.density * G

    def off(x: float) -> float:
        return outside * ((height / (height - x)) ** index - 1.0) - weight * (4.0 + x * area / whole - x)

    low, high = 0.0, 4.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if off(middle) < 0.0 else (low, middle)
    assert course.moments[-1].volume[0] / area == pytest.approx(low, rel=TOLERANCE)
    assert course.moments[-1].overpressure[0] == pytest.approx(
        off(low) + weight * (4.0 + low * area / whole - low), rel=TOLERANCE
    )


@pytest.mark.slow
def test_air_leaves_by_a_vent_and_the_room_fills_as_if_it_were_open():
    """A vent as large as the hole lets air of 1/850 of the water's density go for 5 mm of head, of 4 m."""
    hole = Opening("hole", ("sea", "tank"), circle((50.0, 0.0, 0.0), 1.0, "deck"))
    vent = Opening("vent", ("tank", "sea"), circle((50.0, 0.0, 9.0), 1.0, "deck"))
    ends = []
    for vented in (True, False):
        room = Room("tank", box(-4.0, 4.0, 0.0, 9.0), 40.0, 60.0, vented=vented)
        course = flooded(barge([room], trims=False), [hole, vent], 300.0, 4.0)
        ends.append([one.volume[0] for one in course.moments])
    assert ends[1][100] == pytest.approx(ends[0][100], rel=2e-3)
    assert ends[1][-1] == pytest.approx(ends[0][-1], rel=TOLERANCE)


@pytest.mark.slow
def test_a_cover_opens_at_its_time_and_a_door_gives_way_at_its_head():
    one = Room("side", box(4.0, 10.0, 0.0, 9.0), 40.0, 60.0)
    two = Room("hold", box(-4.0, 4.0, 0.0, 9.0), 40.0, 60.0)
    hole = Opening("hole", ("sea", "side"), rectangle((50.0, 10.0, 2.0), 1.0, 1.0, "side"), opens=20.0)
    door = Opening("door", ("side", "hold"), rectangle((50.0, 4.0, 1.0), 1.0, 2.0, "side"), opens=None, collapse=2.5)
    course = flooded(barge([one, two], trims=False), [hole, door], 250.0, 4.0)
    first = next(moment.time for moment in course.moments if moment.volume[0] > 0.0)
    assert 20.0 < first < 24.0
    gave = course.doors["door"]
    before = [moment for moment in course.moments if moment.time < gave - 1e-9]
    assert all(moment.volume[1] == 0.0 for moment in before)
    assert course.moments[-1].volume[1] > 100.0
    sill = [float(moment.pose.heights(door.corners).min()) for moment in before]
    heads = [moment.level[0] - low for moment, low in zip(before, sill, strict=True)]
    assert 2.3 < max(heads) <= 2.5 + 1e-9


def test_she_sinks_when_her_rooms_hold_more_than_she_can_carry():
    room = Room("all", box(-9.0, 9.0, 0.0, 10.0), 1.0, 99.0)
    hole = Opening("hole", ("sea", "all"), circle((50.0, 0.0, 0.0), 4.0, "deck"))
    assert flooded(barge([room], draught=6.0), [hole], 4000.0, 6.0).end == "sunk"
