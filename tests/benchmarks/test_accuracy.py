"""The studies of error against cost: their statistics, and a page from a hasty one."""

import numpy as np
import pytest

from benchmarks.accuracy import BENCH
from benchmarks.accuracy.beds import Point, mean_and_interval
from benchmarks.accuracy.collisions import steps_of_levels, worst_errors
from benchmarks.accuracy.repeats import beds_for
from lab.base.errors import LabError
from lab.preset.accuracy import LEVELS


def test_half_widths_of_intervals_follow_students_t():
    """t of 2 degrees of freedom is 4.3027 at 97.5 %; an interval is told as one, and a single bed has none."""
    three, one = (Point({}, {"angle": np.array(beds)}, 1.0, None) for beds in ([1.0, 2.0, 3.0], [1.0]))
    assert three.half_interval("angle") == pytest.approx(4.3027 / np.sqrt(3.0), rel=1e-4)
    assert np.isnan(one.half_interval("angle"))
    assert mean_and_interval(three, "angle") == "2.00 [-0.48, 4.48]" and mean_and_interval(one, "angle") == "1.00"


def test_the_computed_number_of_beds_is_the_smallest_for_the_confidence():
    """With a spread of 1: 2.571/√6 = 1.05 and 2.447/√7 = 0.925."""
    assert beds_for(1.0, 1.0) == 7
    assert beds_for(2.0, 2.0) == 7
    assert beds_for(1.0, 0.1) == pytest.approx((1.96 / 0.1) ** 2, rel=0.02)


@pytest.mark.slow
def test_the_restitution_of_verlet_is_of_second_order():
    coarse, fine = worst_errors("verlet", (40, 80))
    assert coarse / fine == pytest.approx(4.0, rel=0.3)


@pytest.mark.slow
def test_each_level_holds_its_error_at_the_steps_that_the_page_has_for_it():
    steps = steps_of_levels()
    for names, error in zip(steps.values(), worst_errors("verlet", list(steps)), strict=True):
        assert all(error < LEVELS[name].restitution for name in names.split(" and "))


@pytest.mark.slow
def test_a_fast_study_writes_a_page(tmp_path):
    path = BENCH.run(["rate"], tmp_path, fast=True)
    text = path.read_text()
    assert "| 10 |" in text and "| 30 |" in text and "accuracy-rate.png" in text
    assert (tmp_path / "accuracy-rate.png").stat().st_size > 5000


def test_an_unknown_study_is_reported():
    with pytest.raises(LabError, match=r"there is no study colour; there are .*stiffness.*\.$"):
        BENCH.run(["colour"], ".", fast=True)
