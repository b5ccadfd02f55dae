"""Walls of a turned tank: gaps against the distance to many points on its surfaces."""

import numpy as np
import pytest
import taichi as ti
from scipy.spatial import cKDTree

from solvers.machine import runtime
from solvers.machine.state import State
from solvers.tank.solids.solid import Lying, Turned
from solvers.tank.solids.turned import TurnedWalls
from solvers.tank.tank import Tank

# A silo: barrel and cone, open above and below
SILO = np.array([[-0.1, 0.0], [0.1, 0.0], [0.4, 0.4], [0.4, 0.9], [-0.4, 0.9], [-0.4, 0.4]])
OPEN = (0, 3)
# A drum with a cone at one end, across its axis and along it
DRUM = np.array([[-0.4, -0.1], [0.4, -0.1], [0.4, 0.2], [0.1, 0.6], [-0.1, 0.6], [-0.4, 0.2]])
FINE = 4e-3  # m, between points on the surfaces
FACED = 1e20


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


def asked(solid, outline, points, open_edges=()):
    """Gaps and normals of all features for points (n, 3) m."""
    runtime.initialise(1)
    arrays = State()
    walls = TurnedWalls(arrays, [Tank(outline, 1.0, open_edges=open_edges)], Still(), solid)
    arrays.finish()
    found = np.zeros((len(points), walls.features, 4))
    gaps(walls, points, found)
    arrays.release()
    return found


def surface():
    """Points (n, 3) m on the barrel and the cone, in the order y, z, x."""
    rings = []
    for (r0, z0), (r1, z1) in ((SILO[1], SILO[2]), (SILO[2], SILO[3])):
        share = np.linspace(0.0, 1.0, int(np.hypot(r1 - r0, z1 - z0) / FINE) + 2)
        for radius, z in zip(r0 + share * (r1 - r0), z0 + share * (z1 - z0), strict=True):
            turn = np.linspace(0.0, 2.0 * np.pi, int(2.0 * np.pi * radius / FINE) + 2)[:-1]
            rings.append(np.column_stack([radius * np.cos(turn), np.full(len(turn), z), radius * np.sin(turn)]))
    return np.concatenate(rings)


def test_the_nearest_feature_of_a_silo_is_its_nearest_wall():
    """From within and from outside. A point of the grid is up to half a diagonal aside, more so where it is curved."""
    points = np.random.default_rng(3).uniform([-0.6, -0.3, -0.6], [0.6, 1.2, 0.6], (4000, 3))
    found = asked(Turned(), SILO, points, OPEN)
    nearest = found[..., 0].argmin(axis=1)
    gap, normal = found[np.arange(len(points)), nearest, 0], found[np.arange(len(points)), nearest, 1:]
    tree = cKDTree(surface())
    distance, _ = tree.query(points)
    assert np.all(gap < FACED)
    assert np.all(gap <= distance * (1.0 + 1e-12))
    assert np.all(distance**2 - gap**2 <= 0.5 * FINE**2 * (1.0 + gap / SILO[1, 0]))
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-12)
    # The foot of the normal is on the surface
    away, _ = tree.query(points - gap[:, None] * normal)
    assert away.max() < FINE


@pytest.mark.parametrize("deep", [0.2, 0.4, 0.9])
def test_its_volume_is_that_of_a_cone_and_a_cylinder(deep):
    """By the closed form of a frustum, up to the slices."""
    low = min(deep, 0.4)
    radius = 0.1 + 0.75 * low
    expected = np.pi * low / 3.0 * (0.1**2 + 0.1 * radius + radius**2) + np.pi * 0.4**2 * max(deep - 0.4, 0.0)
    assert Turned().volume(SILO, deep) == pytest.approx(expected, rel=1e-6)


def test_the_gaps_of_a_lying_drum_are_those_from_its_barrel_its_ends_and_its_cone():
    """By the closed forms of a cylinder, planes and a cone, from within, normals too."""
    drum = Lying(tuple(map(tuple, DRUM.tolist())))
    points = np.random.default_rng(5).uniform([-0.4, -0.4, -0.1], [0.4, 0.4, 0.6], (4000, 3))
    points = points[drum.clear(points, drum.front, 0.0)]
    found = asked(drum, drum.front, points)
    found[..., 0] = np.where(found[..., 0] < FACED, found[..., 0], np.inf)
    away, x = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    slant = np.array([-0.8, -0.6])  # the cone's normal inward, across the axis and along it
    walls = [
        (0.4 - away, np.tile([-1.0, 0.0], (len(points), 1))),
        (x + 0.1, np.tile([0.0, 1.0], (len(points), 1))),
        (0.6 - x, np.tile([0.0, -1.0], (len(points), 1))),
        ((away - 0.4) * slant[0] + (x - 0.2) * slant[1], np.tile(slant, (len(points), 1))),
    ]
    gap = np.array([one for one, _ in walls])
    which = gap.argmin(axis=0)
    np.testing.assert_allclose(found[..., 0].min(axis=1), gap.min(axis=0), atol=1e-12)
    flat = np.array([normal for _, normal in walls])[which, np.arange(len(points))]
    expected = np.column_stack([points[:, :2] / away[:, None] * flat[:, :1], flat[:, 1]])
    nearest = found[..., 0].argmin(axis=1)
    np.testing.assert_allclose(found[np.arange(len(points)), nearest, 1:], expected, atol=1e-9)
    assert set(which) == {0, 1, 2, 3}


@pytest.mark.parametrize("deep", [0.1, 0.4, 0.65, 0.8])
def test_the_volume_in_a_lying_drum_is_that_of_segments_of_its_circles(deep):
    """Against points on a fine grid, of which a share lies in it; half full and full by the closed form."""
    drum = Lying(tuple(map(tuple, DRUM.tolist())))
    whole = np.pi * (0.4**2 * 0.3 + 0.4 / 3.0 * (0.4**2 + 0.4 * 0.1 + 0.1**2))
    edges = [np.linspace(low, high, 81) for low, high in ((-0.4, 0.4), (-0.4, 0.4), (-0.1, 0.6))]
    grid = np.stack(np.meshgrid(*(0.5 * (one[1:] + one[:-1]) for one in edges), indexing="ij"), axis=-1).reshape(-1, 3)
    inside = drum.clear(grid, drum.front, 0.0) & (grid[:, 1] < deep - 0.4)
    found = drum.volume(drum.front, deep)
    assert found == pytest.approx(0.8 * 0.8 * 0.7 * inside.mean(), rel=4e-3)
    if deep in (0.4, 0.8):
        assert found == pytest.approx(whole * deep / 0.8, rel=1e-6)
