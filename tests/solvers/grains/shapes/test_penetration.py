"""Overlaps of placed outlines: closed forms of discs, ellipses by another solver, the source's nodes, symmetry."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import optimize

from solvers.grains.shapes.contour import Contour
from solvers.machine.errors import BadOutline
from tests.oracles.crossing import Placed
from tests.oracles.outlines import ellipse, ellipse_radius, irregular, star
from tests.oracles.overlap_area import area_contacts
from tests.oracles.penetration import penetrations

AXES = ((1.0, 0.5), (1.4, 0.6))  # of two ellipses


def moved(placed, y, z):
    return replace(placed, y=placed.y + y, z=placed.z + z)


def random_pair(seed):
    """Two irregular outlines, most of which overlap slightly."""
    random = np.random.default_rng(seed)
    direction = random.uniform(0.0, 2.0 * np.pi)
    apart = random.uniform(1.7, 2.1)
    return (
        Placed(irregular(2 * seed, 9), 0.3, -0.2, random.uniform(0.0, 6.0)),
        Placed(
            irregular(2 * seed + 1, 9),
            0.3 + apart * np.cos(direction),
            -0.2 + apart * np.sin(direction),
            random.uniform(0.0, 6.0),
        ),
    )


PAIRS = [random_pair(seed) for seed in range(8)]


@pytest.mark.parametrize("radii", [(1.0, 1.0), (1.0, 3.0), (0.2, 1.0)])
@pytest.mark.parametrize("overlap", [0.1, 1e-3, 1e-8])
def test_discs(radii, overlap):
    r, s = radii
    distance, direction = r + s - overlap, np.array([np.cos(2.2), np.sin(2.2)])
    first, second = (
        Placed(Contour(r), 1.0, 2.0, 0.4),
        Placed(Contour(s), *(np.array([1.0, 2.0]) + distance * direction), 1.0),
    )
    (contact,) = penetrations(first, second)
    assert contact.overlap == pytest.approx(overlap, abs=2e-15)
    assert contact.normal == pytest.approx(-direction, abs=1e-7)
    deepest = distance - s if not contact.of_first else r
    assert contact.point == pytest.approx(np.array([1.0, 2.0]) + deepest * direction, abs=1e-7)
    (shared,) = area_contacts(first, second)
    half_r, half_s = (np.arccos((distance**2 + a**2 - b**2) / (2.0 * distance * a)) for a, b in ((r, s), (s, r)))
    lens = sum(a**2 * (half - np.sin(2.0 * half) / 2.0) for a, half in ((r, half_r), (s, half_s)))
    assert shared.area == pytest.approx(lens, rel=1e-7, abs=1e-16)
    assert shared.width == pytest.approx(2.0 * r * np.sin(half_r), rel=1e-7)
    assert shared.normal == pytest.approx(-direction, abs=1e-9)
    middle = r * np.cos(half_r)
    assert shared.point == pytest.approx(np.array([1.0, 2.0]) + middle * direction, abs=1e-9)


def turned(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def depth_in_ellipse(point, a, b, centre, angle):
    own = turned(angle).T @ (point - centre)
    return ellipse_radius(a, b, np.arctan2(own[1], own[0])) - np.hypot(*own)


def deepest_in_ellipse(inner, outer):
    """Overlap and normal by constrained optimisation on the implicit equations; each is (a, b, centre, angle)."""
    a, b, centre, angle = inner

    def implicit(point):
        own = turned(angle).T @ (point - centre)
        return (own[0] / a) ** 2 + (own[1] / b) ** 2 - 1.0

    t = np.linspace(0.0, 2.0 * np.pi, 100)
    around = centre + np.stack([a * np.cos(t), b * np.sin(t)], axis=1) @ turned(angle).T
    start = max(around, key=lambda point: depth_in_ellipse(point, *outer))
    found = optimize.minimize(
        lambda point: -depth_in_ellipse(point, *outer),
        start,
        method="SLSQP",
        constraints={"type": "eq", "fun": implicit},
        options={"ftol": 1e-15, "maxiter": 500},
    )
    a, b, centre, angle = outer
    own = turned(angle).T @ (found.x - centre)
    rim = own / np.hypot(*own) * ellipse_radius(a, b, np.arctan2(own[1], own[0]))
    gradient = np.array([rim[0] / a**2, rim[1] / b**2])
    normal = gradient / np.hypot(*gradient)
    return normal @ (rim - own), turned(angle) @ normal


def ellipses_shared_area(first, second):
    """By the intervals that either ellipse covers at each y."""

    y = np.linspace(-3.0, 3.0, 1_000_001)

    def interval(ellipse):
        a, b, centre, angle = ellipse
        form = turned(angle) @ np.diag([a**-2, b**-2]) @ turned(angle).T
        u = y - centre[0]
        half = np.sqrt((form[0, 1] * u) ** 2 - form[1, 1] * (form[0, 0] * u**2 - 1.0))  # NaN beside the ellipse
        return [centre[1] + (-form[0, 1] * u + sign * half) / form[1, 1] for sign in (-1.0, 1.0)]

    with np.errstate(invalid="ignore"):
        (low, high), (bottom, top) = interval(first), interval(second)
        height = np.minimum(high, top) - np.maximum(low, bottom)
    return (y[1] - y[0]) * height[height > 0.0].sum()


@pytest.mark.parametrize("seed", range(4))
def test_ellipses_against_an_independent_solver(seed):
    random = np.random.default_rng(seed)
    angles, direction = random.uniform(0.0, 2.0 * np.pi, 2), random.uniform(0.0, 2.0 * np.pi)
    towards = np.array([np.cos(direction), np.sin(direction)])
    reach = [
        ellipse_radius(*axes, way - angle)
        for axes, way, angle in zip(AXES, (direction, direction + np.pi), angles, strict=True)
    ]
    centres = np.zeros(2), 0.93 * sum(reach) * towards
    given = [(*axes, centre, angle) for axes, centre, angle in zip(AXES, centres, angles, strict=True)]
    first, second = (Placed(ellipse(a, b), *centre, angle) for a, b, centre, angle in given)
    (contact,) = penetrations(first, second)
    (into_second, normal), (into_first, other) = deepest_in_ellipse(*given), deepest_in_ellipse(*given[::-1])
    assert contact.of_first == (into_second > into_first)
    assert contact.overlap == pytest.approx(max(into_second, into_first), rel=1e-7)
    assert contact.normal == pytest.approx(normal if contact.of_first else -other, abs=1e-6)
    (shared,) = area_contacts(first, second)
    assert shared.area == pytest.approx(ellipses_shared_area(*given), abs=1e-7)


def deepest_node(inner, outer, count):
    """Table 8.1 of the source, one direction: overlap of the deepest of `count` nodes."""
    node = inner.place(2.0 * np.pi / count * np.arange(count))
    own = outer.seen(node)
    depth = outer.contour.polar(np.angle(own)) - np.abs(own)
    k = depth.argmax()
    radius, slope = outer.contour.polar(np.angle(own[k])), outer.contour.polar(np.angle(own[k]), 1)
    return depth[k] * radius / np.hypot(radius, slope)


def test_the_deepest_node_converges_with_the_number_of_nodes():
    """Within half a step h of the deepest point the depth is less by some h², and the tangent turned by some h."""
    touching = [(pair, contacts[0].overlap) for pair in PAIRS if (contacts := penetrations(*pair))]
    assert len(touching) > 4
    for count in (100, 1600, 25600):
        step = 2.0 * np.pi / count
        for (first, second), overlap in touching:
            nodes = max(deepest_node(first, second, count), deepest_node(second, first, count))
            assert nodes == pytest.approx(overlap, abs=step * (2.0 * step + overlap))


@pytest.mark.parametrize("pair", PAIRS)
def test_swapped_grains_give_the_same_contacts_with_opposite_normals(pair):
    for rule in (penetrations, area_contacts):
        there, back = rule(*pair), rule(*pair[::-1])
        assert len(there) == len(back)
        for one, other in zip(there, back, strict=True):
            assert other.normal == pytest.approx(-np.array(one.normal), abs=1e-8)
            assert other.point == pytest.approx(one.point, abs=1e-9)
    for one, other in zip(penetrations(*pair), penetrations(*pair[::-1]), strict=True):
        assert other.overlap == pytest.approx(one.overlap, abs=1e-12)
        assert other.of_first != one.of_first
    for one, other in zip(area_contacts(*pair), area_contacts(*pair[::-1]), strict=True):
        assert (other.area, other.width) == pytest.approx((one.area, one.width), abs=1e-10)


def turned_about_origin(placed, angle):
    y, z = turned(angle) @ [placed.y, placed.z]
    return Placed(placed.contour, y, z, placed.angle + angle)


def mirrored(placed):
    """y → −y: R(π − θ) in place of R(θ), and the angle the other way."""
    contour = placed.contour
    n = np.arange(1, len(contour.phases) + 1)
    there = Contour(contour.radius, contour.descriptors, -np.array(contour.phases) - n * np.pi)
    return Placed(there, -placed.y, placed.z, -placed.angle)


@pytest.mark.parametrize("pair", PAIRS[:4])
@pytest.mark.parametrize(
    ("change", "matrix"),
    [
        (lambda placed: turned_about_origin(placed, 1.1), turned(1.1)),
        (mirrored, np.diag([-1.0, 1.0])),
        (lambda placed: replace(placed, angle=placed.angle - 2.0 * np.pi), np.eye(2)),
    ],
)
def test_contacts_turn_and_mirror_with_their_grains(pair, change, matrix):
    for rule, size in ((penetrations, "overlap"), (area_contacts, "area")):
        before, after = rule(*pair), rule(*map(change, pair))
        assert len(before) == len(after)
        for one, other in zip(before, after, strict=True):
            assert getattr(other, size) == pytest.approx(getattr(one, size), abs=1e-12)
            assert other.normal == pytest.approx(matrix @ one.normal, abs=1e-8)
            assert other.point == pytest.approx(matrix @ one.point, abs=1e-9)


def test_a_shift_of_both_changes_nothing():
    first, second = PAIRS[0]
    (before, *_), (after, *_) = (
        penetrations(first, second),
        penetrations(moved(first, 0.5, 4.0), moved(second, 0.5, 4.0)),
    )
    assert after.overlap == pytest.approx(before.overlap, abs=1e-13)
    assert after.point == pytest.approx(np.add(before.point, (0.5, 4.0)), abs=1e-10)


def test_two_stars_that_touch_with_two_lobes_have_two_contacts():
    """Lobes at ±36° of either meet those of the other, tip to tip, in the middle between the two."""
    first = Placed(star(5, 0.25), 0.0, 0.0, np.pi / 5.0)
    outline = first.place(np.linspace(-1.0, 1.0, 100_001))
    tip = outline[outline.real.argmax()]
    apart = 2.0 * tip.real - 0.02
    second = Placed(star(5, 0.25), apart, 0.0, 0.0)
    contacts = penetrations(first, second)
    assert len(contacts) == 2
    assert contacts[0].overlap == pytest.approx(contacts[1].overlap, abs=1e-13)
    assert contacts[0].overlap == pytest.approx(0.02, rel=0.02)  # along a normal that leans a little
    heights = sorted(contact.point[1] for contact in contacts)
    assert heights == pytest.approx([-abs(tip.imag), abs(tip.imag)], abs=0.05)
    for shared in area_contacts(first, second):
        assert shared.normal == pytest.approx((-1.0, 0.0), abs=1e-9)
        assert shared.point[0] == pytest.approx(0.5 * apart, abs=1e-10)
    gap = moved(second, 0.02 + 1e-9, 0.0)
    assert penetrations(first, gap) == ()
    assert len(penetrations(first, moved(second, 0.02 - 1e-9, 0.0))) == 2


def test_a_lobe_in_a_concavity_has_a_contact_on_either_side():
    """A disc, a little too wide for the hollow between two lobes, hangs on both."""
    first, second = Placed(star(5, 0.25), 0.0, 0.0, np.pi / 5.0), Placed(Contour(0.75), 1.55, 0.0, 0.0)
    low, high = sorted(penetrations(first, second), key=lambda contact: contact.point[1])
    assert low.point == pytest.approx((high.point[0], -high.point[1]), abs=1e-10)
    assert low.normal == pytest.approx((high.normal[0], -high.normal[1]), abs=1e-10)
    assert high.normal[1] > 0.1 and low.overlap == pytest.approx(high.overlap, abs=1e-13)


def test_overlaps_vanish_linearly_as_the_outlines_separate():
    first, second = Placed(ellipse(1.0, 0.5), 0.0, 0.0, 0.7), Placed(ellipse(1.4, 0.6), 1.2, 0.9, -0.3)

    def contact_at(shift, rule):
        found = rule(first, moved(second, shift, 0.0))
        return found[0] if found else None

    near, far = 0.0, 2.0  # in contact, and not
    while far - near > 1e-15:
        middle = 0.5 * (near + far)
        if middle in (near, far):
            break
        near, far = (middle, far) if contact_at(middle, penetrations) else (near, middle)
    push = -contact_at(near - 1e-6, penetrations).normal[0]
    for step in (1e-4, 1e-7, 1e-10):
        contact = contact_at(near - step, penetrations)
        assert contact.overlap == pytest.approx(push * step, rel=20.0 * step**0.5, abs=1e-14)
    areas = [contact_at(near - step, area_contacts) for step in (4e-6, 1e-6)]
    assert areas[0].area / areas[1].area == pytest.approx(8.0, rel=1e-2)
    assert areas[0].width / areas[1].width == pytest.approx(2.0, rel=1e-2)
    assert areas[1].normal == pytest.approx(contact_at(near - 1e-6, penetrations).normal, abs=1e-2)
    assert contact_at(far + 1e-12, penetrations) is None


@pytest.mark.parametrize(
    "pair", [*PAIRS, (Placed(ellipse(1.5, 0.4), 0.0, 0.0, 0.2), Placed(ellipse(1.4, 0.3), 0.1, 0.3, 1.5))]
)
def test_width_normal_and_point_are_the_gradient_of_the_area(pair):
    """As the first grain moves by u and turns by φ about its centre c, dA = −Σ width (n · u + ((point − c) × n) φ)."""
    first, second = pair
    step = 1e-5

    def area(y, z, angle):
        changed = replace(moved(first, y, z), angle=first.angle + angle)
        return sum(contact.area for contact in area_contacts(changed, second))

    contacts = area_contacts(first, second)
    gradient = [(area(*(step * unit)) - area(*(-step * unit))) / (2.0 * step) for unit in np.eye(3)]
    expected = np.zeros(3)
    for contact in contacts:
        (y, z), (ny, nz) = contact.point, contact.normal
        turn = (y - first.y) * nz - (z - first.z) * ny
        expected -= contact.width * np.array([ny, nz, turn])
    assert gradient == pytest.approx(expected, abs=1e-6)


def test_crossed_needles_overlap_in_one_region_without_a_force():
    first, second = Placed(ellipse(2.0, 0.5), 0.0, 0.0, 0.0), Placed(ellipse(2.0, 0.5), 0.0, 0.0, 0.5 * np.pi)
    (shared,) = area_contacts(first, second)
    given = [(2.0, 0.5, np.zeros(2), 0.0), (2.0, 0.5, np.zeros(2), 0.5 * np.pi)]
    assert shared.area == pytest.approx(ellipses_shared_area(*given), abs=1e-7)
    assert shared.width == pytest.approx(0.0, abs=1e-12)
    assert len(penetrations(first, second)) == 1


def test_a_grain_inside_another_is_refused():
    small, large = Placed(Contour(0.2), 0.1, 0.0, 0.0), Placed(ellipse(1.0, 0.8), 0.0, 0.0, 0.0)
    for pair in ((small, large), (large, small)):
        with pytest.raises(BadOutline, match="inside"):
            penetrations(*pair)
    assert penetrations(moved(small, 3.0, 0.0), large) == ()
