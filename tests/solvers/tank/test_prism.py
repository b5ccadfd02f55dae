"""Walls of a prism in space: gaps against the distance to the nearest wall, whatever it is made of."""

import numpy as np
import pytest
import taichi as ti

from solvers.machine import runtime
from solvers.machine.state import State
from solvers.tank.solids.prism import PrismWalls
from solvers.tank.solids.solid import Prism
from solvers.tank.tank import Tank

ALONG, FACED = 0.8, 1e20
HOPPER = np.array([[-0.2, 0.0], [0.3, 0.0], [0.5, 0.6], [-0.4, 0.5]])  # not a rectangle, and its top is open


class Still:
    """No parts."""

    parts, fastest, moving, turning, size = (), 0.0, False, False, 0


@ti.kernel
def gaps(walls: ti.template(), points: ti.types.ndarray(), found: ti.types.ndarray()):
    """The gap and normal of each feature (n, features, 4) of points (n, 3)."""
    for n in range(points.shape[0]):
        for feature in range(walls.features):
            one = walls.gap(feature, ti.Vector([0.0]), points[n, 0], points[n, 1], points[n, 2])
            for k in ti.static(range(4)):
                found[n, feature, k] = one[k]


def asked(tank, points):
    """Gaps and normals of all features for points (n, 3) m."""
    runtime.initialise(1)
    arrays = State()
    walls = PrismWalls(arrays, [tank], Still(), Prism(ALONG))
    arrays.finish()
    found = np.zeros((len(points), walls.features, 4))
    gaps(walls, points, found)
    arrays.release()
    return found


def distance(points, polygon):
    """Distances (n,) and directions (n, 3) of points from a flat convex polygon (m, 3) in space."""
    normal = np.cross(polygon[1] - polygon[0], polygon[2] - polygon[0])
    normal /= np.linalg.norm(normal)
    height = (points - polygon[0]) @ normal
    nearest = points - height[:, None] * normal
    over = np.ones(len(points), dtype=bool)
    for one, two in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        over &= (nearest - one) @ np.cross(normal, two - one) >= 0.0
    best = np.where(over, np.abs(height), np.inf)
    away = np.where(over[:, None], height[:, None] * normal, 0.0)
    for one, two in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        share = np.clip((points - one) @ (two - one) / ((two - one) @ (two - one)), 0.0, 1.0)
        off = points - one - share[:, None] * (two - one)
        near = np.linalg.norm(off, axis=1) < best
        best = np.where(near, np.linalg.norm(off, axis=1), best)
        away = np.where(near[:, None], off, away)
    return best, away


def plates(outline, open_edges):
    """The flat walls (m, 3) of an open prism."""
    ends = [np.column_stack([outline, np.full(len(outline), x)]) for x in (-ALONG / 2, ALONG / 2)]
    sides = [
        np.array([[*a, -ALONG / 2], [*b, -ALONG / 2], [*b, ALONG / 2], [*a, ALONG / 2]])
        for k, (a, b) in enumerate(zip(outline, np.roll(outline, -1, axis=0), strict=True))
        if k not in open_edges
    ]
    return [*ends, *sides]


@pytest.fixture
def points():
    """Points in and around the tank."""
    return np.random.default_rng(7).uniform([-0.8, -0.4, -0.8], [0.9, 1.0, 0.8], (20_000, 3))


def test_the_nearest_feature_of_an_open_prism_is_its_nearest_wall(points):
    """By the distance to each plate with its edges and corners, from within and from outside."""
    found = asked(Tank(HOPPER, 1.0, open_edges=(2,)), points)
    away = [distance(points, plate) for plate in plates(HOPPER, (2,))]
    best = np.min([one for one, _ in away], axis=0)
    nearest = found[..., 0].argmin(axis=1)
    np.testing.assert_allclose(found[np.arange(len(points)), nearest, 0], best, atol=1e-12)
    which = np.argmin([one for one, _ in away], axis=0)
    direction = np.array([off for _, off in away])[which, np.arange(len(points))] / best[:, None]
    np.testing.assert_allclose(found[np.arange(len(points)), nearest, 1:], direction, atol=1e-9)
    assert (found[:, -8:, 0] < FACED).any(axis=0).all()  # every point of the rims is the nearest of some


def test_a_closed_prism_has_all_its_walls_within(points):
    """Six walls of a box, and no rims: what is outside has left, and touches nothing from behind."""
    box = np.array([[-0.2, 0.0], [0.3, 0.0], [0.3, 0.6], [-0.2, 0.6]])
    inside = np.all((points > [-0.2, 0.0, -ALONG / 2]) & (points < [0.3, 0.6, ALONG / 2]), axis=1)
    found = asked(Tank(box, 1.0), points)
    assert found.shape[1] == 6
    gap = np.where(found[..., 0] < FACED, found[..., 0], np.inf)[inside]
    y, z, x = points[inside].T
    expected = np.min([y + 0.2, 0.3 - y, z, 0.6 - z, x + ALONG / 2, ALONG / 2 - x], axis=0)
    np.testing.assert_allclose(gap.min(axis=1), expected, atol=1e-12)
