"""Overlapping grains: moved apart by no more than necessary, or left unchanged."""

import numpy as np
import pytest

from solvers.grains.bed.relaxing import relaxed_start
from solvers.scene import Scene
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

RADIUS = 1.5e-3


def scene(count: int, width: float = 0.1) -> Scene:
    return scene_of(np.full(count, RADIUS), box(width, 0.1), material(), material())


def test_a_pair_separates_evenly_and_a_grain_leaves_a_wall():
    overlap = 0.01 * RADIUS
    place = np.array([[0.0, 0.05], [2.0 * RADIUS - overlap, 0.05], [0.05 - RADIUS + overlap, 0.02]])
    moved = relaxed_start(scene(3), place)
    gap = moved[1, 0] - moved[0, 0] - 2.0 * RADIUS
    assert -4e-4 * RADIUS < gap <= 1e-12
    assert moved[0, 0] + moved[1, 0] == pytest.approx(place[0, 0] + place[1, 0], abs=1e-15)
    assert moved[2, 0] == pytest.approx(0.05 - RADIUS, abs=4e-4 * RADIUS)
    np.testing.assert_array_equal(moved[:, 1], place[:, 1])


def test_a_compressed_lattice_separates_within_its_tank():
    pitch = 1.99 * RADIUS
    y, z = np.meshgrid(np.arange(8), np.arange(8))
    place = pitch * np.column_stack([y.ravel() - 3.5, z.ravel()]) + [0.0, RADIUS]
    moved = relaxed_start(scene(64, 8.5 * 2.0 * RADIUS), place)
    apart = np.linalg.norm(moved[:, None] - moved[None], axis=2) + 2.0 * RADIUS * np.eye(64)
    assert apart.min() > (2.0 - 4e-4) * RADIUS
    assert np.abs(moved[:, 0]).max() < 8.5 * RADIUS - RADIUS + 4e-4 * RADIUS
    assert moved[:, 1].min() > RADIUS * (1.0 - 4e-4)


def test_a_bed_pressed_by_its_weight_stays_as_it_is():
    place = RADIUS * np.array([[0.0, 0.9999], [0.0, 2.9997]])
    np.testing.assert_array_equal(relaxed_start(scene(2), place), place)
