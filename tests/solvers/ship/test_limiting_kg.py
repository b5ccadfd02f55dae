"""Limiting KG: a box in closed form, each criterion against a scan of KG at 1 mm, ranges that are not whole."""

import numpy as np
import pytest

from solvers.ship.naval.form import Form, prism
from solvers.ship.naval.whole_hull.limits import Demands, Floating, Limit, limits, of_all, passing
from solvers.ship.section import Section, box
from solvers.ship.water import Water

SEA = Water(1025.0)
LENGTH, BREADTH, DEPTH, DRAUGHT = 120.0, 20.0, 12.0, 7.0
MASS = 1.025 * LENGTH * BREADTH * DRAUGHT
OPENING = {"opening": np.array([[60.0, 6.0, 14.0]])}  # to starboard alone


def of_box(**more) -> Floating:
    return Floating(prism(box(BREADTH, DEPTH), LENGTH), SEA, MASS, 0.0, Demands(**more))


def by_rule(found: dict, rule: str) -> Limit:
    return next(limit for (name, _), limit in found.items() if name == rule)


def test_gm_of_a_box_in_closed_form():
    """KM = T/2 + B²/(12 T); GM of at least 0.15 m (IS Code) and 0.30 m (Grain Code) leaves KM − GM."""
    found = limits(of_box(grain=1000.0))
    km = DRAUGHT / 2.0 + BREADTH**2 / (12.0 * DRAUGHT)
    assert by_rule(found, "IS Code A 2.2.4").largest == pytest.approx(km - 0.15, abs=1e-4)
    assert by_rule(found, "Grain Code A 7.1.3").largest == pytest.approx(km - 0.30, abs=1e-4)


def test_lever_of_a_box_in_closed_form():
    """The heel under wind, at most 16° or 0.8 of the deck's edge, tan φ_d = 2 (D − T)/B: GZ there is the wind's lever.

    Until the deck's edge goes under a box is wall-sided: GZ = sin φ (KM − KG + BM/2 tan² φ) (Biran and López-Pulido).
    """
    area, arm = 3000.0, 12.0
    limit = by_rule(limits(of_box(wind_area=area, wind_lever=arm)), "IS Code A 2.3.1.2").largest
    most = min(np.radians(16.0), 0.8 * np.arctan(2.0 * (DEPTH - DRAUGHT) / BREADTH))
    lever = 504.0 * area * arm / (1000.0 * 9.81 * MASS)
    bm = BREADTH**2 / (12.0 * DRAUGHT)
    expected = DRAUGHT / 2.0 + bm + 0.5 * bm * np.tan(most) ** 2 - lever / np.sin(most)
    assert limit == pytest.approx(expected, abs=1e-3)


@pytest.fixture(scope="module")
def vee() -> Floating:
    """A ship with a flare, ends that close, an opening to starboard, wind and grain."""
    x = np.linspace(0.0, 100.0, 9)
    half = 9.0 * (1.0 - (2.0 * x / 100.0 - 1.0) ** 4)
    wedge = lambda b: Section(np.array([[0.0, 0.0], [b, 3.0], [1.2 * b, 9.0], [-1.2 * b, 9.0], [-b, 3.0]]))  # noqa: E731
    form = Form(x, [wedge(b) if b > 1e-9 else None for b in half])
    asked = Demands(OPENING, wind_area=900.0, wind_lever=7.0, keel_area=20.0, grain=900.0)
    return Floating(form, SEA, 5500.0, 0.4, asked)


def test_each_limit_is_that_of_a_scan_at_a_millimetre(vee):
    found = limits(vee)
    together, (rule, what) = of_all(found)
    assert found[rule, what].largest == pytest.approx(together.largest, abs=1e-9)
    for key, limit in {**found, "all": together}.items():
        for low, high in limit.ranges:
            if high > 0.999 * vee.upright.km:
                continue  # passes up to KM, where the search ends
            heights = np.round(high, 3) + 1e-3 * np.arange(-6, 7)
            verdict = [_passes(vee, height, key) for height in heights]
            last = heights[np.flatnonzero(verdict)[-1]]
            assert verdict == sorted(verdict, reverse=True), key
            assert high - 1e-3 <= last + 1e-9 <= high + 2e-5, key
            assert _passes(vee, 0.5 * (low + high), key)


def _passes(ship: Floating, height: float, key) -> bool:
    """Whether all, or one criterion, pass to both sides: by the criteria's own verdicts, without a margin."""
    both = [ship.criteria(height, side) for side in ("starboard", "port")]
    return all(one.passed for side in both for name, one in side.items() if key in ("all", name))


def test_coarse_scan_finds_no_other_range(vee):
    """A scan over all KG over her whole height says the same of each criterion as the ranges do."""
    found = limits(vee)
    for height in np.arange(0.01, vee.upright.km, 0.2):
        for key, margin in vee.margins(height).items():
            inside = any(low <= height <= high for low, high in found[key].ranges)
            near = any(abs(height - end) < 1e-3 for ends in found[key].ranges for end in ends)
            assert near or inside == (margin >= 0.0), (key, height)


def test_ranges_of_a_margin_that_is_not_monotone():
    """A margin that fails at first and again at last: its range begins where it first passes, and is told not whole."""
    heights = np.linspace(0.0, 4.0, 41)
    margin = lambda height: 1.0 - (height - 2.0) ** 2  # noqa: E731
    limit = passing(margin, heights, margin(heights))
    assert limit.ranges[0] == pytest.approx((1.0, 3.0), abs=1e-4) and not limit.whole
    assert passing(margin, heights, np.full(41, -1.0)).largest is None
