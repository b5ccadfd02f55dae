"""How deep a bed is, and its pores, in a box and in a trough."""

import numpy as np
import pytest

from solvers.mixture.bed import area_up_to, bed_depth, depth_up_to, is_box, pores

BOX = np.array([(-0.1, 0.02), (0.1, 0.02), (0.1, 0.22), (-0.1, 0.22)])
TROUGH = np.array([(0.0, 0.0), (0.1, 0.2), (-0.1, 0.2)])  # as wide as it is high


@pytest.mark.parametrize("outline", [BOX, TROUGH])
def test_depths_and_areas_are_the_same_told_twice(outline):
    """Also as a polygon with one more corner, which is no box, and above the rim as if the walls went on."""
    more = np.insert(outline, 1, outline[:2].mean(axis=0), axis=0)
    assert is_box(BOX) and not is_box(TROUGH) and not is_box(more)
    for depth in (0.01, 0.05, 0.15):
        area = area_up_to(outline, depth)
        assert area == pytest.approx(0.2 * depth if outline is BOX else 0.5 * depth**2)
        assert depth_up_to(outline, area) == pytest.approx(depth, rel=1e-9)
        assert depth_up_to(more, area) == pytest.approx(depth, rel=1e-9)
        assert area_up_to(more, depth) == pytest.approx(area)
    whole = area_up_to(outline, 1.0)
    assert depth_up_to(outline, whole + 0.2 * 0.01) == pytest.approx(0.21)


def test_the_depth_of_a_bed_is_that_of_its_tops():
    """Of rows of equal grains from the floor on; its pores are what these leave."""
    radius, rows = 2e-3, 10
    z = 0.02 + radius + 2.0 * radius * np.arange(rows)
    y = np.linspace(-0.098, 0.098, 50)
    place = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)
    solid = np.full(len(place), 0.5 * (2.0 * radius) ** 2)
    for outline in (BOX, np.insert(BOX, 1, [0.0, 0.02], axis=0)):
        assert bed_depth(outline, place, solid) == pytest.approx(rows * 2.0 * radius, rel=1e-9)
        assert pores(outline, place, solid) == pytest.approx(0.5 * 0.2 * rows * 2.0 * radius, rel=1e-6)
    lost = np.vstack([place, [np.nan, np.nan]])
    assert bed_depth(BOX, lost, np.append(solid, 1.0)) == pytest.approx(rows * 2.0 * radius)


def test_a_trough_is_filled_evenly():
    """A triangle's centroid lies at two thirds of its depth."""
    random = np.random.default_rng(0).uniform([-0.1, 0.0], [0.1, 0.12], (200_000, 2))
    inside = random[np.abs(random[:, 0]) < 0.5 * random[:, 1]]
    assert bed_depth(TROUGH, inside, np.ones(len(inside))) == pytest.approx(0.12, rel=5e-3)
