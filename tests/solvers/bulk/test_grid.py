"""The grid of bulk: how much of its nodes is inside the tank, which walls hold them, and the bed at the start."""

import numpy as np
import pytest

from solvers.bulk.grid import grid_of
from solvers.bulk.start import at_rest, sideways
from solvers.tank.outline import moments
from solvers.tank.tank import Tank
from tests.oracles.bulk import DENSITY, GRAVITY, box

HOLD = np.array([(-9, 0), (9, 0), (13.3, 4.3), (13.3, 8.36), (7, 12), (-7, 12), (-13.3, 8.36), (-13.3, 4.3)])


@pytest.mark.parametrize("outline", [box(24.0, 16.0), HOLD])
def test_nodes_share_the_tank_among_them(outline):
    """Weights add up to one everywhere, so that their integrals over the tank add up to its area."""
    grid = grid_of([Tank(outline, 1.0)], 0.5)
    assert grid.share.sum() == pytest.approx(moments(outline)[0], rel=1e-9)
    assert grid.share.max() <= np.prod(grid.spacing) * (1.0 + 2e-3)  # samples know an edge to a sixteenth of a cell


def test_tanks_stand_side_by_side_and_each_has_a_whole_number_of_cells_across():
    tanks = [Tank(box(24.0, 16.0), 1.0), Tank(box(5.3, 4.0) + np.array([30.0, 1.0]), 1.0)]
    grid = grid_of(tanks, 0.5)
    for k, tank in enumerate(tanks):
        own = grid.share[grid.first[k] : grid.first[k + 1]]
        assert own.sum() == pytest.approx(moments(tank.outline)[0], rel=1e-9)
        across = np.ptp(tank.outline[:, 0]) / grid.spacing[k, 0]
        assert across == pytest.approx(round(across))


def test_nodes_on_and_behind_a_wall_are_held_by_its_own_normal():
    """Those inside are free, those in an outward corner are held by both of its walls."""
    grid = grid_of([Tank(HOLD, 1.0)], 0.5)
    places = grid.origin[0] + np.stack(np.indices(grid.share.shape), axis=-1) * grid.spacing[0]
    slant = np.array([-1.0, 1.0]) / np.sqrt(2.0)  # into the tank, of the hopper to starboard
    off = (places - np.array([9.0, 0.0])) @ slant
    middle = (places[..., 1] > 1.5) & (places[..., 1] < 3.0) & (places[..., 0] > 0.0)
    cell = grid.spacing[0, 0]
    held = (np.abs(grid.walls - slant).max(axis=-1) < 1e-9).any(axis=-1)
    assert held[middle & (off < 0.49 * cell) & (off > -2.0 * cell)].all()
    assert not held[middle & (off > 0.51 * cell)].any()
    corner = np.abs(places - np.array([-9.0, 0.0])).max(axis=-1) < 0.5 * cell
    assert (np.abs(grid.walls[corner]).max(axis=-1) > 0.0).sum(axis=-1).max() == 2


def test_a_bed_starts_with_its_whole_mass_under_the_weight_above():
    region = np.array([(-9, 0), (9, 0), (13.3, 4.3), (13.3, 6.0), (-13.3, 6.0), (-13.3, 4.3)])
    points = at_rest(region, grid_of([Tank(HOLD, 1.0)], 0.5), 0, DENSITY, 1e7, 0.32, GRAVITY)
    area, centre, _ = moments(region)
    assert points["mass"].sum() == pytest.approx(DENSITY * area, rel=1e-12)
    middle = points["mass"] @ points["position"] / points["mass"].sum()
    assert middle == pytest.approx(centre, abs=0.02)
    upright = 3.0 / (1.0 + 2.0 * sideways(0.32)) * points["pressure"]
    assert upright == pytest.approx(DENSITY * GRAVITY * (6.0 - points["position"][:, 1]), rel=1e-9)


def test_a_bed_at_rest_calls_on_less_than_its_friction():
    """|s|/p = √3 (1 − K)/(1 + 2 K) of a bed with the stress K times the upright one to all sides."""
    for friction in (0.2, 0.32, 0.6, 1.0):
        k = sideways(friction)
        assert np.sqrt(3.0) * (1.0 - k) / (1.0 + 2.0 * k) <= 0.9 * friction + 1e-12
    assert sideways(1.0) == pytest.approx(0.3 / 0.7)  # confined and elastic


def test_a_region_without_room_for_a_point_is_refused():
    with pytest.raises(ValueError, match="no material point"):
        at_rest(np.array([(0, 5), (1e-3, 5), (1e-3, 5.001)]), grid_of([Tank(HOLD, 1.0)], 0.5), 0, 1.0, 1.0, 0.3, 9.81)
