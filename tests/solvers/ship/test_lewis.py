"""Lewis forms against the panel method and closed forms, strips against the section, and the S175 by another code."""

from math import pi, sqrt

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import prism
from solvers.ship.naval.lewis_hull import Particulars, lewis_hull
from solvers.ship.potential.lewis import Lewis, limits
from solvers.ship.potential.radiation import hydrodynamics
from solvers.ship.potential.strips import abeam, strips
from solvers.ship.section import box
from solvers.ship.water import Water
from tests.oracles import s175

WATER, SALT = Water(), Water(1025.0)
S175 = {"length": 175.0, "breadth": 25.4, "draught": 9.5, "depth": 15.4, "block": 0.569}


def test_limits_of_lewis_forms():
    """Known forms: half circle πa²/2 and 2a²/π; ellipse in heave πa²/2, in roll π(a² − b²)²/16 (Lamb 1932)."""
    circle = Lewis(2.0, 1.0, pi / 4.0)
    assert circle.fast.diagonal() == pytest.approx([2.0 / pi, pi / 2.0, 0.0], abs=1e-4)
    assert circle.slow.diagonal() == pytest.approx([pi / 2.0, 0.0], abs=1e-6)
    ellipse = Lewis(3.0, 1.0, pi / 4.0)  # half axes 1.5 and 1 m
    assert ellipse.fast.diagonal()[1:] == pytest.approx([pi / 2.0 * 1.5**2, pi / 16.0 * (1.5**2 - 1.0) ** 2], rel=1e-9)
    assert ellipse.slow[0, 0] == pytest.approx(pi / 2.0, rel=1e-9)


@pytest.mark.parametrize(("breadth", "fullness"), [(3.0, 0.9), (1.0, 0.7)])
def test_panels_have_the_limits_of_a_lewis_form(breadth, fullness):
    """The map and the panel method share nothing."""
    form = Lewis(breadth, 1.0, fullness)
    section = form.section(2.0, 60)
    assert float(section.immersion(-1.0, 0.0).area) == pytest.approx(fullness * breadth, rel=5e-4)
    found = hydrodynamics(section, WATER, -1.0, [0.02 * sqrt(9.81)], about=(0.0, 1.0), count=120)
    assert found.infinite_added_mass / WATER.density == pytest.approx(form.fast, rel=3e-3, abs=1e-6)
    slow = found.added_mass[0][np.ix_((0, 2), (0, 2))] / WATER.density
    assert slow == pytest.approx(form.slow, rel=3e-3)


def test_fullness_beyond_a_lewis_form_is_refused():
    least, most = limits(1.5)
    Lewis(3.0, 1.0, least), Lewis(3.0, 1.0, most)
    with pytest.raises(Unavailable, match=r"from 0\.393 to 0\.933, not 0\.950"):
        Lewis(3.0, 1.0, 0.95)


def test_strips_of_a_prism_are_its_section():
    """A = L a; pitch and yaw have L³/12 of it, as strips do not disturb each other; and waves lift all at once."""
    section, length = box(0.34, 0.3), 2.0
    whole = strips(prism(section, length), 0.11, WATER, [4.0, 8.0], 0.11)
    alone = hydrodynamics(section, WATER, -0.11, [4.0, 8.0], about=(0.0, 0.11), count=80)
    beside = abeam(whole, length)
    for name in ("added_mass", "damping", "excitation", "haskind", "infinite_added_mass"):
        assert getattr(beside, name) == pytest.approx(getattr(alone, name), rel=1e-9, abs=1e-9)
    turning = length**3 / 12.0
    assert whole.added_mass[:, 4, 4] == pytest.approx(turning * alone.added_mass[:, 1, 1], rel=1e-9)
    assert whole.added_mass[:, 5, 5] == pytest.approx(turning * alone.added_mass[:, 0, 0], rel=1e-9)
    assert np.abs(whole.excitation[:, [0, 4, 5]]).max() < 1e-9 * np.abs(whole.excitation).max()


def test_lewis_hulls_have_their_particulars():
    by_kb = lewis_hull(Particulars(**S175, kb=5.207), 11).hydrostatics(9.5, SALT)
    assert (by_kb.block, by_kb.kb) == pytest.approx((0.569, 5.207), rel=1e-4)
    by_plane = lewis_hull(Particulars(**S175, plane=0.709), 11).hydrostatics(9.5, SALT)
    assert (by_plane.block, by_plane.plane) == pytest.approx((0.569, 0.709), rel=1e-4)
    with pytest.raises(Unavailable, match="the nearest has"):
        lewis_hull(Particulars(**S175, kb=4.0), 11)


def test_strips_of_a_lewis_hull_are_near_those_of_the_lines():
    """12 % in sway and heave: a hull of two powers is not hers."""
    hull = lewis_hull(Particulars(**S175, plane=0.709), 15)
    found = strips(hull, 9.5, SALT, s175.FREQUENCY, 9.55, count=40)
    for ours, theirs in ((found.added_mass, s175.ADDED_MASS), (found.damping, s175.DAMPING)):
        assert ours.diagonal(axis1=1, axis2=2)[:, 1:3] / 1e6 == pytest.approx(theirs[:, :2], rel=0.12)
