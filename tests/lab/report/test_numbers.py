"""One way to write numbers: ± for the scatter of beds, and another form for each other thing."""

from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import lab
from lab.measures.value import KINDS, Value, over_worlds
from lab.report.numbers import interval, mean_within, number, plus_minus, with_error

ROOT = Path(lab.__file__).parents[1]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (Value(24.96, "deg", std=1.34), "25.0 ± 1.3 deg"),
        (over_worlds([24.0, 26.0, np.nan], "deg"), "25.0 ± 1.4 deg (2 of 3 beds)"),
        (over_worlds([24.96], "deg", uncertainties=[0.247], kind="detector"), "24.96 deg (1 bed; detector 0.25 deg)"),
        (over_worlds([24.0, 26.0], "deg", uncertainties=[0.2, 0.3], kind="detector"), "25.0 ± 1.4 deg (2 beds)"),
        (Value(1234.5, "mm", std=56.7), "1234 ± 57 mm"),
        (Value(8.44e-6, "µJ", std=4.7e-6), "(8.4 ± 4.7)e-06 µJ"),
        (Value(4.7e-6, "µJ", std=8.44e-4), "(0.0 ± 8.4)e-04 µJ"),
        (Value(99_999.0, "mN", std=1500.0), "99999 ± 1500 mN"),
        (Value(-4.2e9, "mN", std=1.5e8, uncertainty=2e7, kind="fit"), "-4200 ± 150 kN"),
        (over_worlds([3.456e12], "µJ", uncertainties=[2e10], kind="fit"), "3456 kJ (1 bed; fit 20 kJ)"),
        (Value(0.16, "mm", std=7.6e-4), "0.16000 ± 0.00076 mm"),
        (Value(2.25, "1", std=0.5), "2.25 ± 0.50"),
        (Value(1.81144, "d"), "1.811 d"),
        (over_worlds([3.0, 3.0], "1"), "3 ± 0 (2 beds)"),
        (Value(None, "deg"), "none"),
    ],
)
def test_a_number_has_the_digits_that_its_error_allows(value, text):
    assert number(value) == text


def test_each_error_has_a_form_of_its_own():
    assert with_error(3.04, 1.02, "deg") == "3.0 ± 1.0 deg (s.e.)"
    assert with_error(3.04, 1.02, "deg", sign="+") == "+3.0 ± 1.0 deg (s.e.)"
    assert interval(18.2, 23.1, "deg") == "[18.2, 23.1] deg (95 %)"
    assert interval(-np.inf, np.inf) == "[−∞, ∞] (95 %)"
    assert interval(-1.91e-13, 2.1e-13, "mm") == "[-1.9e-13, 2.1e-13] mm (95 %)"
    assert interval(2.0, 2.0, "mm") == "[2.000, 2.000] mm (95 %)"
    assert plus_minus(25.04, 1.34) == "25.0 ± 1.3"
    assert mean_within(31.1, (27.37, 34.83), 1) == "31.1 [27.4, 34.8]" and mean_within(31.1, None, 1) == "31.1"


def test_a_mean_knows_its_error_and_its_interval():
    beds = [20.0, 23.0, 21.0, 26.0]
    value = over_worlds([*beds, np.nan], "deg")
    assert value.n == 4 and value.standard_error == pytest.approx(stats.sem(beds))
    assert value.interval == pytest.approx(stats.t.interval(0.95, 3, np.mean(beds), stats.sem(beds)))
    alone = over_worlds([20.0], "deg", uncertainties=[0.3], kind="detector")
    assert (alone.n, alone.standard_error, alone.interval) == (1, None, None)


def test_every_kind_of_uncertainty_is_explained_on_the_page_on_numbers():
    with pytest.raises(ValueError, match="needs its kind, one of detector, "):
        over_worlds([20.0], "deg", uncertainties=[0.3])
    page = (ROOT / "docs" / "numbers.md").read_text(encoding="utf-8")
    assert all(f"`{kind}`" in page for kind in KINDS)
    for key in Value(1.0, "deg").as_json():
        assert f"`{key}`" in page


def test_numbers_with_plus_minus_are_written_in_one_place():
    """Elsewhere a text may have ± in words, but not between two numbers that it fills in."""
    filled = [path.name for path in (ROOT / "lab").rglob("*.py") if "} ± {" in path.read_text(encoding="utf-8")]
    assert set(filled) == {"written.py"}
