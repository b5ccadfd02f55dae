"""Righting levers of a ship with the water in her tanks level."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.assembly.scene import vessels
from lab.measures import ship_stability
from lab.preset.find import load

BARGE = "ship/barge-open-hatch-frozen"


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("depth", [None, "20 mm"])
def test_an_empty_room_changes_no_lever_and_water_in_it_takes_some(depth, monkeypatch):
    """At a small heel ρ g l³/12 of the room, half as long as she is, over her weight (metacentric formula) to O(φ²)."""
    preset = load(BARGE, {"tanks.room.depth": depth} if depth else {}).resolved
    (vessel,) = vessels(preset)
    monkeypatch.setattr(ship_stability, "vessel_of", lambda _: vessel)
    heel, frozen, level = ship_stability.levers(SimpleNamespace(preset=preset, path=None))
    if depth is None:
        np.testing.assert_allclose(level, frozen, atol=1e-9)
        return
    small = heel[1]
    lost = 1000.0 * 0.5 * 0.32**3 / 12.0 / vessel.ship.body.mass * np.tan(small)
    assert frozen[1] - level[1] == pytest.approx(lost, rel=2.0 * small**2)
