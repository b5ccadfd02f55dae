"""Water that is let go: hydrostatic where it stands on something, without pressure where it falls."""

import numpy as np
import pytest

from solvers.fluid.start.support import depths
from solvers.tank.parts import Body, Part
from solvers.tank.tank import Tank
from tests.oracles.water import box

SPACING = 0.01
TANK = Tank(box(0.4, 0.4), 1.0, open_edges=(2,))
LEDGE = Tank(np.array([(-0.2, 0.0), (0.2, 0.0), (0.2, 0.4), (-0.2, 0.4), (-0.2, 0.2), (-0.1, 0.2), (-0.1, 0.1)]), 1.0)
HOPPER = Tank(np.array([(-0.05, 0.0), (0.05, 0.0), (0.2, 0.3), (0.2, 0.4), (-0.2, 0.4), (-0.2, 0.3)]), 1.0)
UNDER_LID = np.array([(-0.2, 0.3), (0.0, 0.3), (0.0, 0.4), (-0.2, 0.4)])
BESIDE_WALL = UNDER_LID - np.array([0.0, 0.1])
IN_MIDAIR = BESIDE_WALL + np.array([0.05, 0.0])


def depth(polygon: np.ndarray, tank: Tank, *points: tuple[float, float], parts: tuple = ()) -> np.ndarray:
    polygon = np.asarray(polygon, dtype=float)
    return depths(np.array(points), polygon, polygon[:, 1].max(), tank, parts, SPACING)


@pytest.mark.parametrize("block", [UNDER_LID, BESIDE_WALL, IN_MIDAIR])
def test_water_that_stands_on_nothing_falls_without_pressure(block):
    """Beside a wall, to its very face, and under a lid, which does not hold it up."""
    low = block.min(axis=0)
    points = low + np.stack(np.meshgrid(np.linspace(0.001, 0.199, 21), np.linspace(0.001, 0.099, 21)), -1).reshape(
        -1, 2
    )
    assert not depth(block, Tank(box(0.4, 0.4), 1.0), *points).any()


def test_water_that_stands_is_as_deep_as_below_its_own_surface():
    """On the floor, on a sloping wall, on a plate, on a body; under a level, a stepped and a sloping surface."""
    column = [(-0.2, 0.0), (0.0, 0.0), (0.0, 0.3), (-0.2, 0.3)]
    assert depth(column, TANK, (-0.199, 0.1), (-0.001, 0.1)) == pytest.approx(0.2)
    stepped = [(-0.2, 0.0), (0.2, 0.0), (0.2, 0.1), (0.0, 0.1), (0.0, 0.3), (-0.2, 0.3)]
    assert depth(stepped, TANK, (-0.1, 0.05), (0.1, 0.05)) == pytest.approx([0.25, 0.05])
    heap = [(-0.2, 0.0), (0.2, 0.0), (0.0, 0.2)]
    assert depth(heap, TANK, (0.1, 0.05), (0.0, 0.05)) == pytest.approx([0.05, 0.15])
    in_hopper = [(-0.05, 0.0), (0.05, 0.0), (0.15, 0.2), (-0.15, 0.2)]
    assert depth(in_hopper, HOPPER, (0.14, 0.19), (0.0, 0.05)) == pytest.approx([0.01, 0.15])
    raised = [(-0.1, 0.1), (0.1, 0.1), (0.1, 0.3), (-0.1, 0.3)]
    plate, body = Part(((-0.1, 0.1), (0.0, 0.1))), Body(((0.0, 0.05), (0.2, 0.05), (0.2, 0.2), (0.0, 0.2)), closed=True)
    assert depth(raised, TANK, (-0.05, 0.2), (0.05, 0.2), parts=(plate,)) == pytest.approx([0.1, 0.0])
    assert depth(raised, TANK, (-0.05, 0.2), (0.05, 0.25), parts=(body,)) == pytest.approx([0.0, 0.05])


def test_water_under_an_overhang_is_as_deep_as_in_the_vessel_beside_it():
    overhung = [(-0.2, 0.0), (0.0, 0.0), (0.0, 0.3), (-0.1, 0.3), (-0.1, 0.2), (-0.2, 0.2)]
    roof = Part(((-0.2, 0.2), (-0.1, 0.2), (-0.1, 0.4)))
    assert depth(overhung, TANK, (-0.15, 0.1), (-0.05, 0.1), parts=(roof,)) == pytest.approx(0.2)
    assert depth(overhung, TANK, (-0.15, 0.1)) == pytest.approx(0.1)


def test_of_water_that_hangs_over_a_ledge_the_part_beyond_it_falls():
    block = [(-0.2, 0.2), (0.1, 0.2), (0.1, 0.4), (-0.2, 0.4)]
    assert depth(block, LEDGE, (-0.15, 0.3), (-0.05, 0.3)) == pytest.approx([0.1, 0.0])


def test_a_column_touches_what_is_nearer_than_half_a_spacing_and_a_floor_without_a_wall_bears_nothing():
    for gap, stands in ((0.49, True), (0.51, False)):
        block = np.array([(-0.1, 0.0), (0.1, 0.0), (0.1, 0.2), (-0.1, 0.2)]) + np.array([0.0, gap * SPACING])
        assert (depth(block, TANK, (0.0, 0.1)) > 0.0) == stands
    assert depth(block - np.array([0.0, 0.51 * SPACING]), Tank(TANK.outline, 1.0, open_edges=(0,)), (0.0, 0.1)) == 0.0
