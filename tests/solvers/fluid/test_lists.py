"""Lists of the neighbours of water, where they just fill their arrays."""

import numpy as np
import pytest

from solvers.fluid import lists
from solvers.simulation import Simulation
from tests.solvers.fluid.test_step import UNTOLD, disturbed


@pytest.mark.slow
def test_lists_that_fill_their_room_are_whole(monkeypatch):
    """With room at first for as many neighbours of the walls as there are, the same are listed as with more.

    Of the water's own neighbours the last one looked at is near here, whatever is written over it.
    """
    usual, listed, full = lists.Listing, [], []

    def just_enough(arrays, units, called, blocks, capacity, *below):
        return usual(arrays, units, called, blocks, full.pop() if full and called == "facing" else capacity, *below)

    monkeypatch.setattr(lists, "Listing", just_enough)
    for _ in range(2):
        run = Simulation(disturbed(**UNTOLD), threads=1, arch="cpu")
        run.advance(1)
        found = run.water.lists.facing
        full.append(int(found.first.to_numpy().max()))
        listed.append(found.slots.to_numpy()[0, : full[-1]])
        run.close()
    np.testing.assert_array_equal(*listed)
