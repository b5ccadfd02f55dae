"""Bulk in the hold of a ship."""

import pytest

import lab

STUCK = {
    "bulk.repose": "45 deg",
    "bulk.stiffness": 400.0,
    "waves.height": "3 m",
    "run.duration": "60 s",
    "record.picture_rate": "0.1 Hz",
}


@pytest.mark.slow
def test_a_ship_with_bulk_that_does_not_slide_rolls_as_with_her_cargo_frozen(tmp_path):
    """An elastic block leans a little: asked is 1 % with a stiffness of 400."""
    preset = "ship/handysize-grain-bulk-quick"
    found = lab.run(preset, tmp_path / "run", video=False, plots=False, quiet=True, **STUCK).measures
    assert found["largest_roll"].value == pytest.approx(found["frozen_largest_roll"].value, rel=0.01)
    assert abs(found["bulk_shift"].value) < 0.2
    assert found["bulk_carried"].value == pytest.approx(1.0, abs=0.02)
