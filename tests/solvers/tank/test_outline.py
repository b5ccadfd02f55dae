"""The tank's outline for filling: lids, raised walls, areas, linings."""

from math import pi

import numpy as np
import pytest

from solvers.tank.outline import area_below, lining, raised, top_edges
from tests.oracles.scenes import box

TRAPEZIUM = np.array([[-0.1, 0.0], [0.1, 0.0], [0.2, 0.2], [-0.2, 0.2]])
GABLE = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.05, 0.15], [0.0, 0.1]])
U = np.array([[0.0, 0.0], [0.3, 0.0], [0.3, 0.2], [0.2, 0.2], [0.2, 0.1], [0.1, 0.1], [0.1, 0.2], [0.0, 0.2]])
SPLIT = np.array([[0.0, 0.0], [0.3, 0.0], [0.3, 0.2], [0.1, 0.2], [0.0, 0.2]])  # a corner in the middle of its lid


def area(outline: np.ndarray) -> float:
    """Signed area, by triangles from the origin."""
    return 0.5 * sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True))


@pytest.mark.parametrize(
    ("outline", "lids"), [(box(0.2, 0.1), (2,)), (TRAPEZIUM, (2,)), (GABLE, ()), (U, (2, 6)), (SPLIT, (2, 3))]
)
def test_lids_are_the_edges_along_the_top(outline, lids):
    assert top_edges(outline) == lids
    assert top_edges(outline * 1e-3 + np.array([0.3, -0.7])) == lids


@pytest.mark.parametrize(("outline", "mouth"), [(box(0.2, 0.1), 0.2), (TRAPEZIUM, 0.4), (U, 0.2), (SPLIT, 0.3)])
def test_raised_walls_continue_the_mouth(outline, mouth):
    higher = raised(outline, 0.5)
    assert np.ptp(higher[:, 1]) == pytest.approx(np.ptp(outline[:, 1]) + 0.5)
    assert area(higher) == pytest.approx(area(outline) + 0.5 * mouth)
    edges = np.roll(higher, -1, axis=0) - higher
    assert np.all(np.linalg.norm(edges, axis=1) > 0.0)
    np.testing.assert_array_equal(raised(GABLE, 0.5), GABLE)


def test_area_below_a_level():
    assert area_below(box(0.2, 0.1), 0.04) == pytest.approx(0.008)
    assert area_below(box(0.2, 0.1) + np.array([0.3, -0.4]), 0.04) == pytest.approx(0.008)
    assert area_below(box(0.2, 0.1), 0.1) == pytest.approx(0.02)
    assert area_below(TRAPEZIUM, 0.1) == pytest.approx(0.025)
    assert area_below(U, 0.1) == pytest.approx(0.03)
    assert area_below(U, 0.15) == pytest.approx(0.04)


def wall_distance(outline: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Distance of points from the nearest edge of the outline, without lids."""
    found = []
    for k, a in enumerate(outline):
        edge = outline[(k + 1) % len(outline)] - a
        share = np.clip((points - a) @ edge / (edge @ edge), 0.0, 1.0)
        away = np.linalg.norm(points - a - share[:, None] * edge, axis=1)
        found.append(np.full(len(points), np.inf) if k in top_edges(outline) else away)
    return np.min(found, axis=0)


@pytest.mark.parametrize("outline", [box(0.2, 0.1), TRAPEZIUM, U, GABLE], ids=["box", "trapezium", "U", "gable"])
def test_a_lining_covers_floor_and_sides_with_half_embedded_grains(outline):
    d = 3e-3
    fixed = lining(outline, d, np.random.default_rng(1))
    assert np.all(wall_distance(outline, fixed[:, :2]) < 1e-12)
    assert np.all(np.abs(fixed[:, 2] / (0.5 * d) - 1.0) <= 0.1) and np.ptp(fixed[:, 2]) > 0.05 * d
    for k in range(len(outline)):
        if k in top_edges(outline):
            continue
        a, b = outline[k], outline[(k + 1) % len(outline)]
        along = (fixed[:, :2] - a) @ (b - a) / np.linalg.norm(b - a)
        on = np.abs((fixed[:, 0] - a[0]) * (b - a)[1] - (fixed[:, 1] - a[1]) * (b - a)[0]) < 1e-12
        on &= (along > -1e-9) & (along < np.linalg.norm(b - a) + 1e-9)
        order = np.argsort(along[on])
        place, radius = along[on][order], fixed[on, 2][order]
        assert place[0] == pytest.approx(0.0, abs=1e-9)
        assert place[-1] == pytest.approx(np.linalg.norm(b - a))
        gap = np.diff(place) - radius[1:] - radius[:-1]
        assert np.all(gap >= -1e-12) and gap.max() < 0.25 * d
        assert np.ptp(gap) > 0.02 * d  # uneven
    assert len(np.unique(fixed[:, :2].round(9), axis=0)) == len(fixed)


def test_a_lining_depends_only_on_its_seed():
    first, again, other = (lining(TRAPEZIUM, 4e-3, np.random.default_rng(seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert len(first) != len(other) or not np.allclose(first, other)
    covered = 2.0 * first[:, 2].sum()
    around = 0.2 + 2.0 * (0.1**2 + 0.2**2) ** 0.5
    assert covered == pytest.approx(around, rel=0.1) and covered < around + pi * 4e-3
