"""Hulls that are drawn cut open."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from lab.paint.space.hulls import hull_walls
from solvers.tank.parts import Hull, Opening
from solvers.tank.shapes import PrismShape

OUTER = PrismShape(((-2.0, -1.0), (2.0, -1.0), (2.0, 1.0), (-2.0, 1.0)), 6.0, 0.5)
ROOM = PrismShape(((-1.8, -0.8), (1.8, -0.8), (1.8, 0.8), (-1.8, 0.8)), 5.6, 0.5)
CLOSED = Hull(0.2, (ROOM,))
HOLED = replace(CLOSED, openings=(Opening(((-0.5, -0.9), (0.5, -0.9)), x=0.5),))


def areas(walls) -> tuple[np.ndarray, float]:
    """Area vectors (m, 3) m² of all faces, towards where they are seen from, and the volume (m³) that they enclose."""
    vectors, volume = [], 0.0
    for a, b in pairwise(walls.first):
        corners = walls.points[a:b]
        vector = 0.5 * np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        vectors.append(vector)
        volume += vector @ corners.mean(axis=0) / 3.0
    return np.array(vectors), volume


@pytest.mark.parametrize("cut", [0.5, -1.0])
def test_a_hull_that_is_cut_open_is_drawn_as_its_walls(cut):
    """Its faces enclose the volume of the walls behind the cut, and close: their area vectors make up zero."""
    vectors, volume = areas(hull_walls(OUTER, CLOSED, cut))
    behind, within = cut - (0.5 - 3.0), cut - (0.5 - 2.8)
    assert np.abs(vectors.sum(axis=0)).max() < 1e-12
    assert volume == pytest.approx(8.0 * behind - 3.6 * 1.6 * within, rel=1e-9)


def test_a_hull_without_a_cut_is_drawn_closed():
    """Its faces enclose the volume of the hull, with its room."""
    vectors, volume = areas(hull_walls(OUTER, CLOSED, None))
    assert np.abs(vectors.sum(axis=0)).max() < 1e-12
    assert volume == pytest.approx(OUTER.volume, rel=1e-9)


def test_a_hole_is_left_out_of_both_sides_of_a_wall_and_of_the_cut():
    """Half a disc of each plate, to the 2 % that a polygon of twelve strips lacks; of the cut the diameter."""
    closed, holed = (areas(hull_walls(OUTER, hull, 0.5))[0] for hull in (CLOSED, HOLED))
    down = [np.abs(vectors[:, 1]).sum() for vectors in (closed, holed)]
    assert down[0] - down[1] == pytest.approx(2.0 * 0.5 * np.pi * 0.25, rel=0.03)
    across = [np.abs(vectors[:, 2]).sum() for vectors in (closed, holed)]
    assert across[0] - across[1] == pytest.approx(0.2 * (1.0 + 1.0 * 3.6 / 4.0) / 2.0, rel=0.02)
