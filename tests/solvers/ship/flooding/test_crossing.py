"""Cross-flooding by MSC.362(92), and the factor s of SOLAS II-1/7-2."""

import numpy as np
import pytest

from solvers.ship.flooding.crossing import Device, girders, in_series, side_by_side, slowing, time_by_steps, time_needed
from solvers.ship.flooding.openings import Opening, circle
from solvers.ship.flooding.rooms import Room
from solvers.ship.flooding.survival import survival
from solvers.ship.naval.curve import Levers
from tests.oracles.flooded import WATER, barge, box, flooded


@pytest.mark.parametrize("last", [0.0, 0.5, 2.9])
def test_the_formula_is_the_integral_in_time(last):
    exact = 2.0 * 120.0 / (0.3 * np.sqrt(2.0 * 9.81 * 3.0)) * (1.0 - np.sqrt(last / 3.0)) / (1.0 - last / 3.0)
    assert time_needed(120.0, 0.3, 3.0, last) == pytest.approx(exact, rel=1e-12)
    assert time_by_steps(120.0, 0.3, 3.0, last) == pytest.approx(exact, rel=1e-3)


def test_the_formula_is_what_the_whole_tool_gives_of_a_duct():
    """A sea that keeps its level and a room of one area: H falls evenly with W, C_d is F."""
    room = Room("far", box(-5.0, 5.0, 0.5, 9.0), 40.0, 60.0)
    duct = Opening("duct", ("sea", "far"), circle((50.0, 0.0, 0.5), 0.6, "deck"), discharge=slowing(2.5))
    course = flooded(barge([room], trims=False, draught=5.0), [duct], 2000.0, 5.0)
    water = np.array([one.volume[0] for one in course.moments])
    head = -np.array([one.level[0] for one in course.moments])
    time = np.array([one.time for one in course.moments])
    k = int(np.argmax(water > 0.6 * water[-1]))
    exact = time_needed(water[k], duct.area * slowing(2.5), 4.5, head[k], WATER.gravity)
    assert time[k] == pytest.approx(exact, rel=1e-3)


def test_friction_of_girders_of_devices_behind_and_beside_each_other():
    """MSC.245(83) and MSC.362(92), appendix 2: figures 13 and 14; 2.5 to 2.7."""
    assert girders(0.5) == pytest.approx(0.2748 * 0.5 + 0.0313)
    assert girders(2.0) == pytest.approx(-0.0986 * 8 + 0.6873 * 4 - 1.0212 * 2 + 0.7386)
    assert (girders(5.0), girders(5.0, 2)) == (1.34, 1.17)
    assert girders(2.0, 2) == pytest.approx(0.0424 * 8 - 0.3593 * 4 + 1.1401 * 2 - 0.356)
    row = in_series([Device(0.5, 1.5), Device(0.25, 0.8), Device(0.5, 2.0, 0.5)])
    assert (row.area, row.friction) == (0.5, pytest.approx(1.5 + 0.8 * 4.0 + 2.0 * 0.25))
    assert side_by_side([Device(0.5, 4.0), Device(0.2, 0.25)]) == pytest.approx(0.25 + 0.2)  # F is at most 1


def curve(height: float, end: float) -> Levers:
    heel = np.radians(np.arange(0.0, 91.0, 0.5))
    return Levers(heel, height * np.sin(np.pi * heel / np.radians(end)))


def test_s_is_one_with_enough_and_the_fourth_root_with_less():
    assert survival(curve(0.5, 40.0), "cargo", True).factor == pytest.approx(1.0)
    assert survival(curve(0.03, 40.0), "cargo", True).factor == pytest.approx(0.25**0.25, rel=1e-3)
    assert survival(curve(0.5, 4.0), "cargo", True).factor == pytest.approx(0.25**0.25, rel=1e-3)
    assert survival(curve(0.5, 40.0), "cargo", True, np.radians(8.0)).factor == pytest.approx(0.5**0.25, rel=1e-3)
    assert survival(curve(0.025, 40.0), "cargo", False).factor == pytest.approx(0.5**0.25, rel=1e-3)


def test_s_is_nothing_beyond_the_limits_of_heel_and_not_told_between():
    def lying(degrees: float) -> Levers:
        heel = np.radians(np.arange(0.0, 91.0, 0.5))
        return Levers(heel, np.sin(heel - np.radians(degrees)))

    assert survival(lying(31.0), "cargo", True).factor == 0.0
    assert survival(lying(27.0), "cargo", True).factor is None
    assert survival(lying(20.0), "cargo", True).factor == pytest.approx(1.0)
    assert survival(lying(16.0), "passenger", True).factor == 0.0
    assert survival(lying(16.0), "passenger", False).factor == 0.0
    assert survival(curve(-0.1, 60.0), "cargo", True).factor == 0.0
