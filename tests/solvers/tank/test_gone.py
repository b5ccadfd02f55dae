"""Neighbours that leave an open tank together are removed without side effects."""

import numpy as np
import pytest

from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material


@pytest.mark.slow
def test_neighbours_that_leave_together_are_removed():
    """Grain 0, whose number also marks missing pairs, and two that touch it fall beside the tank until removed."""
    radius = np.full((1, 4), 2e-3)
    place = np.array([[[0.03, 0.0], [0.0339, 0.0], [0.03, 0.0039], [0.0, 2e-3]]])
    made = scene_of(radius, box(0.04, 0.03), material(), material(), stiffness_scale=1e-3, open_edges=(2,))
    run = Simulation(made, place, threads=1)
    for _ in range(12):
        run.advance(round(0.01 / run.dt))
        rows = run.observe()
    state = run.snapshot()
    run.close()
    assert rows["spilled"][0] == 3
    assert np.isnan(state["position"][0, :3]).all()
    assert np.isfinite(state["position"][0, 3]).all()
    assert np.isfinite(state["velocity"]).all()
