"""Criteria of the Grain Code and the 2008 IS Code: an exam's case, closed forms, and each made to fail."""

from math import cos, inf, pi, radians, sin

import numpy as np
import pytest

from solvers.ship.naval import grain_code, intact, weather
from solvers.ship.naval.criteria import Criterion
from solvers.ship.naval.curve import Levers
from solvers.ship.naval.form import prism
from solvers.ship.section import box
from solvers.ship.water import Water

SEA = Water(1025.0)
BREADTH, DEPTH, DRAUGHT = 27.0, 14.0, 9.7  # m, of a Handysize's box
DISPLACEMENT = 35_080.0  # t
MIDDLE = DRAUGHT / 2 + BREADTH**2 / (12 * DRAUGHT)  # KM of a box
NO_ARM = grain_code.straight_line(0.0)


def exam() -> Levers:
    """GZ of an exam's ship of 16 500 t, every 15 deg."""
    return Levers(np.radians(np.arange(0, 91, 15)), [0, 0.267, 0.645, 0.571, 0.163, -0.454, -1.104])


def sine(largest: float, vanishing: float) -> Levers:
    """GZ = A sin(π φ/φ_v) of a largest lever A (m) and an angle φ_v (deg)."""
    heel = np.radians(np.arange(-60.0, 91.0))
    return Levers(heel, largest * np.sin(pi * heel / radians(vanishing)))


def of_box(gm: float) -> Levers:
    """GZ of the Handysize's box for a GM (m)."""
    form = prism(box(BREADTH, DEPTH), DISPLACEMENT / (1.025 * BREADTH * DRAUGHT))
    heel = np.radians(np.arange(-60.0, 91.0))
    return Levers(heel, form.righting_levers(DISPLACEMENT, SEA, heel, (0.0, MIDDLE - gm)))


def verdicts(criteria) -> list[bool]:
    return [one.passed for one in criteria]


def test_exam_of_grain_shift():
    arm = grain_code.straight_line(grain_code.heeling_arm(3960.0, 1.2, 16_500.0))
    assert (arm(0.0), arm(radians(40.0))) == pytest.approx((0.20, 0.16), rel=1e-12)
    found = grain_code.residual(exam(), arm)
    assert np.degrees(found.heel) == pytest.approx(12.3, rel=0.01)  # more than the 12 deg that the code allows
    assert np.degrees(found.end) == pytest.approx(35.3, rel=0.01) and found.ends_at == "the largest difference"
    assert found.area == pytest.approx(0.126, rel=0.01)
    # The book goes on to 40 deg, past the first of the code's three limits.
    assert exam().less(arm).area(found.heel, radians(40.0)) == pytest.approx(0.168, rel=0.01)


def test_demonstration_with_half_full_hold():
    """A box 27 × 14 × 9.7 m with V = 557 m³ × 25 m, × 1.12, SF 1.3: λ0 0.342 m; the least GM is 1.71 m."""
    arm = grain_code.straight_line(grain_code.heeling_arm(557.0 * 25.0 * 1.12, 1.3, DISPLACEMENT))
    assert float(arm(0.0)) == pytest.approx(0.342, abs=5e-4)
    expected = {1.5: (11.5, 0.053), 2.0: (9.1, 0.113)}
    for gm, (heel, area) in expected.items():
        found = grain_code.residual(of_box(gm), arm)
        assert (np.degrees(found.heel), found.area) == pytest.approx((heel, area), rel=0.01)
    enough = {gm: grain_code.criteria(of_box(gm), arm, gm)[1].passed for gm in (1.70, 1.72)}
    assert enough == {1.70: False, 1.72: True}


def test_criteria_of_grain_each_met_and_missed():
    arm = grain_code.straight_line(0.3)
    good = grain_code.criteria(sine(1.2, 80.0), arm, 1.5)
    assert verdicts(good) == [True, True, True] and all(one.margin > 0.0 for one in good)
    assert verdicts(grain_code.criteria(sine(0.6, 80.0), arm, 1.5))[0] is False  # heels too far
    assert verdicts(grain_code.criteria(sine(1.2, 80.0), arm, 1.5, flooding=radians(12.0)))[1] is False
    assert verdicts(grain_code.criteria(sine(1.2, 80.0), arm, 0.29))[2] is False
    shallow = grain_code.criteria(sine(1.2, 80.0), arm, 1.5, deck=radians(5.0))[0]  # ships from 1994
    assert not shallow.passed and shallow.limit == pytest.approx(5.0)
    lost = grain_code.criteria(sine(0.2, 80.0), arm, 1.5)
    assert verdicts(lost)[:2] == [False, False] and lost[0].attained == inf


@pytest.mark.parametrize(("flooding", "end", "name"), [(None, 40.0, "40 deg"), (22.0, 22.0, "flooding")])
def test_residual_area_of_a_sine(flooding, end, name):
    """∫ A sin(π φ/φ_v) dφ between the limits, with no arm at all."""
    found = grain_code.residual(sine(1.0, 120.0), NO_ARM, flooding and radians(flooding))
    top = radians(120.0)
    assert found.ends_at == name
    assert found.area == pytest.approx(top / pi * (1.0 - cos(pi * radians(end) / top)), rel=1e-6)


def test_criteria_on_levers_each_met_and_missed():
    good = intact.criteria(sine(0.5, 70.0), 0.8)
    assert verdicts(good) == [True] * 6
    top = radians(70.0)
    exact = [0.5 * top / pi * (1.0 - cos(pi * radians(end) / top)) for end in (30.0, 40.0)]
    assert [one.attained for one in good[:3]] == pytest.approx([*exact, exact[1] - exact[0]], rel=1e-6)
    assert [one.attained for one in good[3:5]] == pytest.approx([0.5, 35.0], rel=1e-6)
    assert verdicts(intact.criteria(sine(0.15, 70.0), 0.8)) == [False, False, False, False, True, True]
    assert verdicts(intact.criteria(sine(0.5, 40.0), 0.8))[4] is False  # the largest lever at 20 deg
    assert verdicts(intact.criteria(sine(0.5, 70.0), 0.14))[5] is False
    assert intact.criteria(sine(0.5, 70.0), 0.8, flooding=radians(20.0))[2].attained == 0.0


def test_levers_beyond_flooding_count_for_nothing():
    """Flooding at 27.1 deg: no lever and no area from 30 deg on, the largest lever there, areas as integrals."""
    top, end = radians(70.0), radians(27.1)
    found = intact.criteria(sine(0.5, 70.0), 0.8, flooding=end)
    whole = 0.5 * top / pi * (1.0 - cos(pi * end / top))
    attained = [whole, whole, 0.0, 0.0, 27.1, 0.8]
    assert [one.attained for one in found] == pytest.approx(attained, rel=1e-6, abs=1e-12)
    assert verdicts(found) == [True, True, False, False, True, True]
    late = intact.criteria(sine(0.5, 70.0), 0.8, flooding=radians(31.0))
    assert late[3].attained == pytest.approx(0.5 * sin(pi * 31.0 / 70.0), rel=1e-6)  # still rising there
    assert [one.note for one in found[:5]] == ["up to the flooding angle, 27.1 deg"] * 5


def test_ship_that_lies_with_an_opening_under_water_meets_nothing():
    """No row of any code passes: the opening is under upright, or before the angle at which she lies."""
    heel, arm = np.radians(np.arange(-60.0, 91.0)), grain_code.straight_line(0.05)
    ship = weather.Exposed(160.0, BREADTH, DRAUGHT, 9.0, 20_000.0, 0.8, 2.0, 2000.0, 12.0)
    listed = Levers(heel, np.sin(2.0 * heel) - sin(radians(10.0)))  # lies at 5 deg
    lolled = Levers(heel, np.sin(heel) * (np.tan(heel) ** 2 - np.tan(radians(5.0)) ** 2) / (1.0 + heel**4))
    assert np.degrees(lolled.equilibrium()) == pytest.approx(5.0, abs=1e-4)
    for levers, flooding in ((sine(1.2, 80.0), 0.0), (listed, radians(4.0)), (lolled, radians(4.0))):
        rows = [
            *intact.criteria(levers, 1.5, flooding),
            *grain_code.criteria(levers, arm, 1.5, flooding=flooding),
            *weather.criteria(levers, ship, flooding=flooding),
        ]
        assert not any(verdicts(rows)), [one for one in rows if one.passed]


def test_heel_beyond_flooding_is_no_heel_she_lies_at():
    """The shift of grain and the wind would heel her by less than is allowed, but the opening is under before."""
    levers, arm = sine(1.2, 80.0), grain_code.straight_line(0.3)
    heel = np.degrees(grain_code.residual(levers, arm).heel)
    assert 5.0 < heel < 12.0
    found = grain_code.criteria(levers, arm, 1.5, flooding=radians(5.0))
    assert verdicts(found) == [False, False, True]
    assert found[0].note == f"she floods at 5.0 deg, before {heel:.1f} deg"
    ship = weather.Exposed(160.0, BREADTH, DRAUGHT, 9.0, 20_000.0, 0.8, 2.0, 6000.0, 12.0)
    assert verdicts(weather.criteria(sine(0.8, 80.0), ship)) == [True, True]
    assert verdicts(weather.criteria(sine(0.8, 80.0), ship, flooding=radians(2.0))) == [False, False]


def test_weather_by_hand():
    """Worked by hand from the code's tables: B/d 2.783, Cb 0.817, GM 2 m."""
    ship = weather.Exposed(160.0, BREADTH, DRAUGHT, MIDDLE - 2.0, DISPLACEMENT, 0.817, 2.0, 1500.0, 10.0)
    assert ship.lever == pytest.approx(504.0 * 1500.0 * 10.0 / (1000.0 * 9.81 * 35_080.0), rel=1e-12, abs=0.0)
    period = 2.0 * (0.373 + 0.023 * 2.7835 - 0.043 * 1.6) * 27.0 / 2.0**0.5
    assert ship.period == pytest.approx(period, rel=1e-4)
    x1 = 0.95 - 0.02 * 0.835  # between 2.7 and 2.8
    r = 0.73 + 0.6 * (MIDDLE - 2.0 - DRAUGHT) / DRAUGHT
    s = 0.053 - 0.009 * (period - 14.0) / 2.0
    assert np.degrees(ship.roll) == pytest.approx(109.0 * x1 * (r * s) ** 0.5, rel=1e-3)
    assert weather.Exposed(**vars(ship) | {"keel_area": 0.02 * 160.0 * BREADTH}).keels == 0.88
    assert weather.Exposed(**vars(ship) | {"sharp": True}).keels == 0.7


def test_weather_areas_of_a_sine():
    """Between a straight gust's lever and A sin(π φ/φ_v) both areas are closed forms."""
    levers, top = sine(0.8, 80.0), radians(80.0)
    ship = weather.Exposed(160.0, BREADTH, DRAUGHT, 9.0, 20_000.0, 0.8, 2.0, 2000.0, 12.0)
    found, k = weather.weather(levers, ship), pi / top
    heel, first = np.arcsin(found.wind / 0.8) / k, np.arcsin(found.gust / 0.8) / k
    integral = lambda a, b: 0.8 / k * (cos(k * a) - cos(k * b)) - found.gust * (b - a)  # noqa: E731
    assert found.heel == pytest.approx(heel, rel=1e-6) and found.end == pytest.approx(radians(50.0))
    assert found.a == pytest.approx(-integral(heel - ship.roll, first), rel=1e-6)
    assert found.b == pytest.approx(integral(first, found.end), rel=1e-6)


def test_weather_met_and_missed():
    ship = weather.Exposed(160.0, BREADTH, DRAUGHT, 9.0, 20_000.0, 0.8, 2.0, 2000.0, 12.0)
    assert verdicts(weather.criteria(sine(0.8, 80.0), ship)) == [True, True]
    assert verdicts(weather.criteria(sine(0.8, 80.0), ship, flooding=radians(15.0)))[1] is False
    assert verdicts(weather.criteria(sine(0.8, 80.0), ship, deck=radians(2.0)))[0] is False
    sail = weather.Exposed(**vars(ship) | {"wind_area": 40_000.0})
    assert verdicts(weather.criteria(sine(0.8, 80.0), sail)) == [False, False]


def test_lee_and_weather_side_of_a_list():
    """A ship that lies over to the other side by her own list comes to rest there."""
    heel = np.radians(np.arange(-60.0, 91.0))
    listed = Levers(heel, np.sin(2.0 * heel) + sin(radians(10.0)))
    assert np.degrees(listed.equilibrium()) == pytest.approx(-5.0, abs=1e-6)


def test_verdict_of_no_number():
    assert not Criterion("", "", "at least", 0.1, float("nan"), "m").passed
    assert not Criterion("", "", "at most", 12.0, inf, "deg").passed
