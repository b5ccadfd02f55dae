"""Roll damping by components: the simple formulas against their authors' program, a decomposition, fits."""

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.ship.damping import simple
from solvers.ship.damping.components import (
    NAMES,
    Particulars,
    Slice,
    components,
    eddies,
    friction,
    linear_quadratic,
)
from solvers.ship.damping.keels import EQUIVALENT, Keels
from solvers.ship.viscous import eddy_coefficient, friction_damping

OMEGA = 2.0 * np.pi / 20.0
S175 = Particulars(175.0, 25.4, 9.5, 0.58, 0.95, 9.48, Keels(0.4, 43.75), 3.0)


def test_the_simple_formulas_give_what_their_authors_program_gives():
    """Its total for L/B 6, B/d 4, Cb 0.65, Cm 0.98, OG/d −0.2, ω̂ 0.6, keels 0.025 B by 0.2 L, 10 deg: 0.0101561488.

    As rolldecay-estimators' tests have it, from the Fortran of 2009. Its laminar friction is 1.488e-5. Tolerance 0.1 %.
    """
    ship = simple.Ratios(4.0, 0.65, 0.98, -0.2, 0.6, 0.025, 0.2)
    ship.require()
    whole = simple.waves(ship) + simple.eddies(ship, 10.0) + simple.keels(ship, 10.0) + 1.488e-5
    assert whole == pytest.approx(0.0101561488, rel=1e-3)


@pytest.mark.parametrize(
    ("ratios", "said"),
    [
        (simple.Ratios(5.0, 0.65, 0.98, -0.2, 0.6), "B/d"),
        (simple.Ratios(4.0, 0.45, 0.98, -0.2, 0.6), "block"),
        (simple.Ratios(4.0, 0.65, 0.98, 0.3, 0.6), "OG/d"),
        (simple.Ratios(4.0, 0.65, 0.98, 0.0, 0.6, 0.001, 0.2), "keel breadth"),
    ],
)
def test_the_simple_formulas_refuse_what_they_do_not_cover(ratios, said):
    with pytest.raises(Unavailable, match=said):
        ratios.require()


def test_keels_are_most_of_the_s175s_damping():
    """At 5 deg and 20 s: keels three quarters or more beside friction and the waves of the published 1.48 MN m s.

    The published sum (rolldecay-estimators, S175 without eddies) is 39.4 MN m s with 84 % keels. There the suction
    reaches over 5.0 m, as S₀/b is not multiplied by b (here 2.0 m), two powers in A₀ and B₀ are others, and the waves,
    5.69 MN m s, have a factor of 3.8 for a speed of zero. Without these 18.5 ± 1 MN m s of keels are expected.
    """
    found = components(S175, OMEGA, [np.radians(5.0)], [Slice(1.0, 1.0, 1.0, 0.8)], waves=1.481e6)[0]
    keels, bare = found[3:].sum(), found[[0, 2]].sum()
    assert 0.75 < keels / (keels + bare) < 0.95
    assert keels == pytest.approx(18.5e6, abs=1.0e6)


def test_eddies_of_a_prism_are_those_of_its_section():
    prism = Particulars(100.0, 20.0, 8.0, 0.97, 0.97, 7.0)
    area = 0.97 * 20.0 * 8.0
    radius = np.sqrt(0.03 * 160.0 / (2.0 - 0.5 * np.pi))
    one = eddies(prism, [Slice(100.0, 20.0, 8.0, area)], 0.5, 0.2)
    expected = 0.5 * 1025.0 * 8.0**4 * eddy_coefficient(20.0, 8.0, radius, 7.0) * EQUIVALENT * 0.5 * 0.2 * 100.0
    assert one == pytest.approx(expected, rel=1e-9)


def test_friction_of_a_model_is_nearly_laminar():
    """Kato's formula for small speeds, and more for a ship, whose layer is turbulent."""
    model = Particulars(2.0, 0.4, 0.2, 0.95, 0.95, 0.15)
    laminar = friction_damping(0.4, 0.2, np.sqrt(0.05 * 0.08 / (2.0 - 0.5 * np.pi)), 0.15, 4.0, 1025.0) * 2.0
    assert friction(model, 4.0, 1e-4) == pytest.approx(laminar, rel=0.01)
    assert friction(S175, OMEGA, 0.2) > 1.5 * friction(S175, OMEGA, 1e-6)


def test_linear_and_quadratic_terms_are_found():
    amplitudes = np.radians([3.0, 10.0, 25.0])
    damping = 4.0e6 + EQUIVALENT * OMEGA * amplitudes * 3.0e8
    linear, quadratic, off = linear_quadratic(OMEGA, amplitudes, damping)
    assert linear == pytest.approx(4.0e6) and quadratic == pytest.approx(3.0e8) and off < 1e-9


def test_no_keels_no_damping_of_keels():
    bare = Particulars(175.0, 25.4, 9.5, 0.58, 0.95, 9.48)
    found = dict(zip(NAMES, components(bare, OMEGA, [0.1])[0], strict=True))
    assert found["keel drag"] == found["keel pressure"] == 0.0
    assert min(found["friction"], found["eddies"], found["waves"]) > 0.0
