"""How many entries lists of water in space have room for, and what happens where that is not enough."""

import numpy as np
import pytest

from solvers.fluid.lists import capacity
from solvers.fluid.lists.capacity import Laid, counted
from solvers.fluid.state import snug
from solvers.simulation import Simulation
from tests.oracles.water_in_space import pool

SPACING = 0.05


STEPS = 12


@pytest.mark.slow
@pytest.mark.parametrize("periodic", [("x",), ()])
def test_the_entries_are_counted_as_lists_have_them_at_the_start(periodic):
    """All blocks of so small a tank are looked at, so the numbers are those of the lists."""
    run = Simulation(pool((10, 9, 12), 6, SPACING, periodic=periodic), threads=1, arch="cpu")
    run.advance(1)
    lists, water = run.water.lists, run.scene.fluid.water
    _, blocks, *_ = run.water.wall_points
    laid, far = Laid(1, run.scene.fluid.particles["position"], blocks), water.reach + capacity.SKIN[0] * SPACING
    found = counted(laid, run.water.order.grid, 1, far)
    for name, count in found.items():
        assert int(getattr(lists, name).first.to_numpy().max()) == pytest.approx(count, rel=1e-3), name
    run.close()


def run_of(monkeypatch, more: float) -> tuple[Simulation, np.ndarray]:
    """Water that moves fast, after some steps with `more` room than lists need at the start; and where it is (n, 3)."""
    monkeypatch.setattr(capacity, "USUAL", 1)
    monkeypatch.setattr(capacity, "MORE", dict.fromkeys(capacity.MORE, more))
    scene = pool((10, 12, 10), 6, SPACING)
    drops = scene.fluid.particles
    drops["velocity"][..., 0] = 3.0 * np.cos(np.pi * drops["position"][..., 0] / (10 * SPACING))
    run = Simulation(scene, threads=1, arch="cpu")
    run.advance(STEPS)
    place = run.snapshot()["water_position"][0]
    run.close()
    return run, place


@pytest.mark.slow
def test_lists_that_do_not_fit_have_the_least_skin_and_then_more_room(monkeypatch):
    """Water that moves fast asks for a wide skin. With room for the least alone it has that, with less room it gets
    more: where it goes does not depend on it, to the rounding of sums in another order.
    """
    found = {}
    for more in (0.6, 1.1, 4.0):
        run, place = run_of(monkeypatch, more)
        found[more] = run.room, place
    np.testing.assert_allclose(found[0.6][1], found[4.0][1], atol=1e-9 * SPACING)
    np.testing.assert_allclose(found[1.1][1], found[4.0][1], atol=1e-9 * SPACING)
    assert [found[more][0] for more in (0.6, 1.1, 4.0)] == [2, 1, 1]


@pytest.mark.parametrize(
    ("wanted", "usual", "found"), [(5, 64, 64), (100, 64, 104), (2**20, 1, 2**20), (9001, 1, 9216)]
)
def test_long_arrays_are_an_eighth_too_long_at_most(wanted, usual, found):
    assert snug(wanted, usual) == found
