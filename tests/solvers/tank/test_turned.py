"""Walls of a turned tank: gaps against the distance to many points on its surfaces."""

import numpy as np
import pytest
import taichi as ti
from scipy.spatial import cKDTree

from solvers.machine import runtime
from solvers.machine.state import State
from solvers.tank.solids.solid import Turned
from solvers.tank.solids.turned import TurnedWalls
from solvers.tank.tank import Tank

# A silo: barrel and cone, open above and below
SILO = np.array([[-0.1, 0.0], [0.1, 0.0], [0.4, 0.4], [0.4, 0.9], [-0.4, 0.9], [-0.4, 0.4]])
OPEN = (0, 3)
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
    runtime.initialise(1)
    arrays = State()
    walls = TurnedWalls(arrays, [Tank(SILO, 1.0, open_edges=OPEN)], Still())
    arrays.finish()
    points = np.random.default_rng(3).uniform([-0.6, -0.3, -0.6], [0.6, 1.2, 0.6], (4000, 3))
    found = np.zeros((len(points), walls.features, 4))
    gaps(walls, points, found)
    arrays.release()
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
