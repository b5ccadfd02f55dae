"""Sizes of grains: distributions against their own definitions."""

import numpy as np
import pytest
from scipy import integrate, stats

from solvers.grains.bed.sizes import Sizes, apportion

MANY = 40_000


def normal_reference(spread: float) -> tuple[float, float]:
    """Mean and mean square of 1 + spread x, x normal and cut at ±3 and where 1 + spread x is a tenth, by quadrature."""
    low = max(-3.0, -0.9 / spread)
    weight = integrate.quad(stats.norm.pdf, low, 3.0)[0]
    moments = [
        integrate.quad(lambda x, power=power: (1.0 + spread * x) ** power * stats.norm.pdf(x), low, 3.0)[0] / weight
        for power in (1, 2)
    ]
    return moments[0], moments[1]


@pytest.mark.parametrize("spread", [0.05, 0.2, 0.5])
def test_normal_diameters_have_the_moments_and_the_cuts_of_their_definition(spread):
    sizes = Sizes(((6e-3, 1.0),), spread, normal=True)
    mean, square = normal_reference(spread)
    assert sizes.mean == pytest.approx(6e-3 * mean, rel=1e-9)
    assert sizes.mean_square == pytest.approx(36e-6 * square, rel=1e-9, abs=0.0)
    diameter = 2.0 * sizes.draw(MANY, np.random.default_rng(1))
    assert diameter.mean() == pytest.approx(sizes.mean, rel=4.0 * spread / MANY**0.5)
    assert (diameter**2).mean() == pytest.approx(sizes.mean_square, rel=1e-2)
    low, high = sizes.range
    assert low == pytest.approx(6e-3 * max(0.1, 1.0 - 3.0 * spread))
    assert high == pytest.approx(6e-3 * (1.0 + 3.0 * spread))
    assert low <= diameter.min() and diameter.max() <= high
    assert diameter.max() > 6e-3 * (1.0 + 2.8 * spread)  # the cut is there, and not nearer


def test_a_table_gives_each_class_its_share_to_within_one_grain():
    """The chickpeas of Spandonidis (2016), chapter 9: 35.2 % of 6 mm and 64.8 % of 8 mm."""
    sizes = Sizes(((6e-3, 35.2), (8e-3, 64.8)))
    for count in (1, 2, 3, 100, 1001):
        radius = sizes.draw(count, np.random.default_rng(count))
        assert len(radius) == count
        small = np.sum(radius == 3e-3)
        assert small + np.sum(radius == 4e-3) == count
        assert abs(small - 0.352 * count) < 1.0
    assert sizes.mean == pytest.approx(0.352 * 6e-3 + 0.648 * 8e-3)
    assert sizes.mean_square == pytest.approx(0.352 * 36e-6 + 0.648 * 64e-6)
    assert sizes.range == (6e-3, 8e-3)


def test_a_table_is_shuffled():
    radius = Sizes(((2e-3, 1.0), (4e-3, 1.0))).draw(2000, np.random.default_rng(1))
    runs = 1 + np.sum(radius[1:] != radius[:-1])
    assert runs == pytest.approx(1001, abs=4 * 2000**0.5 / 2)  # as of a fair coin


def test_the_spread_applies_to_each_class():
    sizes = Sizes(((2e-3, 1.0), (6e-3, 1.0)), 0.1)
    diameter = 2.0 * sizes.draw(2000, np.random.default_rng(2))
    small, large = diameter[diameter < 4e-3], diameter[diameter > 4e-3]
    assert len(small) == len(large) == 1000
    for found, mean in ((small, 2e-3), (large, 6e-3)):
        assert (found.min() / mean, found.max() / mean) == (pytest.approx(0.9, abs=2e-3), pytest.approx(1.1, abs=2e-3))
    assert sizes.range == (pytest.approx(1.8e-3), pytest.approx(6.6e-3))
    assert sizes.mean_square == pytest.approx((diameter**2).mean(), rel=5e-3)


@pytest.mark.parametrize("shares", [(1.0,), (1, 1, 1), (0.5, 0.3, 0.2), (1e-6, 1.0), (5, 1, 1, 1, 1, 1)])
def test_apportioned_numbers_are_within_one_of_their_shares(shares):
    shares = np.array(shares) / sum(shares)
    for total in range(50):
        whole = apportion(shares * total)
        assert whole.sum() == total
        assert np.all(np.abs(whole - shares * total) < 1.0)
