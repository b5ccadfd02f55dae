"""Inverse regression: exact for its own model, with intervals of the stated confidence."""

from math import inf, sqrt

import numpy as np
import pytest
from scipy import stats

from lab.sweeps.inverse import beds_for, crossings, fitted, half_of, misfit, solved

X = np.array([0.1, 0.3, 0.5, 0.7, 0.9])


def measured(x: np.ndarray, beds: int, random: np.random.Generator, scatter=3.0, own=1.0) -> np.ndarray:
    """20 + 30 x − 10 x² with an offset and a slope of each bed's own, and noise: correlated along x, as beds are."""
    offset, tilt = scatter * random.normal(size=(2, beds))
    noise = own * random.normal(size=(len(x), beds))
    return (20 + 30 * x - 10 * x**2)[:, None] + offset + tilt * (x - 0.5)[:, None] + noise


EXACT = 1.5 - sqrt(1.25)  # 30 x − 10 x² = 10


def test_a_parabola_is_inverted_exactly():
    measures = (20 + 30 * X - 10 * X**2)[:, None] + np.array([1.0, -3.0, 2.0])
    response = fitted(X, measures)
    (root,) = crossings(response, 30.0)
    assert root == pytest.approx(EXACT, abs=1e-6)
    found, slope = solved(response, 30.0, root), 30 - 20 * EXACT
    assert found.std == pytest.approx(np.std([1, -3, 2], ddof=1) / slope, rel=1e-4)
    assert found.standard_error == pytest.approx(found.std / sqrt(3), rel=1e-6)
    assert found.beds == 3 and misfit(response, X, measures) == []


def test_beds_of_one_slope_have_students_interval():
    """Straight lines that differ by their offsets alone: x ± t s/(√n slope)."""
    offsets = np.array([1.0, -2.0, 0.5, 0.5])
    measures = (10 + 5 * X)[:, None] + offsets
    found = solved(fitted(X, measures), 12.5, 0.5)
    half = stats.t.ppf(0.975, 3) * offsets.std(ddof=1) / 2 / 5
    assert half > 0.39 and found.interval == pytest.approx((-inf, inf))  # beyond what was run
    found = solved(fitted(X, (10 + 5 * X)[:, None] + 0.1 * offsets), 12.5, 0.5)
    assert found.interval == pytest.approx((0.5 - 0.1 * half, 0.5 + 0.1 * half), abs=4e-4)


@pytest.mark.parametrize("beds", [4, *(pytest.param(n, marks=pytest.mark.slow) for n in (8, 30))])
def test_the_interval_contains_the_value_at_its_confidence_level(beds):
    random, held, trials = np.random.default_rng(beds), 0, 500
    for _ in range(trials):
        response = fitted(X, measured(X, beds, random))
        roots = crossings(response, 30.0)
        low, high = solved(response, 30.0, roots[0]).interval if roots else (-inf, inf)
        held += low <= EXACT <= high
    assert abs(held / trials - 0.95) < 4 * sqrt(0.95 * 0.05 / trials)


def test_an_uncertain_target_widens_the_interval():
    response = fitted(X, measured(X, 20, np.random.default_rng(2)))
    (root,) = crossings(response, 30.0)
    exact, loose = (solved(response, 30.0, root, error) for error in (0.0, 2.0))
    slope = abs(response.slope(root))
    assert loose.standard_error**2 == pytest.approx(exact.standard_error**2 + (2.0 / slope) ** 2)
    assert np.diff(loose.interval) > 1.5 * np.diff(exact.interval)
    assert loose.std == exact.std


def test_the_computed_number_of_beds_gives_the_width():
    for half in (0.02, 0.1, 1.0):
        n = beds_for(half, 0.2)
        assert half_of(n, 0.2) <= half
        assert n == 2 or half_of(n - 1, 0.2) > half
    assert beds_for(1e-6, 1.0) is None and beds_for(0.1, inf) is None


def test_beds_with_missing_values_are_used_partly():
    measures = measured(X, 6, np.random.default_rng(1), own=0.0)
    whole = fitted(X, measures)
    measures[4, 0] = np.nan  # a parabola is determined by the other four
    assert fitted(X, measures).at(X) == pytest.approx(whole.at(X))
    measures[1:3, 1] = np.nan  # three left: still
    measures[1:4, 2] = np.nan  # two: not
    assert fitted(X, measures).beds == 5
    assert fitted(X, np.full((5, 2), np.nan)) is None and fitted(X[:1], measures[:1]) is None


def test_one_bed_has_a_value_and_no_error():
    response = fitted(X, (20 + 30 * X - 10 * X**2)[:, None])
    found = solved(response, 30.0, crossings(response, 30.0)[0])
    assert found.value == pytest.approx(EXACT, abs=1e-6)
    assert (found.standard_error, found.std, found.interval) == (None, None, None)


def test_a_response_that_is_not_a_parabola_is_detected():
    step = np.where(X > 0.6, 10.0, 0.0)[:, None] + measured(X, 8, np.random.default_rng(4), own=0.3)
    assert misfit(fitted(X, step), X, step)


def test_a_parabola_is_rejected_only_by_chance():
    random, refused = np.random.default_rng(5), 0
    for _ in range(400):
        measures = measured(X, 8, random)
        refused += bool(misfit(fitted(X, measures), X, measures))
    assert refused / 400 < 0.05 + 4 * sqrt(0.05 * 0.95 / 400)


def test_a_curve_may_meet_its_target_twice_or_never():
    bow = fitted(X, (-((X - 0.5) ** 2))[:, None])
    assert crossings(bow, -0.04) == pytest.approx([0.3, 0.7], abs=1e-4)
    assert crossings(bow, 1.0) == []
