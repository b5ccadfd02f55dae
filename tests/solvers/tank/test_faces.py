"""Walls of a mesh: gaps against the distance to its triangles, what is inside, volumes, and what is flat."""

import numpy as np
import pytest
import taichi as ti

from solvers.machine import runtime
from solvers.machine.state import State
from solvers.tank.solids.faces import FaceWalls
from solvers.tank.solids.features import features_of
from solvers.tank.tank import Tank
from tests.oracles.holds import BOX, HOPPER, L_SHAPED, drawn_out, hold

FACED = 1e20


class Still:
    """No parts."""

    parts, fastest, moving, turning, size = (), 0.0, False, False, 0


@ti.kernel
def gaps(walls: ti.template(), points: ti.types.ndarray(), found: ti.types.ndarray(), held: ti.types.ndarray()):
    """The gap and normal of each feature (n, features, 4) of points (n, 3), and if they are held, or far off (n,)."""
    for n in range(points.shape[0]):
        held[n] = ti.cast(walls.holds(points[n, 0], points[n, 1], points[n, 2]), ti.i32)
        if not walls.follows(points[n, 0], points[n, 1], points[n, 2]):
            held[n] = -1
        for feature in range(walls.features):
            one = walls.gap(feature, ti.Vector([0.0]), points[n, 0], points[n, 1], points[n, 2])
            for k in ti.static(range(4)):
                found[n, feature, k] = one[k]


@ti.kernel
def listed(nearby: ti.template(), points: ti.types.ndarray(), found: ti.types.ndarray()):
    """Which features (n, features) the cells of points (n, 3) list."""
    for n in range(points.shape[0]):
        cell = nearby.cell(points[n, 0], points[n, 1], points[n, 2])
        for k in range(nearby.first[cell], nearby.first[cell + 1]):
            found[n, nearby.listed[k]] = 1


def asked(mesh, points, reach):
    """Gaps and normals of all features for points (n, 3) m, whether they are held, and what their cells list.

    Points that are far off (−1) are held by none.
    """
    runtime.initialise(1)
    arrays = State()
    walls = FaceWalls(arrays, [Tank(mesh.front, 1.0)], Still(), mesh)
    nearby = walls.nearby(arrays, reach)
    arrays.finish()
    found, held = np.zeros((len(points), walls.features, 4)), np.zeros(len(points), dtype=np.int32)
    gaps(walls, points, found, held)
    some = np.zeros((len(points), walls.features), dtype=np.int32)
    listed(nearby, points, some)
    arrays.release()
    low, high = walls.bounds
    np.testing.assert_array_equal(held >= 0, np.all((points >= low) & (points <= high), axis=1))
    return found, held > 0, some.astype(bool)


def nearest(points, mesh):
    """Distances (n,) m of points from all triangles, and where (n, 3) these are nearest, by the regions of a triangle
    (Ericson 2005, Real-time collision detection, 5.1.5)."""
    best, place = np.full(len(points), np.inf), np.zeros_like(points)
    for a, b, c in mesh.points:
        ab, ac = b - a, c - a
        d1, d2 = (points - a) @ ab, (points - a) @ ac
        d3, d4 = (points - b) @ ab, (points - b) @ ac
        d5, d6 = (points - c) @ ab, (points - c) @ ac
        va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
        with np.errstate(divide="ignore", invalid="ignore"):
            cases = [
                (((d1 <= 0) & (d2 <= 0)), a + 0.0 * points),
                (((d3 >= 0) & (d4 <= d3)), b + 0.0 * points),
                (((vc <= 0) & (d1 >= 0) & (d3 <= 0)), a + (d1 / (d1 - d3))[:, None] * ab),
                (((d6 >= 0) & (d5 <= d6)), c + 0.0 * points),
                (((vb <= 0) & (d2 >= 0) & (d6 <= 0)), a + (d2 / (d2 - d6))[:, None] * ac),
                (((va <= 0) & (d4 >= d3) & (d5 >= d6)), b + ((d4 - d3) / (d4 - d3 + d5 - d6))[:, None] * (c - b)),
            ]
            inner = a + (vb / (va + vb + vc))[:, None] * ab + (vc / (va + vb + vc))[:, None] * ac
        found = np.select([case[:, None] for case, _ in cases], [where for _, where in cases], inner)
        off = np.linalg.norm(points - found, axis=1)
        place = np.where((off < best)[:, None], found, place)
        best = np.minimum(best, off)
    return best, place


MESHES = {
    "box": drawn_out(BOX, 0.4),
    "concave": drawn_out(L_SHAPED, 0.4),
    "open hopper": hold(HOPPER, open_top=True),
    "open concave": drawn_out(L_SHAPED, 0.4, open_top=True, turned=0.3),
}


@pytest.mark.parametrize("name", MESHES)
def test_the_nearest_feature_of_a_mesh_is_its_nearest_triangle(name):
    """By the distance to every triangle, and to the nearest point; of a closed mesh from within, of an open from all
    around. The cell of a point lists what is within its reach."""
    mesh, reach = MESHES[name], 0.07
    low, high = mesh.box
    points = np.random.default_rng(11).uniform(low - 0.1, high + 0.1, (6000, 3))
    if not mesh.open:
        points = points[mesh.inside(points)]
    found, held, some = asked(mesh, points, reach)
    gap = np.where((found[..., 0] > 0.0) & (found[..., 0] < FACED), found[..., 0], np.inf)
    best, place = nearest(points, mesh)
    which = gap.argmin(axis=1)
    np.testing.assert_allclose(gap.min(axis=1), best, atol=1e-12)
    foot = points - best[:, None] * found[np.arange(len(points)), which, 1:]
    clear = best > 1e-6
    np.testing.assert_allclose(foot[clear], place[clear], atol=1e-9)
    np.testing.assert_array_equal(held, mesh.inside(points))
    assert some[np.arange(len(points)), which][best < reach].all()
    faced = np.isfinite(gap).sum(axis=1)
    assert faced.min() >= 1
    # No contact counts twice: no two features face a point from the same place
    for k in np.flatnonzero(faced > 1)[:500]:
        mine = np.isfinite(gap[k])
        feet = points[k] - gap[k, mine, None] * found[k, mine, 1:]
        assert np.linalg.norm(feet[:, None] - feet + np.eye(len(feet))[..., None], axis=2).min() > 1e-9


@pytest.mark.parametrize("name", MESHES)
def test_flat_edges_are_no_features_and_a_point_above_one_is_over_one_face(name):
    """Edges of a box that no grain within can touch are none, either; at the middle of a diagonal one face counts."""
    mesh = MESHES[name]
    features = features_of(mesh)
    expected = {"box": (0, 0), "concave": (1, 2), "open hopper": (20, 12), "open concave": (18, 12)}[name]
    assert (len(features.edges), len(features.corners)) == expected
    low, high = mesh.box
    middle = 0.5 * (low + high)
    middle[1] = low[1] + 0.01
    found, _, _ = asked(mesh, middle[None], 0.05)
    gap = found[0, :, 0]
    assert np.count_nonzero((gap > 0.0) & (gap < 0.0100001)) == 1


def test_a_mesh_has_the_volume_of_the_prism_that_it_is():
    """Up to any depth, closed or open; walls raised on its rim add theirs, and points above the mouth are inside."""
    for depth in (0.05, 0.1, 0.13, 0.2):
        flat = 0.4 * (0.2 * min(depth, 0.1) + 0.1 * max(depth - 0.1, 0.0))
        for open_top in (False, True):
            assert drawn_out(L_SHAPED, 0.4, open_top).volume(BOX, depth) == pytest.approx(flat, rel=1e-12)
    mesh = drawn_out(L_SHAPED, 0.4, True)
    higher = mesh.over(mesh.front * [1.0, 2.0])
    assert higher.open and higher.volume(BOX, 0.4) == pytest.approx(0.4 * (0.2 * 0.1 + 0.1 * 0.3), rel=1e-12)
    points = np.random.default_rng(2).uniform(*(one * 1.1 for one in higher.box), (2000, 3))
    np.testing.assert_array_equal(higher.inside(points), mesh.inside(points))
    clear = mesh.clear(points, mesh.front, 0.01)
    np.testing.assert_array_equal(clear, mesh.inside(points) & (nearest(points, mesh)[0] >= 0.01))
