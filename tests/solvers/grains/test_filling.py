"""Filling a tank: number and sizes of grains, their initial positions, and the settled bed."""

from math import pi

import numpy as np
import pytest

from solvers.grains.bed.filling import (
    DoesNotFit,
    count_for_depth,
    headroom,
    lattice,
    levelled,
    radii,
    start_positions,
)
from solvers.grains.bed.sizes import Sizes
from solvers.motion import Sway
from solvers.simulation import Simulation
from solvers.tank.outline import inside as inside_by_rays
from solvers.tank.outline import lining, raised
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material


def hopper(*side: list[float]) -> np.ndarray:
    """A symmetric outline from the points of its starboard side, from the floor up."""
    return np.array([*side, *([-y, z] for y, z in reversed(side))])


OUTLINES = {
    "rectangle": box(0.2, 0.25),
    "off the middle": box(0.2, 0.25) + np.array([0.31, -0.07]),
    "hopper": hopper([0.025, 0.0], [0.1, 0.04], [0.1, 0.3]),
    "steep hopper": hopper([0.02, 0.0], [0.1, 0.07], [0.1, 0.3]),
    "L": np.array([[0.0, 0.0], [0.12, 0.0], [0.12, 0.3], [-0.1, 0.3], [-0.1, 0.1], [0.0, 0.1]]),
}


def wall_distance(points: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """Distance (n,) of points (n, 2) from the nearest segment."""
    nearest = np.full(len(points), np.inf)
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        edge = b - a
        share = np.clip((points - a) @ edge / (edge @ edge), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(points - a - share[:, None] * edge, axis=1))
    return nearest


def inside(points: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """Whether points (n, 2) lie inside, by the angle the outline turns around them."""
    arms = outline - points[:, None]
    angle = np.arctan2(arms[..., 1], arms[..., 0])
    turned = (np.roll(angle, -1, axis=1) - angle + pi) % (2.0 * pi) - pi
    return turned.sum(axis=1) > pi


@pytest.mark.parametrize("spread", [0.0, 0.4])
@pytest.mark.parametrize("thrown", [False, True], ids=["lattice", "thrown"])
@pytest.mark.parametrize("rough", [0.0, 5e-3], ids=["smooth", "rough"])
@pytest.mark.parametrize("name", OUTLINES)
def test_grains_start_apart_and_clear_of_the_walls(name, rough, thrown, spread):
    outline = OUTLINES[name]
    for seed in range(5):
        random = np.random.default_rng(seed)
        radius = radii(200, 8e-3, spread, random)
        fixed = lining(outline, rough, random) if rough else np.empty((0, 3))
        room = raised(outline, headroom(200, radius.max(), 0.1))
        plate = outline.mean(axis=0) + np.array([[-0.02, 0.0], [0.0, -0.015], [0.02, 0.0]])
        position = start_positions(radius, room, random, fixed, [plate], thrown)
        first, second = np.triu_indices(len(radius), 1)
        apart = np.linalg.norm(position[first] - position[second], axis=1)
        assert np.all(apart > radius[first] + radius[second])
        assert np.all(inside(position, room))
        assert np.all(wall_distance(position, room) >= radius * (1.0 - 1e-9))
        from_fixed = np.linalg.norm(position[:, None] - fixed[:, :2], axis=-1) - radius[:, None] - fixed[:, 2]
        assert np.all(from_fixed >= -1e-12)
        assert np.all(wall_distance(position, np.vstack([plate, plate[1]])) >= radius * (1.0 - 1e-9))


def test_grains_start_in_their_region_or_do_not_fit():
    room, region = box(0.4, 0.4), np.array([(0.0, 0.1), (0.1, 0.3), (-0.1, 0.3)])
    position = start_positions(np.full(100, 4e-3), room, np.random.default_rng(1), region=region)
    assert np.all(inside(position, region))
    assert position[:, 1].min() < 0.15
    with pytest.raises(DoesNotFit, match="do not fit the region, which has room for"):
        start_positions(np.full(400, 4e-3), room, np.random.default_rng(1), region=region)


def test_thrown_grains_are_uniform_over_the_width_in_uneven_heaps():
    """Columns get the same number of grains on average, but differ far more than those of a lattice."""
    outline, width = box(0.1, 1.0), 0.1
    columns = []
    for seed in range(60):
        random = np.random.default_rng(seed)
        position = start_positions(np.full(400, 2e-3), outline, random, thrown=True)
        columns.append(np.histogram(position[:, 0], bins=8, range=(-width / 2, width / 2))[0])
    mean, scatter = np.mean(columns, axis=0), np.std(columns, axis=0)
    np.testing.assert_allclose(mean, 50.0, rtol=0.15)
    assert np.all(scatter > 5.0)


@pytest.mark.parametrize("thrown", [False, True], ids=["lattice", "thrown"])
def test_headroom_is_enough_and_starts_at_the_floor(thrown):
    for count, width in ((1, 0.02), (30, 0.02), (900, 0.1)):
        room = box(width, headroom(count, 2.2e-3, width))
        for seed in range(10):
            position = start_positions(np.full(count, 2.2e-3), room, np.random.default_rng(seed), thrown=thrown)
            assert position[:, 1].min() < 3.0 * 2.2e-3


def test_levelling_moves_protruding_grains_into_gaps():
    """A row of grains on the floor with a gap in it, and a grain on top that fits the gap."""
    row = [-7.0, -5.0, -3.0, -1.0, 1.0, 5.5, 7.5]
    position = np.array([[y, 1.0] for y in row] + [[-4.0, 1.0 + 3.0**0.5]]) * 3e-3
    radius = np.full(len(position), 3e-3)
    outline = box(17.0 * 3e-3, 0.1)
    level = levelled(position, radius, outline)
    assert (level[:, 1] + radius).max() <= 2.01 * 3e-3
    first, second = np.triu_indices(len(radius), 1)
    assert np.all(np.linalg.norm(level[first] - level[second], axis=1) >= 2.0 * 3e-3 * (1.0 - 1e-9))
    assert np.sum(np.any(level != position, axis=1)) == 1
    np.testing.assert_array_equal(levelled(level, radius, outline), level)


def test_a_seed_defines_a_bed():
    def bed(seed):
        random = np.random.default_rng(seed)
        radius = radii(100, 6e-3, 0.1, random)
        return radius, start_positions(radius, OUTLINES["rectangle"], random)

    first, again, other = bed(1), bed(1), bed(2)
    for same, different, values in zip(again, other, first, strict=True):
        np.testing.assert_array_equal(values, same)
        assert np.mean(values == different) < 0.25  # along walls, some stand in line
    # Equal grains differ in where they start.
    equal = [start_positions(np.full(100, 3e-3), OUTLINES["rectangle"], np.random.default_rng(s)) for s in (1, 2)]
    assert np.mean(equal[0] == equal[1]) < 0.25


@pytest.mark.parametrize(
    ("count", "outline"),
    [(2000, box(0.2, 0.2)), (1, box(7.9e-3, 1.0)), (1, box(1.0, 7.9e-3)), (300, OUTLINES["hopper"] * [1.0, 0.3])],
    ids=["too many", "too narrow", "too low", "half a hopper"],
)
def test_too_many_grains_do_not_fit(count, outline):
    with pytest.raises(DoesNotFit, match=rf"^{count} grains of up to 8 mm do not fit .*\.$"):
        start_positions(np.full(count, 4e-3), outline, np.random.default_rng(1))


def test_diameters_are_uniform_around_the_mean():
    diameter = 2.0 * radii(20000, 6e-3, 0.3, np.random.default_rng(1))
    expected = 6e-3 * np.array([0.7, 0.775, 0.85, 0.925, 1.0, 1.075, 1.15, 1.225, 1.3])
    np.testing.assert_allclose(np.quantile(diameter, np.linspace(0.0, 1.0, 9)), expected, rtol=5e-3)


SIZES = {
    "equal": Sizes(((4e-3, 1.0),)),
    "uniform": Sizes(((4e-3, 1.0),), 0.5),
    "normal": Sizes(((4e-3, 1.0),), 0.2, normal=True),
    "wide normal": Sizes(((4e-3, 1.0),), 0.5, normal=True),
    "table": Sizes(((2e-3, 3.0), (6e-3, 1.0))),
    "spread table": Sizes(((2e-3, 3.0), (6e-3, 1.0)), 0.3),
}


@pytest.mark.parametrize("name", SIZES)
def test_count_is_area_over_the_mean_area_of_a_grain(name):
    """Discs of the count asked for cover one and the same share of the area, whatever their distribution."""
    sizes, outline = SIZES[name], box(1.0, 0.9)
    count = count_for_depth(0.5, outline, sizes)
    area = pi * (sizes.draw(count, np.random.default_rng(3)) ** 2).sum()
    assert area / (0.5 * 1.0) == pytest.approx(0.81, rel=6e-3)
    assert count_for_depth(1e-4, box(1e-3, 0.9), sizes) == 1


def test_a_lining_reduces_the_bed():
    outline, sizes = box(1.0, 0.9), SIZES["equal"]
    fixed = lining(outline, 2e-2, np.random.default_rng(1))
    wet = fixed[fixed[:, 1] < 0.5]
    fewer = count_for_depth(0.5, outline, sizes) - count_for_depth(0.5, outline, sizes, fixed)
    assert fewer * pi * 2e-3**2 == pytest.approx(0.81 * 0.5 * pi * (wet[:, 2] ** 2).sum(), rel=2e-3)


def test_a_hopper_is_filled_by_its_own_area():
    """A trapezium 0.2 m high, 0.2 m wide at the floor and 0.4 m at the top."""
    outline = np.array([[-0.1, 0.0], [0.1, 0.0], [0.2, 0.2], [-0.2, 0.2]])
    count = count_for_depth(0.1, outline, SIZES["equal"])
    assert count == round(0.81 * 0.025 / (pi * 2e-3**2))


def surface(position: np.ndarray, radius: np.ndarray, width: float) -> np.ndarray:
    """Height of the highest disc above each of many places across the tank."""
    y = np.linspace(-width / 2, width / 2, 1001)[1:-1, None]
    square = radius**2 - (y - position[:, 0]) ** 2
    return np.where(square > 0.0, position[:, 1] + np.sqrt(np.maximum(square, 0.0)), 0.0).max(axis=1)


@pytest.mark.slow
def test_a_bed_settles_to_the_requested_depth():
    """Softened grains in a tank that will sway, but stands still until they rest."""
    width, depth, diameter, spread, rest = 0.12, 0.05, 6e-3, 0.1, 1e-5
    count = count_for_depth(depth, box(width, 0.12), Sizes(((diameter, 1.0),), spread))
    assert 150 <= count <= 200
    random = [np.random.default_rng(seed) for seed in (1, 2)]
    radius = np.stack([radii(count, diameter, spread, r) for r in random])
    outline = box(width, 0.12)
    position = np.stack([start_positions(radius[w], outline, random[w]) for w in range(2)])
    grain = material(restitution=0.5)
    motions = [(Sway(amplitude=0.05, frequency=3.0, phase=1.0),)] * 2
    run = Simulation(
        scene_of(radius, outline, grain, grain, stiffness_scale=1e-3, motions=motions), position, threads=1
    )

    assert not run.settle(rest, 0.02)
    told = []
    assert run.settle(rest, 5.0, told.append)
    assert np.all(np.diff(told) > 0.0) and told[-1] < 5.0
    assert run.time == run.steps == 0
    rows, state = run.observe(), run.snapshot()
    assert not np.any(state["angle"])
    still = rest * (run.grains.mass * 9.81 * 2.0 * radius).mean(axis=1)
    assert np.all((rows["kinetic"] + rows["rotational"]) / count < still)
    assert np.all(rows["contacts"] > 1.5 * count)
    for w in range(2):
        at, size = state["position"][w], radius[w]
        top = surface(at, size, width)
        middle = (size**2 * at[:, 1]).sum() / (size**2).sum()
        assert top.mean() == pytest.approx(depth, rel=0.05)
        assert 2.0 * middle == pytest.approx(depth, rel=0.06)
        assert np.quantile(at[:, 1] + size, 0.95) == pytest.approx(depth, rel=0.08)

    run.advance(round(0.05 / run.dt))  # now it sways
    assert run.time == pytest.approx(0.05, rel=1e-3)
    pose = 0.05 * np.sin(2.0 * pi * 3.0 * run.time + 1.0)
    assert run.observe()["pose"][..., 0] == pytest.approx(pose)
    assert np.linalg.norm(run.snapshot()["velocity"], axis=-1).mean() > 1e-3
    run.close()


@pytest.mark.parametrize("outline", OUTLINES.values(), ids=OUTLINES)
def test_points_inside_an_outline_are_those_that_matplotlib_finds_either_way_round(outline):
    from matplotlib.path import Path

    points = np.random.default_rng(3).uniform(outline.min(axis=0) - 0.05, outline.max(axis=0) + 0.05, (2000, 2))
    for way in (outline, outline[::-1]):
        found = inside_by_rays(points, way)
        assert found.any() and not found.all()
        assert (found == Path(way).contains_points(points)).all()


def test_no_grain_starts_in_a_body():
    """A part that ends where it begins is solid: sites keep a radius off it, and none lie in it."""
    outline = np.array([[-0.05, 0.0], [0.05, 0.0], [0.05, 0.1], [-0.05, 0.1]])
    body = np.array([[-0.02, 0.02], [0.02, 0.02], [0.02, 0.06], [-0.02, 0.06], [-0.02, 0.02]])
    sites = lattice(1e-3, outline, plates=[body])
    off = np.maximum(np.abs(sites[:, 0]) - 0.02, np.abs(sites[:, 1] - 0.04) - 0.02)
    assert off.min() >= 1e-3 * (1.0 - 1e-9) and len(sites) > 1000
