"""Bilge keels' roll damping: integrals by quadrature, a published drag, the authors' own simple formulas."""

import numpy as np
import pytest
from scipy.integrate import quad

from solvers.ship.damping import simple
from solvers.ship.damping.keels import (
    EIGHTH,
    Midship,
    _behind,
    _front,
    bilge_radius,
    drag,
    hull_pressure,
)

S175 = Midship(breadth=25.4, draught=9.5, radius=3.0, fullness=0.95, centre=9.48)
OMEGA, ANGLE = 2.0 * np.pi / 20.0, np.radians(5.0)


def lever(midship: Midship, s: float, up: bool) -> float:
    """Lever (m) of the hull's normal about the axis at a way s (m) from the bilge's middle."""
    radius = midship.radius
    deep, wide = midship.centre - radius, 0.5 * midship.breadth - radius
    if s < EIGHTH * radius:
        turn = EIGHTH - s / radius if up else EIGHTH + s / radius
        found = deep * np.cos(turn) - wide * np.sin(turn)
        return found if up else -found
    return (deep if up else wide) - (s - EIGHTH * radius)


@pytest.mark.parametrize("radius", [0.5, 3.0, 6.0])
@pytest.mark.parametrize("amplitude", [0.02, 0.1, 0.3])
def test_the_pressure_integrals_are_those_of_the_stated_pressure(radius, amplitude):
    midship = Midship(25.4, 9.5, radius, 0.95, 8.0)
    along = 0.3 * np.pi * midship.arm * midship.faster * amplitude + 1.95 * 0.4
    ways = {True: 9.5 - radius + EIGHTH * radius, False: 12.7 - radius + EIGHTH * radius}
    behind = sum(quad(lambda s, u=u: lever(midship, s, u), 0.0, min(along, way))[0] for u, way in ways.items())
    front = sum(
        quad(lambda s, u=u, w=way: lever(midship, s, u) * (1.0 - s / w), 0.0, way, points=[EIGHTH * radius])[0]
        for u, way in ways.items()
    )
    assert _behind(midship, 0.4, amplitude) == pytest.approx(behind, rel=1e-6)
    assert _front(midship) == pytest.approx(front, rel=1e-6)


def procedure(amplitude: float, along: float, power: int, first: float) -> float:
    """Hull pressure (N s per metre) of the S175 in the form of ITTC 7.5-02-07-04.5, with its rounded m₅ and m₆.

    `along`: S₀ (m), more than a quarter of the bilge; `power`: of m₇ in A₀; `first`: m₄³ in B₀, or what stands there.
    """
    half, m1, m2 = 25.4 / 19.0, 3.0 / 9.5, 0.02 / 9.5
    m3, m4 = 1.0 - m1 - m2, half - m1
    both = (half - 0.215 * m1) * (1.0 - 0.215 * m1)
    m5 = (0.414 * half + 0.0651 * m1**2 - (0.382 * half + 0.0106) * m1) / both
    m6 = (0.414 * half + 0.0651 * m1**2 - (0.382 + 0.0106 * half) * m1) / both
    m7 = along / 9.5 - 0.25 * np.pi * m1
    behind = (m3 + m4) * (m7 + 0.414 * m1) - m7**power
    front = first / (3.0 * (half - 0.215 * m1)) + m1 * (m3 * m5 + m4 * m6)
    front += (1.0 - m1) ** 2 * (2.0 * m3 - m2) / (6.0 * (1.0 - 0.215 * m1))
    suction = 22.5 * 0.4 / (np.pi * S175.arm * amplitude) + 1.2
    moment = behind * suction + front * 1.2
    return 4.0 / (3.0 * np.pi) * 1025.0 * S175.arm**2 * 9.5**2 * OMEGA * amplitude * moment


def test_the_procedures_rounded_form_is_the_same():
    amplitude = np.radians(12.0)
    along = 0.3 * np.pi * S175.arm * amplitude + 1.95 * 0.4
    found = hull_pressure(S175, 0.4, OMEGA, amplitude, 1025.0)
    assert found == pytest.approx(procedure(amplitude, along, 2, (12.7 / 9.5 - 3.0 / 9.5) ** 3), rel=2e-3)


def test_the_published_pressure_of_the_s175_is_explained():
    """rolldecay-estimators: 613 760 N s per metre at 5 deg, 20 s, with S₀/b in place of S₀, m₇³, and m₂² for m₄³."""
    published = procedure(ANGLE, 0.3 * np.pi * S175.arm * ANGLE / 0.4 + 1.95, 3, (0.02 / 9.5) ** 2)
    assert published == pytest.approx(6.13760e5, rel=1e-3)
    assert hull_pressure(S175, 0.4, OMEGA, ANGLE, 1025.0) == pytest.approx(2.88e5, rel=0.01)


def test_the_drag_of_the_s175s_keels_is_the_published_one():
    """rolldecay-estimators 0.6 (Alexandersson), tests: 138 498 N s per metre at 5 deg and 20 s. Tolerance 0.1 %."""
    assert drag(S175, 0.4, OMEGA, ANGLE, 1025.0) == pytest.approx(1.38498e5, rel=1e-3)


@pytest.mark.parametrize(
    ("beam", "block", "midship", "below", "frequency", "wide", "long"),
    [
        (2.67, 0.58, 0.95, 0.0, 0.36, 0.016, 0.25),
        (4.0, 0.65, 0.98, -0.2, 0.6, 0.025, 0.2),
        (3.4, 0.61, 0.93, -0.57, 0.29, 0.0125, 0.25),
        (3.0, 0.7, 0.96, -0.5, 0.5, 0.03, 0.3),
        (3.0, 0.8, 0.98, 0.0, 0.5, 0.02, 0.3),
    ],
)
def test_keels_agree_with_the_fit_of_their_authors(beam, block, midship, below, frequency, wide, long):
    """Kawahara, Maekawa and Ikeda (2009) fitted Ikeda's own program: within a quarter at 5 to 15 deg."""
    breadth, length, density, gravity = 25.0, 160.0, 1025.0, 9.81
    draught = breadth / beam
    section = Midship(breadth, draught, bilge_radius(breadth, draught, midship), midship, draught * (1.0 - below))
    omega = frequency / np.sqrt(0.5 * breadth / gravity)
    unit = density * length * breadth * draught * block * breadth**2 * np.sqrt(2.0 * gravity / breadth)
    ratios = simple.Ratios(beam, block, midship, below, frequency, wide, long)
    for turn in (5.0, 10.0, 15.0):
        angle = np.radians(turn)
        parts = [part(section, wide * breadth, omega, angle, density) for part in (drag, hull_pressure)]
        found = sum(parts) * long * length / unit
        assert found == pytest.approx(simple.keels(ratios, turn), rel=0.25)
