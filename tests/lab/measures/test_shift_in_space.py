"""The shift of a bed's centre of mass in space: along all axes, but in a slice not along x."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.measures.centre_of_mass import measure

CENTRE = np.array([[[0.01, 0.02, -0.01]], [[0.03, 0.05, 0.05]], [[0.02, 0.02, 0.03]]])  # (T, W, 3) m


def recording(periodic):
    tank = SimpleNamespace(periodic=periodic)
    return SimpleNamespace(
        series={"centre_of_mass": CENTRE.copy()}, open_edges=(), mean_diameter=np.array([5e-3]),
        preset=SimpleNamespace(tank=tank),
    )  # fmt: skip


def test_the_shift_has_three_components_in_a_box():
    """The largest is √(20² + 30² + 60²) = 70 mm."""
    found = measure(recording(False))
    assert [found[f"final_shift_{axis}"].value for axis in "yzx"] == pytest.approx([10.0, 0.0, 40.0], abs=1e-9)
    assert found["largest_shift"].value == pytest.approx(70.0)


def test_in_a_slice_no_place_along_x_is_farther_than_another():
    found = measure(recording(True))
    assert "final_shift_x" not in found
    assert found["largest_shift"].value == pytest.approx(np.hypot(20.0, 30.0))
