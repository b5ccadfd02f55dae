"""The barge with low sides: her lever from its parts, her edge of capsize, and how sure a few beds are."""

from dataclasses import replace
from math import atan, cos, radians, sin, tan

import numpy as np
import pytest

from lab.measures.value import over_worlds
from lab.reproduce import low_sides
from lab.reproduce.capsizes import swung
from lab.reproduce.low_sides import chance, low_ship, tell, tell_map
from lab.reproduce.runs import Outcome
from lab.reproduce.ship import AMPLITUDE, FREQUENCY

BREADTH, DRAUGHT, SIDE = 0.34, 0.11, 0.03  # m, the last above the water
HEIGHT = 0.5 * DRAUGHT + BREADTH**2 / (12.0 * DRAUGHT) - 0.0926  # m, GM


def test_her_lever_is_the_boxs_until_her_deck_is_wet_and_less_beyond():
    """Beyond, the box's less the triangle of side above the deck that holds no water out; none near 80 deg."""
    ship = low_ship()

    def boxs(roll):
        return sin(roll) * (HEIGHT + BREADTH**2 / (24.0 * DRAUGHT) * tan(roll) ** 2)

    wet = atan(2.0 * SIDE / BREADTH)
    for roll in (0.3 * wet, 0.9 * wet):
        assert ship.lever(roll) == pytest.approx(boxs(roll), abs=1e-5)
    roll = radians(25.0)
    # Corners from the axis: deck's edge, where the deck meets the water, where the side would
    corners = np.array([[0.5 * BREADTH, SIDE], [SIDE / tan(roll), SIDE], [0.5 * BREADTH, 0.5 * BREADTH * tan(roll)]])
    area = 0.5 * (corners[0, 0] - corners[1, 0]) * (corners[2, 1] - corners[0, 1])
    y, z = corners.mean(axis=0)
    lost = area * (y * cos(roll) + z * sin(roll)) / (BREADTH * DRAUGHT)
    assert ship.lever(roll) == pytest.approx(boxs(roll) - lost, abs=1e-5)
    assert ship.lever(radians(75.0)) > 0.0 > ship.lever(radians(82.0))


def test_loose_cargo_takes_her_over_and_frozen_does_not():
    ship, waves = low_ship(), (np.array([19.0, 40.0]), np.array([4.4, 4.4]))
    assert swung(ship, *waves)[1].tolist() == [0.0, 1.0]
    assert swung(replace(ship, heap=None), *waves)[1].tolist() == [0.0, 0.0]


def test_a_few_beds_are_not_sure():
    """Wilson's interval: none of four may still be one of two; it holds the share, and narrows as beds are added."""
    low, high = chance(0, 4)
    assert low == pytest.approx(0.0, abs=1e-12) and high == pytest.approx(1.96**2 / (4 + 1.96**2))
    assert chance(4, 4) == pytest.approx((1.0 - high, 1.0))
    assert chance(5, 10) == pytest.approx((0.2366, 0.7634), abs=1e-4)


def test_beds_are_counted():
    def run(size, when):
        measures = {"capsized_at": over_worlds(when, "s"), "frozen_capsized_at": over_worlds([np.nan], "s")}
        return Outcome({AMPLITUDE: size}, None, "complete", measures, {})

    rows = tell({"low sides": [run("19 mm", [np.nan, np.nan]), run("30 mm", [12.0, np.nan])]}).rows
    assert rows[0].ours.startswith("0 of 2 beds; 0 %") and rows[1].ours.startswith("1 of 2 beds; ")
    assert rows[1].ours.endswith("frozen stands")


def test_the_map_tells_the_lowest_waves_that_capsize_her_and_where_frozen_cargo_does(monkeypatch):
    monkeypatch.setattr(low_sides, "FINE", (np.array([15.0, 25.0]), np.array([4.0, 4.4])))  # of heaps, behind the beds

    def run(size, omega, when, alone):
        measures = {"capsized_at": over_worlds(when, "s"), "frozen_capsized_at": over_worlds([alone], "s")}
        return Outcome({AMPLITUDE: f"{size} mm", FREQUENCY: f"{omega} rad/s"}, None, "complete", measures, {})

    runs = [
        run(15, 4.4, [np.nan, 12.0], np.nan),
        run(25, 4.4, [9.0, 8.0], 20.0),
        run(15, 4.0, [np.nan, np.nan], np.nan),
        run(25, 4.0, [np.nan, np.nan], np.nan),
    ]
    told = tell_map({"low sides": runs})
    assert [row.ours for row in told.rows] == [
        "in none of these waves",
        "from 15 mm on",
        "in 1 of 4 waves, from 25 mm on",
    ]
    assert [row.agrees for row in told.rows] == [None, None, True]
    points = [line for line in told.figure.axes[0].lines if len(line.get_xdata())]
    assert [(line.get_marker(), line.get_fillstyle()) for line in points] == [
        ("o", "left"),
        ("o", "full"),
        ("x", "full"),
        ("o", "none"),
        ("o", "none"),
    ]
