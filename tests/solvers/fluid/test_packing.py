"""Packed water: it fills any polygon evenly, up to slanted walls and round bodies, and the same in every call."""

import numpy as np
import pytest
from scipy.spatial import Delaunay, cKDTree

from solvers.fluid.given import Water
from solvers.fluid.start import packing
from solvers.fluid.start.packing import EVEN, STEPS, packed
from solvers.fluid.start.plates import is_slanted, packed_beside
from solvers.fluid.walls.layers import distance
from solvers.tank.outline import area_below, cut_off
from solvers.tank.parts import Body
from solvers.tank.tank import Tank
from tests.oracles.water import kernel

BOX = np.array([(-0.15, 0.0), (0.15, 0.0), (0.15, 0.45), (-0.15, 0.45)])
CHAMFERS = np.array([(-0.06, 0.0), (0.06, 0.0), (0.15, 0.09), (0.15, 0.45), (-0.15, 0.45), (-0.15, 0.09)])
VEE = np.array([(0.0, 0.0), (0.3, 0.45), (-0.3, 0.45)])
TRAPEZOID = np.array([(-0.1, 0.0), (0.1, 0.0), (0.25, 0.45), (-0.25, 0.45)])
BODY = np.array([(-0.06, 0.08), (0.05, 0.1), (0.04, 0.2), (-0.05, 0.18)])
FLOATING = BODY + np.array([0.0, 0.15])  # it pierces the surface
DEPTH = 0.3
GAMMA = 0.02  # band of Γ round 1: what no order at 50 neighbours leaves
SHAPES = {
    "box": (BOX, 0.01, ()),
    "chamfers": (CHAMFERS, 0.01, ()),
    "vee": (VEE, 0.01, ()),
    "trapezoid": (TRAPEZOID, 0.01, ()),
    "a body in it": (BOX, 0.0075, (BODY,)),
    "a body in its surface": (BOX, 0.0075, (FLOATING,)),
}


@pytest.fixture(scope="module", params=SHAPES)
def case(request):
    polygon, spacing, holes = SHAPES[request.param]
    return polygon, spacing, holes, packed(polygon, DEPTH, Water(spacing, 20.0), holes)


def test_the_volumes_are_that_of_the_water_between_walls_and_bodies(case):
    polygon, spacing, holes, found = case
    area = area_below(polygon, DEPTH) - sum(area_below(hole, DEPTH - hole[:, 1].min()) for hole in holes)
    assert len(found.points) == round(area / spacing**2)
    assert found.volume * len(found.points) == pytest.approx(area, rel=1e-12)
    assert Tank(polygon, 1.0).holds(found.points).all() and found.points[:, 1].max() < DEPTH
    for hole in holes:
        assert not Tank(hole, 1.0).holds(found.points).any()


def test_it_ends_even(case):
    """Pushes below the stated bound, Γ in its band, none in pairs, no gap wider than that of a lattice and a half."""
    polygon, spacing, holes, found = case
    assert found.steps < STEPS and np.hypot(*found.push.T).max() < EVEN
    assert np.abs(found.cover - 1.0).max() < GAMMA
    assert cKDTree(found.points).query(found.points, 2)[0][:, 1].min() > 0.65 * spacing
    edges = [cut_off(one, DEPTH - one[:, 1].min()) for one in (polygon, *holes)]
    walls = np.min([distance(found.points, edge) for edge in edges], axis=0)
    assert 0.1 * spacing < walls.min() and walls.min() < 0.5 * spacing
    assert widest_gap(found.points, edges) < 1.5 * spacing * np.sqrt(0.5)


def widest_gap(points: np.ndarray, edges: list[np.ndarray]) -> float:
    """Radius (m) of the largest circle that holds no particle, its centre in the water."""
    mesh = Delaunay(points)
    a, b, c = (points[mesh.simplices[:, k]] for k in range(3))
    b, c = b - a, c - a
    double = 2.0 * (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])
    b2, c2 = (b**2).sum(axis=1), (c**2).sum(axis=1)
    away = np.stack([c[:, 1] * b2 - b[:, 1] * c2, b[:, 0] * c2 - c[:, 0] * b2], axis=1) / double[:, None]
    wet = Tank(edges[0], 1.0).holds(a + away)
    for hole in edges[1:]:
        wet &= ~Tank(hole, 1.0).holds(a + away)
    return float(np.hypot(*away.T)[wet].max())


def test_what_it_says_of_its_evenness_are_sums_over_all_particles():
    """Γ and Δx Σ V ∇W within a box, by double sums without lists; near walls wall particles are in them, too."""
    spacing = 0.015
    found = packed(BOX, DEPTH, Water(spacing, 20.0))
    apart = found.points[:, None] - found.points
    value, slope = kernel(np.linalg.norm(apart, axis=2), 2.0 * spacing)
    inner = distance(found.points, cut_off(BOX, DEPTH)) > 4.0 * spacing
    assert inner.sum() > 100
    assert found.cover[inner] == pytest.approx(found.volume * value.sum(axis=1)[inner], rel=1e-9)
    push = -spacing * found.volume * (slope[..., None] * apart).sum(axis=1)
    assert found.push[inner] == pytest.approx(push[inner], abs=1e-10)


def test_it_is_the_same_in_every_call_and_has_no_order():
    """Without order pairs lie in all directions alike: a lattice's mean of cos 4θ over near pairs is 0.5 or more."""
    first = packed(BOX, DEPTH, Water(0.01, 20.0))
    packing._packed.cache_clear()
    assert (packed(BOX, DEPTH, Water(0.01, 20.0)).points == first.points).all()
    a, b = cKDTree(first.points).query_pairs(0.012, output_type="ndarray").T
    along = first.points[b] - first.points[a]
    assert abs(np.cos(4.0 * np.arctan2(along[:, 1], along[:, 0])).mean()) < 0.5


PLATES = {
    "on the floor": Body(((-0.06, 0.0), (0.05, 0.2))),
    "both ends in the water": Body(((-0.07, 0.08), (0.04, 0.22))),
    "from floor to air": Body(((-0.1, 0.0), (0.1, 0.4))),
}


@pytest.mark.parametrize("name", PLATES)
def test_it_is_even_beside_slanted_plates(name):
    """Pushes and Γ as without plates; the row before each side is as near and as close as before a wall."""
    plate, spacing = PLATES[name], 0.015
    found = packed_beside(BOX, DEPTH, Water(spacing, 20.0), (plate,), BOX)
    assert found.steps < STEPS and np.hypot(*found.push.T).max() < EVEN
    assert np.abs(found.cover - 1.0).max() < GAMMA
    assert found.volume * len(found.points) == pytest.approx(area_below(BOX, DEPTH), rel=1e-12)
    start, end = np.array(plate.points)
    way = (end - start) / np.hypot(*(end - start))
    off = found.points - start
    along, across = off @ way, off @ np.array([-way[1], way[0]])
    top = min(np.hypot(*(end - start)), (DEPTH - start[1]) / way[1])
    before = (along > 3.0 * spacing) & (along < top - 3.0 * spacing)  # farther than where the ends are transparent
    for side in (1.0, -1.0):
        row = before & (side * across > 0.0) & (side * across < spacing)
        assert 0.25 * spacing < (side * across[row]).min() and (side * across[row]).min() < 0.6 * spacing
        assert np.diff(np.sort(along[row])).max() < 2.0 * spacing
    if name == "from floor to air":  # it parts the water: both sides have their share
        left = area_below(np.array([BOX[0], plate.points[0], (0.05, DEPTH), (BOX[0][0], DEPTH)]), DEPTH)
        assert (across > 0.0).sum() * found.volume == pytest.approx(left, abs=3.0 * spacing**2)


def test_only_plates_that_are_parallel_to_no_axis_are_slanted():
    """Beside the others, and beside bodies, presets start from a lattice."""
    upright, level = Body(((0.0, 0.1), (0.0, 0.3))), Body(((0.0, 0.1), (0.2, 0.1)))
    ridge = Body(((-0.1, 0.0), (0.1, 0.0), (0.0, 0.1)), closed=True)
    assert [is_slanted(part) for part in (*PLATES.values(), upright, level, ridge)] == [True] * 3 + [False] * 3


def test_water_that_holds_no_particle_is_refused():
    with pytest.raises(ValueError, match="no particle of this spacing"):
        packed(np.array([(0.0, 0.0), (0.1, 0.0), (0.1, 1e-4)]), 1e-4, Water(0.05, 20.0))
