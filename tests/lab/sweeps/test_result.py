"""A sweep as labelled data over its axes, and as a table of pandas: keys in SI, measures with their scatter."""

import json

import numpy as np
import pint
import pytest

import cargolab
from lab.measures.value import Value, over_worlds
from lab.sweeps.grid import define_sweep
from lab.sweeps.result import point_folder

AXES = {"grains.diameter": ["4 mm", "0.6 cm"], "material.friction": "0.1:0.3:3"}
ANGLES = 20.0 + np.arange(6.0).reshape(2, 3)  # deg
MISSING = 4  # the point that was not run


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A sweep over diameter and friction, in which a point is missing and one measure is not found everywhere."""
    folder = tmp_path_factory.mktemp("sweep")
    sweep = define_sweep("tilting/quick", AXES, {"title": "<script>"})
    sweep.write(folder)
    for number, angle in enumerate(ANGLES.ravel()):
        if number == MISSING:
            continue
        measures = {
            "critical_angle": over_worlds([angle - 1.0, angle + 1.0], "deg", uncertainties=[0.3] * 2, kind="detector"),
            "final_shift": over_worlds([0.5 * angle, np.nan], "d"),
        }
        if number == 0:
            measures["flow_rate"] = Value(2.0, "1", worlds=(2.0,))
        told = {"measures": {name: one.as_json() for name, one in measures.items()}, "status": "complete"}
        where = point_folder(folder, number)
        where.mkdir(parents=True)
        (where / "summary.json").write_text(json.dumps(told | {"warnings": [], "version": "0.2.0"}))
    return folder


def test_a_sweep_is_a_data_set_over_its_axes(folder):
    data = cargolab.open(folder).dataset()
    assert dict(data.sizes) == {"grains.diameter": 2, "material.friction": 3}
    assert data["grains.diameter"].values == pytest.approx([0.004, 0.006])
    assert data["grains.diameter"].attrs["units"] == "m" and data["material.friction"].attrs["units"] == "1"
    angle = data["critical_angle"]
    expected = ANGLES.copy()
    expected.flat[MISSING] = np.nan
    np.testing.assert_array_equal(angle.values, expected)
    assert float(angle.sel({"material.friction": 0.3}, method="nearest")[1]) == 25.0
    assert angle.attrs["units"] == "deg"
    spread = data["critical_angle_std"].values.ravel()
    assert np.delete(spread, MISSING) == pytest.approx(np.sqrt(2.0)) and np.isnan(spread[MISSING])
    assert data["critical_angle_n"].values.ravel().tolist() == [2, 2, 2, 2, 0, 2]
    assert data["final_shift_n"].values.ravel().tolist() == [1, 1, 1, 1, 0, 1]
    assert data["critical_angle_uncertainty"].values.flat[0] == pytest.approx(0.3)
    assert data["flow_rate"].notnull().sum() == 1
    assert data["status"].values.ravel().tolist() == [*["complete"] * 4, "not run", "complete"]


def test_its_units_are_those_of_pint(folder):
    """A length in mean diameters, which the lab writes d, is no number of days."""
    registry, data = pint.UnitRegistry(), cargolab.open(folder).dataset()
    for one in data.variables.values():
        registry.parse_units(one.attrs.get("units", "1"))
    assert data["final_shift"].attrs["units"] == "1" and "diameter" in data["final_shift"].attrs["relative_to"]


def test_a_sweep_over_words_has_them_as_text(tmp_path):
    sweep = define_sweep("tilting/quick", {"contact.tangential": ["haff-werner", "none"], "run.repeats": [1, 2]})
    sweep.write(tmp_path)
    data = cargolab.open(tmp_path).dataset()
    assert (
        data["contact.tangential"].values.tolist() == ["haff-werner", "none"]
        and "units" not in data["contact.tangential"].attrs
    )
    assert data["run.repeats"].values.tolist() == [1, 2] and data["status"].values.tolist() == [["not run"] * 2] * 2


def test_a_sweep_is_a_table_of_pandas(folder):
    frame = cargolab.open(folder).frame()
    assert len(frame) == 6 and frame.attrs["units"]["grains.diameter"] == "m"
    row = frame[(frame["grains.diameter"] > 0.005) & (frame["material.friction"] > 0.25)].iloc[0]
    assert row["critical_angle"] == 25.0 and row["critical_angle_n"] == 2


def test_a_sweep_shows_itself(folder):
    found = cargolab.open(folder)
    page = found._repr_html_()
    assert "24.0" not in page and "25.0 ± 1.4 deg (2 beds)" in page and "not run" in page
    assert "<script" not in page
    assert str(found).startswith("Sweep of tilting/quick: 5 of 6 points are complete")
    assert repr(found) == f"<SweepResult of 6 points in {folder}>"
    with pytest.raises(cargolab.Error, match="has no figure 'angle'; it has none"):
        found.plot("angle")
    with pytest.raises(cargolab.Error, match="has no video"):
        found.video  # noqa: B018
