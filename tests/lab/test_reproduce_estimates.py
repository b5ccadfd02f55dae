"""What is said of means over few beds beside one another."""

import numpy as np
import pytest
from scipy import stats

from lab.measures.value import over_worlds
from lab.reproduce.estimates import Estimate, are_ordered, difference, paired_ratio, ratio


def test_an_order_of_means_is_left_open_where_beds_scatter_more_than_means_differ():
    beds = {"high": [30.0, 31.0, 32.0], "low": [20.0, 21.0, 22.0], "scattered": [20.0, 29.0, 38.0]}
    high, low, scattered = (over_worlds(angles, "deg") for angles in beds.values())
    assert are_ordered([high, low]) is True
    assert are_ordered([low, high]) is False
    assert are_ordered([high, scattered]) is None and are_ordered([scattered, high]) is None
    assert are_ordered([high, low, None]) is False
    assert are_ordered([over_worlds([30.0], "deg"), low]) is None  # of a single bed nothing is known


def test_confidence_is_that_of_students_and_welchs_t():
    first, second = [30.0, 34.0, 31.0, 36.0, 29.0], [25.0, 26.0, 24.5]
    value, reference = (over_worlds(angles, "deg") for angles in (first, second))
    welch = stats.ttest_ind(first, second, equal_var=False).confidence_interval(0.95)
    found = difference(value, reference)
    assert (found.value - found.margin, found.value + found.margin) == pytest.approx((welch.low, welch.high))
    share = ratio(value, reference)  # to first order the same, where both are divided by the reference
    assert share.value == pytest.approx(np.mean(first) / np.mean(second))
    assert share.error == pytest.approx(
        np.hypot(value.std / 5**0.5, share.value * reference.std / 3**0.5) / np.mean(second)
    )
    pairs = paired_ratio(over_worlds(np.add(first, [1.0, 2.0, 1.0, 3.0, 2.0]), "deg"), value)
    student = stats.t.interval(0.95, 4, loc=1.8, scale=stats.sem([1.0, 2.0, 1.0, 3.0, 2.0]))
    assert (pairs.value - pairs.margin - 1.0) * 32.0 == pytest.approx(student[0])
    assert paired_ratio(over_worlds([30.0], "deg"), over_worlds([31.0], "deg")) is None


@pytest.mark.parametrize(
    ("low", "high", "said"), [(0.8, 1.1, True), (0.94, 1.1, None), (1.0, 1.1, False), (0.5, 0.6, False)]
)
def test_a_number_lies_between_where_all_of_its_interval_does(low, high, said):
    assert Estimate(0.95, 0.01, 1000).lies(low, high) is said
    assert Estimate(0.95, 0.0, 0).lies(low, high) is None and str(Estimate(0.95, 0.0, 0)) == "0.950"
