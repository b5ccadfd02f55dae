"""A bound of the gap of two grains tells which pairs need no search, and leaves the motion as it was."""

from itertools import pairwise

import numpy as np
import pytest
import taichi as ti

from solvers.grains.shapes.cargo import cargo
from solvers.grains.shapes.given import Shapes
from solvers.grains.shapes.support import CELLS, reaches
from tests.oracles.outlines import ellipse, irregular, star
from tests.oracles.scenes import box, material, simulation

RADIUS, WORLDS, POINTS = 3e-3, 200, 600
OUTLINES = [ellipse(1.5, 1.0 / 1.5), star(5, 0.3), irregular(4), cargo("rice").outline(np.random.default_rng(1))]
OUTLINES = [outline.with_diameter(2.0) for outline in OUTLINES]
SOFT = material(young=3e6, restitution=0.5, friction=0.4)


def made(which, place, width, **scene):
    """Grains with these outlines (W, n) at `place` (W, n, 2) m, at random angles."""
    angle = np.random.default_rng(3).uniform(-7.0, 7.0, which.shape)
    shapes = Shapes(tuple(OUTLINES), which, angle, "continuous", 120)
    return simulation(place, RADIUS, box(width, 0.4), SOFT, shapes=shapes, **scene), angle


@ti.kernel
def bounds(support: ti.template(), g: ti.template(), found: ti.types.ndarray()):
    for w in range(found.shape[0]):
        found[w] = support.gap(g, w, 0, 1)


def test_a_gap_is_never_overestimated_and_seldom_missed():
    """Beside the least distance of many points of both outlines, which is at least the gap."""
    random = np.random.default_rng(1)
    which = random.integers(0, len(OUTLINES), (WORLDS, 2))
    way = RADIUS * random.uniform(1.0, 4.0, WORLDS)
    toward = random.uniform(-np.pi, np.pi, WORLDS)
    place = np.full((WORLDS, 2, 2), 0.1)
    place[:, 1] += way[:, None] * np.stack([np.cos(toward), np.sin(toward)], axis=1)
    run, angle = made(which, place, 0.6)
    found = np.zeros(WORLDS)
    bounds(run.grains.lists.support, run.grains.grains, found)
    run.close()
    theta = 2.0 * np.pi / POINTS * np.arange(POINTS)
    distance = np.zeros(WORLDS)
    for w in range(WORLDS):
        turn = np.exp(1j * angle[w])
        first, second = (
            OUTLINES[which[w, k]].points(theta) @ [1.0, 1j] * RADIUS * turn[k] + place[w, k] @ [1.0, 1j] for k in (0, 1)
        )
        distance[w] = np.abs(first[:, None] - second).min()
        nearest = OUTLINES[which[w, 1]].polar(np.angle((first - place[w, 1] @ [1.0, 1j]) / turn[1])) * RADIUS
        if np.any(np.abs(first - place[w, 1] @ [1.0, 1j]) < nearest):
            distance[w] = 0.0  # they overlap
    assert np.all(found <= distance)
    apart = distance > 0.3 * RADIUS
    assert apart.sum() > 50
    assert np.mean(found[apart] > 0.1 * RADIUS) > 0.9


@pytest.mark.parametrize("outline", OUTLINES, ids=["ellipse", "star", "irregular", "rice"])
def test_no_point_of_an_outline_reaches_farther_than_the_table_says(outline):
    points = outline.points(np.linspace(0.0, 2.0 * np.pi, 20_000))
    direction = np.random.default_rng(2).uniform(0.0, 2.0 * np.pi, 500)
    reach = (points @ np.stack([np.cos(direction), np.sin(direction)])).max(axis=0)
    more = reaches(outline)[(direction * CELLS / (2.0 * np.pi)).astype(int)] - reach
    assert more.min() > 0.0
    assert more.max() < 0.02 * outline.bounding_radius


@pytest.mark.slow
def test_pairs_that_are_not_searched_change_no_bit():
    """A bed that is thrown at a wall, beside one in which no gap is known, so that all pairs are searched.

    In neither has a pair that is listed no contact.
    """
    column, row = np.divmod(np.arange(16), 4)
    place = RADIUS * np.stack([3.9 * (column - 1.5), 3.9 * row + 2.5], axis=1)
    which, found = np.random.default_rng(5).integers(0, len(OUTLINES), (1, 16)), []
    for farther in (0.0, 1e3):
        run, _ = made(which, place[None], 16.0 * RADIUS, velocity=[1.0, 0.0], tangential="mindlin")
        lists = run.grains.lists
        lists.support.most.from_numpy(lists.support.most.to_numpy() + farther)
        run.advance(3000)
        found.append({**run.snapshot(), **run.observe()})
        lists.expire()
        run.advance(1)
        length, first = lists.pairs.length.to_numpy()[0], lists.pairs.first.to_numpy()[0]
        assert first[-1] == length > 0
        place_first, mate = (f.to_numpy()[0].ravel()[:length] for f in (lists.pairs.place_first, lists.pairs.mate))
        for start, end in pairwise(first):
            for other in set(mate[start:end]):
                assert place_first[start:end][mate[start:end] == other].max() >= 0.0
        run.close()
    for name, values in found[0].items():
        np.testing.assert_array_equal(found[1][name], values, err_msg=name)
