"""Outlines by Fourier descriptors: against quadrature in Cartesian coordinates, closed forms and the disc model."""

import numpy as np
import pytest
from scipy import integrate, optimize, special

from solvers.grains.shapes.contour import Contour
from solvers.machine.errors import BadOutline
from tests.oracles.outlines import ellipse, irregular, star

DENSITY = 1300.0
OFF_CENTRE = Contour(3e-3, (0.5e-3, 0.4e-3, 0.2e-3), (0.3, 1.2, -2.0))


def around(contour, integrand):
    """∮ integrand(y, z, dy/dθ, dz/dθ) dθ, the derivatives by finite differences of the points."""

    def at(angle):
        (y, z), step = contour.points(np.array(angle)), 1e-5
        ahead, behind = contour.points(np.array(angle + step)), contour.points(np.array(angle - step))
        return integrand(y, z, *((ahead - behind) / (2.0 * step)))

    return integrate.quad(at, 0.0, 2.0 * np.pi, limit=200, epsrel=1e-10)[0]


@pytest.mark.parametrize("contour", [OFF_CENTRE, irregular(1), star(5, 0.3)])
def test_area_centroid_and_second_moment_are_those_of_greens_theorem(contour):
    area = around(contour, lambda y, z, dy, dz: 0.5 * (y * dz - z * dy))
    centroid = np.array(
        [
            around(contour, lambda y, z, dy, dz: 0.5 * y**2 * dz) / area,
            around(contour, lambda y, z, dy, dz: -0.5 * z**2 * dy) / area,
        ]
    )
    about_origin = around(contour, lambda y, z, dy, dz: (y**3 * dz - z**3 * dy) / 3.0)
    size = contour.radius
    assert contour.area == pytest.approx(area, rel=1e-8)
    assert contour.centroid == pytest.approx(centroid, abs=1e-8 * size)
    assert contour.polar_moment == pytest.approx(about_origin - area * centroid @ centroid, rel=1e-8, abs=0.0)
    perimeter = around(contour, lambda y, z, dy, dz: np.hypot(dy, dz))
    assert contour.perimeter == pytest.approx(perimeter, rel=1e-8)


def test_an_ellipse_has_its_closed_forms_and_the_inertia_of_an_ellipsoid():
    a, b = 3e-3, 1.2e-3
    contour = ellipse(a, b)
    mass = 4.0 / 3.0 * np.pi * a * b * np.sqrt(a * b) * DENSITY
    assert contour.area == pytest.approx(np.pi * a * b, rel=1e-12, abs=0.0)
    assert contour.perimeter == pytest.approx(4.0 * a * special.ellipe(1.0 - (b / a) ** 2), rel=1e-12, abs=0.0)
    assert contour.polar_moment == pytest.approx(np.pi * a * b * (a**2 + b**2) / 4.0, rel=1e-12, abs=0.0)
    assert contour.mass(DENSITY) == pytest.approx(mass, rel=1e-12, abs=0.0)
    assert contour.inertia(DENSITY) == pytest.approx(mass * (a**2 + b**2) / 5.0, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("radius", [0.5e-3, 1.5e-3, 0.0123])
@pytest.mark.parametrize("harmonics", [0, 7])
def test_a_disc_has_exactly_the_mass_and_inertia_of_the_disc_model(radius, harmonics):
    disc = Contour(radius, [0.0] * harmonics, [1.0] * harmonics)
    mass = 4.0 / 3.0 * np.pi * radius**3 * DENSITY  # as in solvers/grains/state.py, to the bit
    assert disc.mass(DENSITY) == mass
    assert disc.inertia(DENSITY) == mass * radius**2 / 2.5
    assert disc.bounding_radius == disc.smallest_radius == disc.equivalent_radius == radius
    assert disc.spread == 1.0
    assert disc.centred() is disc


def test_mass_and_inertia_are_those_of_the_solid_that_the_docstring_describes():
    contour = irregular(3, radius=2e-3).centred(1e-12)
    r = contour.equivalent_radius
    nodes, weights = np.polynomial.legendre.leggauss(200)
    beta = 0.25 * np.pi * (1.0 + nodes)  # s = sin β: the thickness has no root at the rim
    s, ds = np.sin(beta), 0.25 * np.pi * weights * np.cos(beta)
    angle = 2.0 * np.pi / 2000 * np.arange(2000)
    y, z = np.moveaxis(contour.points(angle)[:, None] * s[:, None], -1, 0)
    cell = contour.polar(angle)[:, None] ** 2 * s * ds * (2.0 * np.pi / 2000)
    mass = DENSITY * 2.0 * np.sqrt(r**2 - (r * s) ** 2) * cell
    assert contour.mass(DENSITY) == pytest.approx(mass.sum(), rel=1e-9, abs=0.0)
    assert contour.inertia(DENSITY) == pytest.approx((mass * (y**2 + z**2)).sum(), rel=1e-9, abs=0.0)


@pytest.mark.parametrize("contour", [irregular(5, 40), irregular(6, 12), OFF_CENTRE.scaled(300.0)])
def test_largest_and_smallest_radius_to_rounding(contour):
    angle = np.linspace(0.0, 2.0 * np.pi, 20_001)
    for sign, found in ((1.0, contour.bounding_radius), (-1.0, contour.smallest_radius)):
        best = angle[(sign * contour.polar(angle)).argmax()]
        polished = optimize.minimize_scalar(
            lambda x, sign=sign: -sign * float(contour.polar(x)),
            bounds=(best - 4e-4, best + 4e-4),
            method="bounded",
            options={"xatol": 1e-9},
        )
        assert sign * found == pytest.approx(-polished.fun, abs=1e-12 * contour.radius)


@pytest.mark.parametrize(("lobes", "tilt"), [(37, 1e-8), (151, 1e-5), (151, 0.0)])
def test_the_largest_of_many_lobes_of_nearly_one_height(lobes, tilt):
    """R = 1 + tilt cos x + 0.1 cos(n x), x = θ + 0.123, n odd: largest at x = 0 and smallest at x = π."""
    descriptors = np.zeros(lobes)
    descriptors[0], descriptors[-1] = tilt, 0.1
    contour = Contour(1.0, descriptors, 0.123 * np.arange(1, lobes + 1))
    assert contour.bounding_radius == pytest.approx(1.1 + tilt, abs=1e-12)
    assert contour.smallest_radius == pytest.approx(0.9 - tilt, abs=1e-12)


def test_a_maximum_so_flat_that_its_curvature_vanishes():
    """R = 1 + 0.4 (cos x − cos(2x)/4), x = θ + 0.123: R'' is zero at its maximum, 1.3."""
    contour = Contour(1.0, (0.4, -0.1), (0.123, 0.246))
    assert contour.bounding_radius == pytest.approx(1.3, abs=1e-12)


def test_slope_normals_and_tangents_follow_from_the_points():
    contour, angle, step = irregular(7), np.linspace(0.0, 6.0, 50), 1e-5
    for order in (1, 2, 3):
        difference = contour.polar(angle + step, order - 1) - contour.polar(angle - step, order - 1)
        assert contour.polar(angle, order) == pytest.approx(difference / (2.0 * step), abs=1e-6)
    chord = contour.points(angle + step) - contour.points(angle - step)
    chord /= np.linalg.norm(chord, axis=-1, keepdims=True)
    assert contour.tangents(angle) == pytest.approx(chord, abs=1e-7)
    assert contour.normals(angle) == pytest.approx(np.stack([chord[:, 1], -chord[:, 0]], axis=-1), abs=1e-7)
    outside = contour.points(angle) + 1e-3 * contour.normals(angle)
    assert np.all(np.hypot(*outside.T) > contour.polar(np.arctan2(outside[:, 1], outside[:, 0])))


def test_scaling_keeps_the_shape():
    contour = irregular(8).with_diameter(6e-3)
    assert contour.area == pytest.approx(np.pi * 9e-6, rel=1e-14, abs=0.0)
    double = contour.scaled(2.0)
    assert double.polar(1.0) == pytest.approx(2.0 * contour.polar(1.0), rel=1e-14, abs=0.0)
    assert double.mass(DENSITY) == pytest.approx(8.0 * contour.mass(DENSITY), rel=1e-13, abs=0.0)
    assert double.inertia(DENSITY) == pytest.approx(32.0 * contour.inertia(DENSITY), rel=1e-13, abs=0.0)


@pytest.mark.parametrize("contour", [OFF_CENTRE, irregular(9, 30), Contour(1.0, (0.6,), (2.0,))])
@pytest.mark.parametrize("error", [1e-4, 1e-9])
def test_centred_is_the_same_outline_about_its_centroid(contour, error):
    centred = contour.centred(error)
    size = contour.radius
    points = centred.points(np.linspace(0.0, 2.0 * np.pi, 3001)) + contour.centroid
    off = np.hypot(*points.T) - contour.polar(np.arctan2(points[:, 1], points[:, 0]))
    assert np.abs(off).max() < 3.0 * error * size  # radially from elsewhere: a little more
    assert np.hypot(*centred.centroid) < error * size
    assert centred.area == pytest.approx(contour.area, rel=2.0 * error, abs=0.0)
    assert centred.inertia(DENSITY) == pytest.approx(contour.inertia(DENSITY), rel=4.0 * error)


def test_an_outline_not_visible_from_its_centroid_cannot_be_centred():
    angle = 2.0 * np.pi / 400 * np.arange(400)
    arms = np.exp(-((angle - 1.0) ** 2) / 0.02) + np.exp(-((angle - 2.5) ** 2) / 0.02)
    with pytest.raises(BadOutline, match="star-shaped"):
        Contour.through(0.2 + 2.0 * arms, 60).centred()


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ((1.0, (0.7, 0.4), (0.0, np.pi)), "falls to"),
        ((-1.0, (), ()), "falls to"),
        ((0.0, (), ()), "falls to"),
        ((1.0, (0.1,), ()), "phase"),
        ((1.0, (float("nan"),), (0.0,)), "finite"),
        ((float("inf"), (), ()), "finite"),
    ],
)
def test_invalid_outlines_are_refused_in_one_sentence(given, says):
    with pytest.raises(BadOutline, match=says) as refused:
        Contour(*given)
    assert str(refused.value).endswith(".")


def test_a_barely_positive_radius_is_a_valid_outline():
    lowest = irregular(10, 20)
    depth = lowest.radius - lowest.smallest_radius
    assert Contour(depth * (1.0 + 1e-9), lowest.descriptors, lowest.phases).smallest_radius > 0.0
    with pytest.raises(BadOutline):
        Contour(depth * (1.0 - 1e-9), lowest.descriptors, lowest.phases)


def test_equal_outlines_are_equal_and_can_be_keys():
    assert len({Contour(1.0, np.array([0.1]), np.array([0.2])), Contour(1.0, (0.1,), (0.2,)), Contour(1.0)}) == 2


def test_the_largest_lever_of_an_ellipses_normal():
    """By a − b, the largest distance of a normal of an ellipse from its centre."""
    a, b = 2.0, 0.5
    spread = (a**2 + b**2) / (2.0 * a * b)
    expected = 1.0 / (1.0 + 2.5 / spread * (a - b) ** 2 / (a * b))
    assert ellipse(a, b).least_mass == pytest.approx(expected, rel=1e-3)
    assert Contour(0.7).least_mass == 1.0


@pytest.mark.parametrize("lobes", [2, 3, 5, 8])
def test_a_star_is_convex_up_to_a_height_of_its_lobes(lobes):
    """Where R = 1 − D is least the curvature is that of 1 − D − n² D."""
    height = 1.0 / (lobes**2 + 1.0)
    assert star(lobes, 0.999 * height).convex
    assert not star(lobes, 1.001 * height).convex


@pytest.mark.parametrize(("n", "depth"), [(5, 0.2), (50, 0.0133)])
def test_the_sharpest_concavity_of_a_wave_is_at_its_deepest_point(n, depth):
    wave = Contour(3e-3, [0.0] * (n - 1) + [3e-3 * depth], [0.0] * n)
    assert wave.sharpest_dent == pytest.approx(3e-3 * (1.0 - depth) ** 2 / ((n * n + 1) * depth - 1.0), rel=1e-6)


def test_ellipses_have_no_dents():
    assert ellipse(1.4, 0.7).sharpest_dent == np.inf
