"""The spectrum of Mollon and Zhao (2012): its slopes, and phases drawn at random."""

import numpy as np
import pytest
from scipy import stats

from solvers.grains.shapes.spectrum import draw, spectrum


def test_the_descriptors_follow_power_laws_between_those_given():
    d = spectrum(0.16, 0.07, 0.02, 64, alpha=-1.5, beta=-2.5)
    n = np.arange(1, 65)
    assert len(d) == 64
    assert (d[0], d[1], d[2], d[7]) == (0.0, 0.16, 0.07, 0.02)
    middle, high = slice(2, 7), slice(7, None)
    assert np.diff(np.log2(d[middle])) / np.diff(np.log2(n[middle])) == pytest.approx(np.full(4, -1.5))
    assert np.diff(np.log2(d[high])) / np.diff(np.log2(n[high])) == pytest.approx(np.full(56, -2.5))


def test_the_slopes_are_minus_two_where_none_are_given():
    d = spectrum(0.1, 0.09, 0.04, 16)
    assert d[5] == pytest.approx(0.09 / 4.0)
    assert d[15] == pytest.approx(0.04 / 4.0)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_a_short_spectrum_is_the_beginning_of_a_long_one(count):
    assert spectrum(0.1, 0.09, 0.04, count) == pytest.approx(spectrum(0.1, 0.09, 0.04, 20)[:count])


def test_drawn_outlines_share_descriptors_and_have_uniform_phases():
    d = spectrum(0.16, 0.07, 0.02, 20)
    drawn = [draw(1.0, d, np.random.default_rng(seed)) for seed in range(100)]
    assert all(np.array_equal(contour.descriptors, d) for contour in drawn)
    phases = np.array([contour.phases for contour in drawn])
    assert stats.kstest(phases.ravel(), "uniform", args=(0.0, 2.0 * np.pi)).pvalue > 1e-3
    assert draw(1.0, d, np.random.default_rng(3)) == drawn[3]
