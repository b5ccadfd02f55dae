"""Longitudinal strength in still water: boxes in closed form, a second integration, weights that no line has."""

import numpy as np
import pytest
from scipy.integrate import quad

from lab.naval.hull import read_hull
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import prism
from solvers.ship.naval.whole_hull.strength import Extent, still_water
from solvers.ship.section import box
from solvers.ship.water import Water

SEA = Water(1025.0)
LENGTH, G = 100.0, 9.81
BOX = prism(box(16.0, 10.0), LENGTH)


def test_two_weights_at_the_ends_of_a_box_hog_it():
    """Two weights P at a distance a from the ends of a box: b = 2P/L, M(L/2) = P (L/2 − a) − b (L/2)²/2, hogging.

    Between the end and the weight M = −b x²/2; the shear force jumps there from −b a to P − b a.
    """
    mass, a = 2500.0, 10.0
    beam = still_water(BOX, SEA, [Extent("aft", mass, a), Extent("fore", mass, LENGTH - a)])
    force = mass * G
    middle = force * (0.5 * LENGTH - a) - 2.0 * force / LENGTH * LENGTH**2 / 8.0
    assert np.interp(0.5 * LENGTH, beam.x, beam.moment) == pytest.approx(middle, rel=1e-6) and middle > 0.0
    assert beam.most("moment", 1.0) == (pytest.approx(middle, rel=1e-6), pytest.approx(0.5 * LENGTH, abs=0.1))
    assert np.interp(6.0, beam.x, beam.moment) == pytest.approx(-force / LENGTH * 36.0, rel=1e-4)
    assert beam.most("shear", 1.0)[0] == pytest.approx(force * (1.0 - 2.0 * a / LENGTH), rel=1e-6)


def test_a_weight_in_the_middle_of_a_box_sags_it():
    """One weight W over the middle half: M(L/2) = W L/16 − W L/8 = −W L/16, sagging."""
    mass = 6000.0
    beam = still_water(BOX, SEA, [Extent("cargo", mass, 50.0, 25.0, 75.0)])
    value, place = beam.most("moment", -1.0)
    assert value == pytest.approx(-mass * G * LENGTH / 16.0, rel=1e-5) and place == pytest.approx(50.0, abs=0.1)


@pytest.mark.parametrize("centre", [50.0, 47.0])
def test_a_weight_spread_as_the_buoyancy_bends_nothing(centre):
    """Uniform weight on a level box; and a box that trims to a centre aside has a linear buoyancy as the weight is."""
    beam = still_water(BOX, SEA, [Extent("all", 8000.0, centre, 0.0, LENGTH)])
    full = 8000.0 * G * LENGTH
    assert np.abs(beam.moment).max() < 1e-5 * full and np.abs(beam.shear).max() < 1e-5 * full / LENGTH
    assert abs(beam.open_shear) < 1e-9 * full


@pytest.fixture(scope="module")
def ship():
    """S175's lines with a weight all along, one that is skew, one that is short and one at a point."""
    weights = [
        Extent("light", 9000.0, 80.0, 0.0, 175.0),
        Extent("cargo", 14000.0, 92.0, 30.0, 150.0),
        Extent("fuel", 1500.0, 62.0, 50.0, 72.0),
        Extent("engine", 500.0, 30.0),
    ]
    return read_hull("presets/ship/s175.csv").form, weights


def test_load_sums_to_nothing_and_curves_agree_with_a_second_integration(ship):
    """Weights by adaptive quadrature of their rates, buoyancy by trapezia over its own curve on a finer line."""
    form, weights = ship
    beam = still_water(form, SEA, weights)
    total = sum(one.mass for one in weights) * G
    assert abs(beam.open_shear) < 2e-4 * total and abs(beam.open_moment) < 5e-4 * total * 175.0
    spread = np.trapezoid(beam.load, beam.x) + 500.0 * G
    assert abs(spread) < 5e-4 * total
    assert beam.shear[-1] == 0.0 == beam.moment[-1]
    share = (beam.x - beam.x[0]) / np.ptp(beam.x)
    for at in (20.0, 61.0, 88.0, 140.0):
        k = np.searchsorted(beam.x, at)
        x = beam.x[k]
        heavy = sum(_rate(one, x, lambda s, x=x: x - s) for one in weights) + 500.0 * (x - 30.0) * (x > 30.0)
        lift = np.trapezoid((x - beam.x[: k + 1]) * beam.buoyancy[: k + 1], beam.x[: k + 1])
        expected = heavy * G - lift - share[k] * beam.open_moment
        assert beam.moment[k] == pytest.approx(expected, abs=2e-5 * total * 175.0), at
    slope = np.gradient(beam.moment, beam.x)
    inside = np.abs(beam.x - 30.0) > 1.0
    assert np.abs(slope - beam.shear)[inside].max() < 0.01 * np.abs(beam.shear).max()


def _rate(one: Extent, x: float, arm) -> float:
    """∫ (x − s) w(s) ds (t m) aft of x by quadrature."""
    if one.is_point or x <= one.aft:
        return 0.0
    return quad(lambda s: arm(s) * float(one.rate(np.array([s]))[0]), one.aft, min(x, one.forward))[0]


def test_a_skew_weight_keeps_its_mass_and_centre():
    one = Extent("hold", 900.0, 44.0, 30.0, 50.0 + 2.0)
    x = np.linspace(30.0, 52.0, 20001)
    rate = one.rate(x)
    assert rate.min() >= 0.0
    assert np.trapezoid(rate, x) == pytest.approx(900.0) and np.trapezoid(rate * x, x) / 900.0 == pytest.approx(44.0)


def test_a_centre_outside_the_middle_third_is_refused():
    with pytest.raises(Unavailable, match="middle third"):
        Extent("hold", 900.0, 31.0, 30.0, 50.0)
    with pytest.raises(Unavailable, match="forward of its aft end"):
        Extent("hold", 900.0, 31.0, 50.0, 30.0)
