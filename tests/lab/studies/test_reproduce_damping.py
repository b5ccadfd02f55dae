"""Which damping a peak of the roll asks for: the balance of power at a resonance, and what is read off scans."""

from math import pi, radians

import numpy as np
import pytest

from lab.studies.reproduce.ships.damping import Barge, Damping, Response, implied, safe

NATURAL = 2.0 * pi / 1.282  # rad/s, the preset's
HEIGHT = 0.055 + 0.34**2 / (12.0 * 0.11) - 0.0926  # m, GM


@pytest.mark.slow
def test_the_damping_of_a_small_peak_is_that_of_the_balance_of_power():
    """W GM k a = B1 ω φ at the natural frequency, and (8/3π) B2 ω² φ² of a quadratic one; waves carry off some more.

    Of 2 mm and 5 deg; B1 is 2 ζ ω I and B2 is b I, and W GM = ω² I.
    """
    barge = Barge([NATURAL - 0.1, NATURAL, NATURAL + 0.1])
    amplitude, peak = 0.002, radians(5.0)
    ship = barge.ships[1]
    carried = ship.radiation.damping[2, 2] / ship.damping.linear
    wanted = 0.5 * NATURAL**2 / 9.81 * amplitude / peak - carried
    tried = [Damping(share * wanted) for share in (0.8, 0.95, 1.05, 1.25)]
    found = implied(tried, barge.responses(tried, amplitude), np.degrees(peak))
    assert found.linear == pytest.approx(wanted, rel=0.05)
    wanted = 3.0 * pi / 8.0 * NATURAL**2 / 9.81 * amplitude / peak**2
    tried = [Damping(0.0, share * wanted) for share in (0.8, 0.95, 1.05, 1.25)]
    found = implied(tried, barge.responses(tried, amplitude), np.degrees(peak))
    assert found.quadratic == pytest.approx(wanted, rel=0.08)


def test_values_derived_from_scans():
    """Between the last peak above and the next; the weakest from which on none capsizes, not the first that stands."""
    tried = [Damping(share) for share in (0.01, 0.02, 0.03, 0.04)]
    scan = [Response(np.array([4.0, 5.0]), np.array(pair)) for pair in ([30, 40], [np.nan, 38], [10, 34], [9, 20])]
    assert implied(tried, scan, 36.0) == Damping(pytest.approx(0.025), 0.0)
    assert implied(tried, scan, 41.0) is None and implied(tried, scan, 15.0) is None
    assert safe(tried, scan) == Damping(0.03)
    assert safe(tried[:2], scan[:2]) is None
    assert scan[1].capsized.tolist() == [4.0] and scan[1].peak == (38.0, 5.0)


def test_texts_on_dampings():
    assert Damping(0.01, 0.05).words == "1 % of the critical and 0.05 per rad"
    assert Damping(0.0, 0.016).words == "0.016 per rad"
