"""What is said of means over few beds beside one another."""

import numpy as np
import pytest
from scipy import stats

from lab.measures.value import over_worlds
from lab.studies.reproduce.estimates import (
    Estimate,
    Verdict,
    alike,
    chance,
    difference,
    falling,
    mean,
    mostly,
    paired_difference,
    paired_ratio,
    ratio,
    scatters_more,
    together,
)

AGREES, DIFFERS, CANNOT_TELL = Verdict


def beds(*angles):
    return over_worlds(angles, "deg")


HIGH, LOW, SCATTERED = beds(30.0, 31.0, 32.0), beds(20.0, 21.0, 22.0), beds(20.0, 29.0, 38.0)


def test_an_order_of_means_is_undecided_if_beds_scatter_more():
    assert falling([HIGH, LOW]) is AGREES
    assert falling([LOW, HIGH]) is DIFFERS
    assert falling([HIGH, SCATTERED]) is falling([SCATTERED, HIGH]) is CANNOT_TELL
    assert falling([HIGH, LOW, None]) is CANNOT_TELL and falling([LOW, HIGH, None]) is DIFFERS
    assert falling([beds(30.0), LOW]) is CANNOT_TELL  # of a single bed nothing is known


def test_means_are_equal_if_their_differences_are_known_to_be_small():
    assert alike([HIGH, beds(30.2, 31.1, 32.2)], within=4.0) is AGREES
    assert alike([HIGH, beds(30.2, 31.1, 32.2)], within=1.0) is CANNOT_TELL
    assert alike([HIGH, HIGH, LOW], within=4.0) is DIFFERS
    assert alike([SCATTERED, HIGH], within=4.0) is CANNOT_TELL


def test_with_many_comparisons_a_difference_needs_more_evidence():
    """A step that is just negative at 95 % is said to differ alone, but not as one of six."""
    first, second = beds(20.0, 21.0, 22.0, 21.0), beds(21.75, 22.75, 22.25, 23.25)
    assert falling([first, second]) is DIFFERS
    steps = [beds(*(level + angle for angle in (0.0, 0.1, 0.2, 0.1))) for level in (60.0, 50.0, 40.0, 35.0, 30.0)]
    assert falling([*steps, first, second]) is CANNOT_TELL


def test_confidence_is_that_of_students_and_welchs_t():
    first, second = [30.0, 34.0, 31.0, 36.0, 29.0], [25.0, 26.0, 24.5]
    value, reference = (over_worlds(angles, "deg") for angles in (first, second))
    welch = stats.ttest_ind(first, second, equal_var=False).confidence_interval(0.95)
    assert difference(value, reference).ends() == pytest.approx((welch.low, welch.high))
    assert mean(value).ends() == pytest.approx(value.interval)
    share = ratio(value, reference)  # to first order the same, where both are divided by the reference
    assert share.value == pytest.approx(np.mean(first) / np.mean(second))
    assert share.error == pytest.approx(
        np.hypot(value.std / 5**0.5, share.value * reference.std / 3**0.5) / np.mean(second)
    )
    moved = over_worlds(np.add(first, [1.0, 2.0, 1.0, 3.0, 2.0]), "deg")
    related = stats.ttest_rel(moved.worlds, first).confidence_interval(0.95)
    assert paired_difference(moved, value).ends() == pytest.approx((related.low, related.high))
    pairs = paired_ratio(moved, value)
    student = stats.t.interval(0.95, 4, loc=1.8, scale=stats.sem([1.0, 2.0, 1.0, 3.0, 2.0]))
    assert (pairs.ends()[0] - 1.0) * 32.0 == pytest.approx(student[0])
    assert paired_ratio(over_worlds([30.0], "deg"), over_worlds([31.0], "deg")) is None
    assert paired_difference(None, value) is None


@pytest.mark.parametrize(
    ("low", "high", "said"),
    [(0.8, 1.1, AGREES), (0.94, 1.1, CANNOT_TELL), (1.0, 1.1, DIFFERS), (0.5, 0.6, DIFFERS)],
)
def test_a_number_is_between_limits_if_its_whole_interval_is(low, high, said):
    assert Estimate(0.95, 0.01, 1000).lies(low, high) is said
    assert Estimate(0.95, 0.0, 0).lies(low, high) is CANNOT_TELL  # one bed
    assert Estimate(0.95, 0.0, 0).lies(-np.inf, np.inf) is CANNOT_TELL
    assert Estimate.exact(0.95).lies(low, high) is (AGREES if low < 0.95 < high else DIFFERS)


def test_errors_and_intervals_are_labelled():
    assert Estimate(0.733, 0.067, 5).told() == "0.733 ± 0.067 (s.e.)"
    assert Estimate(0.733, 0.067, 5).interval() == "[0.56, 0.91] (95 %)"
    for one in (Estimate(0.95, 0.0, 0), Estimate.exact(0.95)):
        assert one.told("deg", "+") == "+0.95 deg" and one.interval() == ""


def test_both_kinds_of_tests_have_the_stated_error_rate():
    """Beds whose mean is off by just what is allowed: agreement is said in one case of forty, so is difference."""
    random = np.random.default_rng(1)
    drawn = random.normal(3.0, 1.0, size=(4000, 5))
    said = [mean(over_worlds(angles, "deg")).lies(-3.0, 3.0) for angles in drawn]
    for verdict in (AGREES, DIFFERS):
        assert said.count(verdict) / len(said) == pytest.approx(0.025, abs=0.008)


def test_few_beds_give_wide_intervals_of_a_share():
    """Wilson's interval: none of four may still be one of two; it holds the share, and narrows as beds are added."""
    low, high = chance(0, 4)
    assert low == pytest.approx(0.0, abs=1e-12) and high == pytest.approx(1.96**2 / (4 + 1.96**2), abs=1e-4)
    assert chance(4, 4) == pytest.approx((1.0 - high, 1.0))
    assert chance(5, 10) == pytest.approx((0.2366, 0.7634), abs=1e-4)
    assert [mostly(*seen) for seen in ((4, 4), (0, 4), (3, 4), (1, 1), (0, 1), (0, 0))] == [
        AGREES,
        DIFFERS,
        *[CANNOT_TELL] * 4,
    ]


def test_scatters_are_compared_by_their_variances():
    wide, narrow = (over_worlds(size * np.linspace(-1.0, 1.0, 12), "deg") for size in (10.0, 2.0))
    near = over_worlds(9.0 * np.linspace(-1.0, 1.0, 12), "deg")
    assert scatters_more(wide, narrow) is AGREES and scatters_more(narrow, wide) is DIFFERS
    assert scatters_more(wide, near) is scatters_more(wide, None) is CANNOT_TELL


def test_a_compound_statement_holds_if_all_parts_do():
    assert together([AGREES, AGREES]) is AGREES and together([AGREES, CANNOT_TELL]) is CANNOT_TELL
    assert together([CANNOT_TELL, DIFFERS]) is DIFFERS
