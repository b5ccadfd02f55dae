"""Contact rules of outlines in kernels: all nodes, other solvers, closed forms, symmetry, and energy in collisions."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage, optimize

from solvers.grains.shapes.cargo import cargo, cargoes
from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.tables import ERROR, angle_of, cells_for, curve_cells, polar_cells
from solvers.machine.errors import BadOutline
from tests.oracles.crossing import depth
from tests.oracles.outlines import ellipse, irregular, star
from tests.oracles.penetration import penetrations
from tests.oracles.shape_collisions import Collisions
from tests.oracles.shape_kernels import Asked, Pairs, orientations, random_pairs

COUNT, SOME = 2000, 120  # pairs; those that are looked at one by one
NODES = 100
SKIN = 0.1
SHALLOW = 0.05
FOLLOWED = 64  # steps


def mirrored(contour):
    """R(π − θ) in place of R(θ)."""
    n = np.arange(1, len(contour.phases) + 1)
    return Contour(contour.radius, contour.descriptors, -np.array(contour.phases) - n * np.pi)


def outline_of(name):
    return cargo(name).outline(np.random.default_rng(7), 2.0)


HALF = [star(5, 0.25), irregular(3, 9), outline_of("rice"), outline_of("corn"), outline_of("sand")]
OUTLINES = [*HALF, *(mirrored(outline) for outline in HALF)]
MIRROR = np.roll(np.arange(len(OUTLINES)), len(HALF))
DISC = Contour(1.0)
AXES = np.array([(1.0, 0.5), (1.4, 0.6), (0.8, 0.8)])


@pytest.fixture(scope="module")
def asked():
    """With a disc, the last of them: its kernels are those of the outlines."""
    return Asked([*OUTLINES, DISC], COUNT, NODES)


@pytest.fixture(scope="module")
def pairs():
    return random_pairs(OUTLINES, COUNT, 1, (-0.005, 0.02))


@pytest.fixture(scope="module")
def shallow(asked, pairs):
    """Which pairs overlap no deeper than grains may: beyond, one contact may have become another's far side."""
    return asked.by_nodes(pairs)[:, 0] < SHALLOW


@pytest.mark.parametrize("name", cargoes())
def test_tables_follow_the_outline_of_every_cargo(name):
    outline = outline_of(name)
    count = cells_for([outline])
    place = np.random.default_rng(2).uniform(0.0, count, 4000)
    cell, along = place.astype(int), place % 1.0
    powers = along[:, None] ** np.arange(4)
    curve, radii = curve_cells(outline, count)[cell], polar_cells(outline, count)[cell]
    points = np.stack([(curve[:, :4] * powers).sum(axis=1), (curve[:, 4:] * powers).sum(axis=1)], axis=-1)
    assert np.abs(points - outline.points(2.0 * np.pi * place / count)).max() < 1.05 * ERROR * outline.radius
    assert np.abs((radii * powers).sum(axis=1) - outline.polar(angle_of(place, count))).max() < 1.05 * ERROR


def test_an_outline_that_no_table_can_resolve_is_refused():
    with pytest.raises(BadOutline, match="sharply"):
        cells_for([Contour(1.0, [0.0] * 199 + [0.5], [0.0] * 200)])


def deepest_of_all(inner, outer):
    """Overlap, the outer outline's normal and the node, by the source's table 8.1 over all nodes."""
    node = inner.place(2.0 * np.pi / NODES * np.arange(NODES))
    own = outer.seen(node)
    depth = outer.contour.polar(np.angle(own)) - np.abs(own)
    k = depth.argmax()
    radius, slope = outer.contour.polar(np.angle(own[k])), outer.contour.polar(np.angle(own[k]), 1)
    return depth[k] * radius / np.hypot(radius, slope), complex(outer.normal(np.angle(own[k]))), node[k]


def by_all_nodes(first, second):
    there, back = deepest_of_all(first, second), deepest_of_all(second, first)
    overlap, normal, point = max(there, back, key=lambda found: found[0])
    if overlap <= 0.0:
        return np.zeros(5)
    normal = normal if there[0] >= back[0] else -normal
    point = point - complex(first.y, first.z)
    return np.array([overlap, normal.real, normal.imag, point.real, point.imag])


def test_few_nodes_are_evaluated_but_the_deepest_is_found(asked, pairs):
    expected = np.array([by_all_nodes(*pairs.placed(OUTLINES, k)) for k in range(SOME)])
    found = asked.by_nodes(pairs)[:SOME]
    assert 25 < (expected[:, 0] > 0.0).sum() < SOME
    # The tables' errors in radii of up to 2, in slopes, and in the choice between nodes equally deep.
    assert np.abs(np.maximum(found[:, 0], 0.0) - expected[:, 0]).max() < 8.0 * ERROR
    same = np.abs(found[:, 3:] - expected[:, 3:]).max(axis=1) < 1e-5
    assert same.sum() > SOME - 2
    assert np.abs(found - expected)[same, 1:].max() < 1e-3


def least_gap(inner, outer):
    """The least distance of one outline's nodes from many points of the other."""
    node = inner.place(2.0 * np.pi / NODES * np.arange(NODES))
    return np.abs(node[:, None] - outer.place(2.0 * np.pi / 2000 * np.arange(2000))).min()


def test_without_overlap_no_gap_is_smaller_than_the_reported_bound(asked):
    open_pairs = random_pairs(OUTLINES, COUNT, 6, (0.0, 0.03))
    said = -asked.by_nodes(open_pairs)[:SOME, 0]
    shut = np.flatnonzero(said > 0.0)
    placed = [open_pairs.placed(OUTLINES, k) for k in shut]
    gaps = np.array([min(least_gap(first, second), least_gap(second, first)) for first, second in placed])
    assert len(shut) > 30
    assert (said[shut] < gaps + 8.0 * ERROR).all()
    assert np.median(said[shut] / gaps) > 0.3  # else it would be of no use


def test_the_deepest_nodes_are_tracked_as_grains_slide_and_turn(asked):
    """Of convex grains, farther than the rule goes before it looks at all nodes; then few have been lost."""
    convex = [k for k, outline in enumerate(OUTLINES) if outline.convex]
    pairs = random_pairs([OUTLINES[k] for k in convex], COUNT, 1, (-0.01, 0.0))
    pairs = replace(pairs, shape=np.array(convex)[pairs.shape])
    random, first = np.random.default_rng(5), asked.by_nodes(pairs)[:, 0]
    start = asked.node.to_numpy()
    shift, spin = random.uniform(-5e-5, 5e-5, pairs.place.shape), random.uniform(-1e-3, 1e-3, pairs.angle.shape)
    for k in range(1, FOLLOWED):
        moved = replace(pairs, place=pairs.place + k * shift, angle=pairs.angle + k * spin)
        followed = asked.by_nodes_beside(moved)[:, 0]
    gone = np.abs(asked.node.to_numpy() - start).max(axis=1)
    deepest = asked.by_nodes(moved)[:, 0]
    touching = (first > 0.0) & (deepest > 0.0) & (deepest < SHALLOW)
    assert touching.sum() > 100
    assert (gone[touching] > 0).mean() > 0.5
    assert (np.abs(followed - deepest)[touching] > 1e-12).mean() < 0.1


def disc_pairs():
    random = np.random.default_rng(4)
    scale = random.uniform(0.5, 2.0, (COUNT, 2))
    distance = scale.sum(axis=1) * (1.0 - random.choice([1e-2, 1e-4, 1e-6], COUNT))
    way = random.uniform(-np.pi, np.pi, COUNT)
    towards = np.stack([np.cos(way), np.sin(way)], axis=1)
    place = np.stack([np.zeros((COUNT, 2)), distance[:, None] * towards], axis=1)
    shape = np.full((COUNT, 2), len(OUTLINES))
    return Pairs(shape, scale, random.uniform(-np.pi, np.pi, (COUNT, 2)), place), distance, towards


def test_discs(asked):
    """The smooth rule is exact; of n nodes the deepest is half a step π/n off at most, and its overlap too small.

    The deepest of radius r and overlap ξ lies in another disc of radius R, at an angle a of the first, by
    R − √(d² + r² − 2 d r cos a), which is ξ less d r a²/2R.
    """
    given, distance, towards = disc_pairs()
    number, found = asked.scanned(given, 1e-3)
    assert (number == 1).all()
    overlap = given.scale.sum(axis=1) - distance
    assert np.abs(found[:, 0, 0] - overlap).max() < 4.0 * ERROR
    # The table's slopes are off by its error over a quarter of a cell.
    assert np.abs(found[:, 0, 1:3] + towards).max() < 4.0 * ERROR * cells_for([DISC]) / (2.0 * np.pi)
    nodes = np.maximum(asked.by_nodes(given)[:, 0], 0.0)
    small = given.scale.min(axis=1)
    worst = 0.5 * distance * small / given.scale.max(axis=1) * (np.pi / NODES) ** 2
    assert (nodes <= overlap + 1e-9).all() and (nodes >= np.maximum(overlap - 1.02 * worst, 0.0) - 1e-9).all()


def overlap_of_ellipses(given, k):
    """The least overlap of the two shadows over all directions, by their closed form; negative: a gap."""
    axes, apart = AXES[given.shape[k]] * given.scale[k][:, None], given.place[k, 0] - given.place[k, 1]

    def shadows(way):
        half = [
            np.hypot(a * np.cos(way - turn), b * np.sin(way - turn))
            for (a, b), turn in zip(axes, given.angle[k], strict=True)
        ]
        return sum(half) - apart[0] * np.cos(way) - apart[1] * np.sin(way)

    ways = np.linspace(-np.pi, np.pi, 721)
    start = ways[shadows(ways).argmin()]
    found = optimize.minimize_scalar(
        shadows, bounds=(start - 0.01, start + 0.01), method="bounded", options={"xatol": 1e-9}
    )
    return found.fun, np.array([np.cos(found.x), np.sin(found.x)])


@pytest.mark.slow
def test_ellipses_against_the_least_overlap_of_their_shadows():
    outlines = [ellipse(*axes) if axes[0] > axes[1] else Contour(axes[0]) for axes in AXES]
    given = random_pairs(outlines, COUNT, 5, (-0.01, 0.05))
    number, found = Asked(outlines, COUNT).scanned(given, 1.0)
    tried = 0
    for k in range(0, COUNT, 4):
        overlap, normal = overlap_of_ellipses(given, k)
        if overlap < SHALLOW:
            tried += 1
            assert number[k] == 1  # they are convex
            assert found[k, 0, 0] == pytest.approx(overlap, abs=1e-5)
            assert found[k, 0, 1:3] == pytest.approx(normal, abs=1e-3)
    assert tried > 300


def local_gaps(first, second, skin):
    """Distances below a skin that are local minima of all distances between points of two outlines that are apart."""
    theta = 2.0 * np.pi / 512 * np.arange(512)
    distance = np.abs(first.place(theta)[:, None] - second.place(theta)[None, :])
    least = distance == ndimage.minimum_filter(distance, 3, mode="wrap")

    def half_square(at):
        (p, d), (q, e) = first.trace(at[0]), second.trace(at[1])
        away = p - q
        return 0.5 * abs(away) ** 2, np.array([(away.conjugate() * d).real, -(away.conjugate() * e).real])

    gaps = []
    for a, b in np.argwhere(least & (distance < 1.2 * skin)):
        found = optimize.minimize(half_square, theta[[a, b]], jac=True, method="BFGS", options={"gtol": 1e-10})
        gaps.append(np.sqrt(2.0 * found.fun))
    return np.array(sorted(gap for gap in gaps if gap < skin))


def are_apart(first, second):
    theta = 2.0 * np.pi / 512 * np.arange(512)
    return all(depth(*pair, theta)[0].max() < 0.0 for pair in ((first, second), (second, first)))


def test_a_scan_finds_every_local_minimum_of_the_gap(asked):
    given = random_pairs(OUTLINES, COUNT, 6, (0.0, 0.15))
    number, found = asked.scanned(given, SKIN)
    seen = several = 0
    for k in range(0, COUNT, 60):
        placed = given.placed(OUTLINES, k)
        if are_apart(*placed):
            expected = local_gaps(*placed, SKIN)
            gaps = np.sort(-found[k, : number[k], 0])
            assert len(gaps) >= len(np.unique(expected.round(6))) and gaps[:1] == pytest.approx(expected[:1], abs=1e-5)
            assert all(np.abs(gaps - gap).min() < 1e-5 for gap in expected)
            seen, several = seen + len(expected), several + (len(expected) > 1)
    assert seen > 20 and several > 3


def in_order(number, found):
    """Overlaps, normals and points (m, 5) of all contacts, pair by pair, in the order of the overlaps."""
    return np.concatenate([found[k, :n][np.argsort(found[k, :n, 0])][:, :5] for k, n in enumerate(number)])


def test_swapped_grains_have_the_same_contacts_with_opposite_normals(asked, pairs, shallow):
    apart = pairs.place[:, 0] - pairs.place[:, 1]
    (number, found), (back_number, back) = asked.scanned(pairs, SKIN), asked.scanned(pairs.swapped(), SKIN)
    assert np.array_equal(number[shallow], back_number[shallow])
    there, other = in_order(number * shallow, found), in_order(number * shallow, back)
    shift = np.repeat(apart, number * shallow, axis=0)
    assert there[:, 0] == pytest.approx(other[:, 0], abs=1e-8)
    assert there[:, 1:3] == pytest.approx(-other[:, 1:3], abs=1e-6)
    assert there[:, 3:] + shift == pytest.approx(other[:, 3:], abs=1e-6)
    nodes, back_nodes = asked.by_nodes(pairs), asked.by_nodes(pairs.swapped())
    touching = nodes[:, 0] > 0.0
    assert back_nodes[:, 0] == pytest.approx(nodes[:, 0], abs=1e-13)
    assert back_nodes[:, 1:3] == pytest.approx(-nodes[:, 1:3], abs=1e-9)
    assert back_nodes[touching, 3:] == pytest.approx((nodes[:, 3:] + apart)[touching], abs=1e-9)


@pytest.mark.parametrize(
    ("change", "matrix"),
    [
        (lambda pairs: pairs.turned(1.1), np.array([[np.cos(1.1), -np.sin(1.1)], [np.sin(1.1), np.cos(1.1)]])),
        (lambda pairs: pairs.mirrored(MIRROR), np.diag([-1.0, 1.0])),
    ],
)
def test_contacts_turn_and_mirror_with_their_grains(asked, pairs, shallow, change, matrix):
    (number, found), (there_number, there) = asked.scanned(pairs, SKIN), asked.scanned(change(pairs), SKIN)
    assert np.array_equal(number[shallow], there_number[shallow])
    before, after = in_order(number * shallow, found), in_order(number * shallow, there)
    assert after[:, 0] == pytest.approx(before[:, 0], abs=1e-8)
    assert after[:, 1:3] == pytest.approx(before[:, 1:3] @ matrix.T, abs=1e-6)
    assert asked.by_nodes(change(pairs))[:, 0] == pytest.approx(asked.by_nodes(pairs)[:, 0], abs=1e-12)


def test_the_smooth_rule_and_the_discrete_one_differ_by_the_overlap_squared(asked, pairs, shallow):
    """A shift along the normal makes an overlap exactly so much larger; the polar depth has another second order."""
    number, found = asked.scanned(pairs, SKIN)
    chosen, off = np.flatnonzero((number == 1) & shallow)[:15], []
    for overlap in (1e-2, 1e-3):
        place = pairs.place.copy()
        place[:, 1] += (overlap - found[:, 0, :1]) * found[:, 0, 1:3]
        moved = replace(pairs, place=place)
        now, at = asked.scanned(moved, SKIN)
        single = chosen[now[chosen] == 1]
        assert at[single, 0, 0] == pytest.approx(overlap, abs=1e-6)
        deep = [penetrations(*moved.placed(OUTLINES, k))[0].overlap for k in single]
        off.append(np.median(np.abs(np.array(deep) - overlap)))
    assert len(single) > 8
    assert off[0] / off[1] == pytest.approx(100.0, rel=0.3)


PATHS = 20


def test_energy_minus_that_of_saddles_is_continuous(asked):
    """Grains that overlap turn past each other: bends make contacts come and go, Hertz's energy U = ξ^(5/2)."""
    random = np.random.default_rng(8)
    angle = np.linspace(0.0, 0.5, COUNT // PATHS)
    turned = np.tile(angle, PATHS)
    shape = np.repeat(random.integers(0, len(OUTLINES), (PATHS, 2)), len(angle), axis=0)
    start = np.repeat(random.uniform(-np.pi, np.pi, (PATHS, 2)), len(angle), axis=0)
    place = np.zeros((COUNT, 2, 2))
    given = Pairs(shape, np.ones((COUNT, 2)), start + np.stack([turned, 0.0 * turned], axis=1), place)
    facing = np.array([0.0, np.pi])
    reach = [
        [OUTLINES[k].polar(way) for k, way in zip(*row, strict=True)]
        for row in zip(shape, facing - given.angle, strict=True)
    ]
    place[:, 1, 0] = np.sum(reach, axis=1) - 0.3 * SHALLOW
    number, found = asked.scanned(given, SKIN)
    listed = np.arange(found.shape[1]) < number[:, None]
    minima = np.where(listed, np.maximum(found[:, :, 0], 0.0), 0.0)
    contacts = (minima**2.5).sum(axis=1).reshape(PATHS, -1)
    energy = contacts - (np.where(listed, asked.saddles(), 0.0) ** 2.5).sum(axis=1).reshape(PATHS, -1)
    deepest = minima.max(axis=1).reshape(PATHS, -1)
    fair = (deepest[:, :-2] < SHALLOW) & (deepest[:, 2:] < SHALLOW)

    def jumps(values):
        return np.abs(np.diff(values, 2, axis=1))[fair] / SHALLOW**2.5

    assert fair.sum() > 400
    assert jumps(energy).max() < 0.08  # what 0.3° do to a smooth curve
    assert jumps(contacts).max() > 0.2


STARTS = ((0.0, 0.0), (0.3, 0.2), (1.2, 0.5), (2.0, -0.3))  # angle (rad) and offset (m) of the second grain
STEPS = np.array([2000, 4000, 8000, 16000, 32000])


@pytest.mark.slow
@pytest.mark.parametrize("outline", [outline_of("rice"), star(5, 0.25).with_diameter(2.0)], ids=["rice", "star"])
def test_energy_in_collisions(outline):
    """Followed contacts keep it with the square of the step; the deepest of the nodes jumps, whatever the step."""
    reach = outline.bounding_radius + 0.05
    place = np.array([[[-reach, 0.0, 0.0], [reach, offset, angle]] for angle, offset in STARTS for _ in STEPS])
    rate = np.zeros_like(place)
    rate[:, :, 0] = 0.5, -0.5
    steps = np.tile(STEPS, len(STARTS))
    drift = {}
    for rule in ("tracked", "nodes"):
        collisions = Collisions(outline, rule, len(steps), 2.5e5)
        momentum = np.array(collisions.mass) * rate
        turning = (place[..., 0] * momentum[..., 1] - place[..., 1] * momentum[..., 0]).sum(axis=1)
        outcome = collisions.run(place, rate, 4.0, steps)
        assert (outcome.deepest > 1e-3).all()
        assert np.abs(outcome.momentum).max() < 1e-11
        assert np.abs(outcome.spin - turning).max() < 1e-11
        drift[rule] = np.abs(outcome.energy / (0.5 * momentum * rate).sum(axis=(1, 2)) - 1.0).reshape(len(STARTS), -1)
    tracked, nodes = drift["tracked"].max(axis=0), drift["nodes"].max(axis=0)
    assert tracked[-1] < 1e-4
    assert tracked[-1] < 0.05 * tracked[0]
    assert nodes[-1] > 10.0 * tracked[-1]


def test_orientations_are_cosine_and_sine_of_angles():
    angle = np.concatenate([np.random.default_rng(1).uniform(-30.0, 30.0, 20000), np.pi / 4 * np.arange(-32, 33)])
    found = orientations(angle)
    assert np.abs(found[:, 0] - np.cos(angle)).max() < np.spacing(30.0)
    assert np.abs(found[:, 1] - np.sin(angle)).max() < np.spacing(30.0)
