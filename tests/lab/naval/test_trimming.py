"""Unevenness of a cargo's surface: known heaps of grains, and the IMSBC Code's criterion met and missed."""

import numpy as np
import pytest

from lab.measures.ship_unevenness import unevenness
from solvers.ship.naval.trimming import criterion, unevenness_limit

RADIUS, WIDTH = 0.1, 24.0
HOLD = np.array([[-12.0, 0.0], [12.0, 0.0], [12.0, 14.0], [-12.0, 14.0]])


def heap(slope: float) -> tuple[np.ndarray, np.ndarray]:
    """Columns of grains, one a diameter, whose tops rise to starboard by a slope."""
    y = np.arange(-12.0 + RADIUS, 12.0, 2.0 * RADIUS)
    tops = 4.0 + slope * y
    places = [(a, z) for a, top in zip(y, tops, strict=True) for z in np.arange(top - RADIUS, 0.0, -2.0 * RADIUS)]
    return np.array(places), np.full(len(places), RADIUS)


@pytest.mark.parametrize("degrees", [0.0, 2.0, 8.0])
def test_slope_times_breadth(degrees):
    """Between the middles of the outermost three columns of two diameters each."""
    slope = np.tan(np.radians(degrees))
    assert unevenness(*heap(slope), HOLD) == pytest.approx(slope * (WIDTH - 6.0 * 2.0 * RADIUS), abs=1e-9)


def test_single_grain_on_top_counts_a_third():
    position, radius = heap(0.0)
    position = np.vstack([position, [0.0, 4.0 + RADIUS]])
    assert unevenness(position, np.append(radius, RADIUS), HOLD) == pytest.approx(2.0 * RADIUS / 3.0, rel=1e-9)


def test_spilled_grains_do_not_count():
    position, radius = heap(0.1)
    out = np.vstack([position, [20.0, 9.0]])
    assert unevenness(out, np.append(radius, RADIUS), HOLD) == unevenness(position, radius, HOLD)
    assert np.isnan(unevenness(np.array([[20.0, 9.0]]), np.array([RADIUS]), HOLD))


def test_limits_of_the_code():
    """As grain up to 30 deg; a tenth of the breadth, and 1.5 m up to 35 deg, 2 m beyond."""
    limits = {
        (30.0, 27.0): None,
        (33.0, 27.0): 1.5,
        (35.0, 27.0): 1.5,
        (36.0, 27.0): 2.0,
        (36.0, 12.0): 1.2,
        (33.0, 12.0): 1.2,
    }
    assert {given: unevenness_limit(np.radians(given[0]), given[1]) for given in limits} == pytest.approx(limits)


def test_criterion_met_and_missed():
    steep = np.radians(36.0)
    assert criterion(1.9, steep, 27.0).passed and not criterion(2.1, steep, 27.0).passed
    assert criterion(9.0, np.radians(25.0), 27.0) is None
