"""A voyage takes the worst group of each sea, counts outcomes with Wilson's interval, and says what it cannot tell."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lab.assembly.ship import make_water, make_waves
from lab.base.errors import LabError
from lab.measures.value import over_worlds
from lab.naval.linear_water import linear_motion
from lab.preset.find import load
from lab.sweeps.point import Point
from lab.voyage.asked import Voyage
from lab.voyage.groups import linear_roll, worst_group
from lab.voyage.judged import Check, Judged, Share

SHIP = "ship/handysize-grain-bulk"


@pytest.fixture(scope="module")
def preset():
    return load(SHIP).resolved


@pytest.mark.parametrize("kind", ["jonswap", "pierson-moskowitz", "white-noise"])
def test_a_run_that_begins_later_meets_the_same_sea(preset, kind):
    water = make_water(preset.sea, 9.81)
    given = replace(preset.waves, kind=kind, spread=0.1, soft_start=0.0)
    time = np.linspace(0.0, 60.0, 13)
    whole, late = make_waves(given, water), make_waves(replace(given, begin=5000.0), water)
    assert np.allclose(late.elevation(3.0, time), whole.elevation(3.0, 5000.0 + time), atol=1e-8)


def test_linear_roll_in_regular_waves_is_the_response(preset):
    given = replace(preset.waves, kind="regular", amplitude=0.7, height=None, frequency=0.6)
    time = np.linspace(0.0, 2.0 * np.pi / 0.6, 9)
    ratio = linear_motion(preset, np.array([0.6]))[0, 2]
    found = linear_roll(replace(preset, waves=given), time)
    assert np.allclose(found, 0.7 * (ratio * np.exp(-0.6j * time)).real, atol=1e-9)


def test_the_worst_group_is_in_the_middle_of_the_run(preset):
    length, span = 3600.0, 300.0
    begin = worst_group(preset, length, span)
    time = np.arange(0.0, length, 0.5)
    roll = np.abs(linear_roll(preset, time))
    assert 0.0 <= begin <= length - span
    inside = (time >= begin) & (time <= begin + span)
    assert roll[inside].max() > 0.99 * roll.max()
    assert begin in (0.0, length - span) or abs(time[roll.argmax()] - begin - 0.5 * span) < 10.0


def test_shares_have_the_interval_of_wilson():
    low, high = Share(0, 10).interval  # closed form: z²/(n + z²)
    assert low == 0.0 and high == pytest.approx(1.959964**2 / (10 + 1.959964**2))
    assert Share(10, 10).interval[0] == pytest.approx(1.0 - high)


def run_of(shift: float, list_: float | None, lost: float | None = None, how: str = "capsized_at") -> Point:
    """A run with these measures, in which she was perhaps lost."""
    point = Point({"waves.seed": 1}, Path("nowhere"))
    none = float("nan")
    point.measures = {
        "largest_shifted_share": over_worlds([shift], "%"),
        "list_as_it_lay": over_worlds([none if list_ is None else list_], "deg"),
        how: over_worlds([none if lost is None else lost], "s"),
    }
    return point


def test_a_lost_ship_counts_as_listed_and_lists_to_either_side_count(preset):
    judged = Judged(preset, 5.0, [run_of(1.0, 0.1)] * 7 + [run_of(30.0, -6.0), run_of(80.0, None, 300.0)])
    assert (judged.listed.seen, judged.lost.seen, judged.shifted.seen) == (2, 1, 2)
    assert judged.worst == 8


@pytest.mark.parametrize("how", ["capsized_at", "flooded_at", "sunk_at"])
def test_a_ship_is_lost_however_she_ends(preset, how):
    judged = Judged(preset, 5.0, [run_of(1.0, 0.1)] * 9 + [run_of(2.0, None, 300.0, how)])
    assert (judged.lost.seen, judged.listed.seen, judged.listed.n) == (1, 1, 10)


def test_a_run_that_tells_no_list_is_none_without_one(preset):
    judged = Judged(preset, 5.0, [run_of(1.0, 0.1)] * 30 + [run_of(1.0, None)] * 2, asked=33)
    assert judged.listed.n == 30 and "3 of 33 runs could not be judged" in judged.verdict
    with pytest.raises(LabError, match="none of the runs tells list as it lay"):
        _ = Judged(preset, 5.0, [run_of(1.0, None)] * 12).listed


@pytest.mark.parametrize(
    ("runs", "spacing", "check", "told"),
    [
        (5, 0.5, None, "5 seeds are few"),
        (40, 1.0, None, "are coarse"),
        (40, 0.5, 60.0, "by grains of 0.35 m"),
        (40, 0.5, 25.0, "with a probability of 0% to 9%"),
        (40, 0.5, None, "with a probability of 0% to 9%"),
    ],
)
def test_a_verdict_needs_seeds_cells_and_grains_that_agree(preset, runs, spacing, check, told):
    fine = replace(preset, bulk=replace(preset.bulk, spacing=spacing))
    points = [run_of(20.0, 1.0)] * runs
    checks = [Check("0.35 m", run_of(check, 1.0))] if check else []
    assert told in Judged(fine, 5.0, points, checks).verdict


def test_too_wide_an_interval_cannot_be_told(preset):
    half = [run_of(20.0, 1.0), run_of(20.0, 9.0)] * 5
    assert "Cannot tell: the interval is" in Judged(preset, 5.0, half).verdict


@pytest.mark.parametrize(
    ("name", "more", "told"),
    [
        ("tilting/quick", {}, "has no ship"),
        (SHIP, {"span": 9000.0, "hours": 1.0}, "longer than the sea"),
        (SHIP, {"seeds": 1}, "--seeds: 1"),
    ],
)
def test_what_cannot_sail_is_refused_in_a_sentence(name, more, told):
    with pytest.raises(LabError, match=told):
        Voyage(name, 6.0, 12.0, **more).point(1)


@pytest.mark.slow
def test_a_voyage_of_two_seeds_writes_its_page_and_goes_on(tmp_path):
    from lab.voyage.voyage import sail

    asked = Voyage(f"{SHIP}-quick", 11.0, 14.0, hours=1.0, span=40.0, seeds=2)
    found = sail(asked, tmp_path / "voyage", video=False, quiet=True)
    page = found.page.read_text(encoding="utf-8")
    assert "Cannot tell" in page and "data:image/png" in page and found.judged.lost.n == 2
    recordings = sorted((tmp_path / "voyage" / "points").rglob("recording.h5"))
    written = [path.stat().st_mtime_ns for path in recordings]
    again = sail(asked, tmp_path / "voyage", video=False, quiet=True)
    assert again.judged.mean("largest_roll", "deg") == found.judged.mean("largest_roll", "deg")
    assert len(recordings) == 2 and [path.stat().st_mtime_ns for path in recordings] == written
